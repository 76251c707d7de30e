#include "slipfit/fit/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "fit/inference/intervals.hpp"
#include "fit/report/parameters.hpp"
#include "fit/report/recording_findings.hpp"
#include "fit/selection/ring_down_fit.hpp"
#include "fit/selection/solution.hpp"
#include "fit/sweep/ageing_line.hpp"
#include "fit/sweep/law_choice.hpp"
#include "fit/sweep/sweep_data.hpp"
#include "fit/sweep/sweep_outcome.hpp"
#include "fit/sweep/sweep_solution.hpp"
#include "signal/smoothing.hpp"

namespace slipfit {
namespace {

using fit::LeftOut;
using fit::SweepData;
using fit::SweepOutcome;
using fit::SweepSolution;

double samples_per_slip(std::span<const SweepRecording> recordings, const SweepData& data) {
  std::vector<double> samples;
  for (const std::size_t i : data.fitted) {
    const fit::BlockFit& blocks = data.single[i]->blocks;
    const fit::CycleState state = blocks.state(blocks.size() / 2);
    samples.push_back(state.slip_s() / recordings[i].recording.sample_interval_s());
  }
  return signal::median(samples);
}

/// Returns the root mean square of the residuals of the joint fit, each recording weighted by its number of cycles.
double residual_rms(const SweepSolution& solution) {
  double square = 0.0;
  for (const fit::BlockFit& recording : solution.recordings) {
    square += recording.scales().noise * recording.scales().noise * static_cast<double>(recording.size());
  }
  const double reduced_chi2 = solution.chi2 / solution.degrees_of_freedom;
  return std::sqrt(reduced_chi2 * square / static_cast<double>(solution.cycles()));
}

const char* name_of_change(fit::FrictionLaw law) {
  if (law == fit::FrictionLaw::Hyperbolic) return "hyperbolically";
  return law == fit::FrictionLaw::Exponential ? "exponentially" : "logarithmically";
}

/// Sticks of a sweep that bend.
struct BentSticks {
  std::size_t recordings = 0;
  double largest = 0.0;   ///< change of their slope, of 1
  double variance = 0.0;  ///< of ln k, the mean of the recordings
};

BentSticks bent_sticks_of(const SweepSolution& solution) {
  BentSticks bent;
  for (const fit::BlockFit& recording : solution.recordings) {
    const bool bends_in_model = recording.scales().relaxing.has_value();
    const std::optional<fit::Bend> bend =
        bends_in_model ? std::nullopt : fit::bend_of(recording, solution.recordings.size());
    if (!bend) continue;
    ++bent.recordings;
    bent.largest = std::max(bent.largest, std::abs(bend->log_ratio));
    bent.variance += bend->error * bend->error / static_cast<double>(solution.recordings.size());
  }
  return bent;
}

/// Returns the variance of ln k due to the speeds, for the data determine k V. One drive makes all speeds of a sweep:
/// they may be off by the same factor, the largest that is stated.
double variance_of_speed(std::span<const SweepRecording> recordings) {
  double largest = 0.0;
  for (const SweepRecording& recording : recordings) {
    largest = std::max(largest, recording.recording.conditions().relative_speed_error());
  }
  return largest * largest;
}

/// Returns the spread of the outcome, with a one-sided spread of w_n that averaging adds, and what bent sticks and
/// uncertain speeds add to ln k.
fit::Spread spread_of(const SweepOutcome& outcome, double averaging, double variance_of_log_k) {
  fit::Spread spread = outcome.spread;
  if (!outcome.solution.held[fit::kLogStiffness]) {
    spread.covariance(fit::kLogStiffness, fit::kLogStiffness) += variance_of_log_k;
    if (spread.profile) spread.profile->held(fit::kLogStiffness, fit::kLogStiffness) += variance_of_log_k;
  }
  spread.one_sided.emplace_back(averaging * fit::Coordinates::Unit(fit::kLogFrequency));
  return spread;
}

/// Returns the estimate of a spacing. It is empty, with a reason, where there is no spacing or where it is known to
/// worse than a factor.
Estimate spacing_of(const std::optional<fit::Jet>& spacing, const fit::Intervals& intervals,
                    const std::string& why_none) {
  if (!spacing) return unknown(why_none);
  if (!(intervals.quantile(*spacing) * intervals.standard_error(*spacing) <
        std::log(thresholds::kWidestFactor) * spacing->a)) {
    return unknown("the interval reaches beyond a factor of 2 either way");
  }
  return intervals.interval_of_one_sign(*spacing);
}

class Assembler {
 public:
  Assembler(std::span<const SweepRecording> recordings, const SweepData& data, const SweepOutcome& outcome)
      : recordings_(recordings),
        data_(data),
        outcome_(outcome),
        trend_(fit::trend_of_sweep(recordings, data, outcome.solution.held)),
        values_(fit::with_trend(fit::with_damping_cut(outcome.values, outcome.spread), trend_)),
        model_(values_, data.units),
        bent_(bent_sticks_of(outcome.solution)),
        averaging_(data.motion ? 0.0 : fit::effect_of_averaging(recordings, outcome, data)),
        intervals_(fit::with_trend(spread_of(outcome, averaging_, bent_.variance + variance_of_speed(recordings)),
                                   trend_, data.units.force)) {}

