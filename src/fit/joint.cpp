#include "slipfit/fit/joint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/joint_ageing.hpp"
#include "fit/joint_parameters.hpp"
#include "fit/joint_quantities.hpp"
#include "fit/joint_solution.hpp"
#include "signal/robust.hpp"

namespace slipfit {
namespace {

using fit::JointSolution;
using fit::StaticFriction;
using fit::SweepData;
using fit::SweepIntervals;
using fit::SweepMatrix;
using fit::SweepModel;
using fit::SweepVector;

/// Below it a sweep is one speed: damping and friction that depends on speed cannot be told apart.
constexpr double kLeastSpeedRatio = 1.3;
/// A recording left out moves a parameter by chance by this many standard errors of the shift in fewer than one sweep
/// of 300 (5 recordings, 7 parameters).
constexpr double kShiftSigmas = 4.5;

/// Reduced chi2 of a model that leaves something unexplained (the noise is that of each recording's own fit).
constexpr double kMisfitChi2 = 1.5;

/// A first-order band wider than this says nothing.
constexpr double kWidestFactor = 2.0;

/// Fits without one recording each: their predictions, and how much the parameters move.
struct LeftOut {
  struct One {
    SweepVector values;
    SweepMatrix covariance;
    double degrees_of_freedom = 1.0;
  };
  std::vector<std::optional<One>> each;  ///< in the order of SweepData::fitted

  /// Delete-one-recording jackknife.
  [[nodiscard]] SweepMatrix covariance() const {
    SweepVector mean = SweepVector::Zero();
    for (const auto& one : each) {
      if (one) mean += one->values / count();
    }
    SweepMatrix sum = SweepMatrix::Zero();
    for (const auto& one : each) {
      if (one) sum += (count() - 1.0) / count() * (one->values - mean) * (one->values - mean).transpose();
    }
    return sum;
  }

