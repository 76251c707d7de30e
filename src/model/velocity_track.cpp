#include "model/velocity_track.hpp"

#include <algorithm>
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <functional>

namespace slipfit::model {
namespace {

namespace odeint = boost::numeric::odeint;

/// A trial step may overshoot. Beyond this the exponential is cut off.
constexpr double kLargestExponent = 300.0;

/// Friction above F_k(0+) and its derivatives: slope * (exp(rate v) - 1) / rate.
struct TrackFriction {
  double value = 0.0, d_speed = 0.0, d_slope = 0.0, d_rate = 0.0;
};

TrackFriction friction_at(double v, double slope, double rate) {
  const double x = std::min(rate * v, kLargestExponent);
  if (std::abs(x) < 1e-4) {  // series to x^2
    const double d_slope = v * (1.0 + x * (0.5 + x / 6.0));
    return {slope * d_slope, slope * (1.0 + x * (1.0 + 0.5 * x)), d_slope, slope * v * v * (0.5 + x / 3.0)};
  }
  const double growth = std::expm1(x);
  const double d_slope = growth / rate;
  return {slope * d_slope, slope * (growth + 1.0), d_slope, slope * (v * (growth + 1.0) - d_slope) / rate};
}

/// Latest time of [low, high] at which `holds` is still true; it is at low and ends once.
template <class Predicate>
double last_time(double low, double high, const Predicate& holds) {
  constexpr int kHalvings = 45;  // 0.5 / 2^45 is round-off of tau
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return high;
}

}  // namespace

/// State: z and its four derivatives, then the same of z'.
class VelocityTrack::Integrator {
 public:
  using State = std::array<double, 2 * kRows>;

  Integrator(double z0, double zeta, double slope, double rate) : zeta_(zeta), slope_(slope), rate_(rate) {
    state_ = {z0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0};
    size_ = 1.0 + std::abs(z0);
    step_ = 0.1 / (1.0 + std::abs(rate) * size_);
  }

  void operator()(const State& x, State& dx, double /*tau*/) const {
    const TrackFriction friction = friction_at(1.0 - x[kRows], slope_, rate_);
    for (std::size_t i = 0; i < kRows; ++i) dx[i] = x[kRows + i];
    dx[kRows] = -x[0] - 2.0 * zeta_ * x[kRows] + friction.value;
    const double damping = 2.0 * zeta_ + friction.d_speed;
    const std::array<double, kRows> direct{0.0, 0.0, -2.0 * x[kRows], friction.d_slope, friction.d_rate};
    for (std::size_t i = 1; i < kRows; ++i) dx[kRows + i] = -x[i] - damping * x[kRows + i] + direct[i];
  }

  [[nodiscard]] double third_derivative(const Node& node) const {
    const TrackFriction friction = friction_at(1.0 - node.first[0], slope_, rate_);
    return -node.first[0] - (2.0 * zeta_ + friction.d_speed) * node.second[0];
  }

  [[nodiscard]] Node node() const { return node_of(state_, tau_); }

  /// Between two nodes.
  [[nodiscard]] Node node_at(const Node& from, const Node& to, double tau) const {
    const Quintic quintic(from, to, tau);
    State state;
    for (std::size_t i = 0; i < kRows; ++i) {
      state[i] = quintic.value(from, to, i);
      state[kRows + i] = quintic.slope(from, to, i);
    }
    return node_of(state, tau);
  }

  /// False where the motion runs away or needs steps without end.
  bool advance() {
    constexpr int kMaxRejections = 40;
    for (int attempt = 0; attempt < kMaxRejections; ++attempt) {
      // Dense output by quintic polynomials is good to 4e-7 of the motion at this length.
      step_ = std::min({step_, 0.5, longest_step()});
      const State before = state_;
      const double start = tau_;
      const auto result = stepper_.try_step(std::cref(*this), state_, tau_, step_);
      if (result != odeint::success) continue;
      // Not far past rest, where the friction's exponential soars and spoils the polynomial of the step; and not onto
      // its cut-off, a plateau that looks exact to the error control.
      const double speed = 1.0 - state_[kRows];
      if (rate_ * speed < (speed < 0.0 ? 1.0 : kLargestExponent)) {
        return std::abs(state_[0]) + std::abs(state_[kRows]) < 1e4 * size_;
      }
      step_ = 0.2 * (tau_ - start);
      state_ = before;
      tau_ = start;
    }
    return false;
  }