  [[nodiscard]] SweepFit assemble(const fit::LawChoice& choice) const {
    SweepFit sweep;
    const SweepSolution& solution = outcome_.solution;
    sweep.level_shared = solution.sweep.sharing.level;
    sweep.difference_shared = solution.sweep.sharing.difference;
    sweep.result.tier = choice.velocity ? Tier::Velocity : Tier::Damped;
    sweep.result.conditional_on.emplace_back(choice.velocity ? "F_k(v) = f0 + f1 exp(alpha v)" : "Coulomb friction");
    if (std::any_of(recordings_.begin(), recordings_.end(), [](const SweepRecording& sweep_recording) {
          return !sweep_recording.recording.conditions().speed_standard_error_m_per_s;
        })) {
      sweep.result.conditional_on.emplace_back(fit::kStatedSpeed);
    }
    if (data_.mass) {
      sweep.result.mass_gives_frequency = true;
      sweep.result.conditional_on.push_back(fmt::format("a moving mass of {:.4g} kg", data_.mass->kg));
    }
    sweep.result.residual.rms = residual_rms(solution);
    if (std::any_of(data_.loads.begin(), data_.loads.end(), [](double load) { return load != 1.0; })) {
      sweep.result.conditional_on.push_back(
          fmt::format("normal force {:.6g} N, the mean of the recordings", *data_.mean_load_N));
    }
    sweep.result.residual.reduced_chi2 = solution.chi2 / solution.degrees_of_freedom;
    if (data_.motion) sweep.result.conditional_on.emplace_back(fit::kRingDown);
    add_warnings(sweep);
    fit::report_parameters(findings(choice), sweep.result);
    if (sweep.result.estimate) {
      sweep.result.estimate->reach = outcome_.reach;
      sweep.result.estimate->normal_force_N = data_.mean_load_N;
    }
    for (std::size_t i = 0; i < recordings_.size(); ++i) sweep.points.push_back(point_of(i));
    return sweep;
  }

