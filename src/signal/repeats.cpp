#include "signal/defects.hpp"

#include <algorithm>
#include <cmath>

#include "core/thresholds.hpp"
#include "signal/robust.hpp"

namespace slipfit::signal {
namespace {

/// Many neighbours are equal: worth a closer look, which most recordings are spared.
bool often_repeats(std::span<const double> force) {
  std::size_t equal = 0;
  for (std::size_t i = 1; i < force.size(); ++i) equal += force[i] == force[i - 1] ? 1U : 0U;
  const auto runs = static_cast<double>(force.size() - equal);
  return static_cast<double>(force.size()) > thresholds::kShortestRepeat * runs;
}

/// The number of changes between runs of equal values, and the shortest run.
struct Changes {
  double usual = 0.0;
  double smallest = 0.0;
};

Changes changes_between(std::span<const double> force, const std::vector<std::size_t>& first) {
  std::vector<double> sizes;
  for (std::size_t run = 1; run < first.size(); ++run) {
    sizes.push_back(std::abs(force[first[run]] - force[first[run - 1]]));
  }
  const double smallest = sizes.empty() ? 0.0 : *std::ranges::min_element(sizes);
  return {median(std::move(sizes)), smallest};
}

}  // namespace

std::vector<std::size_t> first_of_repeats(std::span<const double> force) {
  constexpr std::size_t kFewestRuns = 20;
  if (force.empty() || !often_repeats(force)) return {};
  std::vector<std::size_t> first{0};
  for (std::size_t i = 1; i < force.size(); ++i) {
    if (force[i] != force[i - 1]) first.push_back(i);
  }
  if (first.size() < kFewestRuns) return {};
  const Changes changes = changes_between(force, first);
  return changes.usual < thresholds::kRoundingSteps * changes.smallest ? std::vector<std::size_t>{} : first;
}

}  // namespace slipfit::signal
