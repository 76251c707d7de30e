// Speed of the model layer (Google Benchmark). docs/accuracy.md quotes what it prints.

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "slipfit/model/motion.hpp"
#include "slipfit/model/paper.hpp"
#include "slipfit/model/sensitivity.hpp"
#include "slipfit/model/waveform.hpp"

namespace {

using namespace slipfit;

struct Scene {
  Slider slider;
  Friction friction;
};

/// lambda 2 to 200, zeta 0.005 to 0.12: laboratory rubber and the paper's figures; the paper's equations have a root in all.
std::vector<Scene> scenes() {
  std::mt19937_64 random(5);
  std::vector<Scene> result;
  while (result.size() < 4096) {
    const double zeta = std::uniform_real_distribution<double>(0.005, 0.12)(random);
    const double lambda = std::exp(std::uniform_real_distribution<double>(std::log(2.0), std::log(200.0))(random));
    result.push_back({Slider::create(1.0, 1.0, zeta).value(), Friction::create(lambda, 0.0).value()});
  }
  return result;
}

template <class Solve>
void over_scenes(benchmark::State& state, const Solve& solve) {
  const std::vector<Scene> all = scenes();
  std::size_t i = 0;
  for (auto _ : state) {
    const Scene& scene = all[i++ % all.size()];
    benchmark::DoNotOptimize(solve(scene));
  }
}

void exact_cycle(benchmark::State& state) {
  over_scenes(state, [](const Scene& s) { return damped_motion(s.slider, s.friction, 1.0); });
}
void exact_cycle_with_derivatives(benchmark::State& state) {
  over_scenes(state, [](const Scene& s) { return damped_sensitivity(s.slider, s.friction, 1.0); });
}
void paper_approximation(benchmark::State& state) {
  over_scenes(state, [](const Scene& s) { return paper_cycle(s.slider, s.friction, 1.0); });
}

constexpr std::size_t kSamples = 100000;

Scene waveform_scene(benchmark::State& state) {
  return {Slider::create(1.0, 1.0, 0.05).value(), Friction::create(static_cast<double>(state.range(0)), 0.0).value()};
}
void count_samples(benchmark::State& state) {
  state.counters["per_sample"] = benchmark::Counter(
      static_cast<double>(kSamples) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void waveform(benchmark::State& state) {
  const Scene s = waveform_scene(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(damped_waveform(s.slider, s.friction, 1.0, ForceView::Spring, {0.0, 0.1, kSamples}));
  }
  count_samples(state);
}
void waveform_with_derivatives(benchmark::State& state) {
  const Scene s = waveform_scene(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(damped_waveform_sensitivity(s.slider, s.friction, 1.0, {0.0, 0.1, kSamples}));
  }
  count_samples(state);
}

BENCHMARK(exact_cycle);
BENCHMARK(paper_approximation);
BENCHMARK(exact_cycle_with_derivatives);
BENCHMARK(waveform)->Arg(2)->Arg(20);
BENCHMARK(waveform_with_derivatives)->Arg(2)->Arg(20);

}  // namespace

BENCHMARK_MAIN();
