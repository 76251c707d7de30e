#include "chart/ticks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace slipfit::chart {
namespace {

constexpr double kSlack = 1e-9;  // of a step: a tick on the end of the axis counts in spite of rounding

double step_for(double range, int most_steps) {
  const double power = std::pow(10.0, std::floor(std::log10(range / most_steps)));
  for (const double step : {power, 2.0 * power, 5.0 * power}) {
    if (range / step <= most_steps + kSlack) return step;
  }
  return 10.0 * power;
}

std::vector<Tick> linear_ticks(const Axis& axis, int most_steps) {
  const double step = step_for(axis.high - axis.low, most_steps);
  std::vector<Tick> ticks;
  for (double n = std::ceil(axis.low / step - kSlack); n * step <= axis.high + kSlack * step; ++n) {
    const double value = n * step + 0.0;  // not -0
    ticks.push_back({value, fmt::format("{:.6g}", value)});
  }
  return ticks;
}

/// Decades carry values; on a short axis 2 and 5 of each decade too, on a very short one every part.
bool carries_value(const Axis& axis, int part) {
  const double decades = std::log10(axis.high / axis.low);
  return part == 1 || decades < 0.7 || (decades < 2.0 && (part == 2 || part == 5));
}

std::vector<Tick> logarithmic_ticks(const Axis& axis) {
  std::vector<Tick> ticks;
  for (double decade = std::floor(std::log10(axis.low) + kSlack); std::pow(10.0, decade) <= axis.high; ++decade) {
    for (int part = 1; part < 10; ++part) {
      const double value = part * std::pow(10.0, decade);
      if (value < axis.low * (1.0 - kSlack) || value > axis.high * (1.0 + kSlack)) continue;
      ticks.push_back({value, carries_value(axis, part) ? fmt::format("{:.6g}", value) : std::string()});
    }
  }
  return ticks;
}

}  // namespace

std::vector<Tick> ticks_of(const Axis& axis, int most_steps) {
  return axis.scale == Scale::Linear ? linear_ticks(axis, most_steps) : logarithmic_ticks(axis);
}

}  // namespace slipfit::chart
