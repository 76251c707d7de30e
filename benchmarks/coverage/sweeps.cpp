#include "sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "slipfit/model/simulation.hpp"
#include "support/velocity_motion.hpp"

namespace coverage {
namespace {

using Random = std::mt19937_64;

constexpr std::size_t kSpeeds = 5;
constexpr double kLargest = 20000.0;  // samples

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double log_uniform(Random& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

/// Of one recording.
struct Size {
  double cycles, samples_per_half_period;
};

/// What disturbs the recordings of a sweep.
struct Disturbance {
  double scatter_N, noise_N;
};

/// From the second cycle on, or from when the motion that does not stick has decayed.
slipfit::Recording record(const Sweep& sweep, double speed_m_per_s, const Size& size, const Disturbance& disturbance,
                          std::uint64_t seed) {
  const double omega = sweep.slider.natural_frequency_rad_per_s();
  const auto spacing_m = sweep.spacing_m(speed_m_per_s);
  const double ramp_s = sweep.friction.static_N() / (sweep.slider.stiffness_N_per_m() * speed_m_per_s);
  slipfit::SimulationOptions options;
  double begin_s = ramp_s + 10.0 / (omega * sweep.slider.damping_ratio());
  double step_s = 0.05 / omega;
  double length_s = 2000.0 * step_s;
  if (spacing_m) {
    const double period_s = *spacing_m / speed_m_per_s;
    begin_s = ramp_s + 0.63 * period_s;
    length_s = period_s * size.cycles;
    step_s = std::max(std::numbers::pi / omega / size.samples_per_half_period, length_s / kLargest);
  }
  options.sample_rate_Hz = 1.0 / step_s;
  options.duration_s = begin_s + length_s;
  options.static_friction_sd_N = disturbance.scatter_N;
  options.noise_rms_N = disturbance.noise_N;
  options.seed = seed;
  const auto trace = slipfit::simulate(sweep.slider, sweep.friction, speed_m_per_s, options).value();
  const auto first = static_cast<std::ptrdiff_t>(begin_s / step_s);
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  return slipfit::Recording::create({trace.time_s.begin() + first, trace.time_s.end()},
                                    {trace.force_N.begin() + first, trace.force_N.end()}, conditions)
      .value();
}

}  // namespace

std::optional<double> Sweep::spacing_m(double speed_m_per_s) const {
  const auto motion = slipfit::velocity_motion(slider, friction, speed_m_per_s);
  if (!motion || !motion.value().motion.cycle) return std::nullopt;
  return motion.value().motion.cycle->periodic_displacement_m;
}

Sweep make_sweep(std::uint64_t seed) {
  Random random(seed);
  const double stiffness = log_uniform(random, 500.0, 2e4);
  const double omega = log_uniform(random, 50.0, 4e3);
  const auto slider = slipfit::Slider::create(stiffness, omega, log_uniform(random, 0.02, 0.12)).value();
  const double lambda = log_uniform(random, 20.0, 60.0);  // at the lowest speed
  const double slowest_m_per_s = log_uniform(random, 3e-4, 1e-2);
  const double impedance = stiffness / omega;
  const double difference_N = lambda * slowest_m_per_s * impedance;
  const double kinetic_N = difference_N * log_uniform(random, 1.5, 8.0);
  const double bend = log_uniform(random, 0.3, 3.0);
  const bool falls = seed % 3 != 2;
  const double alpha = (falls ? -bend : 0.1 * bend) * impedance / difference_N;
  const double f1_N = falls ? difference_N * uniform(random, 0.15, 0.6)
                            : std::min(0.3 * kinetic_N, difference_N * log_uniform(random, 0.5, 2.0));
  const double scatter_N = seed % 2 == 1 ? difference_N * uniform(random, 0.005, 0.03) : 0.0;
  const Disturbance disturbance{scatter_N, difference_N * log_uniform(random, 0.002, 0.02)};
  Sweep sweep{seed,
              slider,
              slipfit::VelocityFriction::create(kinetic_N + difference_N, kinetic_N - f1_N, f1_N, alpha).value(),
              {}};
  for (std::size_t i = 0; i < kSpeeds; ++i) {
    const double speed_m_per_s = slowest_m_per_s * std::pow(2.0, static_cast<double>(i));
    const Size size{uniform(random, 12.0, 30.0), uniform(random, 15.0, 40.0)};
    sweep.entries.push_back({"v" + std::to_string(i), record(sweep, speed_m_per_s, size, disturbance, random())});
  }
  return sweep;
}

}  // namespace coverage
