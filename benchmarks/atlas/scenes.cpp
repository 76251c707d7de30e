#include "scenes.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "simulator.hpp"
#include "slipfit/model/simulation.hpp"

namespace atlas {
namespace {

constexpr double kLambda = 10.0;
constexpr double kZeta = 0.05;
constexpr double kStiffness_N_per_m = 5000.0;
constexpr double kDifference_N = 1.0;
constexpr double kUsualFrequency_Hz = 17.3;

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1.0p-53;
}

/// What slides.
struct Contact {
  slipfit::Slider slider;
  slipfit::Friction friction;
  double speed_m_per_s = 0.0;
};

/// How it is sampled.
struct Sampling {
  double rate_Hz = 0.0;
  double duration_s = 0.0;
  double sliding_s = 0.0;  ///< of it, that the recording holds
  std::uint64_t noise_seed = 0;
};

struct Trace {
  std::vector<double> time_s, force_N;
};

Trace simulated(const Factors& factors, const Contact& contact, const Sampling& sampling) {
  slipfit::SimulationOptions options;
  options.sample_rate_Hz = sampling.rate_Hz;
  options.duration_s = sampling.duration_s;
  options.static_friction_sd_N = factors.jitter * kDifference_N;
  options.noise_rms_N = factors.noise * kDifference_N;
  options.drift_N_per_s = factors.drift * kDifference_N / sampling.sliding_s;
  options.hum_N = factors.hum * kDifference_N;
  options.seed = sampling.noise_seed;
  slipfit::SimulatedTrace trace = slipfit::simulate(contact.slider, contact.friction, contact.speed_m_per_s, options);
  return {std::move(trace.time_s), std::move(trace.force_N)};
}

/// Means of a force that is a straight line between even steps from time 0 on.
class Averaged {
 public:
  Averaged(std::vector<double> force_N, double step_s) : force_N_(std::move(force_N)), step_s_(step_s) {
    integral_Ns_.reserve(force_N_.size());
    integral_Ns_.push_back(0.0);
    for (std::size_t i = 1; i < force_N_.size(); ++i) {
      integral_Ns_.push_back(integral_Ns_.back() + 0.5 * step_s_ * (force_N_[i - 1] + force_N_[i]));
    }
  }
  /// Over `width_s` around a time, as far as there is a force; the force itself where the width is 0.
  [[nodiscard]] double mean_N(double time_s, double width_s) const {
    const double from_s = std::max(0.0, time_s - 0.5 * width_s);
    const double to_s = time_s + 0.5 * width_s;
    return width_s > 0.0 ? (integral_at(to_s) - integral_at(from_s)) / width_s : force_at(time_s);
  }

 private:
  [[nodiscard]] std::size_t before(double time_s) const {
    return std::min(static_cast<std::size_t>(time_s / step_s_), force_N_.size() - 2);
  }
  [[nodiscard]] double force_at(double time_s) const {
    const std::size_t i = before(time_s);
    return force_N_[i] + (time_s / step_s_ - static_cast<double>(i)) * (force_N_[i + 1] - force_N_[i]);
  }
  [[nodiscard]] double integral_at(double time_s) const {
    const std::size_t i = before(time_s);
    const double since_s = time_s - static_cast<double>(i) * step_s_;
    return integral_Ns_[i] + 0.5 * since_s * (force_N_[i] + force_at(time_s));
  }

