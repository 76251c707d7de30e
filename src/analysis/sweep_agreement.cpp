#include <fmt/format.h>

#include <algorithm>
#include <boost/math/statistics/linear_regression.hpp>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "analysis/sweep_checks.hpp"
#include "core/fit_thresholds.hpp"
#include "signal/robust.hpp"

namespace slipfit {
namespace {

/// The distance of a recording from the others.
struct Apart {
  std::size_t recording = 0;
  double distance = 0.0;  ///< relative, or ln of a ratio; levels in units of F_s - F_k
  double errors = 0.0;    ///< the same in errors, >= 0
};

/// The number of recordings that have to agree; all others for levels, whose unit is not shared and whose zeros may
/// differ.
enum class Agreeing { Half, AllOthers };

/// Returns true if a line over ln V explains nearly all differences.
bool go_with_speed(std::span<const SweepEntry> entries, std::span<const Apart> recordings) {
  std::vector<double> places;
  std::vector<double> distances;
  for (const Apart& one : recordings) {
    places.push_back(std::log(entries[one.recording].recording.conditions().speed_m_per_s));
    distances.push_back(one.distance);
  }
  if (!(boost::math::statistics::variance(places) > 0.0)) return false;
  const auto line = boost::math::statistics::simple_ordinary_least_squares_with_R_squared(places, distances);
  return std::get<2>(line) > thresholds::kGoesWithSpeed;
}

/// Returns the recording that differs most, if enough others agree.
std::optional<Apart> furthest(std::span<const SweepEntry> entries, std::vector<Apart> recordings, Agreeing agreeing) {
  if (recordings.size() < thresholds::kFewestRecordings) return std::nullopt;
  std::ranges::sort(recordings, [](const Apart& a, const Apart& b) { return a.errors > b.errors; });
  const Apart& first = recordings.front();
  const Apart& other = recordings[agreeing == Agreeing::Half ? recordings.size() / 2 : 1];
  const bool beyond = first.errors > thresholds::kLeftOutErrors && std::abs(first.distance) > thresholds::kLeftOutShare;
  const bool is_distinct = beyond && first.errors > thresholds::kDistinctRatio * other.errors;
  // What goes with the speed, without it too, is no fault of one recording.
  const auto others = std::span(recordings).subspan(1);
  const bool is_trend = go_with_speed(entries, recordings) && go_with_speed(entries, others);
  return is_distinct && !is_trend ? std::optional(first) : std::nullopt;
}

/// Spacing predicted without a recording over the one that it shows.
std::optional<Apart> by_spacing(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                                const SweepFit& fit) {
  std::vector<Apart> recordings;
  for (std::size_t i = 0; i < analyses.size(); ++i) {
    const Estimate& measured = analyses[i].derived.pattern_spacing_m;
    const Estimate& predicted = fit.points[i].spacing_left_out_m;
    if (!measured.standard_error || !predicted.standard_error) continue;
    const double distance = std::log(*predicted.value / *measured.value);
    const double error =
        std::hypot(*measured.standard_error / *measured.value, *predicted.standard_error / *predicted.value);
    recordings.push_back({i, distance, std::abs(distance) / error});
  }
  return furthest(entries, std::move(recordings), Agreeing::Half);
}

/// A parameter of a recording's own fit.
struct FittedValue {
  std::size_t recording = 0;
  double value = 0.0;
  double standard_error = 1.0;
};

std::vector<FittedValue> fitted_values(ParameterId id, const std::vector<Analysis>& analyses, const SweepFit& fit) {
  std::vector<FittedValue> values;
  for (std::size_t i = 0; i < analyses.size(); ++i) {
    if (!analyses[i].fit || fit.points[i].cycles_used == 0) continue;
    const Estimate own = analyses[i].fit->estimate_of(id);
    if (!own.value || !own.standard_error || !(*own.standard_error > 0.0)) continue;
    values.push_back({i, *own.value, *own.standard_error});
  }
  return values;
}

double middle_of(const std::vector<FittedValue>& values) {
  std::vector<double> numbers;
  numbers.reserve(values.size());
  for (const FittedValue& own : values) numbers.push_back(own.value);
  return signal::median(numbers);
}

/// Returns the distances from the middle of all recordings, in a unit.
std::vector<Apart> from_middle(const std::vector<FittedValue>& values, double middle, double unit) {
  std::vector<Apart> apart;
  for (const FittedValue& own : values) {
    const double off = own.value - middle;
    apart.push_back({own.recording, off / unit, std::abs(off) / own.standard_error});
  }
  return apart;
}

std::optional<Apart> by_stiffness(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                                  const SweepFit& fit) {
  if (fit.result.find(ParameterId::Relaxation) != nullptr)
    return std::nullopt;  // the slope of a stick depends on how long it lasts
  std::vector<FittedValue> values = fitted_values(ParameterId::Stiffness, analyses, fit);
  if (values.empty()) return std::nullopt;
  for (FittedValue& own : values) {
    if (!fit.result.estimate || !fit.result.estimate->stiffness_trend) break;
    const double speed_m_per_s = entries[own.recording].recording.conditions().speed_m_per_s;
    const double growth = std::exp(fit.result.estimate->stiffness_trend->log_growth_at(speed_m_per_s));
    own.value /= growth;
    own.standard_error /= growth;
  }
  const double middle = middle_of(values);
  return furthest(entries, from_middle(values, middle, middle), Agreeing::Half);
}

/// In units of F_s - F_k, at the mean load where loads are known.
std::optional<Apart> by_level(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                              const SweepFit& fit) {
  const Estimate unit = fit.result.friction_difference();
  if (fit.level_shared || !unit.value) return std::nullopt;
  std::vector<FittedValue> values = fitted_values(ParameterId::KineticFriction, analyses, fit);
  if (values.empty()) return std::nullopt;
  for (FittedValue& own : values) {
    const std::optional<double> load_N = entries[own.recording].recording.conditions().normal_force_N;
    if (!load_N || !fit.result.estimate || !fit.result.estimate->normal_force_N) continue;
    own.value *= *fit.result.estimate->normal_force_N / *load_N;
    own.standard_error *= *fit.result.estimate->normal_force_N / *load_N;
  }
  return furthest(entries, from_middle(values, middle_of(values), *unit.value), Agreeing::AllOthers);
}

const char* side_of(const Apart& apart) {
  return apart.distance > 0.0 ? "above" : "below";
}

}  // namespace

Warnings check_agreement(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                         const SweepFit& fit) {
  const auto warning = [&entries](std::size_t recording, const std::string& shown) {
    return Warning{
        "recording_disagrees",
        fmt::format("recording '{}' disagrees with the others: {}; check its speed, its unit and its file, and "
                    "fit without it",
                    entries[recording].id, shown)};
  };
  if (const auto apart = by_stiffness(entries, analyses, fit)) {
    return {warning(apart->recording, fmt::format("its stiffness is {:.2g} % {} theirs (k is proportional to 1/V)",
                                                  100.0 * std::abs(apart->distance), side_of(*apart)))};
  }
  if (const auto apart = by_spacing(entries, analyses, fit)) {
    return {warning(apart->recording, fmt::format("a fit without it predicts a spacing {:.3g} times the measured one",
                                                  std::exp(apart->distance)))};
  }
  if (const auto apart = by_level(entries, analyses, fit)) {
    return {warning(apart->recording, fmt::format("its force level is {:.2g} times F_s - F_k {} theirs",
                                                  std::abs(apart->distance), side_of(*apart)))};
  }
  return {};
}

Warnings check_duplicates(std::span<const SweepEntry> entries) {
  Warnings warnings;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto one = entries[i].recording.force();
      const auto other = entries[j].recording.force();
      if (!std::ranges::equal(one, other)) continue;
      warnings.push_back(
          {"recording_repeated",
           fmt::format(
               "recordings '{}' and '{}' have the same samples: one is counted twice or listed with wrong conditions",
               entries[j].id, entries[i].id)});
      break;
    }
  }
  return warnings;
}

}  // namespace slipfit
