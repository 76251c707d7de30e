#include "examples.hpp"

#include <utility>
#include <vector>

#include "slipfit/model/simulation.hpp"

namespace test {

using slipfit::Estimate;
using slipfit::Interval;
using slipfit::ParameterStatus;

slipfit::Recording small_recording(slipfit::ForceQuantity quantity, const std::string& file) {
  std::vector<double> time_s;
  std::vector<double> force;
  for (int i = 0; i < 20; ++i) {
    time_s.push_back(0.001 * i);
    force.push_back(1.0 + 0.1 * (i % 5));
  }
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = 0.01;
  conditions.quantity = quantity;
  slipfit::Provenance provenance;
  provenance.file = file;
  provenance.input_digest = slipfit::digest_of("abc");
  provenance.input_bytes = 3;
  provenance.assumed = {"time in seconds"};
  provenance.warnings = {{"rows_left_out", "two rows were left out"}};
  provenance.rows_without_number = 2;
  return slipfit::Recording::create(std::move(time_s), std::move(force), conditions, std::move(provenance)).value();
}

slipfit::Recording stick_slip_recording(double speed_m_per_s) {
  const slipfit::SimulationOptions options{
      .duration_s = 2.0, .sample_rate_Hz = 2000.0, .static_friction_sd_N = 0.02, .noise_rms_N = 0.01};
  const slipfit::Slider slider = slipfit::Slider::create(1000.0, 200.0, 0.05).value();
  const slipfit::Friction friction = slipfit::Friction::create(3.0, 2.5).value();
  slipfit::SimulatedTrace trace = simulate(slider, friction, speed_m_per_s, options);
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  slipfit::Provenance provenance;
  provenance.file = "run.csv";
  return slipfit::Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions,
                                    std::move(provenance))
      .value();
}

namespace {

slipfit::FitResult example_fit() {
  slipfit::FitResult fit;
  fit.tier = slipfit::Tier::Damped;
  fit.conditional_on = {"Coulomb friction"};
  fit.candidates = {{slipfit::Tier::Sawtooth, 1, 0.4, 120.5, false, "worse"},
                    {slipfit::Tier::Damped, 3, 0.02, -250.25, true, "lowest AICc"}};
  fit.residual = {0.02, 1.01, 0.4};
  fit.parameters = {
      {slipfit::ParameterId::Stiffness,
       {1002.3456, 1.2345, Interval{999.93, 1004.76}, ""},
       ParameterStatus::Identified},
      {slipfit::ParameterId::FrictionDifference,
       {1.5, std::nullopt, Interval{1.0, 2.0}, "the slip is not resolved"},
       ParameterStatus::Bounded},
      {slipfit::ParameterId::StaticFriction,
       {std::nullopt, std::nullopt, std::nullopt, "needs --zero"},
       ParameterStatus::Unidentified},
      {slipfit::ParameterId::NaturalFrequency, {200.0, std::nullopt, std::nullopt, ""}, ParameterStatus::Fixed},
      {slipfit::ParameterId::DampingRatio, {0.0512, 0.011, Interval{0.029, 0.073}, ""}, ParameterStatus::Weak}};
  fit.correlation = slipfit::Correlation{{"stiffness_N_per_m", "damping_ratio"}, {{1.0, 0.25}, {0.25, 1.0}}};
  fit.curve = {{2, 1.25}, {3, 1.5}};
  return fit;
}

}  // namespace

slipfit::Analysis full_analysis() {
  slipfit::Analysis analysis;
  analysis.quality.noise_rms = 0.0125;
  analysis.quality.gaps = 1;
  analysis.motion = slipfit::MotionClass::StickSlip;
  analysis.motion_reason = "Every slip sticks again.";
  analysis.warnings = {
      {"rows_left_out", "two rows were left out"}, {"few_cycles", "only 4 cycles"}, {"mains_hum", "50 Hz hum"}};
  analysis.frequency.quoted = {5.4321, 0.0123, Interval{5.408, 5.4562}, ""};
  analysis.frequency.method = slipfit::FrequencyMethod::SlipCounting;
  analysis.frequency.spectral = {5.43, 0.02, 1e-9, {5.43, 10.86}, {{50.0, "mains 50 Hz"}}};
  analysis.frequency.lines = analysis.frequency.spectral.suspicious_lines;
  analysis.frequency.counted = {5.4321, 0.0123, Interval{5.408, 5.4562}, ""};
  analysis.cycles.count = 4;
  analysis.cycles.minor = 1;
  analysis.cycles.used = 3;
  analysis.cycles.period_s = 0.1841;
  analysis.cycles.peak_force = 6.25;
  analysis.cycles.peak_force_sd = 0.0625;
  analysis.cycle_table = {{0.1, 0.12, 6.0, 3.0, true, 0.099, 0.121, 5.9, 4.0, 0.02, 0.2},
                          {0.3, 0.32, 6.5, 3.5, false, std::nullopt, std::nullopt, std::nullopt, std::nullopt, {}, {}}};
  analysis.fit = example_fit();
  analysis.derived.lambda = {4.0, 0.1, Interval{3.8, 4.2}, ""};
  analysis.derived.regime = slipfit::Regime::StickSlipBistable;
  analysis.derived.pattern_spacing_m = {0.0018409, 4.2e-6, Interval{0.0018327, 0.0018491}, ""};
  analysis.derived.periodic_displacement_m = {0.00184, 5e-6, Interval{0.00183, 0.00185}, ""};
  analysis.derived.pattern_spacing_sd_m = 2.5e-5;
  analysis.timing = {0.1, 0.2, 0.3, 0.7};
  return analysis;
}

}  // namespace test
