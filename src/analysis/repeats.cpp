#include "analysis/sweep_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/quantile.hpp"
#include "core/student.hpp"
#include "slipfit/core/range.hpp"

namespace slipfit {
namespace {

constexpr double kSameSpeed = 0.01;

struct RepeatedQuantity {
  const char* name;
  const char* words;
  const char* unit;
  Range range;
  std::optional<double> (*of)(const Recording&, const Analysis&);
};

/// While it slides.
std::optional<double> mean_force(const Recording& recording, const Analysis& analysis) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const double time_s = recording.time_s()[i];
    if (time_s < analysis.sliding.begin_s || time_s > analysis.sliding.end_s) continue;
    sum += recording.force()[i];
    ++count;
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

constexpr std::array kQuantities = std::to_array<RepeatedQuantity>({
    {"frequency_Hz", "frequency", "Hz", kNotNegative,
     [](const Recording&, const Analysis& a) { return a.frequency.quoted.value; }},
    {"pattern_spacing_m", "spacing", "m", kNotNegative,
     [](const Recording&, const Analysis& a) { return a.derived.pattern_spacing_m.value; }},
    {"stick_stiffness_N_per_m", "slope of the sticks / V", "N/m", kNotNegative,
     [](const Recording&, const Analysis& a) { return a.cycles.stick_stiffness.value; }},
    {"peak_force_N", "peak force", "N", kAnyNumber,
     [](const Recording&, const Analysis& a) { return a.cycles.peak_force; }},
    {"force_drop_N", "force drop", "N", kNotNegative,
     [](const Recording&, const Analysis& a) { return a.cycles.force_drop; }},
    {"mean_force_N", "mean force", "N", kAnyNumber, mean_force},
});

bool are_at_one_speed(std::span<const SweepEntry> entries) {
  const auto speed = [](const SweepEntry& entry) { return entry.recording.conditions().speed_m_per_s; };
  const auto [slow, fast] =
      std::ranges::minmax_element(entries, [&](const auto& a, const auto& b) { return speed(a) < speed(b); });
  return speed(*fast) <= (1.0 + kSameSpeed) * speed(*slow);
}

}  // namespace

std::vector<Repeat> compare_repeats(std::span<const SweepEntry> entries, std::span<const Analysis> analyses) {
  std::vector<Repeat> repeats;
  if (entries.size() < 2 || !are_at_one_speed(entries)) return repeats;
  for (const RepeatedQuantity& quantity : kQuantities) {
    std::vector<double> values;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (const auto value = quantity.of(entries[i].recording, analyses[i])) values.push_back(*value);
    }
    if (values.size() < 2) continue;
    const MeanAndSpread spread = describe(values);
    Estimate mean = symmetric(spread.mean, spread.sd / std::sqrt(spread.count), spread.count - 1.0);
    mean = within(std::move(mean), quantity.range);
    repeats.push_back({quantity.name, quantity.words, quantity.unit, values.size(), mean, spread.sd});
  }
  return repeats;
}

}  // namespace slipfit
