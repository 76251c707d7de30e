#include "slipfit/core/recording.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slipfit {
namespace {

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

double median_positive_step(const std::vector<double>& time_s) {
  std::vector<double> steps;
  steps.reserve(time_s.size());
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (time_s[i] > time_s[i - 1]) steps.push_back(time_s[i] - time_s[i - 1]);
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

bool is_even(const std::vector<double>& time_s) {
  const double step = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  double worst = 0.0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    worst = std::max(worst, std::abs(time_s[i] - time_s.front() - step * static_cast<double>(i)));
  }
  return worst < 0.25 * step;
}

}  // namespace

Result<Recording> Recording::create(std::vector<double> time_s, std::vector<double> force, Conditions conditions,
                                    Provenance provenance) {
  if (time_s.size() != force.size()) return Error{"length_mismatch", "time and force differ in length"};
  if (time_s.size() < 2) return Error{"too_few_samples", "fewer than 2 samples with a time and a force"};
  if (!all_finite(time_s) || !all_finite(force)) return Error{"not_finite", "time or force is not finite"};
  if (!std::is_sorted(time_s.begin(), time_s.end())) return Error{"time_decreases", "time runs backwards"};
  if (time_s.front() == time_s.back()) return Error{"time_constant", "all samples have the same time"};
  if (!std::isfinite(conditions.speed_m_per_s) || conditions.speed_m_per_s <= 0.0) {
    return Error{"speed_not_positive", "the driving speed must be a positive number of metres a second"};
  }
  if (conditions.normal_force_N && !(*conditions.normal_force_N > 0.0 && std::isfinite(*conditions.normal_force_N))) {
    return Error{"normal_force_not_positive", "the normal force must be a positive number of newtons"};
  }
  Recording recording;
  recording.sample_interval_s_ = median_positive_step(time_s);
  recording.clock_is_even_ = is_even(time_s);
  recording.time_s_ = std::move(time_s);
  recording.force_ = std::move(force);
  recording.conditions_ = conditions;
  recording.provenance_ = std::move(provenance);
  return recording;
}

}  // namespace slipfit
