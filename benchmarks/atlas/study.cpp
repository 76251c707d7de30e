#include "study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
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

std::vector<double> log_spaced(double low, double high, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / static_cast<double>(count - 1)));
  }
  return values;
}

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string();
}

}  // namespace atlas
