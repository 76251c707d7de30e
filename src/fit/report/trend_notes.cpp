#include "fit/report/trend_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace slipfit::fit {
namespace {

std::string note_on_stiffness(const TrendFindings& trend) {
  return fmt::format("the interval of k includes both readings of the trend of the level: k is {:.2g} % {} if {}",
                     100.0 * std::abs(std::expm1(trend.log_k_to_other)),
                     trend.log_k_to_other > 0.0 ? "larger" : "smaller",
                     trend.is_per_cycle ? "the sensor drifts" : "the friction changes");
}

const char* words_for(LevelReading reading) {
  switch (reading) {
    case LevelReading::Sensor:
      return "the sensor drifts";
    case LevelReading::Friction:
      return "the friction changes";
    default:
      return "the sensor drifts or the friction changes (--drift sensor or --drift friction states which)";
  }
}

/// "rises by 0.2 N/s"; of a sweep, whose recordings have rates of their own, without the number.
std::string words_for_rate(const LevelTrend& trend, const char* unit) {
  if (!trend.rate_per_s.value) return "changes over recordings";
  const double rate = *trend.rate_per_s.value;
  return fmt::format("{} by {:.3g}{}/s", rate > 0.0 ? "rises" : "falls", std::abs(rate), unit);
}

}  // namespace

void state_trend(const TrendFindings& trend, const Conditions& conditions, Findings& findings) {
  const CoordinateMatrix& covariance = findings.intervals.spread().covariance;
  const auto error_of = [&](Coordinate i) { return std::sqrt(std::max(0.0, covariance(i, i))); };
  const char* const unit = conditions.quantity == ForceQuantity::Force_N ? " N" : "";
  std::string of_stiffness;
  if (std::abs(trend.log_k_to_other) > error_of(kLogStiffness)) of_stiffness = note_on_stiffness(trend);
  const std::optional<Interval>& range = trend.trend.level_range;
  if (range && std::max(-range->low, range->high) > findings.units.force * error_of(kLevel)) {
    findings.level_doubt =
        fmt::format("a mean: the force level changes by {:.3g}{} over the recording", range->high - range->low, unit);
  }
  findings.level_trend = trend.trend;
  if (trend.is_significant && conditions.drift == LevelReading::None) {
    findings.warnings.push_back(
        {"level_trend", fmt::format("the force level {}, although no trend is stated: k and the friction forces are "
                                    "those of the recording as it is",
                                    words_for_rate(trend.trend, unit))});
  }
  if (of_stiffness.empty() && findings.level_doubt.empty()) return;
  std::string message =
      fmt::format("the force level {}: {}", words_for_rate(trend.trend, unit), words_for(trend.trend.reading));
  if (!of_stiffness.empty()) message += "; " + of_stiffness;
  findings.warnings.push_back({"level_trend", std::move(message)});
  if (findings.stiffness_note.empty()) findings.stiffness_note = std::move(of_stiffness);
}

}  // namespace slipfit::fit
