#include "slipfit/fit/joint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/inference/intervals.hpp"
#include "fit/inference/joint_outcome.hpp"
#include "fit/report/joint_parameters.hpp"
#include "signal/robust.hpp"

namespace slipfit {
namespace {

using fit::JointSolution;
using fit::LeftOut;
using fit::Outcome;
using fit::StaticFriction;
using fit::SweepData;
using fit::SweepIntervals;
using fit::SweepModel;
using fit::SweepVector;

/// Below it a sweep is one speed: damping and friction that depends on speed cannot be told apart.
constexpr double kLeastSpeedRatio = 1.3;
/// Reduced chi2 of a model that leaves something unexplained (the noise is that of each recording's own fit).
constexpr double kMisfitChi2 = 1.5;

bool is_misfit(const JointSolution& solution) {
  return solution.chi2 > kMisfitChi2 * solution.degrees_of_freedom;
}

/// Which friction law, and the sentence that says why.
struct LawChoice {
  bool velocity = false;
  std::string reason;
};

double speed_ratio(std::span<const SweepRecording> recordings) {
  double low = HUGE_VAL;
  double high = 0.0;
  for (const SweepRecording& sweep : recordings) {
    if (sweep.role == SweepRole::LeftOut) continue;
    low = std::min(low, sweep.recording.conditions().speed_m_per_s);
    high = std::max(high, sweep.recording.conditions().speed_m_per_s);
  }
  return high / low;
}

LawChoice choose_by_chance(const fit::SweepFits& fits, double speeds) {
  if (speeds < kLeastSpeedRatio) {
    return {false, fmt::format("the speeds span a factor of {:.2g} only: one speed cannot tell alpha", speeds)};
  }
  const std::string chance = fmt::format("chance of such a gain under Coulomb friction: {:.2g}", fits.p_value);
  if (!fits.depends_on_speed) return {false, "Coulomb friction explains the sweep; " + chance};
  return {true, chance};
}

/// Where residuals are larger than the noise, misfit pays for parameters too: what counts is whether the law holds from
/// one recording to the other.
LawChoice choose_by_left_out(double velocity_error, double coulomb_error) {
  return {velocity_error < coulomb_error,
          fmt::format("residuals are well above the noise; spacing predicted without each recording is off by {:.2g} % "
                      "with F_k(v), by {:.2g} % under Coulomb friction",
                      100.0 * std::expm1(velocity_error), 100.0 * std::expm1(coulomb_error))};
}

/// Speed-dependent friction has two parameters more, its mean slope and its rate.
std::vector<Candidate> candidates_of(const fit::SweepFits& fits, const LawChoice& choice) {
  const double noise2 = fits.velocity.chi2 / fits.velocity.degrees_of_freedom;
  const auto cycles = static_cast<double>(fits.velocity.problem->cycle_count());
  const auto aicc = [&](const JointSolution& solution, double parameters) -> std::optional<double> {
    if (!(cycles > parameters + 1.0)) return std::nullopt;
    return solution.chi2 / noise2 + 2.0 * parameters +
           2.0 * parameters * (parameters + 1.0) / (cycles - parameters - 1.0);
  };
  const std::optional<double> of_coulomb = fits.coulomb ? aicc(*fits.coulomb, 5.0) : std::nullopt;
  return {{Tier::Damped, 5, std::nullopt, of_coulomb, !choice.velocity, choice.reason},
          {Tier::Velocity, 7, std::nullopt, aicc(fits.velocity, 7.0), choice.velocity, choice.reason}};
}

double samples_per_slip(std::span<const SweepRecording> recordings, const SweepData& data) {
  std::vector<double> samples;
  for (const std::size_t i : data.fitted) {
    const fit::BlockFit& blocks = data.single[i]->blocks;
    const fit::CycleState state = blocks.state(blocks.size() / 2);
    samples.push_back(state.slip.tau_end / state.omega_rad_per_s / recordings[i].recording.sample_interval_s());
  }
  return signal::median(samples);
}

/// Over all cycles of all recordings.
double residual_rms(const fit::JointProblem& problem) {
  double square = 0.0;
  for (std::size_t run = 0; run < problem.size(); ++run) {
    square += problem.run(run).noise * problem.run(run).noise * static_cast<double>(problem.recording(run).size());
  }
  return std::sqrt(square / static_cast<double>(problem.cycle_count()));
}

/// Empty, with a reason, where there is none or where it is known to worse than a factor.
Estimate spacing_of(const std::optional<fit::SweepJet>& spacing, const SweepIntervals& intervals,
                    const std::string& why_none) {
  if (!spacing) return {std::nullopt, std::nullopt, std::nullopt, why_none};
  if (!(intervals.quantile() * intervals.error(*spacing) < std::log(fit::kWidestFactor) * spacing->a)) {
    return {std::nullopt, std::nullopt, std::nullopt, "the interval reaches beyond a factor of 2 either way"};
  }
  return intervals.of_one_sign(*spacing);
}

class Assembler {
 public:
  Assembler(std::span<const SweepRecording> recordings, const SweepData& data, const Outcome& outcome)
      : recordings_(recordings),
        data_(data),
        outcome_(outcome),
        model_(fit::with_damping_cut(outcome.values, outcome.covariance), data.scales),
        intervals_(outcome.covariance, outcome.degrees_of_freedom, outcome.profile) {}