 private:
  [[nodiscard]] fit::Findings findings(const fit::LawChoice& choice) const {
    const SweepSolution& solution = outcome_.solution;
    fit::Findings findings{values_, data_.units, intervals_, damping(), solution.held};
    if (outcome_.values(fit::kDamping) < 0.0) findings.free_damping_ratio = outcome_.values(fit::kDamping);
    findings.zero_known = std::all_of(recordings_.begin(), recordings_.end(), [](const SweepRecording& sweep) {
      return sweep.recording.conditions().zero_force_N.has_value();
    });
    if (data_.motion) findings.held[fit::kLogFrequency] = findings.held[fit::kDamping] = false;
    findings.cycles = solution.cycles();
    findings.mass_gives_frequency = data_.mass.has_value();
    findings.frequency_tested = data_.motion.has_value();
    findings.load_response = load_response();
    findings.samples_per_slip = samples_per_slip(recordings_, data_);
    findings.sample_interval_s = recordings_[data_.fitted.front()].recording.sample_interval_s();
    if (fit::residual_over_noise(recordings_, data_, solution) > thresholds::kLargeChi2) {
      findings.add(fit::About::Slip, ParameterStatus::Weak,
                   "residuals exceed the noise of the recordings: the model misses part of the slips");
    }
    if (fit::is_misfit(solution)) {
      for (const auto about : {fit::About::Slip, fit::About::Stiffness}) {
        findings.add(
            about, ParameterStatus::Weak,
            "residuals exceed the noise: the model misses part of the data, and the interval may be too narrow");
      }
    }
    if (bent_.largest > thresholds::kNegligible) {
      findings.add(fit::About::Stiffness, ParameterStatus::Weak,
                   fmt::format("the sticks of {} of {} recordings are curved: their slope changes by up to {:.1f} %; "
                               "the interval of k includes this",
                               bent_.recordings, solution.recordings.size(), 100.0 * bent_.largest));
    }
    fit::state_trend(trend_, recordings_.front().recording.conditions(), findings);
    if (!findings.damping.value) {
      findings.add(fit::About::Frequency, ParameterStatus::Unidentified, findings.damping.note);
    }
    add_average(findings);
    add_difference_caveat(findings);
    // Only recordings with one level and one static friction separate damping from friction that depends on speed.
    if (!solution.sweep.sharing.level || !solution.sweep.sharing.difference) {
      findings.add(fit::About::Damping, ParameterStatus::Weak,
                   "holds for Coulomb friction only: the recordings share no level or static friction");
    }
    findings.law = fit::LawFindings{choice.velocity, choice.reason};
    findings.law->ageing = outcome_.static_friction;
    findings.law->stiffness_grows = solution.recordings.front().solves_for(fit::kStiffnessExponent);
    findings.law->at_one_speed = fit::speed_ratio(recordings_) < thresholds::kLeastSpeedRatio;
    findings.law->reference_normal_force_N = data_.mean_load_N;
    return findings;
  }

  void add_average(fit::Findings& findings) const {
    const fit::BlockFit* averaged = outcome_.solution.with_sensor_time();
    if (averaged != nullptr) {
      const auto average = fit::average_of(*averaged, outcome_.spread.with_scatter());
      findings.fitted_average =
          symmetric(average->seconds, average->standard_error_s, static_cast<double>(data_.fitted.size()));
      findings.add(fit::About::Slip, ParameterStatus::Weak, fit::kFittedAverage);
      findings.warnings.push_back(fit::averaged_warning(average->seconds));
    }
    if (!(averaging_ > thresholds::kNegligible) || !data_.rounding_s2) return;
    const std::string rounded =
        "the slips are rounded as by sensor averaging over a time that the data do not determine";
    findings.add(fit::About::Slip, ParameterStatus::Weak, rounded);
    findings.warnings.push_back(
        {"samples_averaged",
         rounded + ": state it with --sensor-average, or a filter with --sensor-filter, if it is known"});
  }

  /// Returns the mean response of the normal force in the recordings that measured one.
  [[nodiscard]] std::optional<fit::LoadResponse> load_response() const {
    std::vector<fit::LoadResponse> responses;
    for (std::size_t r = 0; r < data_.fitted.size(); ++r) {
      const std::size_t i = data_.fitted[r];
      const Recording& recording = recordings_[i].recording;
      const fit::Jet friction = model_.level + model_.excess_friction(recording.conditions().speed_m_per_s);
      const auto one =
          fit::load_response(recording, data_.loads[i] * friction.a, outcome_.solution.recordings[r].size());
      if (one) responses.push_back(*one);
    }
    return responses.empty() ? std::nullopt : std::optional(fit::mean_response(responses));
  }

