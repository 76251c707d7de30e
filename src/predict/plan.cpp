#include "slipfit/predict/plan.hpp"

#include <ceres/jet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "model/rebound.hpp"
#include "model/slip_jets.hpp"
#include "predict/critical.hpp"
#include "predict/draws.hpp"
#include "predict/information.hpp"

namespace slipfit::predict {

namespace {

/// ModelEstimate's values, then the force level, and what each cycle has of its own: onset force and time.
constexpr int kValues = static_cast<int>(kModelValues);
constexpr int kLevel = kValues;
constexpr int kOnsetForce = kValues + 1;
constexpr int kOnsetTime = kValues + 2;
constexpr int kColumns = kValues + 3;
using CycleJet = ceres::Jet<double, kColumns>;
using CycleMatrix = Eigen::Matrix<double, kColumns, kColumns>;

/// One cycle of the recording, whose static friction is by `excess_N` above the mean.
class Cycle {
 public:
  Cycle(const ModelEstimate& model, double speed_m_per_s, double excess_N)
      : Cycle(body_of(model, speed_m_per_s), speed_m_per_s, excess_N) {}

  [[nodiscard]] bool sticks() const { return track_ && track_->resticks() && tau_stick() > 0.0; }
  [[nodiscard]] double omega_rad_per_s() const { return omega_.a; }
  [[nodiscard]] double tau_slip() const { return track_->tau_end(); }
  [[nodiscard]] double tau_stick() const { return slip_.tau_period(*track_).a - tau_slip(); }

  /// Force of a sample at a fixed time.
  [[nodiscard]] CycleJet force(double at) const {
    const model::TrackPoint p = track_->at(at);
    CycleJet tau(at);
    tau.v = at * omega_.v / omega_.a;
    tau.v(kOnsetTime) -= omega_.a;
    CycleJet z = slip_.jet(p.z, p);
    z.v += p.d_tau * tau.v;
    return CycleJet(0.0, kLevel) + slip_.force_unit_N * z;
  }
  /// Returns the departure of this cycle's onset force from the mean of the population of cycles.
  [[nodiscard]] CycleJet onset_departure() const { return onset_force_ - mean_onset_force_; }

 private:
  using Body = model::SlidingBody<CycleJet>;

  static Body body_of(const ModelEstimate& model, double speed_m_per_s) {
    Body body = body_at<CycleJet>(model, speed_m_per_s);
    if (!body.ageing) return body;
    // After the sticks of this speed; that these follow F_s - F_k is a small part of what they show of the rate.
    const auto aged_N = body_at<Plain>(model, speed_m_per_s).aged_difference_N();
    const auto [rate_N, cutoff_s, reference_s] = *body.ageing;
    const double log_stick = ((aged_N ? aged_N->a : 0.0) - body.difference_N.a) / rate_N.a;
    const double by_cutoff = (std::exp(-log_stick) - 1.0) / (reference_s + cutoff_s.a);
    body.difference_N += rate_N * log_stick + rate_N.a * by_cutoff * (cutoff_s - cutoff_s.a);
    return body;
  }

  Cycle(const Body& p, double speed_m_per_s, double excess_N)
      : omega_(p.omega_rad_per_s),
        slip_(p.stiffness_N_per_m, p.omega_rad_per_s, p.zeta, p.difference_N, p.slope_N_s_per_m, p.alpha_s_per_m,
              speed_m_per_s),
        mean_onset_force_(slip_.force_unit_N * slip_.z0),  // F_s - cV
        onset_force_(mean_onset_force_.a + excess_N, kOnsetForce) {
    slip_.z0 = onset_force_ / slip_.force_unit_N;
    track_ = slip_.solve();
  }

