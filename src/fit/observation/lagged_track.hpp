#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "model/velocity_track.hpp"

namespace slipfit::fit {

/// What a sensor shows, with the derivative with respect to ln w_n at fixed tau (its times are fixed in seconds) and
/// with respect to the logarithm of the time over which it averages.
struct ShownPoint : model::TrackPoint {
  double d_log_omega = 0.0;
  double d_log_average = 0.0;
};

/// A cycle as a sensor of first order shows it: y' + kappa (y - z) = 0 with kappa = 1 / (w_n T), in the units of
/// model/velocity_track.hpp. In each part of the slip z is a polynomial, of which the response is known in
/// closed form; the stick before counts as long enough for the slip before it to be forgotten. docs/model.md section 7
class LaggedTrack {
 public:
  LaggedTrack(const model::VelocityTrack& track, bool transmitted, double lag_tau);

  [[nodiscard]] double lag_tau() const { return 1.0 / kappa_; }
  /// The force that the sensor shows at any tau.
  [[nodiscard]] ShownPoint at(const model::VelocityTrack& track, double tau) const;

 private:
  static constexpr std::size_t kColumns = 5;  ///< z and its derivatives with respect to z0, zeta, slope and rate
  using Column = std::array<double, kColumns>;

  /// What the sensor shows.
  struct Response {
    Column shown{};
    double d_log_omega = 0.0;
  };
  /// A part of the slip, and what the sensor shows at its begin.
  struct Piece {
    model::VelocityTrack::Part motion;
    Response begin;
  };

  [[nodiscard]] Column motion_at(const model::VelocityTrack& track, double tau) const;
  [[nodiscard]] Response response(const Piece& piece, double time) const;
  [[nodiscard]] Response after_slip(const model::VelocityTrack& track, double tau) const;

  bool transmitted_;
  double kappa_;
  std::vector<Piece> pieces_;  ///< of the slip
  Response end_;               ///< at the end of the slip
};

}  // namespace slipfit::fit
