#pragma once

#include "fit/observation/filter_response.hpp"
#include "model/phasor.hpp"
#include "model/slip.hpp"

namespace slipfit::fit {

/// A slip as an instrument shows it that averages over w_n W around the time stamp: the integral of the force is in
/// closed form. docs/model.md section 7
class AveragedSlip {
 public:
  /// `transmitted`: view.
  AveragedSlip(const model::Slip& slip, const model::StickLine& after, double average_tau, bool transmitted);

  /// Returns the force that the instrument shows, at any tau.
  [[nodiscard]] model::WavePoint at(double tau) const;

  /// Returns the integral of the force itself from the onset to tau.
  [[nodiscard]] MotionPoint integral_to(double tau) const {
    const Force force = force_at(tau);
    return {force.integral, force.z, force.d_z0, force.d_zeta};
  }

  /// Returns the same force from the slip's phasors where the average begins and ends.
  [[nodiscard]] model::WavePoint at(double tau, const model::Phasor& begin, const model::Phasor& end) const {
    return between(force_at(tau - half_, begin), force_at(tau + half_, end));
  }

 private:
  /// Force, and its integral from the onset on with derivatives with respect to z0 and zeta. Or what each of them has
  /// of a function of tau.
  struct Force {
    double z = 0.0, integral = 0.0, d_z0 = 0.0, d_zeta = 0.0;
  };
  /// Linear in c = exp(-zeta tau) cos b tau and s = exp(-zeta tau) sin b tau, the derivative to zeta in tau c and tau s
  /// as well.
  struct Slide {
    Force constant, by_c, by_s;
    double d_zeta_by_tau_c = 0.0, d_zeta_by_tau_s = 0.0;
  };
  /// z = constant.z + tau, and its integral.
  struct Stick {
    Force constant;
    double d_z0_by_tau = 0.0, d_zeta_by_tau = 0.0;
  };

  static Slide slide_of(const model::Slip& slip);
  void transmit(const model::Slip& slip, const model::StickLine& after);
  [[nodiscard]] bool slides_at(double tau) const { return tau > 0.0 && tau <= tau_end_; }
  [[nodiscard]] Force sliding_at(double tau, double c, double s) const;
  [[nodiscard]] Force sticking_at(double tau) const;
  [[nodiscard]] Force force_at(double tau) const;
  [[nodiscard]] Force force_at(double tau, const model::Phasor& phasor) const {
    return slides_at(tau) ? sliding_at(tau, phasor.c(), phasor.s()) : sticking_at(tau);
  }
  [[nodiscard]] model::WavePoint between(const Force& first, const Force& last) const;

  double zeta_, b_, tau_end_;
  double half_;        ///< of the average
  double by_average_;  ///< 1 / average
  Slide slide_;
  Stick before_, after_;  ///< the slip
};

// Asked for every sample.

inline AveragedSlip::Force AveragedSlip::sliding_at(double tau, double c, double s) const {
  const auto& [constant, by_c, by_s, by_tau_c, by_tau_s] = slide_;
  return {by_c.z * c + by_s.z * s, constant.integral + by_c.integral * c + by_s.integral * s,
          constant.d_z0 + by_c.d_z0 * c + by_s.d_z0 * s,
          constant.d_zeta + (by_c.d_zeta + by_tau_c * tau) * c + (by_s.d_zeta + by_tau_s * tau) * s};
}

inline AveragedSlip::Force AveragedSlip::sticking_at(double tau) const {
  const auto& [constant, d_z0_by_tau, d_zeta_by_tau] = tau <= 0.0 ? before_ : after_;
  return {constant.z + tau, constant.integral + tau * (constant.z + 0.5 * tau), constant.d_z0 + d_z0_by_tau * tau,
          constant.d_zeta + d_zeta_by_tau * tau};
}

inline model::WavePoint AveragedSlip::between(const Force& first, const Force& last) const {
  const double mean = by_average_ * (last.integral - first.integral);
  const double by_log_average = 0.5 * (first.z + last.z) - mean;
  return {mean,
          by_average_ * (last.d_z0 - first.d_z0),
          by_average_ * (last.d_zeta - first.d_zeta),
          by_average_ * (last.z - first.z),
          by_log_average,
          by_log_average};
}

}  // namespace slipfit::fit
