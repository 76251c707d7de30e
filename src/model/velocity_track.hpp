#pragma once

#include <array>
#include <optional>
#include <vector>

namespace slipfit::model {

/// Spring force above F_k(0+) in units of k V / w_n with its derivatives at fixed tau: WavePoint (slip.hpp) with two
/// derivatives more.
struct TrackPoint {
  double z = 0.0, d_tau = 0.0, d_z0 = 0.0, d_zeta = 0.0, d_slope = 0.0, d_rate = 0.0;
};

/// The straight line z = intercept + tau that follows the slip; derivatives of the intercept.
struct TrackLine {
  double intercept = 0.0, d_z0 = 0.0, d_zeta = 0.0, d_slope = 0.0, d_rate = 0.0;
};

/// A value and its derivatives at fixed tau.
struct TrackValue {
  double value = 0.0, d_z0 = 0.0, d_zeta = 0.0, d_slope = 0.0, d_rate = 0.0;
};

/// Where the slip ends: z' = 1 where it sticks again, else z'' = 0.
struct TrackEnd {
  double tau = 0.0;
  TrackValue first, second;  ///< z', z''
  double third = 0.0;        ///< z'''
};

/// One cycle with friction that depends on the sliding speed, for fits: dense output and derivatives to about 1e-7.
///   z'' + 2 zeta z' + z = slope (exp(rate v) - 1) / rate,  v = 1 - z',  z(0) = z0, z'(0) = 1
/// (docs/model.md section 5): slope = b w_n / k with b the slope of F_k(v) at v = 0, rate = alpha V. At rate 0 friction
/// is linear in the speed and adds slope / 2 to zeta. The slip ends where z' = 1 again or, where it does not stick, at
/// its smallest sliding speed, as Slip does.
class VelocityTrack {
 public:
  /// Empty where the slip has no start (z0 + 2 zeta <= 0), is not finite, or runs away.
  static std::optional<VelocityTrack> solve(double z0, double zeta, double slope, double rate);

  /// The whole cycle: tau < 0 is the stick before, tau > tau_end() the stick after.
  [[nodiscard]] TrackPoint at(double tau) const;
  /// What spring and damper carry together, z + 2 zeta z'.
  [[nodiscard]] TrackPoint transmitted_at(double tau) const;
  [[nodiscard]] bool resticks() const { return resticks_; }
  [[nodiscard]] double tau_end() const { return tau_end_; }
  [[nodiscard]] TrackLine after() const { return after_; }
  [[nodiscard]] const TrackEnd& end() const { return end_; }

 private:
  static constexpr std::size_t kRows = 5;  // z and its derivatives with respect to z0, zeta, slope, rate
  using Row = std::array<double, kRows>;

  /// Value, first and second derivative with respect to tau at the end of a step of the integration.
  struct Node {
    double tau = 0.0;
    Row value{}, first{}, second{};
  };

  /// Quintic polynomial between two nodes at one time: through value, slope and curvature of both.
  class Quintic {
   public:
    Quintic(const Node& from, const Node& to, double tau);
    [[nodiscard]] double value(const Node& from, const Node& to, std::size_t i) const;
    [[nodiscard]] double slope(const Node& from, const Node& to, std::size_t i) const;

   private:
    using Weights = std::array<double, 3>;
    Weights near_{}, far_{}, near_slope_{}, far_slope_{};
  };

  class Integrator;

  [[nodiscard]] std::vector<Node>::const_iterator node_after(double tau) const;
  [[nodiscard]] TrackPoint inside(double tau) const;
  [[nodiscard]] TrackPoint slope_inside(double tau) const;
  void finish(const Node& end, double third, bool resticks);

  double z0_ = 0.0, zeta_ = 0.0, slope_ = 0.0, rate_ = 0.0;
  double tau_end_ = 0.0;
  bool resticks_ = false;
  TrackLine after_;
  TrackEnd end_;
  std::vector<Node> nodes_;
};

}  // namespace slipfit::model
