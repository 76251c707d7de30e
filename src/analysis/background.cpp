#include "slipfit/background.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/rebound.hpp"
#include "slipfit/inspection.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/predict/single_speed.hpp"

namespace slipfit {

namespace {

constexpr double kSmallestZeta = 1e-3;
constexpr double kLargestZeta = 0.995;  // lambda_c has no end towards 1
constexpr int kLimitPoints = 80;
constexpr int kSpeeds = 80;
constexpr double kSpeedReach = 20.0;  // below the measured speed, and above where stick-slip has no known end
constexpr double kBeyondCritical = 2.0;

std::vector<double> in_equal_ratios(double low, double high, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) values.push_back(low * std::pow(high / low, i / (count - 1.0)));
  return values;
}

/// Around the measured speed, and past the critical one where it is near enough to be drawn; the last speed with
/// stick-slip is among them, so that curves reach their end.
std::vector<double> speeds_around(double speed_m_per_s, const Estimate& critical_speed_m_per_s) {
  double high = kSpeedReach * speed_m_per_s;
  const double critical = critical_speed_m_per_s.value.value_or(0.0);
  const bool is_near = critical > 0.0 && critical < kSpeedReach * kSpeedReach * speed_m_per_s;
  if (is_near) high = std::max(kBeyondCritical * critical, kBeyondCritical * speed_m_per_s);
  const double low = std::min(speed_m_per_s, is_near ? critical : speed_m_per_s) / kSpeedReach;
  std::vector<double> speeds = in_equal_ratios(low, high, kSpeeds);
  if (is_near) speeds.push_back(critical * (1.0 - 1e-9));
  std::ranges::sort(speeds);
  return speeds;
}

Estimate reflection_of(const FitResult& fit) {
  Estimate reflection;
  const Parameter* const damping = fit.find(ParameterId::DampingRatio);
  if (damping == nullptr) return reflection;
  const Estimate& zeta = damping->estimate;
  reflection.note = zeta.note;
  if (!zeta.value || damping->status == ParameterStatus::Bounded) return reflection;
  reflection.value = model::rebound_at(*zeta.value);
  if (zeta.ci95 && zeta.ci95->low >= 0.0 && zeta.ci95->high < 1.0) {
    reflection.ci95 = Interval{model::rebound_at(zeta.ci95->high), model::rebound_at(zeta.ci95->low)};
  }
  return reflection;
}

}  // namespace

Background gather_background(const Recording& recording, const Analysis& analysis) {
  Background background;
  background.spectrum = compute_spectrum(recording, analysis.quality.impulse_mask);
  for (const double zeta : in_equal_ratios(kSmallestZeta, kLargestZeta, kLimitPoints)) {
    background.limit.push_back({zeta, critical_lambda(zeta)});
  }
  if (analysis.fit) background.reflection = reflection_of(*analysis.fit);
  if (analysis.fit && analysis.fit->estimate) {
    const double speed_m_per_s = recording.conditions().speed_m_per_s;
    const PredictionModel model{from_single_speed(*analysis.fit, speed_m_per_s), true, std::nullopt};
    const std::vector<double> speeds = speeds_around(speed_m_per_s, analysis.derived.critical_speed_m_per_s);
    background.prediction = predict_at(model, speeds);
  }
  return background;
}

std::optional<Prediction> predict_around(std::span<const SweepEntry> entries, const SweepAnalysis& sweep) {
  if (!sweep.fit || !sweep.fit->result.estimate) return std::nullopt;
  double slowest = std::numeric_limits<double>::infinity();
  double fastest = 0.0;
  const auto load = entries.front().recording.conditions().normal_force_N;
  for (const SweepEntry& entry : entries) {
    const Conditions& conditions = entry.recording.conditions();
    if (conditions.normal_force_N != load) return std::nullopt;
    slowest = std::min(slowest, conditions.speed_m_per_s);
    fastest = std::max(fastest, conditions.speed_m_per_s);
  }
  constexpr double kReach = 2.0;
  std::vector<double> speeds = in_equal_ratios(slowest / kReach, fastest * kReach, kSpeeds);
  const double critical = sweep.derived.critical_speed_m_per_s.value.value_or(0.0);
  if (speeds.front() < critical && critical < speeds.back()) speeds.push_back(critical * (1.0 - 1e-9));
  std::ranges::sort(speeds);
  const ObservedEnd observed = sweep.derived.observed_end.value_or(ObservedEnd{});
  return predict_at({*sweep.fit->result.estimate, true, std::nullopt, observed}, speeds);
}

/// The places of slips do not depend on the speed: where the file has none, any value gives the same.
Result<Inspection> inspect(const std::filesystem::path& file, const ReadOptions& options) {
  auto info = inspect_recording(file, options);
  if (!info) return info.error();
  Inspection inspection{std::move(info).value(), std::nullopt};
  if (const auto& recording = inspection.info.recording) inspection.sliding = analyze(*recording).sliding;
  return inspection;
}

}  // namespace slipfit
