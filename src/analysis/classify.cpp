#include "analysis/classify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/detect.hpp"
#include "analysis/estimate.hpp"
#include "analysis/harmonic_null.hpp"
#include "core/counted.hpp"
#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "signal/smoothing.hpp"

namespace slipfit {
namespace {

bool no_repetition(const SpectralFrequency& spectral) {
  return !spectral.value_Hz;
}

/// Falls that come once in the stated path of the drive, or a whole number of times.
bool follows_drive_path(const Conditions& conditions, const Segmentation& segmentation) {
  if (!conditions.drive_path_m || !conditions.speed_is_known || segmentation.slips.size() < thresholds::kFewestSlips)
    return false;
  const MeanAndSpread interval = describe(slip_intervals_s(segmentation));
  const double paths = interval.mean * conditions.speed_m_per_s / *conditions.drive_path_m;
  if (paths * thresholds::kMostDriveSteps < 1.0) return false;
  const double nearest = paths < 1.0 ? 1.0 / std::round(1.0 / paths) : 1.0;
  const double error = interval.sd / interval.mean / std::sqrt(interval.count);
  return std::abs(paths / nearest - 1.0) < 2.0 * error + thresholds::kNegligible;
}

/// The periods of what repeats are not proven to scatter by more than those of a drive or of pick-up do.
bool keeps_time_like_a_clock(const Recording& recording, const SpectralFrequency& spectral) {
  if (!spectral.value_Hz || !spectral.standard_error_Hz) return false;
  const double periods = recording.duration_s() * *spectral.value_Hz;
  const double most = thresholds::kClockScatter * (1.0 + kNormalQuantile / std::sqrt(2.0 * periods));
  return *spectral.standard_error_Hz / *spectral.value_Hz * std::sqrt(periods) < most;
}

Classification too_few_in_cycle(double samples) {
  return {MotionClass::Undetermined,
          fmt::format("{:.1f} samples per cycle are too few to resolve slips; sample at least {:.0f} times faster",
                      samples, std::ceil(20.0 / samples))};
}

/// The force repeats, not like a clock, and swings further than the rest scatters, but with so few samples a cycle that
/// it passes for noise where neighbours are compared.
Classification unless_unresolved(Classification classification, const Recording& recording,
                                 const SpectralFrequency& spectral) {
  if (classification.motion != MotionClass::SteadySliding || !spectral.value_Hz) return classification;
  const double samples = 1.0 / (*spectral.value_Hz * recording.sample_interval_s());
  const bool is_resolved = samples > 2.0 * thresholds::kFewestCycleSamples;
  if (is_resolved || keeps_time_like_a_clock(recording, spectral)) return classification;
  constexpr double kSwings = 1.0 / 9.0;  // a swing, 2 sqrt(2) of its rms, as large as the rms of the rest
  return share_of_sine(recording, *spectral.value_Hz) > kSwings ? too_few_in_cycle(samples) : classification;
}

/// The second half of the recording moves little compared with the first swings: the motion died out.
bool ends_flat(const Recording& recording, const Segmentation& segmentation) {
  const double last_s = segmentation.slips.empty() ? recording.time_s().front() : segmentation.slips.back().middle_s;
  return last_s - recording.time_s().front() < thresholds::kSpanShare * recording.duration_s();
}

/// All falls lie close together near the end, and the force does not rise again: the release and its ring-down.
bool is_release(const Recording& recording, const Segmentation& segmentation) {
  const DetectedSlip& last = segmentation.slips.back();
  const auto after = recording.force().subspan(last.trough);
  if (*std::ranges::max_element(after) > last.trough_force + 0.5 * last.drop()) return false;
  const double first_s = segmentation.slips.front().middle_s - recording.time_s().front();
  const double last_s = segmentation.slips.back().middle_s - recording.time_s().front();
  return first_s > thresholds::kSpanShare * recording.duration_s() && last_s - first_s < 0.3 * recording.duration_s();
}

/// Returns the number of falls that are larger than what noise makes of a steady force.
std::size_t falls_beyond_noise(const Segmentation& segmentation) {
  const auto stands_out = [&](const DetectedSlip& slip) {
    return slip.drop() >= thresholds::kNoiseDrop * segmentation.noise;
  };
  return static_cast<std::size_t>(std::ranges::count_if(segmentation.slips, stands_out));
}

/// The force changes by more than half of its largest value, along one line: nothing slides yet, or a zero drifts.
bool is_only_loaded(const Recording& recording) {
  constexpr double kShare = 0.5;
  const std::span<const double> time_s = recording.time_s();
  const std::span<const double> force = recording.force();
  const LineSums line = line_sums(time_s, force);
  const double change = std::abs(line.slope()) * recording.duration_s();
  const auto [low, high] = std::ranges::minmax_element(force);
  if (!(change > kShare * std::max(std::abs(*low), std::abs(*high)))) return false;
  constexpr double kStraight = 0.05;  // rms about the line over the change; 0.1 where half is flat
  return std::sqrt(line.variance()) < kStraight * change;
}

std::optional<Classification> by_counts(const Recording& recording, const Segmentation& segmentation,
                                        const SpectralFrequency& spectral) {
  const std::size_t count = segmentation.slips.size();
  if (count == 0) {
    if (!is_only_loaded(recording))
      return Classification{MotionClass::SteadySliding, "the force has no drops larger than its noise"};
    return Classification{
        MotionClass::Undetermined,
        "the force only rises or falls, along a straight line: a loading ramp before the body slides, "
        "or a sensor that drifts; record longer"};
  }
  const std::size_t larger = falls_beyond_noise(segmentation);
  if (is_faint(segmentation) && larger < thresholds::kFewestSlips && no_repetition(spectral)) {
    return Classification{MotionClass::SteadySliding,
                          larger == 0 ? "the force varies no more than its noise, without repetition"
                                      : fmt::format("only {} larger than the noise of the force, and nothing repeats; "
                                                    "if these are slips, record longer",
                                                    larger == 1 ? "one fall is" : "two falls are")};
  }
  if (!slips_are_sudden(segmentation) && is_release(recording, segmentation)) {
    return Classification{MotionClass::SteadySliding, "no force drops except those of the release at the end"};
  }
  if (count < 4 && ends_flat(recording, segmentation)) {
    return Classification{MotionClass::SteadySliding,
                          fmt::format("{} at the start, then none", counted(count, "force drop"))};
  }
  if (count < thresholds::kFewestSlips) {
    return Classification{MotionClass::Undetermined,
                          fmt::format("only {}: at least 3 are needed; record longer", counted(count, "slip"))};
  }
  const double cycle_samples = (segmentation.slips.back().middle_s - segmentation.slips.front().middle_s) /
                               static_cast<double>(count - 1) / recording.sample_interval_s();
  return cycle_samples < thresholds::kFewestCycleSamples ? std::optional(too_few_in_cycle(cycle_samples))
                                                         : std::nullopt;
}

/// The spectrum shows the rhythm of the falls, whatever they scatter by.
bool spectrum_agrees(const Segmentation& segmentation, const SpectralFrequency& spectral) {
  if (!spectral.value_Hz || segmentation.slips.size() < thresholds::kFewestCycles) return false;
  // The median: falls that were missed do not count.
  return std::abs(*spectral.value_Hz * signal::median(slip_intervals_s(segmentation)) - 1.0) < thresholds::kSameRhythm;
}

/// Large swings that are smoother than a level that wanders, as those of a body that moves, or rougher, as those of one
/// that rings. Falls that are not much larger than the noise of the samples are as rough as that.
bool is_chatter(const Recording& recording, const Signals& signals) {
  const Segmentation& segmentation = signals.segmentation;
  if (segmentation.slips.size() < thresholds::kFewestCycles) return false;
  if (!(swing_share(segmentation) > thresholds::kLargeSwing)) return false;
  const double smooth = smoothness(recording, signals.quality, segmentation);
  const bool is_above_noise = median_drop(segmentation) > thresholds::kNoiseDrop * signals.quality.noise_rms;
  return smooth > thresholds::kSmoothMotion || (smooth < thresholds::kRoughMotion && is_above_noise);
}

/// Swings that are no wander of a level, and no motion that repeats.
Classification irregular(const Segmentation& segmentation) {
  const MeanAndSpread interval = describe(slip_intervals_s(segmentation));
  return {MotionClass::Undetermined,
          fmt::format("irregular slip or chatter: {} force drops, {:.3g} per second, of {:.0f} % of the range of the "
                      "force; their intervals scatter by {:.0f} %",
                      segmentation.slips.size(), 1.0 / interval.mean, 100.0 * swing_share(segmentation),
                      100.0 * interval.sd / interval.mean)};
}

bool are_few(const Segmentation& segmentation) {
  return segmentation.slips.size() < thresholds::kFewFalls;
}

/// The falls are proven to be as sudden as those of slips; few of them, which ripple may make, twice as sudden.
bool are_proven_sudden(const Segmentation& segmentation) {
  const double least = are_few(segmentation) ? 2.0 * thresholds::kSudden : thresholds::kSudden;
  return proven_rise_over_fall(segmentation) > least;
}

/// Classifies the trace without a model if the model fits no slip.
Classification without_model(const Recording& recording, const Signals& signals) {
  const Segmentation& segmentation = signals.segmentation;
  const double ratio = rise_over_fall(segmentation);
  const bool sudden = slips_are_sudden(segmentation);
  if (sudden && are_proven_sudden(segmentation)) {
    return {MotionClass::StickSlip, fmt::format("{} sudden force drops after rises that last {:.1f} times as long; the "
                                                "model does not fit them, so its parameters are unknown",
                                                segmentation.slips.size(), ratio)};
  }
  if (sudden || proven_rise_over_fall(segmentation) > thresholds::kSudden) {
    return {MotionClass::Undetermined,
            fmt::format("{} force drops after rises that last {:.1f} times as long; the model does not fit them, and "
                        "they are too few or too different to distinguish slips from ripple; record longer",
                        segmentation.slips.size(), ratio)};
  }
  if (spectrum_agrees(segmentation, signals.spectral)) {
    return {
        MotionClass::OscillatorySlip,
        fmt::format("oscillation without straight sticks: the force rises {:.1f} times as long as it falls", ratio)};
  }
  if (!keeps_rhythm(segmentation) && is_chatter(recording, signals)) return irregular(segmentation);
  if (!keeps_rhythm(segmentation)) {
    return {MotionClass::SteadySliding,
            "the force wanders: it falls no more suddenly than it rises, and without a period"};
  }
  return {MotionClass::Undetermined,
          fmt::format("the oscillation is not stick-slip: the force rises {:.1f} times as long as it falls", ratio)};
}

/// Describes oscillation without sticks; empty if slips come to rest.
std::optional<Classification> as_round_swings(const Segmentation& segmentation, const FitDiagnostics& e) {
  const bool sine_like = is_sine_like(segmentation);
  if (!sine_like && rise_over_fall(segmentation) < thresholds::kSquare) {
    return Classification{MotionClass::Undetermined, "the force rises as suddenly as it falls: no sticks"};
  }
  if ((sine_like || e.restick_share < thresholds::kRestickShare) && is_faint(segmentation)) {
    return Classification{MotionClass::Undetermined,
                          "the oscillations are not much larger than the noise, so that sticks cannot be recognised"};
  }
  if (sine_like && e.relative_residual > thresholds::kSineFit) {
    return Classification{MotionClass::OscillatorySlip,
                          "nearly sinusoidal: sticks cannot be distinguished from an oscillation"};
  }
  if (e.restick_share < thresholds::kRestickShare) {
    return Classification{MotionClass::OscillatorySlip,
                          fmt::format("{:.0f} % of the slips do not come to rest: oscillation without straight sticks",
                                      100.0 * (1.0 - e.restick_share))};
  }
  return std::nullopt;
}

/// Returns the recording from its first slip to the last with its time counted in cycles: a wave whose period changes
/// has a period of 1.
Result<Recording> over_cycles(const Recording& recording, const Segmentation& segmentation) {
  const std::vector<DetectedSlip>& slips = segmentation.slips;
  std::vector<double> cycles, force;
  std::size_t before = 0;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const double time_s = recording.time_s()[i];
    if (time_s < slips.front().middle_s || time_s > slips.back().middle_s) continue;
    while (before + 2 < slips.size() && time_s > slips[before + 1].middle_s) ++before;
    const double period_s = slips[before + 1].middle_s - slips[before].middle_s;
    cycles.push_back(static_cast<double>(before) + (time_s - slips[before].middle_s) / period_s);
    force.push_back(recording.force()[i]);
  }
  return Recording::create(std::move(cycles), std::move(force), recording.conditions());
}

/// Returns how much better sticks and slips fit the samples than three sines do: twice the difference of the
/// log-likelihoods, each at its best noise, over the cycles that the fit could use, in standard deviations of this
/// difference where both are as good. Its variance is twice the number of parameters: some two for each cycle in
/// either.
std::optional<double> evidence_of_sticks(const Recording& recording, const Signals& signals, const FitResult& fit,
                                         std::size_t used) {
  const double counted_Hz = 1.0 / signal::median(slip_intervals_s(signals.segmentation));
  std::optional<double> harmonic_rms;
  const auto allow = [&](const Recording& trace, double frequency_Hz) {
    const std::optional<double> rms = harmonic_residual_rms(trace, frequency_Hz);
    if (rms) harmonic_rms = std::min(*rms, harmonic_rms.value_or(*rms));
  };
  allow(recording, counted_Hz);
  // From frequencies as near as this the period settles at the same value.
  constexpr double kSameWave = 0.01;
  const std::optional<double>& spectral_Hz = signals.spectral.value_Hz;
  if (spectral_Hz && !(std::abs(*spectral_Hz / counted_Hz - 1.0) < kSameWave)) allow(recording, *spectral_Hz);
  if (const auto counted = over_cycles(recording, signals.segmentation)) allow(counted.value(), 1.0);
  if (!harmonic_rms || !(fit.residual.rms > 0.0)) return std::nullopt;
  const double share = static_cast<double>(used) / static_cast<double>(fit.cycles.size());
  const double evidence =
      2.0 * share * static_cast<double>(recording.size()) * std::log(*harmonic_rms / fit.residual.rms);
  return evidence / std::sqrt(2.0 * 4.0 * static_cast<double>(used));
}

/// Three sines follow the swings as well as sticks and slips do: no sticks have to be there.
Classification as_wave(double evidence) {
  if (evidence < -kNormalQuantile) {
    return {MotionClass::OscillatorySlip, "three sines fit better than sticks and slips: an oscillation"};
  }
  return {MotionClass::Undetermined, "three sines fit as well as sticks and slips: the motion may be an oscillation"};
}

/// Returns true if the slips determine one of their parameters, at least weakly.
bool determines_slips(const FitResult& fit) {
  return std::ranges::any_of(fit.parameters, [](const Parameter& parameter) {
    const bool is_of_slips = parameter.id == ParameterId::Stiffness ||
                             parameter.id == ParameterId::FrictionDifference ||
                             parameter.id == ParameterId::NaturalFrequency;
    const bool is_known = parameter.status == ParameterStatus::Identified ||
                          parameter.status == ParameterStatus::Weak || parameter.status == ParameterStatus::Conditional;
    return is_of_slips && is_known;
  });
}

Classification classify_by_fit(const Recording& recording, const Estimates& estimates) {
  const Segmentation& segmentation = estimates.signals.segmentation;
  const SpectralFrequency& spectral = estimates.signals.spectral;
  if (auto early = by_counts(recording, segmentation, spectral)) return *early;
  if (!estimates.fit) return without_model(recording, estimates.signals);
  const FitDiagnostics& e = estimates.fit->diagnostics;
  std::size_t used = 0;
  for (const Cycle& cycle : estimates.fit->cycles) used += cycle.used ? 1 : 0;
  const bool sudden = slips_are_sudden(segmentation);
  if (used < 5 && !sudden && (e.onset_force_spread > 0.2 || e.relative_residual > 0.04)) {
    if (ends_flat(recording, segmentation)) {
      return {MotionClass::SteadySliding,
              fmt::format("{} force drops at the start, then none", segmentation.slips.size())};
    }
    if (!keeps_rhythm(segmentation)) return without_model(recording, estimates.signals);
    return {MotionClass::Undetermined, fmt::format("only {} usable cycles, and they do not agree", used)};
  }
  const bool loose = !leaves_out_most(*estimates.fit) && e.relative_residual < thresholds::kLooseFit &&
                     e.onset_force_spread < thresholds::kWideSpread;
  const bool close = loose && e.relative_residual < thresholds::kCloseFit;
  const bool died = !sudden && keeps_rhythm(segmentation) && e.span_share < thresholds::kSpanShare;
  if (died && (loose || e.restick_share < thresholds::kRestickShare)) {
    return {MotionClass::OscillatorySlip, "the oscillation decays: a ring-down to steady sliding", true};
  }
  const bool rests = e.restick_share >= thresholds::kRestickShare;
  if (!loose || (sudden && !rests)) return without_model(recording, estimates.signals);
  // Whether a fit that determines nothing is loose or worse than that may hang on how its search ended.
  if (sudden && !close && !determines_slips(*estimates.fit)) return without_model(recording, estimates.signals);
  if (is_sine_like(segmentation) && keeps_mains_phase(segmentation)) {
    return {MotionClass::Undetermined, "nearly sinusoidal oscillation in phase with the mains: it may be mains hum"};
  }
  if (auto round = as_round_swings(segmentation, e)) return *round;
  const std::optional<double> evidence =
      sudden ? std::nullopt : evidence_of_sticks(recording, estimates.signals, *estimates.fit, used);
  if (evidence && *evidence < kNormalQuantile) return as_wave(*evidence);
  if (!close && !sudden) return without_model(recording, estimates.signals);
  const bool is_proven = !evidence || *evidence > thresholds::kClearSigmas;
  return {MotionClass::StickSlip,
          fmt::format("{} cycles of straight sticks and quick slips, residual {:.1f} % of the friction drop", used,
                      100.0 * e.relative_residual),
          false, true, is_proven ? "" : "three sines fit nearly as well: the motion may be an oscillation"};
}

/// Returns true if the fit has the body stick for more than half of the time.
bool sticks_mostly(const FitResult& fit) {
  double slips_s = 0.0;
  double periods_s = 0.0;
  for (const Cycle& cycle : fit.cycles) {
    if (!cycle.used || !cycle.recovery_s) continue;
    slips_s += *cycle.end_s - *cycle.onset_s;
    periods_s += *cycle.recovery_s;
  }
  return 2.0 * slips_s < periods_s;
}

/// Stick-slip has straight sticks where it sticks for most of the time: round rises are none, and levels that wander.
/// Hum that the fit takes off rounds the rises of the trace, not those of the sticks.
Classification unless_no_sticks(Classification classification, const Recording& recording, const Estimates& estimates) {
  const Segmentation& segmentation = estimates.signals.segmentation;
  const bool has_long_sticks = slips_are_sudden(segmentation) || (estimates.fit && sticks_mostly(*estimates.fit));
  const bool is_slipping = classification.motion == MotionClass::StickSlip;
  const bool hums = estimates.fit && estimates.fit->diagnostics.hum_share > 0.0;
  if (!is_slipping || hums || !has_long_sticks) return classification;
  if (!keeps_rhythm(segmentation) && rises_wander(recording, segmentation)) return irregular(segmentation);
  if (!rises_are_round(recording, segmentation)) return classification;
  if (keeps_rhythm(segmentation)) {
    return {MotionClass::OscillatorySlip,
            "the force rises along round curves, not along straight sticks: an oscillation"};
  }
  return {
      MotionClass::Undetermined,
      "the force rises along round curves, not along straight sticks, and without a period: ridges of the surface or "
      "an irregular oscillation"};
}

/// Falls that last much longer than the rises are the sticks of a force with the other sign.
Classification unless_reversed(Classification classification, const Segmentation& segmentation) {
  const bool may_be =
      classification.motion == MotionClass::OscillatorySlip || classification.motion == MotionClass::Undetermined;
  if (!may_be || segmentation.slips.size() < thresholds::kFewestSlips) return classification;
  const double ratio = rise_over_fall(segmentation);
  if (!(ratio > 0.0 && ratio * thresholds::kSudden < 1.0)) return classification;
  return {MotionClass::Undetermined,
          fmt::format("the force falls {:.1f} times as long as it rises, as in stick-slip whose force has the other "
                      "sign: multiply the force by -1 and analyse it again",
                      1.0 / ratio)};
}

/// Classifies by the shape of the falls alone.
Classification by_falls(const Recording& recording, const Signals& signals) {
  const Segmentation& segmentation = signals.segmentation;
  const SpectralFrequency& spectral = signals.spectral;
  if (auto early = by_counts(recording, segmentation, spectral)) return *early;
  const double ratio = rise_over_fall(segmentation);
  if (slips_are_sudden(segmentation) && are_proven_sudden(segmentation)) {
    return {MotionClass::StickSlip, "the force falls much faster than it rises (no model fitted)"};
  }
  if (is_faint(segmentation)) {
    return {MotionClass::Undetermined, "the force drops are not much larger than the noise: only a fit can decide"};
  }
  if (!is_sine_like(segmentation) && ratio > thresholds::kSquare && !are_few(segmentation)) {
    return {MotionClass::StickSlip, "the force falls much faster than it rises (no model fitted)"};
  }
  if (ratio > thresholds::kSquare && are_few(segmentation)) {
    return {MotionClass::Undetermined, "too few force drops to distinguish slips from ripple without a fit"};
  }
  return {MotionClass::Undetermined, "the force falls about as slowly as it rises: only a fit can decide"};
}

/// Classifies the motion, whatever the sign of the force.
Classification as_recorded(const Recording& recording, const Estimates& estimates) {
  Classification classification = unless_no_sticks(classify_by_fit(recording, estimates), recording, estimates);
  if (!classification.model_fits && follows_drive_path(recording.conditions(), estimates.signals.segmentation)) {
    return {MotionClass::SteadySliding,
            fmt::format("the force repeats every {:.4g} mm, the stated drive path: ripple, not slips",
                        1e3 * *recording.conditions().drive_path_m)};
  }
  const bool keeps_time = keeps_time_like_a_clock(recording, estimates.signals.spectral);
  if (classification.motion == MotionClass::OscillatorySlip && !classification.dies_out && keeps_time) {
    if (is_faint(estimates.signals.segmentation)) {
      return {MotionClass::SteadySliding,
              "oscillation not much larger than the noise with a constant period: pick-up on steady sliding"};
    }
    return {MotionClass::Undetermined,
            "oscillation without sticks and with a constant period: pick-up, ripple of the drive or a vibration"};
  }
  return unless_unresolved(std::move(classification), recording, estimates.signals.spectral);
}

}  // namespace

Classification classify(const Recording& recording, const Estimates& estimates) {
  return unless_reversed(as_recorded(recording, estimates), estimates.signals.segmentation);
}

Classification classify_by_shape(const Recording& recording, const Signals& signals) {
  return unless_reversed(unless_unresolved(unless_no_sticks(by_falls(recording, signals), recording, {signals, {}}),
                                           recording, signals.spectral),
                         signals.segmentation);
}

}  // namespace slipfit
