#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "model/slip_series.hpp"

namespace slipfit::fit {

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
  /// A pole, and what it shows at the begin of each part and at the end of the slip.
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

}  // namespace slipfit::fit
