#include "model/velocity_track.hpp"

#include <algorithm>
#include <cmath>

#include "model/velocity_slip.hpp"

namespace slipfit::model {
namespace {

using Node = StepNode<kSensitive>;

/// Quintic polynomials between two nodes at one time, through value, slope and curvature of both: of s with its
/// derivatives, where s' and s'' = -v' stand in the nodes.
class Quintic {
 public:
  Quintic(const Node& from, const Node& to, double tau) : from_(from), to_(to) {
    const double h = to.tau - from.tau;
    const double s = (tau - from.tau) / h;
    const double r = 1.0 - s;
    // Weights of value, slope and curvature at the far end; at the near end the same with s and r exchanged.
    const auto weights = [h](double x, double y) {
      const double x3 = x * x * x;
      return Weights{x3 * (1.0 + 3.0 * y + 6.0 * y * y), x3 * y * (1.0 + 3.0 * y) * h, 0.5 * x3 * y * y * h * h};
    };
    const auto slopes = [h](double x, double y) {
      const double x2 = x * x;
      return Weights{30.0 * x2 * y * y / h, x2 * (3.0 * y * (1.0 + 3.0 * y) - x * (1.0 + 6.0 * y)),
                     0.5 * x2 * y * (3.0 * y - 2.0 * x) * h};
    };
    near_ = weights(r, s);
    far_ = weights(s, r);
    near_slope_ = slopes(r, s);
    far_slope_ = slopes(s, r);
  }

  [[nodiscard]] double s() const { return value(0, kSpeed); }
  [[nodiscard]] double ds() const { return slope(0, kSpeed); }
  [[nodiscard]] double s_by(std::size_t p) const { return value(kFirstDs + p, kFirstDv + p); }
  [[nodiscard]] double ds_by(std::size_t p) const { return slope(kFirstDs + p, kFirstDv + p); }

 private:
  using Weights = std::array<double, 3>;

  /// `i`: of s; `j`: of the speed that belongs to it.
  [[nodiscard]] double value(std::size_t i, std::size_t j) const {
    return near_[0] * from_.x[i] + near_[1] * from_.dx[i] - near_[2] * from_.dx[j] + far_[0] * to_.x[i] -
           far_[1] * to_.dx[i] - far_[2] * to_.dx[j];
  }
  [[nodiscard]] double slope(std::size_t i, std::size_t j) const {
    return -near_slope_[0] * from_.x[i] - near_slope_[1] * from_.dx[i] + near_slope_[2] * from_.dx[j] +
           far_slope_[0] * to_.x[i] - far_slope_[1] * to_.dx[i] - far_slope_[2] * to_.dx[j];
  }

  const Node& from_;
  const Node& to_;
  Weights near_{}, far_{}, near_slope_{}, far_slope_{};
};

}  // namespace

std::optional<VelocityTrack> VelocityTrack::solve(double z0, double zeta, const ScaledLaw& law) {
  const bool finite = std::isfinite(z0) && std::isfinite(law.slope) && std::isfinite(law.rate);
  if (!finite || !(z0 + 2.0 * zeta > 0.0) || !(std::abs(zeta) < 1.0)) return std::nullopt;
  VelocityTrack track;
  track.slip_ = {z0 + 2.0 * zeta, zeta, law};
  track.nodes_.reserve(32);
  const auto keep = [&track](const SlipWalker<kSensitive>& walker) { track.nodes_.push_back(walker.from); };
  const SlipEnd<kSensitive> end = follow_slip<kSensitive>(track.slip_, kForFits, keep);
  if (end.outcome != SlipOutcome::Resticks && end.outcome != SlipOutcome::TurnsBack) return std::nullopt;
  track.nodes_.push_back(end.node);
  track.resticks_ = end.outcome == SlipOutcome::Resticks;
  track.finish();
  return track;
}

void VelocityTrack::finish() {
  const Node& end = nodes_.back();
  const std::array<double, kSensitive>& x = end.x;
  const std::array<double, kSensitive>& dx = end.dx;
  end_.tau = end.tau;
  end_.first = {dx[0], dx[kFirstDs], dx[kFirstDs + 1], dx[kFirstDs + 2], dx[kFirstDs + 3]};
  end_.second = {-dx[kSpeed], -dx[kFirstDv], -dx[kFirstDv + 1], -dx[kFirstDv + 2], -dx[kFirstDv + 3]};
  end_.third = -dx[0] + (2.0 * slip_.zeta + slip_.law.at(x[kSpeed]).d_speed) * dx[kSpeed];
  // A slip that sticks joins its ramp with equal slope (z' = 1): the moving end adds nothing to first order. One that
  // does not ends where z'' = 0, which moves with the parameters: the third derivative is -z' there.
  const double moves = resticks_ ? 0.0 : (end_.first.value - 1.0) / end_.first.value;
  const auto by = [&](std::size_t p) { return x[kFirstDs + p] - moves * dx[kFirstDv + p]; };
  after_ = {x[0] - 2.0 * slip_.zeta - end.tau, by(0), by(1) - 2.0, by(2), by(3)};
}

std::vector<double> VelocityTrack::knots() const {
  std::vector<double> times;
  times.reserve(nodes_.size());
  for (const Node& node : nodes_) times.push_back(node.tau);
  return times;
}

double VelocityTrack::fastest_tau() const {
  return std::ranges::max_element(nodes_, {}, [](const Node& node) { return node.x[kSpeed]; })->tau;
}

const VelocityTrack::Node* VelocityTrack::node_after(double tau) const {
  return &*std::lower_bound(nodes_.begin() + 1, nodes_.end() - 1, tau,
                            [](const Node& node, double time) { return node.tau < time; });
}

TrackPoint VelocityTrack::inside(double tau) const {
  const Node* const to = node_after(tau);
  const Quintic at(*(to - 1), *to, tau);
  return {at.s() - 2.0 * slip_.zeta, at.ds(), at.s_by(0), at.s_by(1) - 2.0, at.s_by(2), at.s_by(3)};
}

/// z' and its derivatives.
TrackPoint VelocityTrack::slope_inside(double tau) const {
  const Node* const to = node_after(tau);
  const Quintic at(*(to - 1), *to, tau);
  const double v = 1.0 - at.ds();
  const double second = 2.0 * slip_.zeta * v + slip_.law.at(v).value - at.s();
  return {at.ds(), second, at.ds_by(0), at.ds_by(1), at.ds_by(2), at.ds_by(3)};
}

TrackPoint VelocityTrack::at(double tau) const {
  if (tau <= 0.0) return {slip_.lambda - 2.0 * slip_.zeta + tau, 1.0, 1.0, 0.0, 0.0, 0.0};
  if (tau <= end_.tau) return inside(tau);
  return {after_.value + tau, 1.0, after_.d_z0, after_.d_zeta, after_.d_slope, after_.d_rate};
}

TrackPoint VelocityTrack::transmitted_at(double tau) const {
  TrackPoint point = at(tau);
  const bool slips = tau > 0.0 && tau <= end_.tau;
  const TrackPoint slope = slips ? slope_inside(tau) : TrackPoint{1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const double drag = 2.0 * slip_.zeta;
  point.z += drag * slope.z;
  point.d_tau += drag * slope.d_tau;
  point.d_z0 += drag * slope.d_z0;
  point.d_zeta += drag * slope.d_zeta + 2.0 * slope.z;
  point.d_slope += drag * slope.d_slope;
  point.d_rate += drag * slope.d_rate;
  return point;
}

}  // namespace slipfit::model
