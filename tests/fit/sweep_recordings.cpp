#include "sweep_recordings.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

#include "model/velocity_slip.hpp"

namespace test {
namespace {

using slipfit::model::VelocityTrack;

double force_scale_N(const SweepScene& s, double speed_m_per_s) {
  return s.stiffness_N_per_m * speed_m_per_s / s.natural_frequency_rad_per_s;
}

/// Onset above F_k(0+), scaled: F_s - cV. The difference is F_s - F_k(0+).
double scaled_onset(const SweepScene& s, double speed_m_per_s, double difference_N) {
  return difference_N / force_scale_N(s, speed_m_per_s) - 2.0 * s.damping_ratio;
}

VelocityTrack slip_of(const SweepScene& s, double speed_m_per_s, double difference_N) {
  const double slope = s.f1_N * s.alpha_s_per_m * s.natural_frequency_rad_per_s / s.stiffness_N_per_m;
  auto track = VelocityTrack::solve(scaled_onset(s, speed_m_per_s, difference_N), s.damping_ratio,
                                    {slope, s.alpha_s_per_m * speed_m_per_s, s.law});
  if (!track || !track->resticks()) throw std::runtime_error("the scene has no stick-slip");
  return *track;
}

/// Running means of so many values.
std::vector<double> averaged(std::vector<double> values, std::size_t count) {
  if (count == 1) return values;
  std::vector<double> means;
  for (std::size_t i = 0; i + count <= values.size(); ++i) {
    double sum = 0.0;
    for (std::size_t j = i; j < i + count; ++j) sum += values[j];
    means.push_back(sum / static_cast<double>(count));
  }
  return means;
}

/// Through a sensor of first order: exact for a force that is straight between the samples and before the first.
std::vector<double> lagged(std::vector<double> values, double step_over_lag) {
  const double decay = std::exp(-step_over_lag);
  const double share = (1.0 - decay) / step_over_lag;
  double before = values[0];
  double shown = values[0] - (values[1] - values[0]) / step_over_lag;
  for (double& value : values) {
    shown = decay * shown + (1.0 - share) * value + (share - decay) * before;
    before = std::exchange(value, shown);
  }
  return values;
}

slipfit::Recording record(const SweepScene& s, double speed_m_per_s, double offset_N, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::mt19937_64 level_random(seed + 1000);  // of their own: scenes without them keep their noise
  std::normal_distribution<double> level_normal;
  const double omega = s.natural_frequency_rad_per_s;
  const double period_s = s.spacing_m(speed_m_per_s) / speed_m_per_s;
  const double step_s = 3.14159 / omega / s.samples_per_half_period;
  std::vector<double> time_s;
  std::vector<double> force_N;
  std::vector<double> noise_N;
  double onset_s = 0.4 * period_s;
  double level_N = s.kinetic_friction_N();
  VelocityTrack slip = slip_of(s, speed_m_per_s, s.static_friction_N - level_N);
  double t = 0.0;
  while (t < s.cycles * period_s) {
    const double next_N = s.static_friction_N + s.scatter_N * normal(random);
    const double next_s = onset_s + (scaled_onset(s, speed_m_per_s, next_N - level_N) - slip.after().value) / omega;
    for (; t < next_s; t += step_s) {
      time_s.push_back(t);
      const slipfit::model::TrackPoint point = slip.at(omega * (t - onset_s));
      const double drag = s.view == slipfit::ForceView::Transmitted ? 2.0 * s.damping_ratio * point.d_tau : 0.0;
      force_N.push_back(level_N + force_scale_N(s, speed_m_per_s) * (point.z + drag) + offset_N);
      noise_N.push_back(s.noise_N * normal(random));
    }
    onset_s = next_s;
    level_N = s.kinetic_friction_N() + s.level_scatter_N * level_normal(level_random);
    slip = slip_of(s, speed_m_per_s, next_N - level_N);
  }
  if (s.lag_s > 0.0) force_N = lagged(std::move(force_N), step_s / s.lag_s);
  force_N = averaged(std::move(force_N), s.averaged);
  time_s = averaged(std::move(time_s), s.averaged);
  for (std::size_t i = 0; i < force_N.size(); ++i) force_N[i] += noise_N[i];
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  conditions.force_view = s.view;
  if (s.lag_s > 0.0) conditions.sensor_bandwidth_Hz = 1.0 / (2.0 * std::numbers::pi * s.lag_s);
  conditions.normal_force_N = s.normal_force_N;
  if (s.normal_force_N) conditions.zero_force_N = 0.0;
  return slipfit::Recording::create(std::move(time_s), std::move(force_N), conditions).value();
}

}  // namespace

double SweepScene::spacing_m(double speed_m_per_s) const {
  const VelocityTrack slip = slip_of(*this, speed_m_per_s, static_friction_N - kinetic_friction_N());
  return speed_m_per_s *
         (scaled_onset(*this, speed_m_per_s, static_friction_N - kinetic_friction_N()) - slip.after().value) /
         natural_frequency_rad_per_s;
}

std::vector<slipfit::SweepEntry> record_sweep(const SweepScene& scene, const std::vector<double>& speeds_m_per_s) {
  std::vector<slipfit::SweepEntry> entries;
  for (std::size_t i = 0; i < speeds_m_per_s.size(); ++i) {
    entries.push_back({"v" + std::to_string(i),
                       record(scene, speeds_m_per_s[i], static_cast<double>(i) * scene.offset_N, scene.seed + i)});
  }
  return entries;
}

}  // namespace test