  [[nodiscard]] JointFit assemble(const LawChoice& choice) const {
    JointFit joint;
    const fit::JointProblem& problem = *outcome_.solution.problem;
    joint.level_shared = problem.shares().level;
    joint.difference_shared = problem.shares().difference;
    joint.fit.tier = choice.velocity ? Tier::Velocity : Tier::Damped;
    joint.fit.conditional_on.emplace_back(choice.velocity ? "F_k(v) = f0 + f1 exp(alpha v)" : "Coulomb friction");
    joint.fit.residual.rms = residual_rms(problem);
    if (std::any_of(data_.loads.begin(), data_.loads.end(), [](double load) { return load != 1.0; })) {
      joint.fit.conditional_on.push_back(
          fmt::format("normal force {:g} N", *recordings_.front().recording.conditions().normal_force_N));
    }
    joint.fit.residual.reduced_chi2 = outcome_.solution.chi2 / outcome_.solution.degrees_of_freedom;
    add_warnings(joint);
    fit::SweepEvidence evidence{fit::with_damping_cut(outcome_.values, outcome_.covariance), data_.scales, intervals_,
                                outcome_.values(fit::kJointDamping)};
    evidence.depends_on_speed = choice.velocity;
    evidence.law_reason = choice.reason;
    evidence.zero_known = std::all_of(recordings_.begin(), recordings_.end(), [](const SweepRecording& sweep) {
      return sweep.recording.conditions().zero_force_N.has_value();
    });
    evidence.shares_all = joint.level_shared && joint.difference_shared;
    evidence.misfit = is_misfit(outcome_.solution);
    evidence.held = outcome_.solution.held;
    evidence.static_friction = outcome_.static_friction;
    evidence.cycles = problem.cycle_count();
    evidence.samples_per_slip = samples_per_slip(recordings_, data_);
    if (data_.loads_known)
      evidence.reference_normal_force_N = recordings_.front().recording.conditions().normal_force_N;
    fit::report_sweep(evidence, joint.fit);
    for (std::size_t i = 0; i < recordings_.size(); ++i) joint.points.push_back(point_of(i));
    return joint;
  }

