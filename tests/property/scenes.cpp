#include "scenes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <utility>

#include "slipfit/model/simulation.hpp"

using namespace slipfit;

namespace test {
namespace {

/// Numbers that are the same with every standard library: its distributions are not.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) {
    constexpr double kSteps = 18446744073709551616.0;
    return low + (high - low) * static_cast<double>(generator_()) / kSteps;
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

 private:
  std::mt19937_64 generator_;
};

}  // namespace

Scene random_scene(std::uint64_t seed) {
  Dice dice(seed);
  const double stiffness_N_per_m = dice.log_uniform(300.0, 30000.0);
  const double omega_rad_per_s = dice.log_uniform(60.0, 2000.0);
  const double zeta = dice.uniform(0.02, 0.1);
  const double kinetic_N = dice.log_uniform(0.5, 20.0);
  const double difference_N = kinetic_N * dice.log_uniform(0.15, 0.8);
  const double lambda = dice.log_uniform(6.0, 60.0);
  const double speed_m_per_s = omega_rad_per_s * difference_N / (stiffness_N_per_m * lambda);
  const Slider slider = Slider::create(stiffness_N_per_m, omega_rad_per_s, zeta).value();
  const Friction friction = Friction::create(kinetic_N + difference_N, kinetic_N).value();
  const LimitCycle cycle = *damped_motion(slider, friction, speed_m_per_s).cycle;
  SimulationOptions options;
  options.duration_s = dice.uniform(30.0, 60.0) * cycle.period_s;
  options.sample_rate_Hz = dice.uniform(25.0, 60.0) / cycle.slip_s;
  options.noise_rms_N = dice.log_uniform(0.003, 0.02) * difference_N;
  options.static_friction_sd_N = dice.uniform(0.01, 0.06) * difference_N;
  options.seed = seed;
  SimulatedTrace trace = simulate(slider, friction, speed_m_per_s, options);
  Scene scene;
  scene.described = fmt::format(
      "seed {}: k {} N/m, w_n {} rad/s, zeta {}, F_k {} N, F_s - F_k {} N, V {} m/s, {} samples", seed,
      stiffness_N_per_m, omega_rad_per_s, zeta, kinetic_N, difference_N, speed_m_per_s, trace.time_s.size());
  scene.time_s = std::move(trace.time_s);
  scene.force_N = std::move(trace.force_N);
  scene.conditions.speed_m_per_s = speed_m_per_s;
  scene.conditions.zero_force_N = 0.0;
  return scene;
}

Analysis analyse(const Scene& scene) {
  return analyze_and_fit(Recording::create(scene.time_s, scene.force_N, scene.conditions).value());
}

}  // namespace test
