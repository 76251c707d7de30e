#include <fmt/format.h>

#include <algorithm>

#include "analysis/rules.hpp"
#include "report/format.hpp"
#include "report/names.hpp"
#include "report/quantities.hpp"
#include "report/text_sections.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

std::string tests_text(const std::vector<ShortTest>& tests) {
  if (tests.empty()) return {};
  std::string text = "\nTests\n";
  for (const ShortTest& test : tests) text += fmt::format("  - {}\n", printable(test.finding));
  return text;
}

std::string judgement_text(const Recording& recording, const Analysis& analysis) {
  const std::string& file = recording.provenance().file;
  std::string text =
      fmt::format("{}: {}", file.empty() ? "recording" : printable(file), words_for_motion(analysis.motion));
  if (analysis.frequency.quoted.value) {
    text += fmt::format(", {} Hz", with_error(analysis.frequency.quoted));
    if (analysis.cycles.count > 0) text += fmt::format(", {} slips", analysis.cycles.count);
  }
  text += "\n";
  if (!analysis.motion_reason.empty()) text += fmt::format("  {}\n", printable(analysis.motion_reason));
  return text;
}

std::string spectral_text(const SpectralFrequency& spectral) {
  if (!spectral.value_Hz) return "no repetition stands out of the spectrum";
  const std::string frequency = with_error(Estimate{spectral.value_Hz, spectral.standard_error_Hz, {}, {}});
  const std::size_t lines = spectral.harmonics_Hz.size();
  return fmt::format("{} Hz, {} {}, false-alarm probability {:.1g}", frequency, lines,
                     lines == 1 ? "harmonic" : "harmonics", spectral.false_alarm_probability);
}

std::string lines_text(const std::vector<SuspiciousLine>& lines) {
  std::string text;
  for (const SuspiciousLine& line : lines) {
    text +=
        fmt::format("  suspicious line at {}: {}\n", quantity_text(line.frequency_Hz, "Hz"), printable(line.reason));
  }
  return text;
}

/// "5.983 N (sd 0.054 N)": rounded by the spread, both in one unit.
std::string with_spread(std::optional<double> value, std::optional<double> spread, const std::string& SI_unit) {
  if (!value || !spread) return quantity_text(value, SI_unit);
  const DisplayUnit unit = display_unit(SI_unit, value);
  const double shown_spread = *spread * unit.per_SI;
  const std::string blank_unit = unit.unit.empty() ? std::string() : " " + unit.unit;
  return fmt::format("{}{} (sd {}{})", rounded(*value * unit.per_SI, shown_spread), blank_unit,
                     rounded(shown_spread, shown_spread), blank_unit);
}

Table estimate_table() {
  return Table({Align::Left, Align::Right, Align::Left, Align::Left, Align::Left});
}

/// What is not known is a row only where the note says why. `unit`: of SI, or one to show.
template <class Unit>
void add_estimate(Table& table, std::string_view words, const Estimate& estimate, Unit unit) {
  if (!estimate.value && !estimate.ci95 && estimate.note.empty()) return;
  const EstimateRow row = estimate_row(estimate, unit);
  table.add({std::string(words), row.value, row.unit, row.interval, printable(estimate.note)});
}

std::string regime_text(Regime regime) {
  if (regime == Regime::StickSlipBistable) {
    return "  regime: stick-slip from rest; steady sliding, once reached, persists too (bistable)\n";
  }
  std::string words(name_of(regime));
  std::ranges::replace(words, '_', '-');
  return fmt::format("  regime: {}\n", words);
}

std::string frequency_text(const FrequencyReport& frequency) {
  Table table({Align::Left, Align::Left});
  table.add({"by FFT", spectral_text(frequency.spectral)});
  const Estimate& counted = frequency.counted;
  table.add({"by counting slips", counted.value ? with_error(counted) + " Hz" : "none: " + printable(counted.note)});
  if (frequency.quoted.value) {
    const std::string interval = estimate_row(frequency.quoted, "Hz").interval;
    table.add({"result", with_error(frequency.quoted) + " Hz" +
                             (interval.empty() ? "" : ", 95 % interval " + interval) +
                             fmt::format(" (method: {})", plain_words(name_of(frequency.method)))});
  } else {
    const std::string& note = frequency.quoted.note;
    table.add({"result", "none" + (note.empty() ? note : ": " + printable(note))});
  }
  return "\nFrequency\n" + table.text() + lines_text(frequency.lines);
}

