#include "bent_trace.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {

std::vector<double> BentTrace::force_N(double begin_s, double step_s, std::size_t count) const {
  const double half_s = 0.5 * bends_.average_s;
  const std::vector<Node> nodes = nodes_until(begin_s + step_s * static_cast<double>(count) + half_s);
  std::vector<double> force_N;
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = begin_s + step_s * static_cast<double>(i);
    const Node from = between(nodes, time_s - half_s), to = between(nodes, time_s + half_s);
    force_N.push_back(half_s > 0.0 ? (to.integral_Ns - from.integral_Ns) / bends_.average_s : to.force_N);
  }
  return force_N;
}

std::vector<BentTrace::Node> BentTrace::nodes_until(double end_s) const {
  const double rate_N_per_s = slider_.stiffness_N_per_m() * speed_m_per_s_;
  // The damper adds c V to the spring while it sticks.
  const double onset_N = friction_.static_N() - slider_.damping_N_s_per_m() * speed_m_per_s_;
  std::vector<Node> nodes{{}};
  while (nodes.back().time_s < end_s) {
    add(nodes, nodes.back().time_s + (onset_N - nodes.back().force_N) / rate_N_per_s, onset_N);
    slide(nodes);
  }
  return nodes;
}

void BentTrace::slide(std::vector<Node>& nodes) const {
  const double step_s = 1e-3 / slider_.natural_frequency_rad_per_s();
  constexpr double kNudge = 1e-9;  // of the driving speed: sets it in motion
  State state{nodes.back().force_N, kNudge * speed_m_per_s_, 0.0};
  while (true) {
    const State next = stepped(state, step_s);
    if (next.speed_m_per_s > 0.0) {
      add(nodes, nodes.back().time_s + step_s, next.force_N);
      state = next;
      continue;
    }
    const double share = state.speed_m_per_s / (state.speed_m_per_s - next.speed_m_per_s);
    add(nodes, nodes.back().time_s + share * step_s, state.force_N + share * (next.force_N - state.force_N));
    return;
  }
}

BentTrace::State BentTrace::slope(const State& at) const {
  const double left = bends_.slip_distance_m > 0.0 ? std::max(0.0, 1.0 - at.slipped_m / bends_.slip_distance_m) : 0.0;
  const double friction_N = friction_.kinetic_N() + left * friction_.difference_N();
  const double omega = slider_.natural_frequency_rad_per_s();
  const double stiffness = slider_.stiffness_N_per_m();
  const double lag_m_per_s = speed_m_per_s_ - at.speed_m_per_s;
  const double driving_N = at.force_N + slider_.damping_N_s_per_m() * lag_m_per_s;
  return {stiffness * lag_m_per_s, omega * omega / stiffness * (driving_N - friction_N), at.speed_m_per_s};
}

BentTrace::State BentTrace::stepped(const State& from, double step_s) const {
  const auto moved = [&](const State& by, double share_s) {
    return State{from.force_N + share_s * by.force_N, from.speed_m_per_s + share_s * by.speed_m_per_s,
                 from.slipped_m + share_s * by.slipped_m};
  };
  const State a = slope(from);
  const State b = slope(moved(a, 0.5 * step_s));
  const State c = slope(moved(b, 0.5 * step_s));
  const State d = slope(moved(c, step_s));
  const auto mean = [](double p, double q, double r, double s) { return (p + 2.0 * q + 2.0 * r + s) / 6.0; };
  return moved({mean(a.force_N, b.force_N, c.force_N, d.force_N),
                mean(a.speed_m_per_s, b.speed_m_per_s, c.speed_m_per_s, d.speed_m_per_s),
                mean(a.slipped_m, b.slipped_m, c.slipped_m, d.slipped_m)},
               step_s);
}

void BentTrace::add(std::vector<Node>& nodes, double time_s, double force_N) {
  const Node& last = nodes.back();
  const double area_Ns = 0.5 * (time_s - last.time_s) * (last.force_N + force_N);
  nodes.push_back({time_s, force_N, last.integral_Ns + area_Ns});
}

BentTrace::Node BentTrace::between(const std::vector<Node>& nodes, double time_s) {
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), time_s,
                                      [](double at_s, const Node& node) { return at_s < node.time_s; });
  if (after == nodes.begin()) return nodes.front();
  if (after == nodes.end()) return nodes.back();
  const Node& last = *(after - 1);
  const double share = (time_s - last.time_s) / (after->time_s - last.time_s);
  const double force_N = last.force_N + share * (after->force_N - last.force_N);
  return {time_s, force_N, last.integral_Ns + 0.5 * (time_s - last.time_s) * (last.force_N + force_N)};
}

}  // namespace atlas
