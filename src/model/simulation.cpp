#include "slipfit/model/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "model/slip.hpp"

namespace slipfit {
namespace {

/// Normal deviates by Box-Muller from a generator that the standard fixes (std::normal_distribution is not fixed).
class NormalDeviates {
 public:
  explicit NormalDeviates(std::uint64_t seed) : generator_(seed) {}

  double draw() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  /// In (0, 1], 53 bits.
  double uniform() { return (static_cast<double>(generator_() >> 11U) + 1.0) * 0x1.0p-53; }

  std::mt19937_64 generator_;
};

/// The exact motion, cycle after cycle: asked for the force at times that never decrease.
class SlidingBody {
 public:
  SlidingBody(const Slider& slider, const Friction& friction, double speed_m_per_s, const SimulationOptions& options)
      : slider_(slider),
        friction_(friction),
        options_(options),
        stiffness_rate_N_per_s_(slider.stiffness_N_per_m() * speed_m_per_s),
        force_scale_N_(stiffness_rate_N_per_s_ / slider.natural_frequency_rad_per_s()),
        scatter_(options.seed ^ 0x9e3779b97f4a7c15ULL) {
    plan_slip(0.0, 0.0);
  }

  double force_N(double time_s) {
    while (slip_.resticks && time_s > end_s_) plan_slip(end_s_, end_force_N_);
    if (time_s < onset_s_) return in_view(ramp_force_N_ + stiffness_rate_N_per_s_ * (time_s - ramp_s_), 1.0, true);
    const double tau = slider_.natural_frequency_rad_per_s() * (time_s - onset_s_);
    const auto point = model::slip_point(slip_.z0, slip_.zeta, tau);
    return in_view(friction_.kinetic_N() + force_scale_N_ * point.z, point.dz, false);
  }

 private:
  /// Stick from (time, force), then the slip that ends it.
  void plan_slip(double time_s, double force_N) {
    ramp_s_ = time_s;
    ramp_force_N_ = force_N;
    const double zeta = slider_.damping_ratio();
    const double static_N =
        std::max(friction_.kinetic_N(), friction_.static_N() + options_.static_friction_sd_N * scatter_.draw());
    const double onset_force_N = std::max(force_N, static_N - 2.0 * zeta * force_scale_N_);  // F_s - c V
    onset_s_ = time_s + (onset_force_N - force_N) / stiffness_rate_N_per_s_;
    slip_ = model::solve_slip((onset_force_N - friction_.kinetic_N()) / force_scale_N_, zeta);
    end_s_ = onset_s_ + slip_.tau_end / slider_.natural_frequency_rad_per_s();
    end_force_N_ = friction_.kinetic_N() + force_scale_N_ * slip_.end.z;
  }

  /// model.md section 7; `dz` is the rate of the spring force in units of k V.
  double in_view(double spring_N, double dz, bool sticks) const {
    const double damper_N = 2.0 * slider_.damping_ratio() * force_scale_N_ * dz;
    switch (options_.force_view) {
      case ForceView::Spring:
        return spring_N;
      case ForceView::Transmitted:
        return spring_N + damper_N;
      case ForceView::Contact:
        return sticks ? spring_N + damper_N : friction_.kinetic_N();
    }
    return spring_N;
  }

  Slider slider_;
  Friction friction_;
  SimulationOptions options_;
  double stiffness_rate_N_per_s_;
  double force_scale_N_;
  NormalDeviates scatter_;
  double ramp_s_ = 0.0, ramp_force_N_ = 0.0;
  double onset_s_ = 0.0, end_s_ = 0.0, end_force_N_ = 0.0;
  model::Slip slip_;
};

}  // namespace

SimulatedTrace simulate(const Slider& slider, const Friction& friction, double speed_m_per_s,
                        const SimulationOptions& options) {
  SlidingBody body(slider, friction, speed_m_per_s, options);
  NormalDeviates noise(options.seed);
  const auto samples = static_cast<std::size_t>(std::floor(options.duration_s * options.sample_rate_Hz)) + 1;
  SimulatedTrace trace;
  trace.time_s.reserve(samples);
  trace.force_N.reserve(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double time_s = static_cast<double>(i) / options.sample_rate_Hz;
    const double hum_N = options.hum_N * std::sin(2.0 * std::numbers::pi * options.hum_frequency_Hz * time_s);
    trace.time_s.push_back(time_s);
    trace.force_N.push_back(body.force_N(time_s) + options.noise_rms_N * noise.draw() + options.offset_N +
                            options.drift_N_per_s * time_s + hum_N);
  }
  return trace;
}

}  // namespace slipfit