  [[nodiscard]] double count() const {
    return static_cast<double>(
        std::count_if(each.begin(), each.end(), [](const auto& one) { return one.has_value(); }));
  }
};

/// A line through few recordings counts for fewer than the cycles do.
double degrees_of_freedom(const fit::JointCovariance& covariance, const JointSolution& solution, StaticFriction kind) {
  if (kind == StaticFriction::Constant) return covariance.degrees_of_freedom;
  return std::min(covariance.degrees_of_freedom, std::max(1.0, static_cast<double>(solution.problem->size()) - 2.0));
}

LeftOut leave_out_each(const SweepData& data, const JointSolution& solution, StaticFriction kind) {
  LeftOut result;
  for (const std::size_t recording : data.fitted) {
    result.each.emplace_back();
    const std::optional<JointSolution> without = fit::leave_out(data, solution, recording);
    if (!without) continue;
    const fit::JointCovariance covariance = fit::covariance_of(data, *without);
    result.each.back() =
        LeftOut::One{fit::sweep_values(*without, kind), fit::sweep_covariance(*without, covariance, kind),
                     degrees_of_freedom(covariance, *without, kind)};
  }
  return result;
}

/// The recordings disagree by more than noise and the scatter of the cycles explain: the variance of the shift between
/// an efficient estimate and one from fewer data is the difference of their variances (Hausman).
bool recordings_disagree(const SweepVector& values, const SweepMatrix& covariance, const LeftOut& left_out) {
  if (left_out.count() < 3.0) return false;
  for (const auto& one : left_out.each) {
    for (Eigen::Index i = 0; one && i < fit::kSweepValues; ++i) {
      const double least = 0.05 * covariance(i, i);  // rounding and iteration: the difference may come out as nothing
      const double variance = std::max(one->covariance(i, i) - covariance(i, i), least);
      const double shift = one->values(i) - values(i);
      if (variance > 0.0 && shift * shift > kShiftSigmas * kShiftSigmas * variance) return true;
    }
  }
  return false;
}

bool is_misfit(const JointSolution& solution) {
  return solution.chi2 > kMisfitChi2 * solution.degrees_of_freedom;
}

/// A solution with the intervals that it deserves.
struct Outcome {
  const JointSolution& solution;
  StaticFriction static_friction = StaticFriction::Constant;
  SweepVector values;
  SweepMatrix covariance;
  double degrees_of_freedom = 1.0;
  LeftOut left_out;
  bool disagree = false;  ///< the covariance is widened by what leaving out each recording changes
};

Outcome weigh(const SweepData& data, const JointSolution& solution) {
  const fit::JointCovariance covariance = fit::covariance_of(data, solution);
  const StaticFriction kind = fit::static_friction_of(solution);
  Outcome outcome{solution,
                  kind,
                  fit::sweep_values(solution, kind),
                  fit::sweep_covariance(solution, covariance, kind),
                  degrees_of_freedom(covariance, solution, kind),
                  leave_out_each(data, solution, kind)};
  outcome.disagree = recordings_disagree(outcome.values, outcome.covariance, outcome.left_out);
  if (outcome.disagree) {
    outcome.covariance += outcome.left_out.covariance();
    outcome.degrees_of_freedom = std::min(outcome.degrees_of_freedom, outcome.left_out.count() - 1.0);
  }
  return outcome;
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

/// Root mean square of ln (spacing predicted without a recording / its own); no prediction counts as a factor of 2.
double left_out_error(const SweepData& data, const Outcome& outcome) {
  double square = 0.0;
  for (std::size_t run = 0; run < data.fitted.size(); ++run) {
    const fit::BlockFit& blocks = outcome.solution.problem->recording(run);
    const double speed = blocks.scales().speed_m_per_s;
    double error = std::log(kWidestFactor);
    if (const auto& one = outcome.left_out.each[run]) {
      const SweepModel model(fit::with_damping_cut(one->values, one->covariance), data.scales);
      const auto spacing = model.spacing(speed, outcome.solution.problem->run(run).load);
      if (spacing) error = std::min(error, std::abs(std::log(spacing->a / (speed * fit::median_period_s(blocks)))));
    }
    square += error * error;
  }
  return std::sqrt(square / static_cast<double>(data.fitted.size()));
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
  const auto aicc = [&](double chi2, double parameters) -> std::optional<double> {
    if (!(cycles > parameters + 1.0) || !std::isfinite(chi2)) return std::nullopt;
    return chi2 / noise2 + 2.0 * parameters + 2.0 * parameters * (parameters + 1.0) / (cycles - parameters - 1.0);
  };
  return {{Tier::Damped, 5, std::nullopt, aicc(fits.coulomb.chi2, 5.0), !choice.velocity, choice.reason},
          {Tier::Velocity, 7, std::nullopt, aicc(fits.velocity.chi2, 7.0), choice.velocity, choice.reason}};
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
  if (!(intervals.quantile() * intervals.error(*spacing) < std::log(kWidestFactor) * spacing->a)) {
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
        intervals_(outcome.covariance, outcome.degrees_of_freedom) {}

  JointFit assemble(const LawChoice& choice) const {
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
      const double half = 2.26 * steady.standard_error;  // Student's t, 9 degrees of freedom
      point.mean_steady_force_N = {
          steady.mean_force, steady.standard_error, Interval{steady.mean_force - half, steady.mean_force + half}, {}};
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
  const bool have_coulomb = std::isfinite(fits->coulomb.chi2);
  // Weighing fits once without each recording: not for a law that is left.
  std::optional<Outcome> outcome;
  if (choice.velocity || !have_coulomb) outcome.emplace(weigh(data, fits->velocity));
  if (choice.velocity && !options.tier && have_coulomb && is_misfit(fits->velocity)) {
    Outcome coulomb = weigh(data, fits->coulomb);
    choice = choose_by_left_out(left_out_error(data, *outcome), left_out_error(data, coulomb));
    if (!choice.velocity) outcome.emplace(std::move(coulomb));
  }
  if (!outcome) outcome.emplace(weigh(data, fits->coulomb));
  JointFit joint = Assembler(recordings, data, *outcome).assemble(choice);
  joint.fit.candidates = candidates_of(*fits, choice);
  return joint;
}

}  // namespace slipfit
