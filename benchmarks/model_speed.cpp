// Speed of the model layer and of whole analyses (Google Benchmark). docs/validation.md quotes what it prints.

#include <benchmark/benchmark.h>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "fit/law/coulomb.hpp"
#include "fit/law/slip_weakening.hpp"
#include "model/reloading.hpp"
#include "model/velocity_slip.hpp"
#include "predict/draws.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/paper.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/predict/prediction.hpp"
#include "support/sensitivity.hpp"
#include "support/velocity_motion.hpp"
#include "usual_recording.hpp"

namespace {

using namespace slipfit;

struct Scene {
  Slider slider;
  Friction friction;
};

/// lambda 2 to 200, zeta 0.005 to 0.12: laboratory rubber and the paper's figures; the paper's equations have a root in
/// all.
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

struct VelocityScene {
  Slider slider;
  VelocityFriction friction;
};

/// The same lambda and zeta, friction that falls by up to 5 k V / w_n at speeds between V / 3 and 20 V.
std::vector<VelocityScene> velocity_scenes() {
  std::mt19937_64 random(7);
  std::vector<VelocityScene> result;
  for (const Scene& scene : scenes()) {
    const double f1_N = std::uniform_real_distribution<double>(0.0, 5.0)(random);
    const double alpha = -std::exp(std::uniform_real_distribution<double>(std::log(0.05), std::log(3.0))(random));
    result.push_back(
        {scene.slider, VelocityFriction::create(f1_N + scene.friction.static_N(), 0.0, f1_N, alpha).value()});
  }
  return result;
}

template <class Solve>
void over_velocity_scenes(benchmark::State& state, const Solve& solve) {
  const std::vector<VelocityScene> all = velocity_scenes();
  std::size_t i = 0;
  for (auto _ : state) {
    const VelocityScene& scene = all[i++ % all.size()];
    benchmark::DoNotOptimize(solve(scene));
  }
}

void velocity_cycle(benchmark::State& state) {
  over_velocity_scenes(state, [](const VelocityScene& s) { return velocity_motion(s.slider, s.friction, 1.0); });
}
void velocity_cycle_with_derivatives(benchmark::State& state) {
  over_velocity_scenes(state, [](const VelocityScene& s) { return velocity_derivatives(s.slider, s.friction, 1.0); });
}

std::optional<model::VelocityTrack> track_of(const VelocityScene& s) {
  const double zeta = s.slider.damping_ratio();
  const double lambda = s.friction.static_N() - s.friction.onset_N();
  const double rate = s.friction.alpha_s_per_m();
  return model::VelocityTrack::solve(lambda - 2.0 * zeta, zeta, s.friction.f1_N() * rate, rate);
}
void velocity_track_solved(benchmark::State& state) {
  over_velocity_scenes(state, track_of);
}
/// One sample of a slip of which all derivatives are asked.
void velocity_track_sample(benchmark::State& state) {
  const auto track = track_of(velocity_scenes().front());
  const double step = track->tau_end() / 1000.0;
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(track->at(step * static_cast<double>(++i % 1000)));
}

// The slips of the fit, as an instrument shows them, with their derivatives. Of a slip of lambda 20 and zeta 0.05 one
// cycle is solved, or one sample is asked at even steps; an average is 2 / w_n long, the slip distance 0.2 of
// (F_s - F_k) / k.
constexpr double kLambda = 20.0;
constexpr double kZeta = 0.05;

fit::Sensor averaging(double average_tau) {
  fit::Sensor sensor;
  sensor.average_tau = average_tau;
  return sensor;
}
fit::CoulombCycle coulomb_cycle(double average_tau) {
  return {kLambda - 2.0 * kZeta, kZeta, averaging(average_tau), ForceView::Spring};
}
fit::WeakeningCycle weakening_cycle(double average_tau) {
  fit::Scales scales;
  scales.speed_m_per_s = 1.0;
  scales.slip_distance_m = kLambda;  // (F_s - F_k) / k in units of V / w_n
  scales.sensor_average_s = average_tau;
  fit::Coordinates values = fit::oscillator(0.0, 0.0, kZeta);
  values(fit::kSlipDistance) = std::sqrt(0.2);
  return *fit::WeakeningCycle::solve(kLambda - 2.0 * kZeta, 1.0, values, {0.0, scales.sensor_average_s}, scales);
}

void coulomb_solved(benchmark::State& state) {
  const auto average_tau = static_cast<double>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(coulomb_cycle(average_tau));
}
void weakening_solved(benchmark::State& state) {
  const auto average_tau = static_cast<double>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(weakening_cycle(average_tau));
}

/// A thousand samples from before the slip to after it.
template <class Cycle>
void over_samples(benchmark::State& state, const Cycle& cycle) {
  constexpr int kCount = 1000;
  const double step = 1.5 * cycle.tau_end() / kCount;
  for (auto _ : state) {
    typename Cycle::Samples samples(cycle, step);
    for (int i = 0; i < kCount; ++i) benchmark::DoNotOptimize(samples.at(step * i - 0.25 * cycle.tau_end()));
  }
  state.counters["per_sample"] = benchmark::Counter(kCount * static_cast<double>(state.iterations()),
                                                    benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
void coulomb_sample(benchmark::State& state) {
  over_samples(state, coulomb_cycle(static_cast<double>(state.range(0))));
}
void weakening_sample(benchmark::State& state) {
  over_samples(state, weakening_cycle(static_cast<double>(state.range(0))));
}

/// The stick whose first part is steeper, with its derivatives.
void reloaded_stick(benchmark::State& state) {
  using Jet = ceres::Jet<double, 3>;
  const Jet drop_m(2.0, 0);
  const Jet rise_m(0.4, 1);
  const Jet length_m(0.6, 2);
  for (auto _ : state) benchmark::DoNotOptimize(model::reloaded_stick_m(drop_m, rise_m, length_m));
}

/// The limit cycle at one speed, with its derivatives: 1: static friction is that of a stick of its own length.
void limit_cycle(benchmark::State& state) {
  ModelEstimate model =
      stated_model(Slider::create(1000.0, 1.0, kZeta).value(), Friction::create(3.0, 2.0).value()).estimate;
  if (state.range(0) == 1) model.ageing = Ageing{0.05, 1.0, 0.1};
  for (auto _ : state) benchmark::DoNotOptimize(predict::motion_at(model, 1e-3));
}

/// Quality, slips, frequency, all Coulomb tiers, kind of motion; 400 samples a cycle.
void analysis_and_fit(benchmark::State& state) {
  const Recording recording = usual_recording(static_cast<double>(state.range(0)), 400.0);
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

BENCHMARK(analysis_and_fit)->Arg(50)->Arg(200)->Arg(1000)->Arg(5000)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(coulomb_solved)->Arg(0)->Arg(2);
BENCHMARK(coulomb_sample)->Arg(0)->Arg(2);
BENCHMARK(weakening_solved)->Arg(0)->Arg(2);
BENCHMARK(weakening_sample)->Arg(0)->Arg(2);
BENCHMARK(reloaded_stick);
BENCHMARK(limit_cycle)->Arg(0)->Arg(1);
BENCHMARK(exact_cycle);
BENCHMARK(paper_approximation);
BENCHMARK(exact_cycle_with_derivatives);
BENCHMARK(velocity_cycle);
BENCHMARK(velocity_cycle_with_derivatives);
BENCHMARK(velocity_track_solved);
BENCHMARK(velocity_track_sample);

}  // namespace

BENCHMARK_MAIN();
