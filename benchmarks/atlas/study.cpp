#include "study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iterator>
#include <limits>
#include <utility>

namespace atlas {

double cpu_now_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double time_call_s(const std::function<void()>& call, std::size_t repeats) {
  constexpr double kLongEnough_s = 5e-5;
  const auto batch_s = [&](std::size_t calls) {
    const double start_s = cpu_now_s();
    for (std::size_t i = 0; i < calls; ++i) call();
    return (cpu_now_s() - start_s) / static_cast<double>(calls);
  };
  const double first_s = std::max(1e-9, batch_s(1));
  const auto calls = static_cast<std::size_t>(std::max(1.0, kLongEnough_s / first_s));
  std::vector<double> seconds;
  for (std::size_t i = 0; i < repeats; ++i) seconds.push_back(batch_s(calls));
  return median_of(seconds);
}

double median_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double robust_size(std::vector<double> errors) {
  for (double& error : errors) error = std::abs(error);
  return 1.4826 * median_of(std::move(errors));
}

std::vector<chart::Point> front_of(std::vector<chart::Point> points) {
  std::sort(points.begin(), points.end(),
            [](const chart::Point& a, const chart::Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<chart::Point> front;
  for (const chart::Point& point : points) {
    if (front.empty() || point.y < front.back().y) front.push_back(point);
  }
  return front;
}

chart::Line draw_front(const std::vector<chart::Point>& points, double right_end) {
  chart::Line line{"Pareto front: nothing left of and below it", chart::Colour::Grey, chart::Stroke::Dashed, {}};
  for (const chart::Point& corner : front_of(points)) {
    if (!line.points.empty()) line.points.push_back({corner.x, line.points.back().y});
    line.points.push_back(corner);
  }
  if (!line.points.empty()) line.points.push_back({right_end, line.points.back().y});
  return line;
}

std::vector<double> log_spaced(double low, double high, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / static_cast<double>(count - 1)));
  }
  return values;
}

void add_series(chart::Panel& panel, const Look& look, const std::vector<chart::Point>& points) {
  if (points.size() > 1) panel.lines.push_back({"", look.colour, look.stroke, points});
  std::vector<chart::Point> known;  // no mark where there is no number
  std::copy_if(points.begin(), points.end(), std::back_inserter(known),
               [](const chart::Point& point) { return std::isfinite(point.y); });
  panel.markers.push_back({look.name, look.colour, look.shape, std::move(known)});
}

void strip_legend(chart::Panel& panel) {
  for (chart::Line& line : panel.lines) line.name.clear();
  for (chart::Markers& markers : panel.markers) markers.name.clear();
}

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string();
}

}  // namespace atlas