  void add_difference_caveat(fit::Findings& findings) const {
    const bool is_mean = !outcome_.solution.sweep.sharing.difference;
    if (is_mean && !outcome_.static_friction) {
      findings.add(fit::About::Difference, ParameterStatus::Weak,
                   "a mean, because static friction differs between the recordings");
    }
    if (!outcome_.other_law) return;
    const fit::OtherLaw& other = *outcome_.other_law;
    findings.other_law = other.move;
    const double share = std::abs(data_.units.force * other.move(fit::kDifference) / model_.difference.a);
    if (!(share > thresholds::kOtherLawShare)) return;
    findings.add(
        fit::About::Difference, ParameterStatus::Weak,
        fmt::format(
            "kinetic friction that changes {} with speed explains the recordings equally well and gives {:.3g} N",
            name_of_change(other.law), data_.units.force * other.difference));
  }

  /// zeta cannot be negative: its interval is cut at 0.
  [[nodiscard]] Estimate damping() const {
    fit::Jet free = model_.zeta;
    free.a = outcome_.values(fit::kDamping);
    Estimate zeta = intervals_.interval_of(free);
    if (zeta.ci95->high <= 0.0 && !outcome_.solution.held[fit::kDamping]) {
      return unknown("the best value is negative: the slips are not damped oscillations");
    }
    if (outcome_.other_law && !outcome_.solution.held[fit::kDamping]) {
      const double other = std::min(1.0, free.a + outcome_.other_law->move(fit::kDamping));
      zeta.ci95 = Interval{std::min(zeta.ci95->low, other), std::max(zeta.ci95->high, other)};
    }
    zeta.value = std::max(0.0, *zeta.value);
    zeta.ci95->low = std::max(0.0, zeta.ci95->low);
    return zeta;
  }

  void add_warnings(SweepFit& sweep) const {
    if (outcome_.disagree) {
      sweep.result.warnings.push_back({"recordings_disagree",
                                       "the recordings do not agree on one set of parameters: intervals were widened "
                                       "to cover the changes when each "
                                       "recording is left out"});
    }
    if (outcome_.static_friction) {
      sweep.result.warnings.push_back(
          {"static_friction_ages",
           "static friction changes with the logarithm of the stick time (ageing_N); predictions include this"});
    } else if (!sweep.difference_shared) {
      sweep.result.warnings.push_back(
          {"static_friction_differs",
           "static friction differs between the recordings (ageing, or a changed surface): F_s - F_k is their mean"});
    }
    const bool has_exponent = outcome_.solution.recordings.front().solves_for(fit::kStiffnessExponent);
    const auto trend = has_exponent ? intervals_.interval_of(model_.stiffness_exponent).ci95 : std::nullopt;
    if (trend && (trend->low > 0.0 || trend->high < 0.0)) {
      sweep.result.warnings.push_back(
          {"stiffness_goes_with_speed", fmt::format("k varies with driving speed as V^{:.2g} (95 % interval {:.2g} to "
                                                    "{:.2g}); predictions include this",
                                                    model_.stiffness_exponent.a, trend->low, trend->high)});
    }
    if (!sweep.level_shared) {
      sweep.result.warnings.push_back(
          {"level_differs",
           "the force level differs between the recordings by more than velocity-dependent friction explains: the zero "
           "of the sensor changed, or the surface"});
    }
  }

