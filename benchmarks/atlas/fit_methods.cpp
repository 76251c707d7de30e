#include "fit_methods.hpp"

#include <algorithm>
#include <cmath>

#include "slipfit/pipeline.hpp"
#include "slipfit/sweep.hpp"

namespace atlas {
namespace {

using slipfit::DetectedSlip;
using slipfit::Estimate;

/// Median with the standard error of a median of normal values.
Estimate middle_of(const std::vector<double>& values) {
  if (values.size() < 3) return {};
  const double middle = median_of(values);
  std::vector<double> distances;
  for (const double value : values) distances.push_back(value - middle);
  const double error = 1.2533 * robust_size(distances) / std::sqrt(static_cast<double>(values.size()));
  return {middle, error, slipfit::Interval{middle - 1.96 * error, middle + 1.96 * error}, {}};
}

FitAnswer read_parameters(const std::vector<slipfit::Parameter>& parameters) {
  constexpr std::array<std::string_view, kFitParameters> kKeys{"stiffness_N_per_m", "natural_frequency_rad_per_s",
                                                               "damping_ratio", "friction_difference_N"};
  FitAnswer answer;
  for (const slipfit::Parameter& parameter : parameters) {
    const auto key = std::find(kKeys.begin(), kKeys.end(), parameter.name());
    if (key == kKeys.end()) continue;
    const auto i = static_cast<std::size_t>(key - kKeys.begin());
    answer.estimates[i] = parameter.estimate;
    answer.sure[i] = parameter.status == slipfit::ParameterStatus::Identified;
  }
  return answer;
}

FitAnswer fit_blocks(const Scene& scene) {
  const slipfit::Analysis analysis = slipfit::analyze_and_fit(scene.recording);
  return analysis.fit ? read_parameters(analysis.fit->parameters) : FitAnswer{};
}

/// A third of the cycles at each of three speeds.
std::vector<slipfit::SweepEntry> make_sweep(Factors factors, std::uint64_t seed) {
  std::vector<slipfit::SweepEntry> entries;
  factors.cycles = std::max(4.0, factors.cycles / 3.0);
  for (const double speedup : {1.0, 2.0, 4.0}) {
    factors.speedup = speedup;
    entries.push_back({"v" + std::to_string(entries.size()), make_scene(factors, seed).recording});
  }
  return entries;
}

TimedFit run_sweep(const Factors& factors, std::uint64_t seed) {
  const std::vector<slipfit::SweepEntry> entries = make_sweep(factors, seed);
  const double start_s = cpu_now_s();
  const slipfit::SweepAnalysis sweep = slipfit::analyze_sweep(entries);
  const double time_s = cpu_now_s() - start_s;
  return {sweep.fit ? read_parameters(sweep.fit->result.parameters) : FitAnswer{}, time_s};
}

FitMethod on_one_recording(const std::string& name, const std::function<FitAnswer(const Scene&, std::uint64_t)>& fit) {
  return {name, [fit](const Factors& factors, std::uint64_t seed) {
            const Scene scene = make_scene(factors, seed);
            const double start_s = cpu_now_s();
            FitAnswer answer = fit(scene, seed);
            return TimedFit{std::move(answer), cpu_now_s() - start_s};
          }};
}

}  // namespace

bool is_confidently_wrong(const FitAnswer& answer, std::size_t parameter, double truth) {
  const slipfit::Estimate& estimate = answer.estimates[parameter];
  if (!answer.sure[parameter] || !estimate.value) return false;
  const double allowed = std::max(0.02 * truth, 4.0 * estimate.standard_error.value_or(0.0));
  return !(std::abs(*estimate.value - truth) <= allowed);
}

FitAnswer fit_features(const Scene& scene) {
  const slipfit::Recording& recording = scene.recording;
  const slipfit::Quality quality = slipfit::assess_quality(recording);
  const std::vector<DetectedSlip> slips = slipfit::find_slips(recording, quality).slips;
  const double speed_m_per_s = recording.conditions().speed_m_per_s;
  std::vector<double> stiffness, omega, drop;
  for (std::size_t i = 1; i < slips.size(); ++i) {
    const double stick_s = recording.time_s()[slips[i].peak] - recording.time_s()[slips[i - 1].trough];
    stiffness.push_back((slips[i].peak_force - slips[i - 1].trough_force) / (stick_s * speed_m_per_s));
    // 80 % to 20 % of a half cosine.
    if (slips[i].fall_s > 0.0) omega.push_back(2.0 * std::asin(0.6) / slips[i].fall_s);
    drop.push_back(slips[i].drop());
  }
  FitAnswer answer;
  answer.estimates[kStiffnessOf] = middle_of(stiffness);
  answer.estimates[kFrequencyOf] = middle_of(omega);
  if (answer.estimates[kFrequencyOf].value) {
    // Undamped: half the drop is hypot(F_s - F_k, k V / w_n), [Paper] eqs (12)-(27).
    const double u = *answer.estimates[kStiffnessOf].value * speed_m_per_s / *answer.estimates[kFrequencyOf].value;
    for (double& d : drop) d = std::sqrt(std::max(0.0, 0.25 * d * d - u * u));
    answer.estimates[kDropOf] = middle_of(drop);
  }
  for (std::size_t i = 0; i < kFitParameters; ++i) answer.sure[i] = answer.estimates[i].value.has_value();
  return answer;
}

std::vector<FitMethod> fit_methods() {
  const auto whole_trace = [](double start_error) {
    return [start_error](const Scene& scene, std::uint64_t seed) { return fit_whole_trace(scene, start_error, seed); };
  };
  return {on_one_recording("features: slopes, drops, falls",
                           [](const Scene& scene, std::uint64_t) { return fit_features(scene); }),
          on_one_recording("whole trace, start off by 0.1 %", whole_trace(0.001)),
          on_one_recording("whole trace, start off by 1 %", whole_trace(0.01)),
          on_one_recording("whole trace, start off by 10 %", whole_trace(0.1)),
          on_one_recording("cycles as blocks (slipfit fit)",
                           [](const Scene& scene, std::uint64_t) { return fit_blocks(scene); }),
          {"three speeds jointly (slipfit fit --joint)", run_sweep}};
}

FitMethod fit_without_terms() {
  const auto fit = [](const Scene& scene, std::uint64_t) {
    slipfit::Conditions conditions = scene.recording.conditions();
    conditions.sensor_average_s = 0.0;
    const auto time_s = scene.recording.time_s();
    const auto force_N = scene.recording.force();
    const auto recording =
        slipfit::Recording::create({time_s.begin(), time_s.end()}, {force_N.begin(), force_N.end()}, conditions);
    slipfit::FitOptions options;
    options.tier = slipfit::Tier::Damped;
    const slipfit::Analysis analysis = slipfit::analyze_and_fit(recording.value(), options);
    return analysis.fit ? read_parameters(analysis.fit->parameters) : FitAnswer{};
  };
  return on_one_recording("cycles as blocks, Coulomb friction alone", fit);
}

}  // namespace atlas