  std::vector<double> force_N_, integral_Ns_;
  double step_s_;
};

/// Of the independent simulator: an average of the sensor, and friction that falls over a slip distance. Begins at a
/// stick without force, as `simulated` does.
Trace bent(const Factors& factors, const Contact& contact, const Sampling& sampling) {
  const double omega = contact.slider.natural_frequency_rad_per_s();
  const double average_s = factors.average / omega;
  const auto count = static_cast<std::size_t>(sampling.duration_s * sampling.rate_Hz);
  const double sample_s = 1.0 / sampling.rate_Hz;
  const auto fine =
      static_cast<std::size_t>(std::ceil(sample_s * omega / 0.01));  // steps of the simulation in a sample
  const auto steps = count * fine + static_cast<std::size_t>(std::ceil(0.5 * average_s / sample_s)) * fine + 1;
  independent::Model model{};
  model.stiffness = kStiffness_N_per_m;
  model.omega = omega;
  model.damping_ratio = contact.slider.damping_ratio();
  model.weakening_length = factors.weakening * kDifference_N / kStiffness_N_per_m;
  const std::vector<double> speed(steps, contact.speed_m_per_s), static_N(steps, contact.friction.static_N());
  const std::vector<double> kinetic_N(steps, contact.friction.kinetic_N());
  std::vector<double> force_N(steps), behind_m(steps);
  std::vector<independent::Slip> slips(5000);
  const double one = 1.0;
  const double step_s = sample_s / static_cast<double>(fine);
  const independent::Course course{
      speed.data(), static_N.data(), kinetic_N.data(), &one, static_cast<long>(steps), 1, step_s, 2};
  independent::simulate(&model, &course, 0.0, force_N.data(), behind_m.data(), slips.data(),
                        static_cast<long>(slips.size()));
  const Averaged seen(std::move(force_N), step_s);
  std::mt19937_64 random(sampling.noise_seed);
  std::normal_distribution<double> noise_N(0.0, factors.noise * kDifference_N);
  Trace trace;
  for (std::size_t i = 0; i < count; ++i) {
    trace.time_s.push_back(static_cast<double>(i) * sample_s);
    trace.force_N.push_back(seen.mean_N(trace.time_s.back(), average_s) + noise_N(random));
  }
  return trace;
}

}  // namespace

Scene make_scene(const Factors& factors, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto usual = slipfit::damped_motion(slipfit::Slider::create(1.0, 1.0, kZeta).value(),
                                            slipfit::Friction::create(kLambda, 0.0).value(), 1.0);
  const double omega = usual.cycle->period_s * kUsualFrequency_Hz * uniform(random, 0.95, 1.05);
  const auto slider = slipfit::Slider::create(kStiffness_N_per_m, omega, kZeta).value();
  const auto friction = slipfit::Friction::create(3.0 * kDifference_N, 2.0 * kDifference_N).value();
  const double speed_m_per_s = factors.speedup * omega * kDifference_N / (kStiffness_N_per_m * kLambda);
  const slipfit::LimitCycle cycle = *slipfit::damped_motion(slider, friction, speed_m_per_s).cycle;

  const double first_onset_s = (friction.static_N() / kStiffness_N_per_m) / speed_m_per_s;
  const double begin_s = first_onset_s + cycle.period_s * uniform(random, 0.1, 1.1);
  const double sliding_s = factors.cycles * cycle.period_s;
  // Recordings of one seed at several speeds share the body, not the noise.
  const Sampling sampling{factors.samples_per_slip / cycle.slip_s, begin_s + sliding_s, sliding_s,
                          64 * seed + static_cast<std::uint64_t>(8.0 * factors.speedup)};
  const bool is_bent = factors.average > 0.0 || factors.weakening > 0.0;
  const Contact contact{slider, friction, speed_m_per_s};
  const Trace trace = is_bent ? bent(factors, contact, sampling) : simulated(factors, contact, sampling);
  std::size_t first = 0;
  while (trace.time_s[first] < begin_s) ++first;
  std::vector<double> time_s, force_N(trace.force_N.begin() + static_cast<std::ptrdiff_t>(first), trace.force_N.end());
  for (std::size_t i = first; i < trace.time_s.size(); ++i) time_s.push_back(trace.time_s[i] - trace.time_s[first]);
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  auto recording = slipfit::Recording::create(std::move(time_s), std::move(force_N), conditions);
  const double onset_s = first_onset_s - 2.0 * kZeta / omega;  // F_s - cV
  return {std::move(recording).value(),
          slider,
          friction,
          cycle,
          factors.noise * kDifference_N,
          std::fmod(trace.time_s[first] - onset_s, cycle.period_s)};
}

double period_by_friction(const Scene& scene) {
  constexpr double kStep = 1e-4;
  const double speed_m_per_s = scene.recording.conditions().speed_m_per_s;
  const double difference_N = scene.friction.difference_N();
  const auto changed =
      slipfit::Friction::create(scene.friction.static_N() + kStep * difference_N, scene.friction.kinetic_N());
  const slipfit::Motion motion = slipfit::damped_motion(scene.slider, changed.value(), speed_m_per_s);
  return (motion.cycle->period_s / scene.cycle.period_s - 1.0) / kStep;
}

}  // namespace atlas
