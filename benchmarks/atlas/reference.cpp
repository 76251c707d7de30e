#include <algorithm>
#include <array>
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "forward_methods.hpp"

namespace atlas {
namespace {

namespace odeint = boost::numeric::odeint;
using Real = long double;
using State = std::array<Real, 2>;  // z, z'

struct Node {
  Real tau = 0;
  State state{};
};

class Slip {
 public:
  explicit Slip(const ForwardScene& scene) : scene_(scene) { integrate(); }

  [[nodiscard]] bool resticks() const { return resticks_; }
  [[nodiscard]] const Node& end() const { return nodes_.back(); }
  [[nodiscard]] Real onset() const { return Real(scene_.lambda) - 2 * Real(scene_.zeta); }

  [[nodiscard]] State at(Real tau) const {
    const auto next = std::upper_bound(nodes_.begin(), nodes_.end() - 1, tau,
                                       [](Real time, const Node& node) { return time < node.tau; });
    const Node& from = next == nodes_.begin() ? *next : *(next - 1);
    return step(from, tau - from.tau).state;
  }
  /// First fall of z through 0.
  [[nodiscard]] Real fall() const {
    std::size_t i = 1;
    while (nodes_[i].state[0] > 0) ++i;
    return nodes_[i - 1].tau + bisect(nodes_[i - 1], nodes_[i], [](const State& s) { return s[0] > 0; });
  }

 private:
  [[nodiscard]] Real curvature(const State& s) const {
    return -s[0] - 2 * Real(scene_.zeta) * s[1] + friction_above<Real>(scene_, 1 - s[1]);
  }
  [[nodiscard]] Node step(const Node& from, Real h) const {
    odeint::runge_kutta_fehlberg78<State, Real, State, Real, odeint::array_algebra> stepper;
    Node node = from;
    const auto system = [this](const State& x, State& dx, Real) { dx = {x[1], curvature(x)}; };
    stepper.do_step(system, node.state, node.tau, h);
    node.tau += h;
    return node;
  }
  /// Time after `from` up to which `holds` is true; it changes once before `to`.
  template <class Predicate>
  [[nodiscard]] Real bisect(const Node& from, const Node& to, const Predicate& holds) const {
    Real low = 0;
    Real high = to.tau - from.tau;
    for (int i = 0; i < 64; ++i) {
      const Real middle = (low + high) / 2;
      (holds(step(from, middle).state) ? low : high) = middle;
    }
    return high;
  }
  void integrate() {
    // The friction law bends over 1 / (|alpha V| lambda) at the least.
    const Real h = 0.04L / (1 + std::abs(Real(scene_.rate)) * Real(scene_.lambda));
    nodes_.push_back({0, {onset(), 1}});
    while (nodes_.back().tau < 12) {
      const Node from = nodes_.back();
      const Node to = step(from, h);
      const bool turns = curvature(from.state) > 0 && curvature(to.state) <= 0;
      Node slowest = to;
      if (turns) slowest = step(from, bisect(from, to, [this](const State& s) { return curvature(s) > 0; }));
      resticks_ = nodes_.size() > 1 && slowest.state[1] >= 1;
      if (resticks_) {
        nodes_.push_back(step(from, bisect(from, slowest, [](const State& s) { return s[1] < 1; })));
        return;
      }
      nodes_.push_back(to);
      if (turns || !std::isfinite(to.state[0])) return;
    }
  }

  ForwardScene scene_;
  std::vector<Node> nodes_;
  bool resticks_ = false;
};

}  // namespace

Reference solve_reference(const ForwardScene& scene, std::size_t samples) {
  const Slip slip(scene);
  if (!slip.resticks()) return {{Outcome::NoCycle, 0.0, {}}, {0.1, samples}};
  const Real period = slip.end().tau + slip.onset() - slip.end().state[0];
  Reference reference{{Outcome::Cycle, static_cast<double>(period), {}},
                      {static_cast<double>(period) / static_cast<double>(samples), samples}};
  const Real fall = slip.fall();
  for (std::size_t i = 0; i < samples; ++i) {
    Real tau = fall + Real(reference.times.step) * static_cast<Real>(i);
    if (tau >= period) tau -= period;
    const Real z = tau < slip.end().tau ? slip.at(tau)[0] : slip.end().state[0] + tau - slip.end().tau;
    reference.answer.z.push_back(static_cast<double>(z));
  }
  return reference;
}

}  // namespace atlas
