#include "report/blocks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/rules.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

/// Returns the row of the trend, or nothing if the level has no significant trend.
std::optional<Row> trend_row(const Analysis& analysis, ForceQuantity quantity) {
  if (!analysis.fit || !analysis.fit->level_trend.level_range) return std::nullopt;
  const LevelTrend& trend = analysis.fit->level_trend;
  const char* const reading = trend.reading == LevelReading::Sensor ? "drift of the sensor"
                              : trend.reading == LevelReading::Friction
                                  ? "change of the friction"
                                  : "drift of the sensor or change of the friction";
  const char* const unit = quantity == ForceQuantity::Force_N ? " N/s" : " /s";
  return Row{"trend of the level", with_error(trend.rate_per_s) + unit, {}, {}, reading};
}

std::string regime_sentence(Regime regime) {
  if (regime == Regime::StickSlipBistable) {
    return "regime: stick-slip from rest; steady sliding is stable as well (bistable)";
  }
  std::string words(name_of(regime));
  std::ranges::replace(words, '_', '-');
  return "regime: " + words;
}

std::string whiteness_sentence(double p) {
  constexpr double kLevel = 1e-3;
  constexpr double kSmallestPrinted = 1e-6;  // the normal approximation is not accurate that far into its tail
  return fmt::format("residuals: {} (whiteness p {}, level {:g})",
                     p < kLevel ? "neighbouring residuals are correlated, so the model misses a pattern"
                                : "consistent with white noise",
                     p > kSmallestPrinted ? fmt::format("{:.2g}", p) : "below 1e-6", kLevel);
}

/// Returns the defects of the samples: "4 gaps, the longest 120 ms", ...
std::vector<std::string> defects_of(const Recording& recording, const Quality& quality) {
  const Provenance& provenance = recording.provenance();
  std::vector<std::string> found;
  const auto add = [&found](std::size_t count, const char* what) {
    if (count > 0) found.push_back(fmt::format("{} {}", count, what));
  };
  add(quality.clipped_samples, "samples at the limit of the sensor's range");
  add(quality.impulses, "isolated impulses, left out");
  add(quality.gaps, "gaps");
  if (quality.gaps > 0) found.back() += ", the longest " + quantity_text(quality.longest_gap_s, "s");
  add(provenance.rows_without_number, "rows without a number, left out");
  add(provenance.rows_backward_in_time, "rows backward in time, left out");
  add(provenance.rows_repeating_time, "repeated time stamps, kept");
  if (found.empty()) found.emplace_back("No gaps, no clipping, no impulses, no rows left out");
  return found;
}

}  // namespace

void Block::add(std::string_view label, const Estimate& estimate, const std::string& SI_unit) {
  add(label, estimate, suitable_unit(estimate, SI_unit));
}

void Block::add(std::string_view label, const Estimate& estimate, const DisplayUnit& unit) {
  if (!estimate.value && !estimate.ci95 && estimate.note.empty()) return;
  const EstimateRow shown = estimate_row(estimate, unit);
  rows.push_back({std::string(label), shown.value, shown.unit, shown.interval, printable(estimate.note)});
}

