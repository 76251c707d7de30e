#include "fit/inference/misfit.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace slipfit::fit {
namespace {

constexpr double kMargin = 0.15;  // of the slip, on either side
constexpr double kSigmas = 4.5;
constexpr double kMatters = 0.01;
constexpr std::size_t kFewCycles = 5;

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

using Means = std::array<std::optional<double>, kPhases>;

/// Mean residual of one cycle in every stretch, unit of force.
Means means_of(const BlockFit& fit, std::size_t cycle) {
  const CycleModel& model = fit.model(cycle);
  std::vector<double> residuals(model.residuals());
  model.evaluate(fit.values(cycle), residuals.data(), nullptr);
  std::array<Stack, kPhases> stacks;
  const CycleState state = fit.state(cycle);
  const CycleData& data = fit.data(cycle);
  for (std::size_t j = 0; j < data.time_s.size(); ++j) {
    const std::optional<std::size_t> phase = phase_of(state, data.time_s[j]);
    const double weight = data.weight.empty() ? 1.0 : data.weight[j];
    if (phase && weight > 0.0) stacks[*phase].add(residuals[j] * fit.scales().noise / weight);
  }
  Means means;
  for (std::size_t p = 0; p < kPhases; ++p) {
    if (stacks[p].count > 0.0) means[p] = stacks[p].mean;
  }
  return means;
}

}  // namespace

std::optional<std::size_t> phase_of(const CycleState& state, double time_s) {
  const double share = (time_s - state.onset_s) / state.slip_s();
  const double place = (share + kMargin) / (1.0 + 2.0 * kMargin) * kPhases;
  return place >= 0.0 && place < kPhases ? std::optional(static_cast<std::size_t>(place)) : std::nullopt;
}

std::optional<PhaseMisfit> find_misfit(const BlockFit& fit, double tolerated) {
  std::array<Stack, kPhases> stacks;
  double onset_force = 0.0;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    onset_force += fit.state(i).onset_force / static_cast<double>(fit.size());
    const Means means = means_of(fit, i);
    for (std::size_t p = 0; p < kPhases; ++p) {
      if (means[p]) stacks[p].add(*means[p]);
    }
  }
  std::optional<PhaseMisfit> worst;
  for (std::size_t p = 0; p < kPhases; ++p) {
    const Stack& stack = stacks[p];
    if (stack.count < kFewCycles) continue;
    const double size = std::abs(stack.mean);
    if (size < kSigmas * stack.standard_error() || size < kMatters * std::abs(onset_force) + tolerated) continue;
    if (worst && size <= std::abs(worst->size * onset_force)) continue;
    const double phase = (static_cast<double>(p) + 0.5) / kPhases * (1.0 + 2.0 * kMargin) - kMargin;
    worst = PhaseMisfit{phase, stack.mean / onset_force};
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
