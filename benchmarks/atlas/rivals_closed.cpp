#include <cmath>
#include <numbers>

#include "model/slip.hpp"
#include "model/velocity_slip.hpp"
#include "rivals.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/paper.hpp"
#include "support/waveform.hpp"

namespace atlas {
namespace {

using slipfit::Friction;
using slipfit::Slider;

/// When z of eq. (2), docs/model.md, first falls through 0.
double fall_time(double z0, double zeta) {
  const double b = std::sqrt(1.0 - zeta * zeta);
  return (std::numbers::pi - std::atan(b * z0 / (1.0 + zeta * z0))) / b;
}

Answer coulomb(double lambda, double zeta, const WaveTimes& times) {
  const auto slider = Slider::create(1.0, 1.0, zeta);
  const auto friction = Friction::create(lambda, 0.0);
  if (!slider || !friction) return {};
  const slipfit::Motion motion = slipfit::damped_motion(slider.value(), friction.value(), 1.0);
  if (!motion.cycle) return {Outcome::NoCycle, 0.0, {}};
  const slipfit::SampleTimes samples{fall_time(lambda - 2.0 * zeta, zeta), times.step, times.count};
  auto z = slipfit::damped_waveform(slider.value(), friction.value(), 1.0, slipfit::ForceView::Spring, samples);
  return {Outcome::Cycle, motion.cycle->period_s, std::move(*z)};
}

/// Samples of a slip that starts at 0, ends at `slip`, and repeats.
template <class Wave>
std::vector<double> repeat(const WaveTimes& times, double begin, double period, const Wave& wave) {
  std::vector<double> z;
  z.reserve(times.count);
  for (std::size_t i = 0; i < times.count; ++i) {
    z.push_back(wave(std::fmod(begin + times.step * static_cast<double>(i), period)));
  }
  return z;
}

}  // namespace

Answer run_sawtooth(const ForwardScene& scene, const WaveTimes& times) {
  const double period = 2.0 * scene.lambda;
  const auto ramp = [&](double tau) { return tau - scene.lambda; };
  return {Outcome::Cycle, period, repeat(times, 0.0, period, ramp)};
}

Answer run_undamped(const ForwardScene& scene, const WaveTimes& times) {
  return coulomb(scene.lambda, 0.0, times);
}

Answer run_damped(const ForwardScene& scene, const WaveTimes& times) {
  return coulomb(scene.lambda, scene.zeta, times);
}

Answer run_paper(const ForwardScene& scene, const WaveTimes& times) {
  const auto slider = Slider::create(1.0, 1.0, scene.zeta);
  const auto friction = Friction::create(scene.lambda, 0.0);
  if (!slider || !friction) return {};
  const auto cycle = slipfit::paper_cycle(slider.value(), friction.value(), 1.0);
  if (!cycle) return {};  // says so: no_solution
  const double z0 = scene.lambda - 2.0 * scene.zeta;
  const double slip = cycle.value().slip_s;
  const double period = cycle.value().displacement_corrected_m;
  const auto wave = [&](double tau) {
    return tau < slip ? slipfit::model::slip_point(z0, scene.zeta, tau).z : -cycle.value().lambda_d + tau - slip;
  };
  return {Outcome::Cycle, period, repeat(times, fall_time(z0, scene.zeta), period, wave)};
}

Answer run_velocity(const ForwardScene& scene, const WaveTimes& times) {
  const double z0 = scene.lambda - 2.0 * scene.zeta;
  const auto track = slipfit::model::VelocityTrack::solve(z0, scene.zeta, scene.slope, scene.rate);
  if (!track) return {};
  if (!track->resticks()) return {Outcome::NoCycle, 0.0, {}};
  double fall = fall_time(z0, scene.zeta);
  for (int i = 0; i < 6; ++i) {  // Newton's steps from the Coulomb fall
    const auto at = track->at(fall);
    fall -= at.z / at.d_tau;
  }
  const double period = z0 - track->after().value;
  return {Outcome::Cycle, period, repeat(times, fall, period, [&](double tau) { return track->at(tau).z; })};
}

}  // namespace atlas