namespace {

/// Adds the quantities of a table; those in N/m only if the force column holds newtons.
template <class Table, class Owner>
void add_all(Block& block, const Table& table, const Owner& owner, const Conditions& conditions) {
  for (const auto& quantity : table) {
    if (quantity.unit == "N/m" && conditions.quantity != ForceQuantity::Force_N) continue;
    Estimate estimate = quantity.of(owner);
    const DisplayUnit unit = unit_of(quantity, estimate, conditions);
    const std::optional<double> spread = quantity.spread != nullptr ? quantity.spread(owner) : std::nullopt;
    if (spread) {
      const double shown = *spread * unit.per_SI;
      estimate.standard_error = spread;  // rounds the value
      estimate.note =
          fmt::format("standard deviation {}{}{}", rounded(shown, shown), unit.unit.empty() ? "" : " ", unit.unit);
    }
    block.add(quantity.words, estimate, unit);
  }
}

/// Leaves out rows whose value is not known, with their reasons.
void erase_unknown(Block& block) {
  std::erase_if(block.rows, [](const Row& row) { return row.value == "-"; });
}

Block frequency_block(const FrequencyReport& frequency) {
  const auto row = [](const char* label, const Estimate& estimate, const std::string& interval, std::string note) {
    if (estimate.value) return Row{label, with_error(estimate) + " Hz", {}, interval, std::move(note)};
    return Row{label, "none", {}, {}, printable(estimate.note)};
  };
  const SpectralFrequency& spectral = frequency.spectral;
  const std::size_t lines = spectral.harmonics_Hz.size();
  Block block{"frequency", "Frequency"};
  block.rows = {
      row("by FFT", {spectral.value_Hz, spectral.standard_error_Hz, {}, "the spectrum shows no significant repetition"},
          {},
          fmt::format("{} {}, false-alarm probability {:.1g}", lines, lines == 1 ? "harmonic" : "harmonics",
                      spectral.false_alarm_probability)),
      row("by counting slips", frequency.counted, {}, {}),
      row("result", frequency.quoted, estimate_row(frequency.quoted, std::string("Hz")).interval,
          "method: " + plain_words(name_of(frequency.method)))};
  for (const SuspiciousLine& line : frequency.lines) {
    block.sentences.push_back(
        fmt::format("suspicious line at {}: {}", quantity_text(line.frequency_Hz, "Hz"), printable(line.reason)));
  }
  return block;
}

Block cycles_block(const Analysis& analysis, const Conditions& conditions) {
  const CycleStatistics& cycles = analysis.cycles;
  Block block{"cycles-numbers", "Cycles"};
  block.rows = {{"slips",
                 std::to_string(cycles.count),
                 {},
                 {},
                 fmt::format("{} minor{}, {} used in the fit", cycles.minor,
                             cycles.minor > 0 ? " (drop below a quarter of the median)" : "", cycles.used)}};
  if (cycles.regularity) block.rows.push_back({"rhythm", std::string(name_of(*cycles.regularity))});
  add_all(block, kCycleQuantities, cycles, conditions);
  erase_unknown(block);
  if (auto trend = trend_row(analysis, conditions.quantity)) block.rows.push_back(*std::move(trend));
  return block;
}

Block transients_block(const Transients& transients, const Conditions& conditions) {
  Block block{"transients", "Before and after the sliding"};
  add_all(block, kTransients, transients, conditions);
  erase_unknown(block);
  return block;
}

Block spacing_block(const Conditions& conditions, const Derived& derived) {
  Block block{"spacing", "Spacing, measured (V/f) at " + speed_text(conditions)};
  add_all(block, kMeasured, derived, conditions);
  if (block.rows.empty()) block.sentences.emplace_back("none");
  return block;
}

Block surface_block(const Conditions& conditions, const Derived& derived) {
  Block block{"worn-surface", "On the worn surface"};
  if (!derived.surface_spacing_m) return block;
  add_all(block, kOnSurface, derived, conditions);
  block.sentences.push_back(printable(derived.surface_verdict));
  return block;
}

Block predicted_block(const Conditions& conditions, const Derived& derived) {
  Block block{"predicted", "Predicted by the model at this speed"};
  if (!derived.lambda.value && !derived.lambda.note.empty()) {
    block.sentences.push_back("nothing: " + printable(derived.lambda.note));
    return block;
  }
  add_all(block, kPredicted, derived, conditions);
  if (derived.regime) block.sentences.push_back(regime_sentence(*derived.regime));
  return block;
}

Block tests_block(const std::vector<ShortTest>& tests) {
  Block block{"tests", "Tests"};
  for (const ShortTest& test : tests) block.sentences.push_back(printable(test.finding));
  return block;
}

}  // namespace

Block coefficients_block(const std::optional<Coefficients>& coefficients) {
  Block block{"coefficients", "Coefficient of friction"};
  if (!coefficients) return block;
  add_all(block, kCoefficients, *coefficients, {});
  add_all(block, kCoefficientThirds, *coefficients, {});
  add_all(block, kCoefficientSpreads, *coefficients, {});
  for (const StandardCoefficients& standard : coefficients->standards) {
    Estimate kinetic = standard.kinetic_coefficient;
    kinetic.note =
        fmt::format("{} prescribes {}. Here: {}", standard.standard, standard.prescribes,
                    standard.differs.empty() ? std::string("as prescribed, as far as a recording can show it")
                                             : fmt::format("{}", fmt::join(standard.differs, "; ")));
    block.add("static, as " + standard.standard, standard.static_coefficient, "");
    block.add("kinetic, as " + standard.standard, kinetic, "");
  }
  return block;
}