  CycleJet omega_;
  model::SlipJets<CycleJet> slip_;
  CycleJet mean_onset_force_, onset_force_;
  std::optional<model::VelocityTrack> track_;
};

/// Sum over the samples of one cycle, the first of the slip at `phase` of a step; half a stick on either side.
CycleMatrix normal_matrix(const Cycle& cycle, double phase, double tau_step, const Disturbance& disturbance) {
  // Among more samples than these one represents several: the sum is then an integral.
  constexpr double kMostSamples = 1000.0;
  CycleMatrix sum = CycleMatrix::Zero();
  const auto add = [&sum](const CycleJet& y, double weight) { sum += weight * y.v * y.v.transpose(); };
  const double precision = 1.0 / (disturbance.noise_rms_N * disturbance.noise_rms_N);
  const double samples = std::max(1.0, std::ceil(cycle.tau_slip() / tau_step / kMostSamples));
  const double stride = samples * tau_step;
  for (double tau = phase * stride; tau < cycle.tau_slip(); tau += stride) add(cycle.force(tau), samples * precision);
  // Squares of straight lines: two Gauss points are exact.
  const double half = 0.5 * cycle.tau_stick();
  for (const double share : {0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0)}) {
    add(cycle.force(-share * half), 0.5 * half / tau_step * precision);
    add(cycle.force(cycle.tau_slip() + share * half), 0.5 * half / tau_step * precision);
  }
  // No scatter at all would be one number for all cycles; a thousandth of the noise is as good as none.
  const double scatter = std::max(disturbance.static_friction_sd_N, 1e-3 * disturbance.noise_rms_N);
  add(cycle.onset_departure(), 1.0 / (scatter * scatter));
  return sum;
}

/// Returns what remains of the first `kept` rows when the others are free.
Eigen::MatrixXd marginal(const Eigen::MatrixXd& matrix, Eigen::Index kept) {
  const Eigen::Index freed = matrix.rows() - kept;
  const Eigen::MatrixXd cross = matrix.topRightCorner(kept, freed);
  const Eigen::MatrixXd corner = matrix.bottomRightCorner(freed, freed);
  return matrix.topLeftCorner(kept, kept) - cross * corner.ldlt().solve(cross.transpose());
}

}  // namespace

std::optional<Information> information_of(const ModelEstimate& model, const RecordingPlan& recording,
                                          const Disturbance& disturbance) {
  Information information;
  // Slips of different size distinguish zeta from the force level: half of the cycles on either side of the mean.
  for (const double side : {-1.0, 1.0}) {
    const Cycle cycle(model, recording.speed_m_per_s, side * disturbance.static_friction_sd_N);
    if (!cycle.sticks()) return std::nullopt;
    const double tau_step = cycle.omega_rad_per_s() / recording.sample_rate_Hz;
    const double cycles = 0.5 * recording.duration_s * cycle.omega_rad_per_s() / (cycle.tau_slip() + cycle.tau_stick());
    information.cycles += cycles;
    information.samples_per_slip += 0.5 * cycle.tau_slip() / tau_step;
    // The clock is as likely in any phase of the slip; each cycle has one.
    constexpr int kPhases = 8;
    for (int phase = 0; phase < kPhases; ++phase) {
      const CycleMatrix normals = normal_matrix(cycle, (phase + 0.5) / kPhases, tau_step, disturbance);
      information.matrix += cycles / kPhases * marginal(normals, kOnsetForce);
    }
  }
  return information;
}

PlanMatrix without_level(const PlanMatrix& information) {
  PlanMatrix result = PlanMatrix::Zero();
  result.topLeftCorner(kLevel, kLevel) = marginal(information, kLevel);
  return result;
}

PlanMatrix updated(const PlanMatrix& covariance, const PlanMatrix& information) {
  const PlanMatrix system = PlanMatrix::Identity() + covariance * information;
  return system.partialPivLu().solve(covariance);
}

}  // namespace slipfit::predict

