#include "report/html/figure.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace slipfit::html {

namespace {

constexpr double kRoom = 0.05;     // of the range, on both sides
constexpr double kVisible = 1e-9;  // of the largest: below it are the last digits of a constant
constexpr double kLogRoom = 1.3;   // factor on both sides

}  // namespace

DisplayUnit force_unit_of(const Recording& recording) {
  if (recording.conditions().quantity == ForceQuantity::FrictionCoefficient) return {};
  double largest = 0.0;
  for (const double force : recording.force()) largest = std::max(largest, std::abs(force));
  return display_unit("N", largest);
}

std::string force_name_of(const Recording& recording) {
  return recording.conditions().quantity == ForceQuantity::Force_N ? "friction force" : "friction coefficient";
}

std::string label_with_unit(const std::string& name, const std::string& unit) {
  return fmt::format("{} [{}]", name, unit.empty() ? "-" : unit);
}

std::string quantity_of(const Estimate& estimate, const std::string& SI_unit) {
  return unbroken(with_error(estimate, SI_unit));
}

std::string unbroken(const std::string& quantity) {
  std::string result;
  for (const char c : quantity) result += c == ' ' ? std::string("\u00A0") : std::string(1, c);
  return result;
}

chart::Line line_up(const chart::Panel& panel, const std::string& name, double x, chart::Colour colour) {
  return {name, colour, chart::Stroke::Dashed, {{x, panel.y.low}, {x, panel.y.high}}};
}

chart::Area rectangle(std::string name, chart::Colour colour, chart::Point low, chart::Point high) {
  return {std::move(name), colour, chart::Fill::Plain, {low, {low.x, high.y}, high, {high.x, low.y}}, kEdge_px};
}

void Span::add(double value) {
  if (!std::isfinite(value)) return;
  const bool is_first = empty();
  low_ = is_first ? value : std::min(low_, value);
  high_ = is_first ? value : std::max(high_, value);
}

void Span::add(const std::vector<chart::Point>& points, double chart::Point::*coordinate) {
  for (const chart::Point& point : points) add(point.*coordinate);
}

double Span::range() const {
  if (empty()) return 0.0;
  const double range = high_ - low_;
  return range > kVisible * std::max(std::abs(low_), std::abs(high_)) ? range : 0.0;
}

chart::Axis Span::linear_axis(const std::string& label) const {
  if (empty()) return {label, 0.0, 1.0};
  const double room = range() > 0.0 ? kRoom * range() : std::max(0.5 * std::abs(low_), 1e-12);
  return {label, low_ - room, high_ + room};
}

chart::Axis Span::logarithmic_axis(const std::string& label) const {
  if (empty()) return {label, 1.0, 10.0, chart::Scale::Logarithmic};
  return {label, low_ / kLogRoom, high_ * kLogRoom, chart::Scale::Logarithmic};
}

SampleRange samples_between(const Recording& recording, double begin_s, double end_s) {
  const std::span<const double> time_s = recording.time_s();
  const auto first = std::lower_bound(time_s.begin(), time_s.end(), begin_s);
  const auto last = std::upper_bound(first, time_s.end(), end_s);
  return {static_cast<std::size_t>(first - time_s.begin()), static_cast<std::size_t>(last - time_s.begin())};
}

std::vector<chart::Point> envelope(std::span<const double> x, std::span<const double> y, std::size_t columns) {
  std::vector<chart::Point> points;
  const std::size_t count = std::min(x.size(), y.size());
  const bool is_sparse = count <= 2 * columns;
  const std::size_t parts = is_sparse ? count : columns;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t first = part * count / parts;
    const std::size_t last = (part + 1) * count / parts;
    std::size_t lowest = last;
    std::size_t highest = last;
    for (std::size_t i = first; i < last; ++i) {
      if (!std::isfinite(y[i])) continue;
      if (lowest == last || y[i] < y[lowest]) lowest = i;
      if (highest == last || y[i] > y[highest]) highest = i;
    }
    if (lowest == last) {
      points.push_back({x[first], std::numeric_limits<double>::quiet_NaN()});
      continue;
    }
    const auto [earlier, later] = std::minmax(lowest, highest);
    points.push_back({x[earlier], y[earlier]});
    if (later != earlier) points.push_back({x[later], y[later]});
  }
  return points;
}

}  // namespace slipfit::html