Block quality_block(const Recording& recording, const Analysis& analysis) {
  const Quality& quality = analysis.quality;
  const Conditions& conditions = recording.conditions();
  const std::string unit = force_unit(conditions.quantity);
  Block block{"quality", "Data quality"};
  block.rows = {{"samples", std::to_string(recording.size())},
                {"sampling rate", stated_text(1.0 / recording.sample_interval_s(), "Hz")},
                {"duration", quantity_text(recording.duration_s(), "s")},
                {"force that the sensor measures", std::string(name_of(conditions.force_view))}};
  if (conditions.normal_force_N) block.rows.push_back({"normal force", stated_text(*conditions.normal_force_N, "N")});
  block.rows.push_back({"noise, rms", quantity_text(quality.noise_rms, unit)});
  if (quality.quantisation_step)
    block.rows.push_back({"smallest step of the sensor", quantity_text(quality.quantisation_step, unit)});
  constexpr double kNoJitter = 1e-4;  // rounding leaves as much of an even clock
  const bool is_even = quality.clock_jitter < kNoJitter;
  block.rows.push_back({"clock jitter", is_even ? "less than 0.01 % of a step"
                                                : quantity_text(100.0 * quality.clock_jitter, "") + " % of a step"});
  block.sentences = defects_of(recording, quality);
  const TimeSpan& sliding = analysis.sliding;
  if (sliding.end_s - sliding.begin_s < recording.duration_s()) {
    block.sentences.push_back(
        fmt::format("sliding from {:.6g} to {:.6g} s: all numbers refer to this part (--window T0:T1 selects another)",
                    sliding.begin_s, sliding.end_s));
  }
  return block;
}

const char* reference_of_residuals(FitKind kind) {
  return kind == FitKind::Single ? "the noise" : "that of the recordings fitted alone";
}

Block models_block(const FitResult& fit, ForceQuantity quantity, FitKind kind) {
  Block block{"models", "Models compared"};
  const std::string unit = force_unit(quantity);
  for (const Candidate& candidate : fit.candidates) {
    block.rows.push_back({std::string(name_of(candidate.tier)),
                          candidate.rms ? quantity_text(candidate.rms, unit) + " rms" : "",
                          candidate.chosen ? "chosen" : "not chosen",
                          {},
                          printable(candidate.reason)});
  }
  std::string residual = fmt::format("residual {} rms", quantity_text(fit.residual.rms, unit));
  if (const auto chi2 = fit.residual.reduced_chi2)
    residual +=
        fmt::format(", {:.3g} times {} (reduced chi2 {:.3g})", std::sqrt(*chi2), reference_of_residuals(kind), *chi2);
  block.sentences.push_back(residual);
  if (fit.residual.whiteness_p) block.sentences.push_back(whiteness_sentence(*fit.residual.whiteness_p));
  for (const std::string& condition : fit.conditional_on) block.sentences.push_back("assumed: " + printable(condition));
  return block;
}

