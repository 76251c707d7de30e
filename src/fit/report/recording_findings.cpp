#include "fit/report/recording_findings.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/inference/level_trend.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/level/hum.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/average_term.hpp"
#include "fit/selection/rise.hpp"
#include "fit/selection/stated_mass.hpp"
#include "fit/selection/tiers.hpp"
#include "signal/mains.hpp"

namespace slipfit::fit {

namespace {

std::string note_on_stiffness(const TrendFindings& trend) {
  return fmt::format("the interval of k includes both readings of the trend of the level: k is {:.2g} % {} if {}",
                     100.0 * std::abs(std::expm1(trend.log_k_to_other)),
                     trend.log_k_to_other > 0.0 ? "larger" : "smaller",
                     trend.is_per_cycle ? "the sensor drifts" : "the friction changes");
}

const char* words_for(LevelReading reading) {
  switch (reading) {
    case LevelReading::Sensor:
      return "the sensor drifts";
    case LevelReading::Friction:
      return "the friction changes";
    default:
      return "the sensor drifts or the friction changes (--drift sensor or --drift friction states which)";
  }
}

/// "rises by 0.2 N/s"; of a sweep, whose recordings have rates of their own, without the number.
std::string words_for_rate(const LevelTrend& trend, const char* unit) {
  if (!trend.rate_per_s.value) return "changes over recordings";
  const double rate = *trend.rate_per_s.value;
  return fmt::format("{} by {:.3g}{}/s", rate > 0.0 ? "rises" : "falls", std::abs(rate), unit);
}

}  // namespace

void state_trend(const TrendFindings& trend, const Conditions& conditions, Findings& findings) {
  const auto error_of = [&](Coordinate i) { return findings.intervals.standard_error(Jet(0.0, static_cast<int>(i))); };
  const char* const unit = conditions.quantity == ForceQuantity::Force_N ? " N" : "";
  std::string of_stiffness;
  if (std::abs(trend.log_k_to_other) > error_of(kLogStiffness)) of_stiffness = note_on_stiffness(trend);
  const std::optional<Interval>& range = trend.trend.level_range;
  if (range && std::max(-range->low, range->high) > findings.units.force * error_of(kLevel)) {
    findings.add(
        About::Level, ParameterStatus::Conditional,
        fmt::format("a mean: the force level changes by {:.3g}{} over the recording", range->high - range->low, unit));
  }
  findings.level_trend = trend.trend;
  if (trend.is_significant && conditions.drift == LevelReading::None) {
    findings.warnings.push_back(
        {"level_trend", fmt::format("the force level {}, although no trend is stated: k and the friction forces are "
                                    "those of the recording as it is",
                                    words_for_rate(trend.trend, unit))});
  }
  if (of_stiffness.empty() && !findings.has_caveat(About::Level)) return;
  std::string message =
      fmt::format("the force level {}: {}", words_for_rate(trend.trend, unit), words_for(trend.trend.reading));
  if (!of_stiffness.empty()) message += "; " + of_stiffness;
  findings.warnings.push_back({"level_trend", std::move(message)});
  if (!findings.has_caveat(About::StiffnessAlone)) {
    findings.add(About::StiffnessAlone, ParameterStatus::Identified, std::move(of_stiffness));
  }
}

namespace {

/// Returns the shortest average that the recordings state; 0 if one of them states none.
double shortest_average_s(std::span<const SweepRecording> recordings) {
  double shortest_s = HUGE_VAL;
  for (const SweepRecording& sweep : recordings) {
    if (sweep.role == SweepRole::LeftOut) continue;
    shortest_s = std::min(shortest_s, sweep.recording.conditions().sensor_average_s.value_or(0.0));
  }
  return std::isfinite(shortest_s) ? shortest_s : 0.0;
}

/// Returns whether the sensor averages over most of the slip: its shape determines zeta only where the model explains
/// the rest.
bool is_hidden(const FitResult& result, std::span<const SweepRecording> recordings) {
  const bool agree = std::none_of(result.warnings.begin(), result.warnings.end(),
                                  [](const Warning& warning) { return warning.code == "recordings_disagree"; });
  const bool explains = agree && !(result.residual.reduced_chi2 > thresholds::kSweepMisfit);
  if (explains || result.mass_gives_frequency) return false;
  const std::optional<FittedAverage> found = found_average(result);
  const double average_s = found ? found->seconds : shortest_average_s(recordings);
  return average_s * result.natural_frequency().value.value_or(0.0) > thresholds::kHidingAverage;
}

}  // namespace

std::optional<FittedAverage> found_average(const FitResult& result) {
  const Parameter* const average = result.find(ParameterId::SensorAverage);
  if (average == nullptr || average->status == ParameterStatus::Fixed || !average->estimate.value) return std::nullopt;
  return FittedAverage{*average->estimate.value, average->estimate.standard_error.value_or(0.0)};
}

bool is_damping_open(const FitResult& result, std::span<const SweepRecording> recordings) {
  const Parameter* const zeta = result.find(ParameterId::DampingRatio);
  if (zeta == nullptr || zeta->status != ParameterStatus::Weak || !zeta->estimate.ci95) return false;
  return is_hidden(result, recordings) || (zeta->estimate.ci95->low <= 0.0 && zeta->estimate.ci95->high >= 1.0);
}

void report_open_damping(FitResult& result) {
  for (Parameter& parameter : result.parameters) {
    if (parameter.id != ParameterId::DampingRatio) continue;
    parameter.estimate = {0.0, std::nullopt, Interval{0.0, 1.0}, "the recordings do not determine it; the fit takes 0"};
    parameter.status = ParameterStatus::Bounded;
  }
  if (result.estimate) result.estimate->damping_identified = false;
  result.conditional_on.emplace_back("a damping ratio of 0, of which the recordings say nothing");
}

namespace {

/// Returns whether the fit with zeta = 0 is the best one, because the free zeta is below 0.
bool is_at_bound(const TierFits& fits) {
  return fits.damped.blocks.parameters.values(kDamping) < 0.0 && !fits.damping_held() && fits.undamped.has_value();
}

const BlockFit& reported(const TierFits& fits) {
  return is_at_bound(fits) ? fits.undamped->blocks : fits.damped.blocks;
}

}  // namespace

std::optional<Bend> bend_of(const BlockFit& blocks, std::size_t recordings) {
  // As unlikely by chance in the largest of many recordings as in one.
  const double sigmas =
      std::sqrt(std::pow(thresholds::kClearSigmas, 2) + 2.0 * std::log(static_cast<double>(recordings)));
  std::optional<Bend> largest;
  const auto add = [&](const std::optional<RampBend>& seen, double share, const char* where) {
    if (!seen || !(std::abs(seen->log_ratio) > sigmas * seen->standard_error)) return;
    const Bend bend{seen->log_ratio, share * std::abs(seen->log_ratio), where};
    if (!largest || bend.error > largest->error) largest = bend;
  };
  add(ramp_bend(blocks), 0.5, "from start to end");
  add(late_bend(blocks), blocks.level().reloading ? 1.0 : 0.5, "over their second half");
  return largest;
}

namespace {

/// States where on the path k has its value, if it changes.
constexpr const char* kInMiddle = "in the middle of the path, along which k changes";

/// Warns that a line swings in the sticks. It is of the drive, unless that would have to turn back.
Warning ripple_warning(const DriveRipple& ripple) {
  return {
      "drive_ripple",
      fmt::format(
          "the force in stick oscillates at {:.4g} Hz, as if the driving speed varied by {:.2g} %: the speed at the "
          "onset of a slip then differs from the mean",
          ripple.frequency_Hz, 100.0 * ripple.speed_share)};
}

/// Holds what makes k uncertain besides the fit.
struct StiffnessFindings {
  double variance = 0.0;  ///< of ln k
  std::string note;
  std::string caveat;  ///< why k is not identified, whatever its interval; empty: no reason
  Warnings warnings;
};

StiffnessFindings stiffness_findings(const Recording& recording, const TierFits& fits) {
  StiffnessFindings result;
  if (fits.damped.held[kLogStiffness]) return result;
  const BlockFit& blocks = reported(fits);
  const Conditions& conditions = recording.conditions();
  // Ramps that bend (creep before a slip, a tightening line) have no one slope.
  if (const std::optional<Bend> bend = bend_of(blocks)) {
    result.variance += bend->error * bend->error;
    result.note =
        fmt::format("the sticks are curved: their slope {} by {:.1f} % {}; the interval of k includes this",
                    bend->log_ratio > 0.0 ? "decreases" : "increases", 100.0 * std::abs(bend->log_ratio), bend->where);
    result.warnings.push_back({"model_misfit", result.note});
    if (std::abs(bend->log_ratio) > thresholds::kNegligible) result.caveat = result.note;
  }
  if (const std::optional<DriveRipple> ripple = fitted_ripple(fits.damped.blocks)) {
    result.warnings.push_back(ripple_warning(*ripple));
    result.note = result.warnings.back().message;
  }
  // The data give k V.
  result.variance += std::pow(conditions.relative_speed_error(), 2);
  return result;
}

Spread spread_of(const DampedFit& fit) {
  Spread spread;
  spread.covariance = fit.uncertainty.covariance;
  spread.degrees_of_freedom = fit.uncertainty.degrees_of_freedom;
  // With cycles as the units of resampling the scatter is already in the covariance.
  if (fit.uncertainty.from_cycles) return spread;
  const auto cycles = static_cast<double>(fit.blocks.size());
  Scatter of_onsets{CoordinateMatrix::Zero(), cycles - 1.0};
  of_onsets.covariance(kDifference, kDifference) = std::pow(fit.uncertainty.onset_force_sd, 2) / cycles;
  spread.scatter = {of_onsets};
  return spread;
}

/// Holds what averaging in the instrument may have changed if its duration is not stated.
struct AveragingFindings {
  Coordinates one_sided = Coordinates::Zero();
  std::string caveat;  ///< of all that is read from the slip
  Warnings warnings;
};

/// Returns how the coordinates move where each sample is an average that nobody stated. The moves of slips of few
/// samples are not proportional to what it does to one of them: these are fitted once more, as averaged over a step of
/// the clock.
Coordinates move_by_averaging(const DampedFit& fit, const BlockFit& blocks, const Smoothing& seen, double step_s) {
  Coordinates linear = unstated_variance_s2(fit, seen, step_s) * seen.move_per_s2;
  if (median_slip_s(blocks) > thresholds::kSlipSamples * step_s) return linear;
  Scales scales = blocks.scales();
  scales.sensor_average_s = step_s;
  BlockFit averaged = blocks.with_scales(scales);
  if (!std::isfinite(solve(averaged, {fit.held, false}))) return linear;
  constexpr double kLost = 1.0;  // of ln w_n: such slips may be arbitrarily short
  Coordinates move = coordinates_of(averaged) - coordinates_of(blocks);
  if (std::abs(move(kLogFrequency)) > kLost) move(kLogFrequency) = linear(kLogFrequency);
  return move;
}

/// Returns the effects of averaging. If it is not stated it is assumed to be anything up to one step of the clock, or
/// what the slips show.
AveragingFindings averaging_of(const Recording& recording, const DampedFit& fit, const BlockFit& blocks) {
  AveragingFindings result;
  if (recording.conditions().sensor_average_s) return result;
  if (fit.average) {
    result.warnings.push_back(averaged_warning(fit.average->seconds));
    result.caveat = kFittedAverage;
    return result;
  }
  const double step_s = recording.sample_interval_s();
  const std::optional<Smoothing> seen =
      &blocks == &fit.blocks ? fit.rounding : estimate_smoothing(blocks, fit.held, step_s);
  if (!seen) return result;
  const bool rounded = !repeats_rounding(fit) && seen->exceeds_step(step_s);
  result.one_sided = move_by_averaging(fit, blocks, *seen, step_s);
  if (rounded) {
    const double average_s = std::sqrt(12.0 * seen->variance_s2);
    result.caveat = fmt::format("the slips are rounded as by sensor averaging over {:.2g} ms", 1e3 * average_s);
    result.warnings.push_back(
        {"samples_averaged", result.caveat +
                                 " or by friction that changes during the slip; intervals include this. State what is "
                                 "known with --sensor-average or --sensor-filter"});
  }
  return result;
}

/// zeta with its interval, and how the other coordinates follow it where zeta = 0 is the best.
struct DampingFindings {
  Estimate estimate;
  std::optional<Profile> profile;
};

DampingFindings damping_of(const TierFits& fits, const BlockFit& blocks) {
  const Uncertainty& uncertainty = fits.damped.uncertainty;
  const CoordinateMatrix& covariance = uncertainty.covariance;
  const double variance = covariance(kDamping, kDamping);
  const double se = std::sqrt(std::max(0.0, variance));
  const double quantile = t_quantile(uncertainty.degrees_of_freedom);
  const double zeta = std::max(0.0, blocks.parameters.values(kDamping));
  DampingFindings result{{zeta, se, Interval{zeta, zeta}, {}}, std::nullopt};
  if (fits.damped.held[kDamping] && !fits.damped.motion) return result;
  result.estimate.ci95 = damping_interval(fits.damped.blocks.parameters.values(kDamping), se, quantile);
  if (!is_at_bound(fits)) return result;
  const bool has_more = uncertainty.from_refits || fits.damped.average || !fits.damped.rivals.empty();
  result.profile = Profile{has_more ? given(covariance, kDamping) : fits.undamped->uncertainty.covariance, {}, true};
  if (variance > 0.0) {
    result.profile->moves = {covariance.col(kDamping) / variance * result.estimate.ci95->high};
  }
  return result;
}

/// Unresolved slip: F_s - F_k lies between half of the fall from onset to end of slip (zeta = 0) and the drop between
/// the ramps (zeta -> 1), which also has what the drive makes up during the slip. 0.485 leaves room for its time.
Interval bounds_by_drop(const SawtoothFit& sawtooth, double cycles) {
  const double spread = t_quantile(cycles - 1.0) * sawtooth.drop_sd / std::sqrt(cycles);
  return {std::max(0.0, 0.485 * (sawtooth.fall - spread)), sawtooth.drop + spread};
}

void state_conditions(const Recording& recording, Findings& findings) {
  findings.in_newtons = recording.conditions().quantity == ForceQuantity::Force_N;
  findings.zero_known = recording.conditions().zero_force_N.has_value();
  findings.sample_interval_s = recording.sample_interval_s();
  findings.sensor_average_s = recording.conditions().sensor_average_s;
}

void state_law(const DampedFit& fit, Findings& findings) {
  findings.weakens = fit.blocks.scales().law == FrictionLaw::Weakening;
  findings.mass_gives_frequency = fit.mass_gives_frequency;
  findings.add(About::Average, ParameterStatus::Unidentified, fit.average_caveat);
  if (findings.weakens) {
    findings.add(About::Slip, ParameterStatus::Weak, fit.law_caveat);
  } else {
    findings.add(About::SlipDistance, ParameterStatus::Unidentified, fit.law_caveat);
  }
}

/// Returns why w_n and zeta cannot be read from the slips of a contact that is not the model's and not seen as it is;
/// empty where they can. A fall that the sensor's average draws out fits as well as a slow slip then.
std::string caveat_of_fall(const Conditions& conditions, const DampedFit& fit, const Residual& residual,
                           const Findings& findings) {
  const auto stated_mass = [&] {
    return fmt::format("the stated mass of {:.3g} kg does not explain the slips", *conditions.mass_kg);
  };
  const bool is_rejected = conditions.mass_kg && !fit.mass_gives_frequency;
  const std::string by_mass = is_rejected ? stated_mass() : std::string("state the mass with --mass");
  if (!fit.fall_caveat.empty()) {
    const bool is_average_known = fit.average && average_is_identifiable(*fit.average);
    const std::string by_either = "state the average with --sensor-average, or the mass with --mass";
    return fit.fall_caveat + ": " + (is_average_known || is_rejected ? by_mass : by_either);
  }
  const bool coloured = residual.whiteness_p && *residual.whiteness_p < thresholds::kProven;
  const bool large = residual.reduced_chi2 && *residual.reduced_chi2 > thresholds::kLargeChi2;
  if (!large || !coloured || fit.mass_gives_frequency || fit.motion) return {};
  if (hides_damping(fit.blocks)) {
    return "w_n and zeta cannot be read from the slips, because the sensor averages over most of a slip and the "
           "residuals are correlated: " +
           by_mass;
  }
  if (!fit.blocks.level().reloading || findings.sensor_average_s || fit.average) return {};
  const std::string open_fall =
      "the force recovers after a slip, and residuals are correlated and larger than the noise: sensor averaging "
      "(--sensor-average) or friction may determine the slip time instead of the mass";
  // An average obscures slips that are quicker, and so of a smaller mass, than they look.
  const bool is_too_large = sigmas_of_stated_mass(conditions, fit) > thresholds::kClearSigmas;
  return is_too_large ? open_fall + "; " + stated_mass() : open_fall;
}

/// Returns whether the slips of all cycles deviate from the model in the same way, however little: what is left of
/// noise that is correlated, or of a surface, is different in each cycle, and the scatter of the cycles includes it.
bool repeats_in_slips(const DampedFit& fit) {
  constexpr double kByChance = 2.0;  // twice what the scatter of the cycles leaves in the mean of all
  if (!fit.uncertainty.from_cycles) return true;
  const StackedResidual stack = stacked_residual(fit.blocks, fit.blocks);
  return stack.size > kByChance * stack.by_chance;
}

/// States why what is read from the slip is not determined, or not surely.
void state_caveats(const Conditions& conditions, const TierFits& fits, const Resolution& resolution,
                   const Residual& residual, Findings& findings) {
  const bool coloured = !residual.whiteness_p || *residual.whiteness_p < thresholds::kProven;
  const bool large =
      residual.reduced_chi2 && *residual.reduced_chi2 > thresholds::kLargeChi2 && repeats_in_slips(fits.damped);
  if (large) {
    findings.warnings.push_back(
        {"model_misfit",
         fmt::format("residuals are {:.3g} times the noise: the model misses part of the slip, and parameters "
                     "that depend on its shape are uncertain",
                     std::sqrt(*residual.reduced_chi2))});
  }
  if (const std::optional<double>& zeta = fits.damped.refused_damping) {
    const std::string why = no_damped_oscillation(*zeta) +
                            "; friction, creep or the sensor may determine the slip time instead of the mass";
    findings.add(About::Frequency, ParameterStatus::Unidentified, why);
    findings.add(About::Slip, ParameterStatus::Weak, why);
  } else if (fits.damped.misfit) {
    // A sensor that lags, or creep, moves w_n more than leaving out parts of the slip shows.
    findings.add(About::Slip, ParameterStatus::Weak,
                 "the slip is not a damped oscillation: the error of w_n may exceed its interval");
  } else if (large) {
    findings.add(About::Slip, ParameterStatus::Weak,
                 fmt::format("residuals are {}larger than the noise: the interval may be too narrow",
                             coloured ? "correlated and " : ""));
  }
  if (findings.weakens && coloured && fits.damped.law_caveat.empty()) {
    findings.add(
        About::Slip, ParameterStatus::Weak,
        "residuals are correlated: creep before a slip may be taken for friction that weakens over a distance");
  }
  findings.slip_unresolved =
      resolution.slip_resolved ? caveat_of_fall(conditions, fits.damped, residual, findings) : resolution.reason;
  const bool is_resolved = findings.slip_unresolved.empty() && resolution.damping_resolved;
  if (!is_resolved) {
    const std::string& why = findings.slip_unresolved.empty() ? resolution.reason : findings.slip_unresolved;
    findings.damping = unknown(why);
  }
  // A standard error of a third says less than the bound by the drop.
  const Estimate difference = findings.intervals.interval_of(SlidingModel(findings.values, findings.units).difference);
  const bool is_informative = *difference.standard_error < thresholds::kInformativeError * *difference.value;
  if (!is_resolved || !is_informative) {
    findings.difference_bounds = bounds_by_drop(fits.sawtooth, static_cast<double>(findings.cycles));
  }
}

std::optional<Estimate> fitted_average_of(const DampedFit& fit) {
  if (!fit.average) return std::nullopt;
  return symmetric(fit.average->seconds, fit.average->standard_error_s, fit.uncertainty.degrees_of_freedom);
}

Units units_of(const BlockFit& blocks) {
  const Scales& scales = blocks.scales();
  return {.force = scales.force,
          .level = scales.level,
          .stick_s = blocks.level().reloading ? median_stick_s(blocks) : 1.0,
          .slip_distance_m = scales.slip_distance_m,
          .speed_m_per_s = scales.speed_m_per_s};
}

}  // namespace

std::vector<std::string> conditions_of(const Recording& recording, Tier tier) {
  const char* const law = tier == Tier::Weakening ? "friction that weakens over a slip distance" : "Coulomb friction";
  std::vector<std::string> conditions{
      fmt::format("{} (one speed cannot separate zeta and F_s - F_k from velocity-dependent friction)", law)};
  if (!recording.conditions().speed_standard_error_m_per_s) conditions.emplace_back(kStatedSpeed);
  return conditions;
}

Findings findings_of(const Recording& recording, const TierFits& fits, const Resolution& resolution,
                     const Residual& residual) {
  const BlockFit& blocks = reported(fits);
  Spread spread = spread_of(fits.damped);
  AveragingFindings averaging = averaging_of(recording, fits.damped, blocks);
  spread.one_sided = {averaging.one_sided};
  spread.to_rivals = moves_to_rivals(fits.damped, blocks);
  DampingFindings damping = damping_of(fits, blocks);
  damping.estimate.ci95 = lengthened_damping(*damping.estimate.ci95, spread);
  spread.profile = std::move(damping.profile);
  StiffnessFindings stiffness = stiffness_findings(recording, fits);
  spread.covariance(kLogStiffness, kLogStiffness) += stiffness.variance;
  const TrendFindings trend = find_level_trend(recording, fits.damped);
  spread = with_trend(std::move(spread), trend, blocks.scales().force);
  if (spread.profile) spread.profile->held(kLogStiffness, kLogStiffness) += stiffness.variance;

  Coordinates values = with_trend(coordinates_of(blocks), trend);
  values(kDamping) = std::max(0.0, values(kDamping));
  Findings findings{values, units_of(blocks), Intervals(std::move(spread)), std::move(damping.estimate),
                    fits.held_by_user()};
  state_conditions(recording, findings);
  findings.cycles = blocks.size();
  findings.levels_differ = blocks.level().per_cycle;
  findings.onsets_scatter =
      recording.conditions().force_view == ForceView::Spring && spread_of_onsets(fits.damped) > thresholds::kNegligible;
  findings.samples_per_slip = resolution.samples_per_slip;
  findings.add(About::StiffnessAlone, ParameterStatus::Identified, stiffness.note);
  if (blocks.solves_for(kStiffnessDrift)) findings.add(About::StiffnessAlone, ParameterStatus::Identified, kInMiddle);
  findings.add(About::Stiffness, ParameterStatus::Weak, stiffness.caveat);
  // Bent sticks begin and end in other slips than the model's.
  if (!stiffness.warnings.empty()) findings.add(About::Slip, ParameterStatus::Weak, stiffness.note);
  findings.add(About::Slip, ParameterStatus::Weak, averaging.caveat);
  findings.warnings = std::move(stiffness.warnings);
  findings.fitted_average = fitted_average_of(fits.damped);
  findings.warnings.insert(findings.warnings.end(), averaging.warnings.begin(), averaging.warnings.end());
  state_trend(trend, recording.conditions(), findings);
  state_law(fits.damped, findings);
  findings.frequency_tested = fits.damped.motion || agrees_with_stated_mass(recording.conditions(), fits.damped);
  findings.load_response = load_response(recording, SlidingModel(values, findings.units).level.a, findings.cycles);
  state_caveats(recording.conditions(), fits, resolution, residual, findings);
  return findings;
}

FitResult without_parameters(FitResult fit) {
  for (Parameter& parameter : fit.parameters) {
    if (parameter.status == ParameterStatus::Fixed) continue;
    parameter.status = ParameterStatus::Unidentified;
    parameter.estimate = unknown("the motion is not stick-slip of this model");
  }
  fit.correlation.reset();
  fit.estimate.reset();
  fit.level_trend = {};
  constexpr std::array kOfParameters{"level_trend", "samples_averaged", "part_of_cycles_fitted"};
  std::erase_if(fit.warnings, [&](const Warning& warning) { return std::ranges::count(kOfParameters, warning.code); });
  for (Warning& warning : fit.warnings) {  // how far off it is says nothing where it is another motion
    if (warning.code != "model_misfit") continue;
    warning.message = "the model does not describe the slips: no parameter is determined";
  }
  return fit;
}

FitResult without_identified(FitResult fit, const std::string& reason) {
  for (Parameter& parameter : fit.parameters) {
    if (parameter.status != ParameterStatus::Identified) continue;
    parameter.status = ParameterStatus::Weak;
    parameter.estimate.note = reason;
  }
  return fit;
}

FitResult qualified_by_mains(FitResult fit, double frequency_Hz, double duration_s) {
  const bool hum_found = fit.diagnostics.hum_share > 0.0;
  const std::optional<double> mains_Hz = signal::mains_in_step(frequency_Hz, hum_found ? 2 : 1, duration_s);
  if (!mains_Hz) return fit;
  const std::string reason = fmt::format("in step with {:.0f} Hz mains: hum hides in the cycles", *mains_Hz);
  fit.warnings.push_back(
      {"mains_in_step",
       fmt::format("the cycles ({:.4g} Hz) keep {}{}; another speed or a longer recording sets them apart",
                   frequency_Hz, reason, hum_found ? "" : ", and is taken to be absent")});
  return hum_found ? without_identified(std::move(fit), reason) : fit;
}

namespace {

bool depends_on_inertia(ParameterId id) {
  return id == ParameterId::NaturalFrequency || id == ParameterId::Mass || id == ParameterId::DampingRatio ||
         id == ParameterId::DampingCoefficient;
}

/// Nothing that rests on the inertia of the slips.
FitResult without_inertia(FitResult fit, const std::string& reason, double force_drop) {
  const Interval bounds{0.5 * force_drop, force_drop};
  for (Parameter& parameter : fit.parameters) {
    if (parameter.status == ParameterStatus::Fixed) continue;
    if (depends_on_inertia(parameter.id)) {
      parameter.status = ParameterStatus::Unidentified;
      parameter.estimate = unknown(reason);
    } else if (parameter.id == ParameterId::FrictionDifference) {
      parameter.status = ParameterStatus::Bounded;
      parameter.estimate = {0.75 * force_drop, std::nullopt, bounds,
                            "between half and all of the force drop: " + reason};
    }
  }
  fit.correlation.reset();
  fit.estimate.reset();
  return fit;
}

FitResult with_doubtful_inertia(FitResult fit, const std::string& reason) {
  for (Parameter& parameter : fit.parameters) {
    if (!depends_on_inertia(parameter.id)) continue;
    if (parameter.status == ParameterStatus::Unidentified || parameter.status == ParameterStatus::Fixed) continue;
    parameter.status = ParameterStatus::Weak;
    parameter.estimate.note = reason;
  }
  return fit;
}

}  // namespace

FitResult qualified_by_ring_down(FitResult fit, double ring_down_frequency_Hz, double force_drop) {
  const Estimate natural = fit.natural_frequency();
  if (!natural.value) return fit;
  const double slip_Hz = *natural.value / (2.0 * std::numbers::pi);
  if (slip_Hz > thresholds::kInertialSlip * ring_down_frequency_Hz) return fit;
  const bool misfits = std::any_of(fit.warnings.begin(), fit.warnings.end(),
                                   [](const Warning& warning) { return warning.code == "model_misfit"; });
  const std::string slower =
      fmt::format("the slips ({:.3g} Hz) are much slower than the free ring-down of the rig ({:.3g} Hz)", slip_Hz,
                  ring_down_frequency_Hz);
  if (misfits) {
    const std::string reason = slower + ", so inertia does not determine them";
    fit.warnings.push_back({"slips_not_inertial", reason});
    return without_inertia(std::move(fit), reason, force_drop);
  }
  const std::string reason = slower + ": assumes that another body rings";
  fit.warnings.push_back({"slips_not_inertial", reason});
  return with_doubtful_inertia(std::move(fit), reason);
}

}  // namespace slipfit::fit
