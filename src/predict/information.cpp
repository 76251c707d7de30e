#include "predict/information.hpp"

#include <ceres/jet.h>

#include <cmath>

#include "model/velocity_track.hpp"
#include "predict/motion.hpp"

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
  using Id = ParameterId;

 public:
  Cycle(const ModelEstimate& model, double speed_m_per_s, double excess_N)
      : stiffness_(from_speed(exponential(at_speed(model, speed_m_per_s).stiffness_N_per_m, Id::Stiffness), model,
                              speed_m_per_s)),
        omega_(from_speed(exponential(at_speed(model, speed_m_per_s).natural_frequency_rad_per_s, Id::NaturalFrequency),
                          model, speed_m_per_s)),
        zeta_(parameter(model.damping_ratio, Id::DampingRatio)),
        difference_(exponential(model.friction_difference_N, Id::FrictionDifference)),
        unit_(stiffness_ * speed_m_per_s / omega_) {
    if (model.ageing) {
      // After the sticks of this speed; that these follow F_s - F_k is a small part of what they tell of the rate.
      const double aged_N = aged_difference_N(at_speed(model, speed_m_per_s), speed_m_per_s).value_or(0.0);
      const auto [rate_N, reference_s, cutoff_s] = *model.ageing;
      const double log_stick = (aged_N - model.friction_difference_N) / rate_N;
      const double by_cutoff = (std::exp(-log_stick) - 1.0) / (reference_s + cutoff_s);
      difference_ += parameter(rate_N, Id::Ageing) * log_stick + rate_N * by_cutoff * parameter(0.0, Id::AgeingTime);
    }
    const SpeedDependence law = model.speed_dependence.value_or(SpeedDependence{});
    slope_ = parameter(law.slope_N_s_per_m, Id::FrictionSlope) * omega_ / stiffness_;
    rate_ = parameter(law.alpha_s_per_m, Id::Alpha) * speed_m_per_s;
    onset_force_ = CycleJet((difference_ - 2.0 * zeta_ * unit_).a + excess_N, kOnsetForce);  // F_s - cV
    z0_ = onset_force_ / unit_;
    track_ = model::VelocityTrack::solve(z0_.a, zeta_.a, slope_.a, rate_.a);
  }

  [[nodiscard]] bool sticks() const { return track_ && track_->resticks() && tau_stick() > 0.0; }
  [[nodiscard]] double omega_rad_per_s() const { return omega_.a; }
  [[nodiscard]] double tau_slip() const { return track_->tau_end(); }
  [[nodiscard]] double tau_stick() const { return z0_.a - track_->after().value - tau_slip(); }

  /// Force of a sample at a fixed time.
  [[nodiscard]] CycleJet force(double at) const {
    const model::TrackPoint p = track_->at(at);
    CycleJet tau(at);
    tau.v = at * omega_.v / omega_.a;
    tau.v(kOnsetTime) -= omega_.a;
    CycleJet z(p.z);
    z.v = p.d_tau * tau.v + p.d_z0 * z0_.v + p.d_zeta * zeta_.v + p.d_slope * slope_.v + p.d_rate * rate_.v;
    return CycleJet(0.0, kLevel) + unit_ * z;
  }
  /// What the population of cycles says of this one's onset force.
  [[nodiscard]] CycleJet onset_departure() const { return onset_force_ - (difference_ - 2.0 * zeta_ * unit_); }

 private:
  static CycleJet parameter(double value, Id id) { return {value, static_cast<int>(place_in_model(id))}; }
  /// A quantity whose logarithm the model has.
  static CycleJet exponential(double value, Id id) {
    CycleJet jet(value);
    jet.v(static_cast<Eigen::Index>(place_in_model(id))) = value;
    return jet;
  }

  CycleJet stiffness_, omega_, zeta_, difference_, unit_, slope_, rate_, onset_force_, z0_;
  std::optional<model::VelocityTrack> track_;
};

/// Sum over the samples of one cycle, the first of the slip at `tau_first`; half a stick on either side.
CycleMatrix normal_matrix(const Cycle& cycle, double tau_first, double tau_step, const Disturbance& disturbance) {
  CycleMatrix sum = CycleMatrix::Zero();
  const auto add = [&sum](const CycleJet& y, double weight) { sum += weight * y.v * y.v.transpose(); };
  const double precision = 1.0 / (disturbance.noise_rms_N * disturbance.noise_rms_N);
  for (double tau = tau_first; tau < cycle.tau_slip(); tau += tau_step) add(cycle.force(tau), precision);
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

/// What remains of the first `kept` rows when the others are free.
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
  // Slips of different size tell zeta from the force level: half of the cycles on either side of the mean.
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
      const double tau_first = (phase + 0.5) / kPhases * tau_step;
      information.matrix +=
          cycles / kPhases * marginal(normal_matrix(cycle, tau_first, tau_step, disturbance), kOnsetForce);
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
