#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "model/slip.hpp"
#include "model/slip_series.hpp"
#include "model/weakening.hpp"

namespace slipfit::fit {

/// Lags after which a sensor shows nothing more of a slip: e^-8.
inline constexpr double kForgottenLags = 8.0;

/// What the instrument does to the force of one cycle, in the scaled units of model/slip.hpp. docs/model.md section 7
/// - a low-pass filter with a Butterworth response of some order, of which the first is y' + kappa y = kappa z;
/// - a moving average over w_n W around the time stamp.
struct Sensor {
  double lag_tau = 0.0;      ///< by which the filter delays a slow ramp, times w_n; 0: no filter
  double average_tau = 0.0;  ///< w_n W; 0: none
  std::size_t order = 1;     ///< of the filter
};

/// The force above the level at some tau, in units of k V / w_n, with its derivatives: at fixed tau by z0, zeta and two
/// numbers of the law.
struct MotionPoint {
  double z = 0.0, d_tau = 0.0, d_z0 = 0.0, d_zeta = 0.0;
  std::array<double, 2> d_law{};
};

/// Holds the force that a sensor shows, with the derivative with respect to ln w_n at fixed tau (its times are fixed in
/// seconds) and with respect to the logarithm of the time over which it averages.
struct ShownPoint : MotionPoint {
  double d_log_omega = 0.0;
  double d_log_average = 0.0;
};

/// A cycle as a sensor with a Butterworth response shows it. In each part of the slip z is a polynomial, of which each
/// pole's response is known in closed form, whatever the law of friction; the stick before counts as long enough for
/// the slip before it to be forgotten. docs/model.md section 7
class FilterResponse {
 public:
  /// `onset`, `delayed`: the motion at tau = 0 and at -delay_tau; the stick between them counts as straight.
  /// `parts`: all that is not straight from there on, in their order. `order`: from 1, a lag of first order, to
  /// kHighestFilterOrder. `delay_tau` (> 0): by which the filter delays a slow ramp.
  FilterResponse(const MotionPoint& onset, const MotionPoint& delayed, std::vector<model::SlipPart> parts,
                 std::size_t order, double delay_tau);

  [[nodiscard]] double delay_tau() const { return delay_tau_; }
  /// On a straight stick `memory_at` is delay_tau() times the force this time earlier.
  [[nodiscard]] double memory_delay_tau() const { return memory_delay_tau_; }
  /// The force that the sensor shows at a tau above 0. `motion`: z there.
  [[nodiscard]] ShownPoint at(const MotionPoint& motion, double tau) const;
  /// Returns what the filter holds back at a tau above 0: the integral of z less that of the force shown.
  [[nodiscard]] ShownPoint memory_at(const MotionPoint& motion, double tau) const;

 private:
  static constexpr std::size_t kColumns = 1 + model::kScaledParameters;
  using Complex = std::complex<double>;
  using Column = std::array<Complex, kColumns>;  ///< as model::SlipPart::terms

  /// What a pole shows, with its derivatives.
  struct Response {
    Column shown{};
    Complex d_log_omega = 0.0;
  };
  /// A pole of the filter and, if it is complex, its conjugate: y' = kappa (z - y), of which the filter shows the real
  /// part of share * y. docs/model.md section 7
  struct Pole {
    Complex kappa;  ///< in units of w_n
    Complex share;  ///< contains the factor 2 of a pair; the real parts of all add up to 1
  };
  /// A pole, and what it shows at the start of each part and at the end of the slip.
  struct Channel {
    Pole pole;
    std::vector<Response> begin;
  };

  static std::vector<Pole> butterworth_poles(std::size_t order, double delay_tau);
  static Column column_of(const MotionPoint& point) {
    return {point.z, point.d_z0, point.d_zeta, point.d_law[0], point.d_law[1]};
  }
  static Response response(const Complex& kappa, const model::SlipPart& part, const Response& begin, double time);
  [[nodiscard]] Response at(const Channel& channel, const MotionPoint& motion, double tau) const;
  /// Adds what a pole shows, times a weight.
  static void add(const Complex& weight, const Response& response, ShownPoint& sum);

  double tau_end_;
  double delay_tau_;
  double memory_delay_tau_ = 0.0;
  std::vector<model::SlipPart> parts_;
  std::vector<Channel> channels_;
};

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