namespace slipfit {

namespace {

using predict::Disturbance;
using predict::Jet;
using predict::PlanMatrix;

struct NamedJet {
  std::string name;
  Jet value;
};

/// False for those that the planned cycles do not have: force recovery and relaxation.
bool is_planned(ParameterId id) {
  constexpr std::array kNotPlanned{ParameterId::ReloadForce, ParameterId::ReloadLength, ParameterId::Relaxation,
                                   ParameterId::RelaxationTime};
  return std::ranges::find(kNotPlanned, id) == kNotPlanned.end();
}

/// Those of the model that can be planned for, mass and damping coefficient, in the order of every report.
std::vector<NamedJet> parameters_of(const ModelEstimate& model) {
  const auto of = [&model](ParameterId id) { return predict::parameter_of<Jet>(model, id); };
  const Jet k = of(ParameterId::Stiffness);
  const Jet omega = of(ParameterId::NaturalFrequency);
  std::vector<NamedJet> all;
  for (const ParameterInfo& parameter : parameter_table()) {
    std::string name(parameter.key);
    if (!is_planned(parameter.id)) continue;
    if (model.find(parameter.id) != nullptr)
      all.push_back({std::move(name), of(parameter.id)});
    else if (parameter.id == ParameterId::Mass)
      all.push_back({std::move(name), k / (omega * omega)});
    else if (parameter.id == ParameterId::DampingCoefficient)
      all.push_back({std::move(name), 2.0 * of(ParameterId::DampingRatio) * k / omega});
  }
  return all;
}

Eigen::Matrix<double, predict::kPlanValues, 1> gradient_of(const Jet& y) {
  Eigen::Matrix<double, predict::kPlanValues, 1> gradient = Eigen::Matrix<double, predict::kPlanValues, 1>::Zero();
  gradient.head(static_cast<Eigen::Index>(kModelValues)) = y.v;
  return gradient;
}

/// Hardly anything known, but for what is held.
PlanMatrix vague(const ModelEstimate& model) {
  PlanMatrix matrix = PlanMatrix::Zero();
  for (std::size_t i = 0; i < kModelValues; ++i) {
    matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = 1e4 * model.covariance[i][i];
  }
  matrix(predict::kPlanValues - 1, predict::kPlanValues - 1) = 1e4 * std::pow(model.friction_difference_N, 2);
  return matrix;
}

/// Scatter of the static friction, from that of the fall, which is free of drift.
double scatter_N(const PlanBasis& basis) {
  const double zeta = std::min(basis.estimate.damping_ratio, 0.9);
  return basis.force_drop_sd_N.value_or(0.0) / (1.0 + model::rebound_at(zeta));
}

class Planner {
 public:
  explicit Planner(const PlanBasis& basis)
      : basis_(basis),
        disturbance_{basis.noise_rms_N, scatter_N(basis)},
        propagation_(basis.estimate),
        before_(vague(basis.estimate)),
        measured_(measured(disturbance_, 1.0)),
        quiet_(measured({kGood * disturbance_.noise_rms_N, disturbance_.static_friction_sd_N}, 1.0)),
        even_(measured({disturbance_.noise_rms_N, kGood * disturbance_.static_friction_sd_N}, 1.0)),
        // More samples, each with more noise, so that nothing is won by their number.
        dense_(measured({std::sqrt(kFastClock) * disturbance_.noise_rms_N, disturbance_.static_friction_sd_N},
                        kFastClock)) {}

  [[nodiscard]] double error_now(const Jet& y) const { return propagation_.standard_error(y); }

  [[nodiscard]] ParameterLimit limit_of(const NamedJet& parameter) const {
    ParameterLimit result{parameter.name, parameter.value.a, error_now(parameter.value), 0.0, Limit::Held};
    if (!(result.standard_error > 0.0)) return result;
    const double expected = error_by(parameter.value, measured_);
    result.explained_error = expected;
    result.limit = result.standard_error > thresholds::kUnexplainedError * expected
                       ? Limit::Misfit
                       : most_helpful(parameter.value, expected);
    return result;
  }

  [[nodiscard]] std::vector<PlanOption> options(const Jet& target) const {
    std::vector<PlanOption> all;
    for (const double speed : speeds()) {
      if (const auto option = best_rate(target, speed)) all.push_back(*option);
    }
    std::ranges::stable_sort(
        all, [](const PlanOption& a, const PlanOption& b) { return a.standard_error < b.standard_error; });
    return all;
  }

  /// Information grows as the duration. At least as long as a few cycles.
  [[nodiscard]] std::optional<double> halving_s(const Jet& target, const RecordingPlan& recording) const {
    const auto information = predict::information_of(basis_.estimate, recording, disturbance_);
    if (!information) return std::nullopt;
    const auto error = [&](double times) { return error_with(target, times * information->matrix); };
    const double wanted = 0.5 * error_now(target);
    double low = kLeastCycles / information->cycles;
    double high = kLongest;
    if (!(error(high) <= wanted)) return std::nullopt;
    if (error(low) <= wanted) return low * recording.duration_s;
    while (high / low > 1.01) (error(std::sqrt(low * high)) > wanted ? low : high) = std::sqrt(low * high);
    return high * recording.duration_s;
  }

