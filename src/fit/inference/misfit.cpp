#include "fit/inference/misfit.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/student.hpp"
#include "fit/cycle/side_by_side.hpp"

namespace slipfit::fit {
namespace {

constexpr double kMargin = 0.15;  // of the slip, on either side

struct Stack {
  double count = 0.0, mean = 0.0, square = 0.0;

  void add(double value) {
    count += 1.0;
    const double step = value - mean;
    mean += step / count;
    square += step * (value - mean);
  }
  [[nodiscard]] double standard_error() const { return std::sqrt(square / (count - 1.0) / count); }
};

using Means = std::array<std::optional<double>, kSegments>;

/// Mean residual of one cycle in every stretch of a slip, unit of force.
Means means_of(const BlockFit& fit, std::size_t cycle, const CycleState& slip) {
  const CycleModel& model = fit.model(cycle);
  std::vector<double> residuals(model.residuals());
  model.evaluate(fit.values(cycle), residuals.data(), nullptr);
  std::array<Stack, kSegments> stacks;
  const CycleData& data = fit.data(cycle);
  for (std::size_t j = 0; j < data.time_s.size(); ++j) {
    const std::optional<std::size_t> segment = segment_of(slip, data.time_s[j]);
    const double weight = data.weight.empty() ? 1.0 : data.weight[j];
    if (segment && weight > 0.0) stacks[*segment].add(residuals[j] * fit.scales().noise / weight);
  }
  Means means;
  for (std::size_t p = 0; p < kSegments; ++p) {
    if (stacks[p].count > 0.0) means[p] = stacks[p].mean;
  }
  return means;
}

/// The means of all cycles, and the mean onset force of their slips.
struct StackedCycles {
  std::array<Stack, kSegments> stacks;
  double onset_force = 0.0;
};

/// Over the slips of `phases`, a fit of the same recording.
StackedCycles stacked(const BlockFit& fit, const BlockFit& phases) {
  std::vector<std::optional<std::size_t>> same(fit.size());
  for (std::size_t i = 0, next = 0; i < fit.size(); ++i) {
    while (next < phases.size() && phases.data(next).slip < fit.data(i).slip) ++next;
    if (next < phases.size() && phases.data(next).slip == fit.data(i).slip) same[i] = next;
  }
  std::vector<Means> means(fit.size());
  std::vector<double> onset_forces(fit.size());
  for_cycles(fit.size(), fit.residuals(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!same[i]) continue;
      const CycleState slip = phases.state(*same[i]);
      onset_forces[i] = slip.onset_force;
      means[i] = means_of(fit, i, slip);
    }
  });
  StackedCycles result;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    if (same[i]) result.onset_force += onset_forces[i] / static_cast<double>(fit.size());
    for (std::size_t p = 0; p < kSegments; ++p) {
      if (means[i][p]) result.stacks[p].add(*means[i][p]);
    }
  }
  return result;
}

}  // namespace

StackedResidual stacked_residual(const BlockFit& fit, const BlockFit& phases) {
  const auto [stacks, onset_force] = stacked(fit, phases);
  double square = 0.0;
  double variance = 0.0;
  for (const Stack& stack : stacks) {
    square += stack.mean * stack.mean / kSegments;
    if (stack.count > 1.0) variance += std::pow(stack.standard_error(), 2) / kSegments;
  }
  return {std::sqrt(square) / std::abs(onset_force), std::sqrt(variance) / std::abs(onset_force)};
}

std::optional<std::size_t> segment_of(const CycleState& state, double time_s) {
  const double share = (time_s - state.onset_s) / state.slip_s();
  const double place = (share + kMargin) / (1.0 + 2.0 * kMargin) * kSegments;
  return place >= 0.0 && place < kSegments ? std::optional(static_cast<std::size_t>(place)) : std::nullopt;
}

std::optional<SegmentMisfit> find_misfit(const BlockFit& fit, double tolerated) {
  const auto [stacks, onset_force] = stacked(fit, fit);
  std::optional<SegmentMisfit> worst;
  for (std::size_t p = 0; p < kSegments; ++p) {
    const Stack& stack = stacks[p];
    if (stack.count < thresholds::kFewestCycles) continue;
    const double size = std::abs(stack.mean);
    if (size < thresholds::kOfManySigmas * stack.standard_error() ||
        size < thresholds::kNegligible * std::abs(onset_force) + tolerated)
      continue;
    if (worst && size <= std::abs(worst->size * onset_force)) continue;
    const double position = (static_cast<double>(p) + 0.5) / kSegments * (1.0 + 2.0 * kMargin) - kMargin;
    const double chance = kSegments * t_chance(size / stack.standard_error(), stack.count - 1.0);
    worst = SegmentMisfit{position, stack.mean / onset_force, chance};
  }
  return worst;
}

Uncertainty with_misfit(Uncertainty uncertainty, const Moves& moves) {
  const auto count = static_cast<double>(moves.rows());
  uncertainty.from_refits = true;
  uncertainty.covariance += (count - 1.0) / count * moves.transpose() * moves;
  return uncertainty;
}

}  // namespace slipfit::fit