/// "0.199 ± 0.002 N/s (drift of the sensor)"; empty where the level has no significant trend.
std::string trend_text(const Analysis& analysis, ForceQuantity quantity) {
  if (!analysis.fit || !analysis.fit->level_trend.level_range) return {};
  const LevelTrend& trend = analysis.fit->level_trend;
  const char* const reading = trend.reading == LevelReading::Sensor ? "drift of the sensor"
                              : trend.reading == LevelReading::Friction
                                  ? "change of the friction"
                                  : "drift of the sensor or change of the friction";
  return fmt::format("{}{} ({})", with_error(trend.rate_per_s), quantity == ForceQuantity::Force_N ? " N/s" : " /s",
                     reading);
}

std::string cycles_text(const Analysis& analysis, ForceQuantity quantity) {
  const CycleStatistics& cycles = analysis.cycles;
  const std::string unit = force_unit(quantity);
  Table table({Align::Left, Align::Left});
  table.add({"slips", fmt::format("{} counted, {} minor{}, {} used in the fit", cycles.count, cycles.minor,
                                  cycles.minor > 0 ? " (drop below a quarter of the median)" : "", cycles.used)});
  if (cycles.period_s) table.add({"period", with_spread(cycles.period_s, cycles.period_sd_s, "s")});
  if (cycles.regularity) table.add({"rhythm", std::string(name_of(*cycles.regularity))});
  if (cycles.slip_time_s) table.add({"slip time", quantity_text(cycles.slip_time_s, "s")});
  if (cycles.stick_time_s) table.add({"stick time", quantity_text(cycles.stick_time_s, "s")});
  if (cycles.sticking_degree) table.add({"sticking degree", quantity_text(cycles.sticking_degree, "")});
  if (cycles.peak_force) table.add({"peak force", with_spread(cycles.peak_force, cycles.peak_force_sd, unit)});
  if (cycles.trough_force) table.add({"trough force", quantity_text(cycles.trough_force, unit)});
  if (cycles.force_drop) table.add({"force drop", with_spread(cycles.force_drop, cycles.force_drop_sd, unit)});
  if (cycles.stick_stiffness.value && quantity == ForceQuantity::Force_N) {
    table.add({"slope of the sticks / V", with_error(cycles.stick_stiffness) + " N/m"});
  }
  const std::string trend = trend_text(analysis, quantity);
  if (!trend.empty()) table.add({"trend of the level", trend});
  return "\nCycles\n" + table.text();
}

std::string transients_text(const Transients& transients, ForceQuantity quantity) {
  Table table = estimate_table();
  for (const auto& row : kTransients) {
    const bool is_breakaway = row.unit == "N";
    if (row.unit == "N/m" && quantity != ForceQuantity::Force_N) continue;
    if (!(transients.*row.estimate).value) continue;
    add_estimate(table, row.words, transients.*row.estimate,
                 is_breakaway ? force_unit(quantity) : std::string(row.unit));
  }
  return table.empty() ? std::string() : "\nBefore and after the sliding\n" + table.text();
}

std::string coefficients_text(const std::optional<Coefficients>& coefficients) {
  if (!coefficients) return {};
  Table table = estimate_table();
  for (const auto& [words, estimate] : coefficient_rows(*coefficients)) {
    if (estimate.value) add_estimate(table, words, estimate, "");
  }
  if (table.empty()) return {};
  std::string text = "\nCoefficient of friction\n" + table.text();
  for (const StandardCoefficients& standard : coefficients->standards) {
    text += fmt::format("  as {} asks: static {}, kinetic {}\n    prescribed: {}\n    here: {}\n", standard.standard,
                        estimate_text(standard.static_coefficient, ""), estimate_text(standard.kinetic_coefficient, ""),
                        standard.prescribes, differences_text(standard));
  }
  return text;
}

std::string spacing_text(const Recording& recording, const Derived& derived) {
  const std::string title = fmt::format("\nSpacing, measured (V/f) at {}\n", speed_text(recording.conditions()));
  if (!derived.pattern_spacing_m.value) {
    const std::string& note = derived.pattern_spacing_m.note;
    return title + fmt::format("  none{}\n", note.empty() ? note : ": " + printable(note));
  }
  Table table = estimate_table();
  for (const auto& row : kMeasured) add_estimate(table, row.words, derived.*row.estimate, std::string(row.unit));
  add_estimate(table, "spread of the spacing over cycles (sd)", Estimate{derived.pattern_spacing_sd_m, {}, {}, {}},
               std::string("m"));
  return title + table.text();
}

std::string surface_text(const Derived& derived) {
  if (!derived.surface_spacing_m) return {};
  Table table = estimate_table();
  add_estimate(table, "pattern on the worn surface", *derived.surface_spacing_m, "m");
  add_estimate(table, "over the spacing by force (V/f)", derived.surface_ratio.value_or(Estimate{}), "");
  add_estimate(table, "E_n of the two (within +-1: agree)", derived.surface_En.value_or(Estimate{}), "");
  return "\nOn the worn surface\n" + table.text() + "  " + printable(derived.surface_verdict) + "\n";
}