 private:
  static constexpr double kLeastCycles = 5.0;  // fewer are no fit
  static constexpr double kLongest = 1e3;      // times as long as now: longer is no plan
  static constexpr double kGood = 0.1;         // less disturbance, as good as none
  static constexpr double kFastClock = 8.0;    // more samples
  static constexpr double kHelpful = 0.7;      // a change that lowers the error to less than this share helps by itself

  [[nodiscard]] PlanMatrix share_of(const PlanMatrix& information) const {
    return basis_.levels == LevelSharing::Shared ? information : predict::without_level(information);
  }

  /// Returns the information of the recordings of the fit, with another disturbance or clock.
  [[nodiscard]] PlanMatrix measured(const Disturbance& disturbance, double clock) const {
    PlanMatrix sum = PlanMatrix::Zero();
    for (RecordingPlan recording : basis_.recordings) {
      recording.sample_rate_Hz *= clock;
      const auto information = predict::information_of(basis_.estimate, recording, disturbance);
      if (information) sum += share_of(information->matrix);
    }
    return sum;
  }

  [[nodiscard]] double error_by(const Jet& y, const PlanMatrix& information) const {
    const auto gradient = gradient_of(y);
    return std::sqrt(std::max(0.0, gradient.dot(predict::updated(before_, information) * gradient)));
  }

  /// The fit's own standard error with a recording more.
  [[nodiscard]] double error_with(const Jet& y, const PlanMatrix& information) const {
    return error_now(y) * error_by(y, measured_ + share_of(information)) / error_by(y, measured_);
  }

  [[nodiscard]] Limit most_helpful(const Jet& y, double now) const {
    if (error_by(y, dense_) < kHelpful * now) return Limit::Sampling;
    const double by_scatter = error_by(y, even_);
    const double by_noise = error_by(y, quiet_);
    if (std::min(by_scatter, by_noise) >= kHelpful * now) return Limit::Cycles;
    return by_scatter < by_noise ? Limit::Scatter : Limit::Noise;
  }

  /// Around those measured, where the model sticks for sure.
  [[nodiscard]] std::vector<double> speeds() const {
    const auto [slow, fast] = std::ranges::minmax_element(
        basis_.recordings,
        [](const RecordingPlan& a, const RecordingPlan& b) { return a.speed_m_per_s < b.speed_m_per_s; });
    std::vector<double> result;
    constexpr double kBeyond = 8.0;
    const double end = end_of_stick_slip().value_or(fast->speed_m_per_s);
    for (double speed = slow->speed_m_per_s / kBeyond; speed < fast->speed_m_per_s * kBeyond * 1.01; speed *= 2.0) {
      if (basis_.estimate.ageing ? speed < end : sticks_for_sure(speed)) result.push_back(speed);
    }
    return result;
  }

  /// The lower end of its interval, where static friction ages: the margin of the single slip says nothing there.
  [[nodiscard]] std::optional<double> end_of_stick_slip() const {
    if (!basis_.estimate.ageing) return std::nullopt;
    const Estimate critical = predict::critical_point(basis_.estimate).speed_m_per_s;
    return critical.ci95 ? std::optional(critical.ci95->low) : std::nullopt;
  }

  [[nodiscard]] bool sticks_for_sure(double speed_m_per_s) const {
    const predict::ModelMotion motion = predict::motion_at(basis_.estimate, speed_m_per_s);
    if (!motion.cycle || !motion.restick_margin) return false;
    const Jet& margin = *motion.restick_margin;
    return margin.a > 2.0 * propagation_.quantile() * propagation_.standard_error(margin);
  }

