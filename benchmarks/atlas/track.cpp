#include "track.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {

void Track::add(const Node& node) {
  if (falls_.size() == 1) stuck_between_ = stuck_between_ || node.stuck;
  if (!nodes_.empty() && nodes_.back().z > 0.0 && node.z <= 0.0) {
    if (falls_.empty()) first_fall_node_ = nodes_.size() - 1;
    falls_.push_back(fall_between(nodes_.back(), node));
  }
  nodes_.push_back(node);
}

double Track::wanted_end() const {
  return falls_.front() + times_.step * static_cast<double>(times_.count);
}

bool Track::finished() const {
  if (nodes_.size() > kMostNodes || (!nodes_.empty() && !std::isfinite(nodes_.back().z))) return true;
  return falls_.size() > 1 && nodes_.back().tau >= wanted_end();
}

Answer Track::answer() const {
  if (falls_.size() < 2 || nodes_.back().tau < wanted_end()) return {};
  if (!stuck_between_) return {Outcome::NoCycle, 0.0, {}};
  Answer answer{Outcome::Cycle, falls_[1] - falls_[0], {}};
  answer.z.reserve(times_.count);
  std::size_t node = first_fall_node_;
  for (std::size_t i = 0; i < times_.count; ++i) {
    const double tau = falls_[0] + times_.step * static_cast<double>(i);
    while (nodes_[node + 1].tau < tau) ++node;
    answer.z.push_back(between(nodes_[node], nodes_[node + 1], tau));
  }
  return answer;
}

double Track::between(const Node& from, const Node& to, double tau) {
  const double h = to.tau - from.tau;
  if (!(h > 0.0)) return to.z;
  const double s = (tau - from.tau) / h;
  const double r = 1.0 - s;
  return r * r * ((1.0 + 2.0 * s) * from.z + s * h * from.dz) + s * s * ((1.0 + 2.0 * r) * to.z - r * h * to.dz);
}

double Track::fall_between(const Node& from, const Node& to) {
  constexpr int kSecantSteps = 6;
  double low = from.tau, high = to.tau;
  double z_low = from.z, z_high = to.z;
  for (int i = 0; i < kSecantSteps && z_low != z_high; ++i) {
    const double tau = std::clamp(low - z_low * (high - low) / (z_high - z_low), from.tau, to.tau);
    low = high;
    z_low = z_high;
    high = tau;
    z_high = between(from, to, tau);
  }
  return high;
}

}  // namespace atlas
