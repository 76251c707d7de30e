#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

#include "core/thresholds.hpp"
#include "report/html/figure.hpp"
#include "report/html/page.hpp"
#include "report/json_values.hpp"

namespace slipfit::html {
namespace {

constexpr std::size_t kMostSamples = 1'000'000;  // 5.4 MB in the page
constexpr double kLevels = 65534.0;
constexpr std::uint16_t kMissing = 65535;
constexpr double kTicks = 4294967295.0;
constexpr double kEvenClock = 0.02;  // largest deviation, in steps: too small for the eye

/// RFC 4648.
std::string base64(std::vector<unsigned char> bytes) {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  bytes.resize(bytes.size() + padding);
  std::string text;
  text.reserve(bytes.size() / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const unsigned three = unsigned{bytes[i]} << 16U | unsigned{bytes[i + 1]} << 8U | bytes[i + 2];
    for (const unsigned shift : {18U, 12U, 6U, 0U}) text += kAlphabet[three >> shift & 63U];
  }
  std::fill(text.end() - static_cast<std::ptrdiff_t>(padding), text.end(), '=');
  return text;
}

/// Little-endian, as browsers hold numbers on every machine in use.
template <class Number>
std::string packed(const std::vector<Number>& numbers) {
  std::vector<unsigned char> bytes;
  bytes.reserve(numbers.size() * sizeof(Number));
  for (const Number number : numbers) {
    for (std::size_t byte = 0; byte < sizeof(Number); ++byte) {
      bytes.push_back(static_cast<unsigned char>(number >> (8 * byte)));
    }
  }
  return base64(std::move(bytes));
}

/// All samples, or the lowest and the highest of each group, in order: two a group, so that they lie evenly in time.
std::vector<std::size_t> chosen_samples(std::span<const double> force) {
  std::vector<std::size_t> chosen;
  if (force.size() <= kMostSamples) {
    chosen.resize(force.size());
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    return chosen;
  }
  const std::size_t groups = kMostSamples / 2;
  for (std::size_t group = 0; group < groups; ++group) {
    const auto begin = force.begin() + static_cast<std::ptrdiff_t>(group * force.size() / groups);
    const auto end = force.begin() + static_cast<std::ptrdiff_t>((group + 1) * force.size() / groups);
    const auto [lowest, highest] = std::minmax_element(begin, end);
    chosen.push_back(static_cast<std::size_t>(std::min(lowest, highest) - force.begin()));
    chosen.push_back(static_cast<std::size_t>(std::max(lowest, highest) - force.begin()));
  }
  return chosen;
}

/// A member with base64, which needs no escape in JSON, and would take as long as the fit in a JSON library.
std::string packed_member(const std::string& name, const std::string& base64) {
  return fmt::format(",\"{}\":\"{}\"", name, base64);
}

/// The series as `NAME_low`, `NAME_high` and `NAME_levels`.
std::string series_members(const std::string& name, const std::vector<double>& values) {
  Span span;
  for (const double value : values) span.add(value);
  const double low = span.empty() ? 0.0 : span.low();
  const double range = span.range();
  const auto level_of = [&](double value) {
    return static_cast<std::uint16_t>(range > 0.0 ? std::lround(kLevels * ((value - low) / range)) : 0);
  };
  std::vector<std::uint16_t> levels;
  levels.reserve(values.size());
  for (const double value : values) {
    levels.push_back(std::isfinite(value) ? level_of(value) : kMissing);
  }
  return fmt::format(",\"{0}_low\":{1},\"{0}_high\":{2}", name, low, low + range) +
         packed_member(name + "_levels", packed(levels));
}

/// Times as parts of the recording's duration.
std::string ticks_member(const std::string& name, const Recording& recording, const std::vector<double>& times_s) {
  const double per_second = kTicks / recording.duration_s();
  std::vector<std::uint32_t> ticks;
  ticks.reserve(times_s.size());
  for (const double time_s : times_s) {
    ticks.push_back(
        static_cast<std::uint32_t>(std::clamp(per_second * (time_s - recording.time_s().front()), 0.0, kTicks)));
  }
  return packed_member(name, packed(ticks));
}

bool is_even(std::span<const double> time_s) {
  const double step_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (std::abs(time_s[i] - time_s.front() - static_cast<double>(i) * step_s) > kEvenClock * step_s) return false;
  }
  return true;
}

std::vector<double> slip_times_s(const Analysis& analysis) {
  std::vector<double> times_s;
  if (!shows_cycles(analysis)) return times_s;
  for (const Cycle& cycle : analysis.cycle_table) {
    times_s.push_back(slip_begin_s(cycle));
    times_s.push_back(slip_end_s(cycle));
  }
  return times_s;
}

/// Begin and end of each gap of the clock.
std::vector<double> gap_times_s(const Recording& recording) {
  const std::span<const double> time_s = recording.time_s();
  const double shortest_s = thresholds::kGapSteps * recording.sample_interval_s();
  std::vector<double> times_s;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (time_s[i] - time_s[i - 1] > shortest_s) times_s.insert(times_s.end(), {time_s[i - 1], time_s[i]});
  }
  return times_s;
}

std::vector<double> outlier_times_s(const Source& source) {
  std::vector<double> times_s;
  const std::vector<bool>& outliers = source.analysis.quality.impulse_mask;
  for (std::size_t i = 0; i < outliers.size(); ++i) {
    if (outliers[i]) times_s.push_back(source.recording.time_s()[i]);
  }
  return times_s;
}

}  // namespace

std::string trace_data(const Source& source) {
  const Recording& recording = source.recording;
  const DisplayUnit& unit = source.force_unit;
  const std::vector<std::size_t> chosen = chosen_samples(recording.force());
  const auto of_chosen = [&chosen](const auto& at) {
    std::vector<double> values;
    values.reserve(chosen.size());
    for (const std::size_t i : chosen) values.push_back(at(i));
    return values;
  };
  const Json names{{"label", label_with_unit(force_name_of(recording), unit.unit)},
                   {"residual_label", label_with_unit("residual", unit.unit)},
                   {"unit", unit.unit},
                   {"first_s", recording.time_s().front()},
                   {"last_s", recording.time_s().back()}};
  std::string json = script_json(text_of(names, JsonLayout::OneLine));
  json.pop_back();
  json += series_members("force", of_chosen([&](std::size_t i) { return unit.per_SI * recording.force()[i]; })) +
          ticks_member("slips", recording, slip_times_s(source.analysis)) +
          ticks_member("gaps", recording, gap_times_s(recording)) +
          ticks_member("outliers", recording, outlier_times_s(source));
  if (!is_even(recording.time_s())) {
    json += ticks_member("ticks", recording, of_chosen([&](std::size_t i) { return recording.time_s()[i]; }));
  }
  if (has_fitted_curve(source.analysis)) {
    json += series_members(
        "residual", of_chosen([&](std::size_t i) { return unit.per_SI * (recording.force()[i] - source.fitted[i]); }));
  }
  return json + "}";
}

}  // namespace slipfit::html
