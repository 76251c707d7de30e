#include "slipfit/predict/speeds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>

#include "slipfit/core/units.hpp"

namespace slipfit {
namespace {

constexpr std::size_t kMostSpeeds = 100'000;  // about 100 MB of JSON: more is taken for a typing error

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t start = 0;
  for (std::size_t end = 0; end != std::string::npos; start = end + 1) {
    end = text.find(separator, start);
    parts.push_back(text.substr(start, end == std::string::npos ? end : end - start));
  }
  return parts;
}

Error bad_speeds(const std::string& message) {
  return Error{"bad_speeds", "--speeds: " + message};
}

Result<double> speed_from(const std::string& text) {
  Result<double> speed = parse_quantity(text, Dimension::Speed);
  if (!speed) return Error{speed.error().code, "--speeds: " + speed.error().message};
  if (speed.value() > 0.0) return speed;
  return Error{"out_of_range", fmt::format("--speeds: '{}' is not above zero", text)};
}

/// Returns the speeds of a list or the ends of a range. A unit that only the last one has is that of all.
std::vector<std::string> with_units(std::vector<std::string> speeds) {
  const auto has_unit = [](const std::string& speed) { return !unit_in(speed).empty(); };
  if (std::ranges::count_if(speeds, has_unit) != 1 || !has_unit(speeds.back())) return speeds;
  const std::string unit(unit_in(speeds.back()));
  for (std::string& speed : speeds) {
    if (!has_unit(speed)) speed += " " + unit;
  }
  return speeds;
}

Result<std::size_t> number_of_speeds(const std::string& text) {
  std::size_t count = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, count);
  if (status == std::errc() && stop == end && count >= 2 && count <= kMostSpeeds) return count;
  return bad_speeds(fmt::format("bad number of speeds '{}', expected A:B:N with N from 2 to {}", text, kMostSpeeds));
}

/// N speeds from A to B in equal ratios, both ends exact.
Result<Speeds> speed_range(const std::vector<std::string>& parts) {
  const std::vector<std::string> ends = with_units({parts[0], parts[1]});
  const Result<double> first = speed_from(ends[0]);
  if (!first) return first.error();
  const Result<double> last = speed_from(ends[1]);
  if (!last) return last.error();
  const Result<std::size_t> count = number_of_speeds(parts[2]);
  if (!count) return count.error();
  if (!(first.value() < last.value())) {
    return bad_speeds(fmt::format("'{}' is not below '{}', expected A:B:N with A < B", parts[0], parts[1]));
  }
  std::vector<double> speeds(count.value(), last.value());
  for (std::size_t i = 0; i + 1 < speeds.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(speeds.size() - 1);
    // Its square may be no number.
    const double root = std::exp(0.5 * share * (std::log(last.value()) - std::log(first.value())));
    speeds[i] = first.value() * root * root;
  }
  return Speeds{std::move(speeds), std::string(unit_in(ends[0]))};
}

}  // namespace

Result<Speeds> parse_speeds(const std::string& text) {
  if (text.find(':') != std::string::npos) {
    const std::vector<std::string> parts = split(text, ':');
    if (parts.size() != 3) return bad_speeds(fmt::format("bad range '{}', expected A:B:N", text));
    return speed_range(parts);
  }
  const std::vector<std::string> parts = with_units(split(text, ','));
  Speeds speeds{{}, std::string(unit_in(parts.front()))};
  for (const std::string& part : parts) {
    const Result<double> speed = speed_from(part);
    if (!speed) return speed.error();
    speeds.speeds_m_per_s.push_back(speed.value());
  }
  if (speeds.speeds_m_per_s.size() > kMostSpeeds) return bad_speeds(fmt::format("more than {} speeds", kMostSpeeds));
  return speeds;
}

}  // namespace slipfit
