#include <cstdio>
#include <slipfit/slipfit.hpp>

// Simulate, analyse, report: touches every layer of the installed library.
int main() {
  const auto slider = slipfit::Slider::create(1000.0, 200.0, 0.05);
  const auto friction = slipfit::Friction::create(6.0, 4.0);
  if (!slider || !friction) return 1;

  const slipfit::SimulationOptions options{.duration_s = 3.0, .noise_rms_N = 0.02};
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = 0.02;
  auto trace = slipfit::simulate(slider.value(), friction.value(), conditions.speed_m_per_s, options);
  const auto recording = slipfit::Recording::create(trace.time_s, trace.force_N, conditions);
  if (!recording) return 1;

  const slipfit::Analysis analysis = slipfit::analyze_and_fit(recording.value());
  std::fputs(slipfit::to_text(recording.value(), analysis).c_str(), stdout);
  const bool has_document = slipfit::to_json(recording.value(), analysis).front() == '{';
  return has_document && analysis.motion == slipfit::MotionClass::StickSlip ? 0 : 1;
}