Block correlations_block(const FitResult& fit) {
  constexpr double kWorthShowing = 0.7;  // half of the variance of one follows from the other
  Block block{"correlations", "Correlated parameters"};
  if (!fit.correlation) return block;
  const auto& [names, matrix] = *fit.correlation;
  std::vector<std::pair<double, std::string>> pairs;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (std::abs(matrix[i][j]) < kWorthShowing) continue;
      pairs.emplace_back(matrix[i][j],
                         fmt::format("{}; {}", quantity_with_key(names[j]).words, quantity_with_key(names[i]).words));
    }
  }
  std::ranges::stable_sort(pairs, [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  for (const auto& [correlation, words] : pairs) block.rows.push_back({words, fmt::format("{:+.3f}", correlation)});
  return block;
}

Block repeats_block(const std::vector<Repeat>& repeats) {
  Block block{"repeats", "At one speed: scatter between the recordings"};
  for (const Repeat& repeat : repeats) {
    Estimate mean = repeat.mean;
    mean.note = fmt::format("standard deviation {} between {} recordings",
                            quantity_text(repeat.standard_deviation, repeat.unit), repeat.count);
    block.add(repeat.words, mean, repeat.unit);
  }
  return block;
}

std::vector<Block> number_blocks(const Recording& recording, const Analysis& analysis) {
  const Conditions& conditions = recording.conditions();
  std::vector<Block> blocks{frequency_block(analysis.frequency)};
  if (analysis.motion != MotionClass::SteadySliding) blocks.push_back(cycles_block(analysis, conditions));
  blocks.push_back(transients_block(analysis.transients, conditions));
  blocks.push_back(spacing_block(conditions, analysis.derived));
  blocks.push_back(surface_block(conditions, analysis.derived));
  const bool moves_like_model =
      analysis.motion == MotionClass::StickSlip || analysis.motion == MotionClass::OscillatorySlip;
  if (moves_like_model) blocks.push_back(predicted_block(conditions, analysis.derived));
  blocks.push_back(tests_block(analysis.tests));
  std::erase_if(blocks, [](const Block& block) { return block.empty(); });
  return blocks;
}

std::string text_of(const Block& block) {
  if (block.empty()) return {};
  Table table({Align::Left, Align::Right, Align::Left, Align::Left, Align::Left});
  for (const Row& row : block.rows) table.add({row.label, row.value, row.unit, row.interval, row.note});
  std::string text = "\n" + block.title + "\n" + table.text();
  for (const std::string& sentence : block.sentences) text += wrapped_text("  - ", sentence);
  return text;
}

namespace {

/// Each note once, after the names of the parameters that it is about.
std::string notes_text(const std::vector<Parameter>& parameters) {
  std::string text;
  for (auto first = parameters.begin(); first != parameters.end(); ++first) {
    const std::string& note = first->estimate.note;
    const auto has_note = [&note](const Parameter& parameter) { return parameter.estimate.note == note; };
    if (note.empty() || std::any_of(parameters.begin(), first, has_note)) continue;
    std::string names;
    for (auto other = first; other != parameters.end(); ++other) {
      if (has_note(*other)) names += (names.empty() ? "" : ", ") + printable(info(other->id).words);
    }
    const bool is_of_all = std::ranges::all_of(parameters, has_note);
    text += wrapped_text("    ", fmt::format("{}: {}", is_of_all ? "all of them" : names, printable(note)));
  }
  return text;
}

}  // namespace

std::vector<std::string> status_meanings(const std::vector<Parameter>& parameters) {
  constexpr auto kMeanings = std::to_array<std::pair<ParameterStatus, std::string_view>>(
      {{ParameterStatus::Weak, "an estimate that should be confirmed"},
       {ParameterStatus::Bounded, "only an interval is known"},
       {ParameterStatus::Unidentified, "the data do not determine it"},
       {ParameterStatus::Conditional, "determined if the assumption in its note holds"},
       {ParameterStatus::Fixed, "fixed at the stated value"}});
  std::vector<std::string> meanings;
  for (const auto& [status, meaning] : kMeanings) {
    if (std::ranges::find(parameters, status, &Parameter::status) == parameters.end()) continue;
    meanings.push_back(fmt::format("{}: {}", name_of(status), meaning));
  }
  return meanings;
}

std::string critical_speed_text(const Estimate& speed_m_per_s, const Estimate& lambda, const std::string& given_unit) {
  std::string text = fmt::format("  {}: ", quantity_with_key("critical_speed_m_per_s").words);
  const std::string note = in_speed_unit(speed_m_per_s.note, given_unit);
  if (!speed_m_per_s.value) return wrapped_text(text, note.empty() ? "not known" : printable(note));
  text += estimate_text(speed_m_per_s, speed_unit(given_unit, speed_m_per_s.value));
  if (!note.empty()) return text + "\n" + wrapped_text("  ", printable(note));
  return text + fmt::format(", lambda there {}\n", estimate_text(lambda, display_unit("", {})));
}

std::string off_by(const Estimate& predicted, const Estimate& measured) {
  if (!predicted.value || !measured.value) return "-";
  constexpr double kWorthAPercentage = 10.0;
  const double factor = std::exp(std::abs(std::log(*predicted.value / *measured.value)));
  if (!(factor < kWorthAPercentage)) return "more than a factor of 10";
  return fmt::format("{:+.1f} %", 100.0 * (*predicted.value / *measured.value - 1.0));
}

std::string conditions_text(const std::vector<std::string>& conditional_on) {
  if (conditional_on.empty()) return {};
  return wrapped_text("  assumed: ", printable(fmt::format("{}", fmt::join(conditional_on, "; "))));
}

EstimateRow parameter_row(const Parameter& parameter) {
  EstimateRow row = estimate_row(parameter.estimate, std::string(info(parameter.id).unit));
  const bool has_value =
      parameter.status != ParameterStatus::Bounded && parameter.status != ParameterStatus::Unidentified;
  if (!has_value) row.value = "-";
  return row;
}

std::vector<ShownParameter> shown_parameters(const FitResult& fit) {
  std::vector<ShownParameter> shown;
  for (const Parameter& parameter : fit.parameters) {
    EstimateRow row = parameter_row(parameter);
    if (row.interval.empty()) row.interval = "-";
    shown.push_back({printable(info(parameter.id).words), row, parameter.status, printable(parameter.estimate.note)});
  }
  return shown;
}

namespace {

/// Returns the table of parameters; `caution` follows the heading.
std::string parameters_text(const FitResult& fit, ForceQuantity quantity, FitKind kind, const std::string& caution) {
  Table table({Align::Left, Align::Right, Align::Left, Align::Left, Align::Left});
  table.add({"", "value", "unit", "95 % interval", "status"});
  for (const ShownParameter& parameter : shown_parameters(fit)) {
    const EstimateRow& numbers = parameter.numbers;
    table.add({parameter.words, numbers.value, numbers.unit, numbers.interval, std::string(name_of(parameter.status))});
  }
  std::string text = fmt::format("\nParameters{}\n", caution) + table.text() + notes_text(fit.parameters);
  for (const std::string& meaning : status_meanings(fit.parameters)) text += "  " + meaning + "\n";
  return text + text_of(models_block(fit, quantity, kind)) + text_of(correlations_block(fit));
}

std::string parameters_text(const Recording& recording, const Analysis& analysis) {
  if (!analysis.fit) return {};
  if (analysis.motion == MotionClass::SteadySliding) {
    return "\nParameters\n  none: the model describes stick-slip, which this recording does not show\n";
  }
  const bool is_doubtful = analysis.motion == MotionClass::Undetermined;
  return parameters_text(*analysis.fit, recording.conditions().quantity, FitKind::Single,
                         is_doubtful ? " (unreliable: the motion may not be stick-slip)" : "");
}

std::string recordings_text(std::span<const SweepEntry> entries, const SweepAnalysis& sweep) {
  Table table({Align::Left, Align::Right, Align::Left, Align::Left, Align::Left, Align::Left, Align::Right});
  table.add({"recording", "speed", "shows", "kinetic friction", std::string(kMeasured.front().words),
             "predicted from the others", "off by"});
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const SweepPoint* point = sweep.fit ? &sweep.fit->points[i] : nullptr;
    const Estimate& measured = sweep.recordings[i].derived.pattern_spacing_m;
    table.add({printable(entries[i].id), speed_text(entries[i].recording.conditions()),
               fmt::format("{}{}", plain_words(name_of(sweep.recordings[i].motion)),
                           sweep.roles[i] == SweepRole::LeftOut ? " (left out)" : ""),
               point != nullptr ? with_error(point->kinetic_friction_N, "N") : "-", with_error(measured, "m"),
               point != nullptr ? estimate_text(point->spacing_left_out_m, "m") : "-",
               point != nullptr ? off_by(point->spacing_left_out_m, measured) : "-"});
  }
  return "\nRecordings\n" + table.text();
}

}  // namespace