  [[nodiscard]] SweepPoint point_of(std::size_t i) const {
    const double speed = recordings_[i].recording.conditions().speed_m_per_s;
    const double load = data_.loads[i];
    SweepPoint point;
    point.kinetic_friction_N = intervals_.interval_of(load * (model_.level + model_.excess_friction(speed)));
    point.spacing_m = spacing_of(model_.spacing(speed, load), intervals_, "no stick-slip at this speed");
    const auto fitted = std::find(data_.fitted.begin(), data_.fitted.end(), i);
    if (fitted != data_.fitted.end()) {
      const auto run = static_cast<std::size_t>(fitted - data_.fitted.begin());
      point.cycles_used = outcome_.solution.recordings[run].size();
      point.rms = outcome_.solution.recordings[run].scales().noise;
      point.spacing_left_out_m = spacing_without(outcome_.left_out[run], speed, load);
      if (const std::optional<LeftOut>& one = outcome_.left_out[run]) {
        point.stiffness_left_out_N_per_m = std::exp(one->values(fit::kLogStiffness));
        point.friction_difference_left_out_N = data_.units.force * one->values(fit::kDifference);
      }
    }
    if (data_.steady_of[i]) {
      const fit::SteadyRun& steady = data_.steady[*data_.steady_of[i]];
      point.mean_steady_force_N =
          symmetric(steady.mean_force, steady.standard_error, static_cast<double>(fit::kSteadyStretches) - 1.0);
    }
    return point;
  }

  [[nodiscard]] Estimate spacing_without(const std::optional<LeftOut>& one, double speed, double load) const {
    if (!one) return unknown("too few recordings to leave one out");
    const fit::SlidingModel model(fit::with_damping_cut(one->values, one->spread), data_.units);
    return spacing_of(model.spacing(speed, load), fit::Intervals(fit::spread_at(*one, speed)),
                      "no stick-slip at this speed by the others");
  }

  std::span<const SweepRecording> recordings_;
  const SweepData& data_;
  const SweepOutcome& outcome_;
  fit::TrendFindings trend_;
  fit::Coordinates values_;
  fit::SlidingModel model_;
  BentSticks bent_;
  double averaging_;
  fit::Intervals intervals_;
};

/// Fits prepared recordings. `stated`: what the user holds.
std::optional<SweepFit> fit_prepared(std::span<const SweepRecording> recordings, SweepData data,
                                     const HeldParameters& stated, const FitOptions& options) {
  if (options.notify_step) options.notify_step(fmt::format("fitting {} recordings together", data.fitted.size()));
  const std::optional<fit::SweepFits> fits = fit::solve_sweep(data, options);
  if (!fits) return std::nullopt;
  fit::ChosenLaw law = fit::choose_law(data, *fits, options.tier, fit::speed_ratio(recordings));
  const std::optional<Warning> ring_caveat = fit::join_ring_downs(recordings, stated, data, law.outcome);
  SweepFit sweep = Assembler(recordings, data, law.outcome).assemble(law.choice);
  if (ring_caveat) sweep.result.warnings.push_back(*ring_caveat);
  sweep.ring_down_used = data.motion.has_value();
  sweep.result.candidates = law.candidates;
  return sweep;
}

}  // namespace

std::optional<SweepFit> fit_sweep(std::span<const SweepRecording> recordings, const FitOptions& options) {
  SweepData data = fit::prepare_sweep(recordings, options);
  if (data.fitted.size() < 2) return std::nullopt;
  data = fit::with_relaxation(std::move(data), recordings, options.held);
  std::optional<SweepFit> sweep = fit_prepared(recordings, data, options.held, options);
  if (!sweep || options.held.damping_ratio || sweep->ring_down_used) return sweep;
  if (!fit::is_damping_open(sweep->result, recordings)) return sweep;
  FitOptions undamped = options;
  undamped.held.damping_ratio = 0.0;
  // Whether the springs relax is settled; otherwise each recording is fitted without damping, too.
  if (!fit::relaxes(data)) data = fit::prepare_sweep(recordings, undamped, fit::found_average(sweep->result));
  std::optional<SweepFit> simpler = fit_prepared(recordings, std::move(data), options.held, undamped);
  if (!simpler) return sweep;
  if (!simpler->ring_down_used) fit::report_open_damping(simpler->result);
  return simpler;
}

}  // namespace slipfit
