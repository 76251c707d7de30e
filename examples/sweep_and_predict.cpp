// Three recordings of one sliding pair at three speeds, fitted together, and what the fit predicts between and beyond
// them. The recordings are simulated here; read_recording takes their place for measured ones.

#include <array>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <slipfit/slipfit.hpp>
#include <vector>

namespace {

std::optional<slipfit::SweepEntry> simulated(double speed_m_per_s, std::uint64_t seed) {
  const auto slider = slipfit::Slider::create(5000.0, 900.0, 0.05);  // k [N/m], w_n [rad/s], zeta
  const auto friction = slipfit::Friction::create(4.0, 3.0);         // F_s, F_k [N]
  if (!slider || !friction) return std::nullopt;
  slipfit::SimulationOptions options;
  options.duration_s = 2.0;
  options.sample_rate_Hz = 10000.0;
  options.noise_rms_N = 0.01;
  options.seed = seed;
  slipfit::SimulatedTrace trace = slipfit::simulate(slider.value(), friction.value(), speed_m_per_s, options);
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  auto recording = slipfit::Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions);
  if (!recording) return std::nullopt;
  return slipfit::SweepEntry{"seed " + std::to_string(seed), std::move(recording).value()};
}

}  // namespace

int main() {
  std::vector<slipfit::SweepEntry> entries;
  for (const double speed_m_per_s : {0.005, 0.01, 0.02}) {
    auto entry = simulated(speed_m_per_s, 1 + entries.size());
    if (!entry) return 1;
    entries.push_back(std::move(*entry));
  }
  const slipfit::SweepAnalysis sweep = slipfit::analyze_sweep(entries);
  if (!sweep.fit || !sweep.fit->result.estimate) {
    std::printf("no joint fit: %s\n", sweep.fit_reason.c_str());
    return 1;
  }
  const slipfit::FitResult& fit = sweep.fit->result;
  std::printf("stiffness %.0f N/m, natural frequency %.1f rad/s, damping ratio %.3f\n", *fit.stiffness().value,
              *fit.natural_frequency().value, *fit.damping_ratio().value);

  const slipfit::PredictionModel model{*fit.estimate, true, std::nullopt};
  constexpr std::array<double, 3> kSpeeds_m_per_s{0.007, 0.014, 0.05};
  const slipfit::Prediction prediction = slipfit::predict_at(model, kSpeeds_m_per_s);
  for (const slipfit::PredictedMotion& row : prediction.rows) {
    const slipfit::Estimate& spacing_m = row.periodic_displacement_m;
    if (!spacing_m.value || !spacing_m.ci95) continue;
    std::printf("%.0f mm/s: spacing %.3f mm, 95 %% interval %.3f to %.3f mm\n", 1e3 * row.speed_m_per_s,
                1e3 * *spacing_m.value, 1e3 * spacing_m.ci95->low, 1e3 * spacing_m.ci95->high);
  }
  return 0;
}
