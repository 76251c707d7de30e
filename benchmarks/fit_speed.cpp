// Speed of a whole analysis after reading (Google Benchmark): quality, slips, frequency, all Coulomb tiers, kind of
// motion. docs/validation.md quotes what it prints.

#include <benchmark/benchmark.h>

#include <utility>

#include "slipfit/model/simulation.hpp"
#include "slipfit/pipeline.hpp"

namespace {

using namespace slipfit;

/// Scattering static friction, noise of 1 % of F_s - F_k, 400 samples a cycle.
Recording recording_of(double cycles) {
  const auto slider = Slider::create(5000.0, 900.0, 0.05).value();
  const auto friction = Friction::create(4.0, 3.0).value();
  const double speed_m_per_s = 0.01;
  const double period_s = damped_motion(slider, friction, speed_m_per_s).cycle->period_s;
  SimulationOptions options;
  options.duration_s = period_s * cycles;
  options.sample_rate_Hz = 400.0 / period_s;
  options.static_friction_sd_N = 0.05;
  options.noise_rms_N = 0.01;
  SimulatedTrace trace = simulate(slider, friction, speed_m_per_s, options);
  Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  return Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions).value();
}

void analyse_and_fit(benchmark::State& state) {
  const Recording recording = recording_of(static_cast<double>(state.range(0)));
  double fit_s = 0.0;
  for (auto _ : state) {
    const Analysis analysis = analyze_and_fit(recording);
    fit_s += analysis.timing.fit_s;
    benchmark::DoNotOptimize(&analysis);
  }
  state.counters["fit_ms"] = 1e3 * fit_s / static_cast<double>(state.iterations());
  state.counters["us_per_cycle"] =
      benchmark::Counter(static_cast<double>(state.range(0)) * 1e-6,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(analyse_and_fit)->Arg(50)->Arg(200)->Arg(1000)->Arg(5000)->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
