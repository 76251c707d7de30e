#include "chart/drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

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

/// Power of ten of the first digit.
double exponent_of(double value) {
  return std::floor(std::log10(std::abs(value)));
}

/// Writes a tick with enough digits to differ from its neighbours: a clock of the year 1970 needs ten before the
/// decimal point.
std::string text_of(double value, double step) {
  constexpr double kFew = 6.0;
  constexpr double kMost = 16.0;  // that a double has
  const double digits = value == 0.0 ? kFew : exponent_of(value) - exponent_of(step) + 1.0;
  return fmt::format("{:.{}g}", value, static_cast<int>(std::clamp(digits, kFew, kMost)));
}

std::vector<Tick> linear_ticks(const Axis& axis, int most_steps) {
  const double step = step_for(axis.high - axis.low, most_steps);
  const double first = std::ceil(axis.low / step - kSlack);
  std::vector<Tick> ticks;
  for (int i = 0; i <= most_steps; ++i) {
    const double value = (first + i) * step + 0.0;  // not -0
    if (value > axis.high + kSlack * step) break;
    ticks.push_back({value, text_of(value, step)});
  }
  constexpr int kClose = 8;  // a single value does not show the scale
  return ticks.size() < 2 && most_steps < kClose ? linear_ticks(axis, most_steps + 1) : ticks;
}

/// Decades carry values; on a short axis 2 and 5 of each decade too, on a very short one every part.
bool carries_value(const Axis& axis, int part) {
  const double decades = std::log10(axis.high / axis.low);
  return part == 1 || decades < 0.7 || (decades < 2.0 && (part == 2 || part == 5));
}

/// 10 to the power of `decade`, times `part` unless that is 1.
std::string power_of_ten(int part, int decade) {
  constexpr std::array kRaised{"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                               "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = part == 1 ? "10" : fmt::format("{}\u00D710", part);
  for (const char c : std::to_string(decade))
    text += c == '-' ? "\u207B" : kRaised.at(static_cast<std::size_t>(c - '0'));
  return text;
}

std::vector<Tick> logarithmic_ticks(const Axis& axis) {
  constexpr int kMostDecades = 24;  // beyond them some decades represent all
  const int first = static_cast<int>(std::floor(std::log10(axis.low) + kSlack));
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + kSlack));
  const int stride = 1 + (last - first) / kMostDecades;
  const bool is_plain = first >= -4 && last <= 5;  // no exponent in any of them
  std::vector<Tick> ticks;
  for (int decade = first; decade <= last; decade += stride) {
    for (int part = 1; part < (stride == 1 ? 10 : 2); ++part) {
      const double value = part * std::pow(10.0, decade);
      if (value < axis.low * (1.0 - kSlack) || value > axis.high * (1.0 + kSlack)) continue;
      const std::string text = is_plain ? fmt::format("{:.6g}", value) : power_of_ten(part, decade);
      ticks.push_back({value, carries_value(axis, part) ? text : std::string()});
    }
  }
  return ticks;
}

constexpr double kLargest = 1e300;  // differences and sums of two such numbers are finite
constexpr double kSmallest = 1e-300;

Axis drawable_linear(Axis axis) {
  constexpr double kLeastShare =
      64.0 * std::numeric_limits<double>::epsilon();  // eight doubles for each of eight steps
  const double least = std::max(kSmallest, kLeastShare * std::max(std::abs(axis.low), std::abs(axis.high)));
  if (axis.high - axis.low >= least) return axis;
  const double middle = axis.low + 0.5 * (axis.high - axis.low);
  axis.low = middle - 0.5 * least;
  axis.high = middle + 0.5 * least;
  return axis;
}

Axis drawable_logarithmic(Axis axis) {
  constexpr double kLeastRatio = 1.001;
  axis.low = std::max(axis.low, kSmallest);
  axis.high = std::max(axis.high, axis.low);
  if (axis.high >= kLeastRatio * axis.low) return axis;
  axis.low /= kLeastRatio;
  axis.high *= kLeastRatio;
  return axis;
}

}  // namespace

Axis drawable(Axis axis) {
  const bool is_linear = axis.scale == Scale::Linear;
  if (std::isnan(axis.low) || std::isnan(axis.high)) {
    axis.low = is_linear ? 0.0 : 1.0;
    axis.high = axis.low + 1.0;
  }
  if (axis.high < axis.low) std::swap(axis.low, axis.high);
  axis.low = std::clamp(axis.low, -kLargest, kLargest);
  axis.high = std::clamp(axis.high, -kLargest, kLargest);
  return is_linear ? drawable_linear(std::move(axis)) : drawable_logarithmic(std::move(axis));
}

std::vector<Tick> ticks_of(const Axis& axis, int most_steps) {
  return axis.scale == Scale::Linear ? linear_ticks(axis, most_steps) : logarithmic_ticks(axis);
}

}  // namespace slipfit::chart
