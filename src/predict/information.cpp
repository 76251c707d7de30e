#include "predict/information.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "model/slip_jets.hpp"
#include "predict/delta.hpp"

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
