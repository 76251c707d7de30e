#include "sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "model/velocity_slip.hpp"

namespace sweep_coverage {
namespace {

using slipfit::model::VelocityTrack;
using Random = std::mt19937_64;

constexpr std::size_t kSpeeds = 5;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double log_uniform(Random& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

/// One speed of a sweep: the scaled slip and its force scale.
struct Drive {
  const Truth& truth;
  double speed_m_per_s;

  [[nodiscard]] double force_scale_N() const {
    return truth.stiffness_N_per_m * speed_m_per_s / truth.natural_frequency_rad_per_s;
  }
  /// Spring force above F_k(0+) at which the slip starts: F_s - cV - F_k(0+).
  [[nodiscard]] double onset_N(double static_friction_N) const {
    return static_friction_N - 2.0 * truth.damping_ratio * force_scale_N() - truth.kinetic_friction_N();
  }
  [[nodiscard]] std::optional<VelocityTrack> slip(double static_friction_N) const {
    const double slope = truth.f1_N * truth.alpha_s_per_m;
    return VelocityTrack::solve(onset_N(static_friction_N) / force_scale_N(), truth.damping_ratio,
                                slope * truth.natural_frequency_rad_per_s / truth.stiffness_N_per_m,
                                truth.alpha_s_per_m * speed_m_per_s);
  }
};

struct Trace {
  std::vector<double> time_s, force_N;
};

Trace steady_trace(const Truth& truth, double speed_m_per_s, double noise_N, Random& random) {
  constexpr std::size_t kSamples = 2000;
  std::normal_distribution<double> normal;
  const double force_N = truth.f0_N + truth.f1_N * std::exp(truth.alpha_s_per_m * speed_m_per_s);
  Trace trace;
  for (std::size_t i = 0; i < kSamples; ++i) {
    trace.time_s.push_back(static_cast<double>(i) * 0.05 / truth.natural_frequency_rad_per_s);
    trace.force_N.push_back(force_N + noise_N * normal(random));
  }
  return trace;
}

Trace stick_slip_trace(const Drive& drive, const Size& size, double noise_N, Random& random) {
  const Truth& truth = drive.truth;
  const double omega = truth.natural_frequency_rad_per_s;
  const double u = drive.force_scale_N();
  const double period_s = *truth.spacing_m(drive.speed_m_per_s) / drive.speed_m_per_s;
  const double step_s = std::max(3.14159 / omega / size.samples_per_half_period,
                                 period_s * size.cycles / static_cast<double>(size.largest));
  std::normal_distribution<double> normal;
  Trace trace;
  double onset_s = 0.37 * period_s;
  const double end_s = onset_s + period_s * size.cycles;
  std::optional<VelocityTrack> slip = drive.slip(truth.static_friction_N);
  double time_s = 0.0;
  while (slip && slip->resticks() && time_s < end_s) {
    const double next_N = truth.static_friction_N + truth.scatter_N * normal(random);
    const double next_s = onset_s + (drive.onset_N(next_N) / u - slip->after().value) / omega;
    for (; time_s < std::min(next_s, end_s); time_s += step_s) {
      trace.time_s.push_back(time_s);
      const double z = slip->at(omega * (time_s - onset_s)).z;
      trace.force_N.push_back(truth.kinetic_friction_N() + u * z + noise_N * normal(random));
    }
    onset_s = next_s;
    slip = drive.slip(next_N);
  }
  return trace;
}

}  // namespace

std::optional<double> Truth::spacing_m(double speed_m_per_s) const {
  const Drive drive{*this, speed_m_per_s};
  const std::optional<VelocityTrack> slip = drive.slip(static_friction_N);
  if (!slip || !slip->resticks()) return std::nullopt;
  return speed_m_per_s * (drive.onset_N(static_friction_N) / drive.force_scale_N() - slip->after().value) /
         natural_frequency_rad_per_s;
}

Sweep make_sweep(std::uint64_t seed, const std::optional<Size>& size) {
  Random random(seed);
  Sweep sweep;
  sweep.seed = seed;
  Truth& truth = sweep.truth;
  truth.stiffness_N_per_m = log_uniform(random, 500.0, 2e4);
  truth.natural_frequency_rad_per_s = log_uniform(random, 50.0, 4e3);
  truth.damping_ratio = log_uniform(random, 0.02, 0.12);
  const double lambda = log_uniform(random, 20.0, 60.0);  // at the lowest speed
  const double slowest_m_per_s = log_uniform(random, 3e-4, 1e-2);
  const double impedance = truth.stiffness_N_per_m / truth.natural_frequency_rad_per_s;
  const double difference_N = lambda * slowest_m_per_s * impedance;
  const double kinetic_N = difference_N * log_uniform(random, 1.5, 8.0);
  const double bend = log_uniform(random, 0.3, 3.0);
  const bool falls = seed % 3 != 2;
  truth.alpha_s_per_m = (falls ? -bend : 0.1 * bend) * impedance / difference_N;
  truth.f1_N = falls ? difference_N * uniform(random, 0.15, 0.6)
                     : std::min(0.3 * kinetic_N, difference_N * log_uniform(random, 0.5, 2.0));
  truth.f0_N = kinetic_N - truth.f1_N;
  truth.static_friction_N = kinetic_N + difference_N;
  truth.scatter_N = seed % 2 == 1 ? difference_N * uniform(random, 0.005, 0.03) : 0.0;
  const double noise_N = difference_N * log_uniform(random, 0.002, 0.02);
  for (std::size_t i = 0; i < kSpeeds; ++i) {
    const double speed_m_per_s = slowest_m_per_s * std::pow(2.0, static_cast<double>(i));
    const Size drawn = size.value_or(Size{uniform(random, 12.0, 30.0), uniform(random, 15.0, 40.0), 20000});
    Trace trace = truth.spacing_m(speed_m_per_s) ? stick_slip_trace({truth, speed_m_per_s}, drawn, noise_N, random)
                                                 : steady_trace(truth, speed_m_per_s, noise_N, random);
    slipfit::Conditions conditions;
    conditions.speed_m_per_s = speed_m_per_s;
    auto recording = slipfit::Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions);
    sweep.entries.push_back({"v" + std::to_string(i), std::move(recording).value()});
  }
  return sweep;
}

}  // namespace sweep_coverage
