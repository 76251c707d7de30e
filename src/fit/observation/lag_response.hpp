#pragma once

#include <array>
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

/// A cycle as a sensor of first order shows it: y' + kappa (y - z) = 0 with kappa = 1 / (w_n T). In each part of the
/// slip z is a polynomial, of which the response is known in closed form, whatever the law of friction; the stick
/// before counts as long enough for the slip before it to be forgotten. docs/model.md section 7
class LagResponse {
 public:
  /// `shown`: by the sensor at tau = 0. `parts`: of all that is not straight from there on, in their order.
  LagResponse(const MotionPoint& shown, const std::vector<model::SlipPart>& parts, double lag_tau);

  [[nodiscard]] double lag_tau() const { return 1.0 / kappa_; }
  /// The force that the sensor shows at a tau above 0. `motion`: z there.
  [[nodiscard]] ShownPoint at(const MotionPoint& motion, double tau) const;

 private:
  static constexpr std::size_t kColumns = 1 + model::kScaledParameters;
  using Column = std::array<double, kColumns>;  ///< as model::SlipPart::terms

  /// Holds the force that the sensor shows, with its derivatives.
  struct Response {
    Column shown{};
    double d_log_omega = 0.0;
  };
  /// A part of the slip, and what the sensor shows at its begin.
  struct Piece {
    model::SlipPart motion;
    Response begin;
  };

  static Column column_of(const MotionPoint& point) {
    return {point.z, point.d_z0, point.d_zeta, point.d_law[0], point.d_law[1]};
  }
  [[nodiscard]] Response response(const Piece& piece, double time) const;
  [[nodiscard]] Response after_slip(const Column& motion, double tau) const;

  double tau_end_;
  double kappa_;
  std::vector<Piece> pieces_;  ///< of the slip
  Response end_;               ///< at the end of the slip
};

}  // namespace slipfit::fit