std::string predicted_text(const Recording& recording, const Derived& derived) {
  const std::string title = "\nPredicted by the model at this speed\n";
  if (!derived.lambda.value && !derived.lambda.note.empty())
    return title + "  nothing: " + printable(derived.lambda.note) + "\n";
  Table table = estimate_table();
  for (const auto& row : kPredicted) {
    const Estimate& estimate = derived.*row.estimate;
    if (row.unit == "m/s") {
      add_estimate(table, row.words, estimate, speed_unit(recording.conditions().speed_unit, estimate.value));
    } else {
      add_estimate(table, row.words, estimate, std::string(row.unit));
    }
  }
  if (table.empty() && !derived.regime) return {};
  return title + table.text() + (derived.regime ? regime_text(*derived.regime) : std::string());
}

std::string recording_text(const Recording& recording, const Analysis& analysis) {
  const Quality& quality = analysis.quality;
  const Conditions& conditions = recording.conditions();
  std::string text = "\nRecording\n";
  text += fmt::format("  {} samples at {} over {}, sensor sees the {} force", recording.size(),
                      stated_text(1.0 / recording.sample_interval_s(), "Hz"),
                      quantity_text(recording.duration_s(), "s"), name_of(conditions.force_view));
  if (conditions.normal_force_N) text += ", normal force " + stated_text(*conditions.normal_force_N, "N");
  text += fmt::format("\n  noise {} rms", quantity_text(quality.noise_rms, force_unit(conditions.quantity)));
  for (const std::string& defect : defects_of(recording, quality)) text += ", " + defect;
  const TimeSpan& sliding = analysis.sliding;
  if (sliding.end_s - sliding.begin_s < recording.duration_s()) {
    text += fmt::format(
        "\n  sliding from {:.6g} to {:.6g} s: all numbers are of this stretch (--window T0:T1 chooses another)",
        sliding.begin_s, sliding.end_s);
  }
  return text + "\n";
}

}  // namespace

std::string warnings_text(const Warnings& warnings) {
  std::string doubts;
  std::string facts;
  for (const Warning& warning : warnings) {
    (is_fact(warning) ? facts : doubts) += fmt::format("  {} {} [{}]\n", is_fact(warning) ? '-' : '!',
                                                       printable(warning.message), printable(warning.code));
  }
  return (doubts.empty() ? "" : "\nWarnings\n" + doubts) +
         (facts.empty() ? "" : "\nAccounted for in the analysis\n" + facts);
}

std::string assumed_text(const std::vector<std::string>& assumed) {
  if (assumed.empty()) return {};
  std::string text = "\nAssumed while reading\n";
  for (const std::string& sentence : assumed) text += fmt::format("  - {}\n", printable(sentence));
  return text;
}

std::vector<std::string> defects_of(const Recording& recording, const Quality& quality) {
  const Provenance& provenance = recording.provenance();
  std::vector<std::string> found;
  const auto add = [&found](std::size_t count, const char* what) {
    if (count > 0) found.push_back(fmt::format("{} {}", count, what));
  };
  add(quality.clipped_samples, "samples at the end of the sensor's range");
  add(quality.impulses, "isolated impulses, left out");
  add(quality.gaps, "gaps");
  if (quality.gaps > 0) found.back() += ", the longest " + quantity_text(quality.longest_gap_s, "s");
  add(provenance.rows_without_number, "rows without a number, left out");
  add(provenance.rows_backward_in_time, "rows backward in time, left out");
  add(provenance.rows_repeating_time, "repeated time stamps, kept");
  return found;
}

std::string to_text(const Recording& recording, const Analysis& analysis) {
  std::string text = judgement_text(recording, analysis);
  text += parameters_text(recording, analysis);
  text += frequency_text(analysis.frequency);
  if (analysis.motion != MotionClass::SteadySliding) {
    text += cycles_text(analysis, recording.conditions().quantity);
  }
  text += transients_text(analysis.transients, recording.conditions().quantity);
  text += coefficients_text(analysis.coefficients);
  text += spacing_text(recording, analysis.derived);
  text += surface_text(analysis.derived);
  const bool moves_like_model =
      analysis.motion == MotionClass::StickSlip || analysis.motion == MotionClass::OscillatorySlip;
  if (moves_like_model) text += predicted_text(recording, analysis.derived);
  text += tests_text(analysis.tests);
  text += recording_text(recording, analysis);
  text += warnings_text(analysis.warnings);
  text += assumed_text(recording.provenance().assumed);
  return text;
}

}  // namespace slipfit