  /// The slowest clock that is within a tenth of the best; the present one, or faster.
  [[nodiscard]] std::optional<PlanOption> best_rate(const Jet& target, double speed_m_per_s) const {
    std::vector<double> rates;
    std::vector<double> durations;
    for (const RecordingPlan& recording : basis_.recordings) {
      rates.push_back(recording.sample_rate_Hz);
      durations.push_back(recording.duration_s);
    }
    std::vector<PlanOption> options;
    for (const double faster : {1.0, 4.0, 16.0}) {
      const RecordingPlan recording{speed_m_per_s, faster * median(rates), median(durations)};
      // A sensor does not get quieter by asking it more often: the noise density stays.
      const Disturbance disturbance{std::sqrt(faster) * disturbance_.noise_rms_N, disturbance_.static_friction_sd_N};
      const auto information = predict::information_of(basis_.estimate, recording, disturbance);
      if (!information || information->cycles < kLeastCycles) return std::nullopt;
      options.push_back(
          {recording, information->cycles, information->samples_per_slip, error_with(target, information->matrix)});
    }
    const double best = options.back().standard_error;
    return *std::ranges::find_if(options,
                                 [best](const PlanOption& option) { return option.standard_error <= 1.1 * best; });
  }

  const PlanBasis& basis_;
  Disturbance disturbance_;
  predict::Propagation propagation_;
  PlanMatrix before_;
  // Information of the recordings: as they are; with less noise; with less scatter; with more samples.
  PlanMatrix measured_, quiet_, even_, dense_;
};

/// The parameter with the widest relative interval; held ones need nothing.
PlanTarget worst_known(const std::vector<ParameterLimit>& limits) {
  const auto relative = [](const ParameterLimit& limit) {
    return limit.standard_error > 0.0 ? limit.standard_error / std::abs(limit.value) : 0.0;
  };
  const auto worst =
      std::ranges::max_element(limits, [&](const auto& a, const auto& b) { return relative(a) < relative(b); });
  return {worst->name, std::nullopt};
}

/// One recording does not show how friction changes with speed, which limits a prediction elsewhere.
bool is_elsewhere(const PlanBasis& basis, double speed_m_per_s) {
  const double ratio = speed_m_per_s / basis.recordings.front().speed_m_per_s;
  return basis.recordings.size() == 1 && std::abs(ratio - 1.0) > thresholds::kNegligible;
}

Result<Jet> jet_of(const PlanTarget& target, const PlanBasis& basis) {
  const ModelEstimate& model = basis.estimate;
  if (target.name == "periodic_displacement_m") {
    if (!target.speed_m_per_s) return Error{"bad_target", "periodic_displacement_m needs a speed"};
    const predict::ModelMotion motion = predict::motion_at(model, *target.speed_m_per_s);
    if (!motion.cycle) return Error{"bad_target", "the fitted model has no stick-slip at this speed"};
    if (is_elsewhere(basis, *target.speed_m_per_s)) {
      return Error{"bad_target",
                   fmt::format("one recording does not show how friction changes with speed, which limits "
                               "the prediction at {:.4g} m/s: record at that speed, and fit both "
                               "recordings together",
                               *target.speed_m_per_s)};
    }
    return Jet(*target.speed_m_per_s * motion.cycle->period_s());
  }
  std::string known;
  for (const NamedJet& parameter : parameters_of(model)) {
    if (parameter.name == target.name) return Jet(parameter.value);
    known += parameter.name + ", ";
  }
  const std::optional<ParameterId> id = parameter_with_key(target.name);
  if (id && !is_planned(*id)) {
    return Error{"bad_target", "recordings are not planned for " + target.name + ", expected one of " + known +
                                   "periodic_displacement_m"};
  }
  return Error{"bad_target",
               "unknown target '" + target.name + "', expected one of " + known + "periodic_displacement_m"};
}

}  // namespace

Result<Plan> plan_next(const PlanBasis& basis, const std::optional<PlanTarget>& target) {
  const Planner planner(basis);
  Plan plan;
  for (const NamedJet& parameter : parameters_of(basis.estimate)) plan.limits.push_back(planner.limit_of(parameter));
  plan.target = target.value_or(worst_known(plan.limits));
  const Result<Jet> wanted = jet_of(plan.target, basis);
  if (!wanted) return wanted.error();
  plan.value = wanted.value().a;
  plan.standard_error = planner.error_now(wanted.value());
  if (!(plan.standard_error > 0.0))
    return Error{"bad_target", plan.target.name +
                                   " was held in this fit, by --fix or because the recordings do not "
                                   "determine it: choose another parameter with --for"};
  plan.options = planner.options(wanted.value());
  if (!plan.options.empty()) plan.halving_s = planner.halving_s(wanted.value(), plan.options.front().recording);
  return plan;
}

}  // namespace slipfit
