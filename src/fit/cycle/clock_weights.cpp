#include "fit/cycle/clock_weights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace slipfit::fit {
namespace {

/// Returns the variance of the samples about straight sticks.
double stick_variance(const BlockFit& fit) {
  double scatter = 0.0;
  double freedom = 0.0;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    for (const auto* bins : {&fit.data(i).bins_before, &fit.data(i).bins_after}) {
      for (const StickBin& bin : *bins) {
        scatter += bin.scatter;
        freedom += std::max(0.0, bin.count - 2.0);
      }
    }
  }
  return freedom > 0.0 ? scatter / freedom : fit.scales().noise * fit.scales().noise;
}

struct Slopes {
  std::vector<double> residual;  ///< unit of force
  std::vector<double> slope;     ///< of the model, unit of force a second
};

/// Returns the residuals and slopes of the samples around one slip. The derivative with respect to the onset is minus
/// that of the force with respect to time.
Slopes slopes_of(const BlockFit& fit, std::size_t cycle) {
  const CycleModel& model = fit.model(cycle);
  std::vector<double> residuals(model.residuals());
  std::vector<double> jacobian(model.residuals() * model.columns().size());
  model.evaluate(fit.values(cycle), residuals.data(), jacobian.data());
  const std::size_t onset = model.columns().common();
  Slopes result;
  const CycleData& data = fit.data(cycle);
  for (std::size_t j = 0; j < data.time_s.size(); ++j) {
    const double unit = fit.scales().noise / (data.weight.empty() ? 1.0 : data.weight[j]);
    result.residual.push_back(residuals[j] * unit);
    result.slope.push_back(jacobian[onset * model.residuals() + j] * unit / fit.scales().half_period_s);
  }
  return result;
}

}  // namespace

std::vector<CycleData> weigh_by_slope(const BlockFit& fit) {
  const double noise2 = stick_variance(fit);
  const double rate = std::exp(fit.parameters.values(0)) * fit.scales().speed_m_per_s;
  std::vector<Slopes> slopes;
  double excess = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    slopes.push_back(slopes_of(fit, i));
    for (std::size_t j = 0; j < slopes[i].slope.size(); ++j) {
      const double steeper2 = std::max(0.0, slopes[i].slope[j] * slopes[i].slope[j] - rate * rate);
      excess += steeper2 * (slopes[i].residual[j] * slopes[i].residual[j] - noise2);
      weight += steeper2 * steeper2;
    }
  }
  const double time_variance = weight > 0.0 ? std::max(0.0, excess / weight) : 0.0;
  std::vector<CycleData> cycles;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    cycles.push_back(fit.data(i));
    cycles[i].weight.clear();
    for (const double slope : slopes[i].slope) {
      const double more = time_variance * std::max(0.0, slope * slope - rate * rate);
      cycles[i].weight.push_back(std::sqrt(noise2 / (noise2 + more)));
    }
  }
  return cycles;
}

}  // namespace slipfit::fit