std::string to_text(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const std::string& name) {
  std::string text = fmt::format("{}: {} recordings fitted together\n", printable(name), entries.size());
  if (!sweep.fit)
    text = fmt::format("{}: {} recordings, no joint fit: {}\n", printable(name), entries.size(), sweep.fit_reason);
  if (sweep.fit) text += parameters_text(sweep.fit->result, ForceQuantity::Force_N, FitKind::Sweep, "");
  text += recordings_text(entries, sweep) + text_of(repeats_block(sweep.repeats));
  if (sweep.fit || sweep.derived.observed_end) {
    text += "\nEnd of stick-slip\n" + critical_speed_text(sweep.derived.critical_speed_m_per_s,
                                                          sweep.derived.lambda_critical,
                                                          entries.front().recording.conditions().speed_unit);
  }
  return text + warnings_text(sweep.warnings);
}

std::string warnings_text(const Warnings& warnings) {
  std::string doubts;
  std::string facts;
  for (const Warning& warning : warnings) {
    (is_fact(warning) ? facts : doubts) +=
        wrapped_text(is_fact(warning) ? "  - " : "  ! ", printable(warning.message + " [" + warning.code + "]"));
  }
  return (doubts.empty() ? "" : "\nWarnings\n" + doubts) +
         (facts.empty() ? "" : "\nAccounted for in the analysis\n" + facts);
}

std::string assumed_text(const std::vector<std::string>& assumed) {
  if (assumed.empty()) return {};
  std::string text = "\nAssumed while reading\n";
  for (const std::string& sentence : assumed) text += wrapped_text("  - ", printable(sentence));
  return text;
}

std::string to_text(const Recording& recording, const Analysis& analysis) {
  std::string text = headline_of(recording, analysis) + "\n";
  if (!analysis.motion_reason.empty()) text += wrapped_text("  ", printable(analysis.motion_reason));
  text += parameters_text(recording, analysis) + text_of(coefficients_block(analysis.coefficients));
  for (const Block& block : number_blocks(recording, analysis)) text += text_of(block);
  return text + text_of(quality_block(recording, analysis)) + warnings_text(analysis.warnings) +
         assumed_text(recording.provenance().assumed);
}

}  // namespace slipfit