 private:
  void add_warnings(JointFit& joint) const {
    if (outcome_.disagree) {
      joint.fit.warnings.push_back(
          {"recordings_disagree",
           "the recordings of the sweep do not agree on one set of parameters: intervals are widened to hold what "
           "leaving out each recording changes"});
    }
    if (outcome_.static_friction == StaticFriction::Ages) {
      joint.fit.warnings.push_back({"static_friction_ages",
                                    "static friction is larger after longer sticks: predictions take it to grow with "
                                    "the logarithm of the stick time (ageing_N)"});
    } else if (!joint.difference_shared) {
      joint.fit.warnings.push_back({"static_friction_differs",
                                    "static friction differs between the recordings (ageing, or another state of the "
                                    "surface): F_s - F_k is their mean"});
    }
    if (!joint.level_shared) {
      joint.fit.warnings.push_back({"level_differs",
                                    "the force level differs between the recordings by more than friction that depends "
                                    "on the speed would make it: a sensor's zero, or another state of the surface"});
    }
  }

  [[nodiscard]] SweepPoint point_of(std::size_t i) const {
    const double speed = recordings_[i].recording.conditions().speed_m_per_s;
    const double load = data_.loads[i];
    SweepPoint point;
    point.kinetic_friction_N = intervals_.plain(load * (model_.level + model_.excess_friction(speed)));
    point.spacing_m = spacing_of(model_.spacing(speed, load), intervals_, "no stick-slip at this speed");
    const auto fitted = std::find(data_.fitted.begin(), data_.fitted.end(), i);
    if (fitted != data_.fitted.end()) {
      const auto run = static_cast<std::size_t>(fitted - data_.fitted.begin());
      point.cycles_used = outcome_.solution.problem->recording(run).size();
      point.rms = outcome_.solution.problem->run(run).noise;
      point.spacing_left_out_m = spacing_without(outcome_.left_out.each[run], speed, load);
    }
    if (data_.steady_of[i]) {
      const fit::SteadyRun& steady = data_.steady[*data_.steady_of[i]];
      point.mean_steady_force_N =
          fit::symmetric(steady.mean_force, steady.standard_error, static_cast<double>(fit::kSteadyStretches) - 1.0);
    }
    return point;
  }

  [[nodiscard]] Estimate spacing_without(const std::optional<LeftOut::One>& one, double speed, double load) const {
    if (!one) return {std::nullopt, std::nullopt, std::nullopt, "too few recordings to leave one out"};
    const SweepVector values = fit::with_damping_cut(one->values, one->covariance);
    return spacing_of(SweepModel(values, data_.scales).spacing(speed, load),
                      SweepIntervals(one->covariance, one->degrees_of_freedom),
                      "no stick-slip at this speed by the others");
  }

  std::span<const SweepRecording> recordings_;
  const SweepData& data_;
  const Outcome& outcome_;
  SweepModel model_;
  SweepIntervals intervals_;
};

}  // namespace

std::optional<JointFit> fit_jointly(std::span<const SweepRecording> recordings, const FitOptions& options) {
  const SweepData data = fit::prepare_sweep(recordings, options);
  if (data.fitted.size() < 2) return std::nullopt;
  const std::optional<fit::SweepFits> fits = fit::fit_sweep(data, options);
  if (!fits) return std::nullopt;
  LawChoice choice = options.tier ? LawChoice{*options.tier == Tier::Velocity, "asked for by --tier"}
                                  : choose_by_chance(*fits, speed_ratio(recordings));
  // Weighing fits once without each recording: not for a law that is left.
  std::optional<Outcome> outcome;
  if (choice.velocity || !fits->coulomb) outcome.emplace(fit::weigh(data, fits->velocity));
  if (choice.velocity && !options.tier && fits->coulomb && is_misfit(fits->velocity)) {
    Outcome coulomb = fit::weigh(data, *fits->coulomb);
    choice = choose_by_left_out(fit::left_out_error(data, *outcome), fit::left_out_error(data, coulomb));
    if (!choice.velocity) outcome.emplace(std::move(coulomb));
  }
  if (!outcome) outcome.emplace(fit::weigh(data, *fits->coulomb));
  JointFit joint = Assembler(recordings, data, *outcome).assemble(choice);
  joint.fit.candidates = candidates_of(*fits, choice);
  return joint;
}

}  // namespace slipfit