 private:
  /// longest_slip_step of velocity_slip.hpp. There is its reason.
  [[nodiscard]] double longest_step() const {
    State derivative;
    (*this)(state_, derivative, tau_);
    const double acceleration = -derivative[kRows];
    if (rate_ >= 0.0 || acceleration >= 0.0) return 0.5;
    return (0.5 * (1.0 - state_[kRows]) - 1.0 / rate_) / -acceleration;
  }

  [[nodiscard]] Node node_of(const State& state, double tau) const {
    State derivative;
    (*this)(state, derivative, tau);
    Node node;
    node.tau = tau;
    std::copy_n(state.begin(), kRows, node.value.begin());
    std::copy_n(derivative.begin(), kRows, node.first.begin());
    std::copy_n(derivative.begin() + kRows, kRows, node.second.begin());
    return node;
  }

  using Fehlberg = odeint::runge_kutta_fehlberg78<State, double, State, double, odeint::array_algebra>;

  double zeta_, slope_, rate_;
  State state_{};
  double size_ = 1.0;
  double tau_ = 0.0;
  double step_ = 0.0;
  odeint::controlled_runge_kutta<Fehlberg> stepper_{
      odeint::default_error_checker<double, odeint::array_algebra, odeint::default_operations>(1e-9, 1e-9)};
};

std::optional<VelocityTrack> VelocityTrack::solve(double z0, double zeta, double slope, double rate) {
  const bool finite = std::isfinite(z0) && std::isfinite(slope) && std::isfinite(rate);
  if (!finite || !(z0 + 2.0 * zeta > 0.0) || !(std::abs(zeta) < 1.0)) return std::nullopt;
  VelocityTrack track;
  track.z0_ = z0;
  track.zeta_ = zeta;
  track.slope_ = slope;
  track.rate_ = rate;
  Integrator integrator(z0, zeta, slope, rate);
  track.nodes_.reserve(32);
  track.nodes_.push_back(integrator.node());
  bool slows_down = false;
  constexpr int kMaxSteps = 4000;  // an ordinary slip needs 8 to 30
  for (int step = 0; step < kMaxSteps; ++step) {
    if (!integrator.advance()) return std::nullopt;
    track.nodes_.push_back(integrator.node());
    const Node& from = track.nodes_[track.nodes_.size() - 2];
    const Node& to = track.nodes_.back();
    if (std::abs(to.first[0]) + std::abs(to.second[0]) < 1e-6) return std::nullopt;  // slides steadily, without a turn
    // Only what falls below the driving speed can stick or turn back, docs/model.md (16).
    slows_down = slows_down || (from.first[0] < 0.0 && to.first[0] >= 0.0);
    if (!slows_down) continue;
    // z' is largest, the sliding speed smallest, where z'' passes 0 from above: perhaps at rest inside the step only.
    const bool turns = from.second[0] > 0.0 && to.second[0] <= 0.0;
    const auto speed_falls = [&](double tau) { return integrator.node_at(from, to, tau).second[0] > 0.0; };
    const double slowest = turns ? last_time(from.tau, to.tau, speed_falls) : to.tau;
    const auto slides = [&](double tau) { return Quintic(from, to, tau).slope(from, to, 0) < 1.0; };
    const bool comes_to_rest = !slides(slowest);
    if (!comes_to_rest && !turns) continue;
    const double tau_end = comes_to_rest ? last_time(from.tau, slowest, slides) : slowest;
    const Node end = integrator.node_at(from, to, tau_end);
    track.finish(end, integrator.third_derivative(end), comes_to_rest);
    if (!std::isfinite(track.after_.intercept)) return std::nullopt;  // ran away within the step
    return track;
  }
  return std::nullopt;
}

void VelocityTrack::finish(const Node& end, double third, bool resticks) {
  tau_end_ = end.tau;
  const auto value = [](const Row& row) { return TrackValue{row[0], row[1], row[2], row[3], row[4]}; };
  end_ = {end.tau, value(end.first), value(end.second), third};
  resticks_ = resticks;
  Row row = end.value;
  if (!resticks) {
    // The slip ends where z'' = 0, which moves with the parameters: the third derivative is -z' there.
    for (std::size_t i = 1; i < kRows; ++i) row[i] += (end.first[0] - 1.0) * end.second[i] / end.first[0];
  }
  // A slip that sticks joins its ramp with equal slope (z' = 1): the moving end adds nothing to first order.
  after_ = {row[0] - tau_end_, row[1], row[2], row[3], row[4]};
}

VelocityTrack::Quintic::Quintic(const Node& from, const Node& to, double tau) {
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

double VelocityTrack::Quintic::value(const Node& from, const Node& to, std::size_t i) const {
  return near_[0] * from.value[i] + near_[1] * from.first[i] + near_[2] * from.second[i] + far_[0] * to.value[i] -
         far_[1] * to.first[i] + far_[2] * to.second[i];
}

double VelocityTrack::Quintic::slope(const Node& from, const Node& to, std::size_t i) const {
  return -near_slope_[0] * from.value[i] - near_slope_[1] * from.first[i] - near_slope_[2] * from.second[i] +
         far_slope_[0] * to.value[i] - far_slope_[1] * to.first[i] + far_slope_[2] * to.second[i];
}

TrackPoint VelocityTrack::inside(double tau) const {
  const auto to = node_after(tau);
  const Node& from = *(to - 1);
  const Quintic quintic(from, *to, tau);
  return {quintic.value(from, *to, 0), quintic.slope(from, *to, 0), quintic.value(from, *to, 1),
          quintic.value(from, *to, 2), quintic.value(from, *to, 3), quintic.value(from, *to, 4)};
}

/// z' and its derivatives.
TrackPoint VelocityTrack::slope_inside(double tau) const {
  const auto to = node_after(tau);
  const Node& from = *(to - 1);
  const Quintic quintic(from, *to, tau);
  const double first = quintic.slope(from, *to, 0);
  const double second =
      -quintic.value(from, *to, 0) - 2.0 * zeta_ * first + friction_at(1.0 - first, slope_, rate_).value;
  return {first,
          second,
          quintic.slope(from, *to, 1),
          quintic.slope(from, *to, 2),
          quintic.slope(from, *to, 3),
          quintic.slope(from, *to, 4)};
}

std::vector<VelocityTrack::Node>::const_iterator VelocityTrack::node_after(double tau) const {
  return std::lower_bound(nodes_.begin() + 1, nodes_.end() - 1, tau,
                          [](const Node& node, double time) { return node.tau < time; });
}

TrackPoint VelocityTrack::at(double tau) const {
  if (tau <= 0.0) return {z0_ + tau, 1.0, 1.0, 0.0, 0.0, 0.0};
  if (tau <= tau_end_) return inside(tau);
  return {after_.intercept + tau, 1.0, after_.d_z0, after_.d_zeta, after_.d_slope, after_.d_rate};
}

TrackPoint VelocityTrack::transmitted_at(double tau) const {
  TrackPoint point = at(tau);
  const bool slips = tau > 0.0 && tau <= tau_end_;
  const TrackPoint slope = slips ? slope_inside(tau) : TrackPoint{1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const double drag = 2.0 * zeta_;
  point.z += drag * slope.z;
  point.d_tau += drag * slope.d_tau;
  point.d_z0 += drag * slope.d_z0;
  point.d_zeta += drag * slope.d_zeta + 2.0 * slope.z;
  point.d_slope += drag * slope.d_slope;
  point.d_rate += drag * slope.d_rate;
  return point;
}

}  // namespace slipfit::model
