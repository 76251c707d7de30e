#include "slipfit/model/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include "model/slip.hpp"
#include "model/velocity_slip.hpp"
#include "model/velocity_units.hpp"

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
  /// Returns a number in (0, 1] with 53 bits.
  double uniform() { return (static_cast<double>(generator_() >> 11U) + 1.0) * 0x1.0p-53; }

  std::mt19937_64 generator_;
};

/// Spring force above F_k(0+) in units of k V / w_n, and its rate in units of k V: 1 - v / V.
struct Point {
  double z = 0.0;
  double dz = 0.0;
};

/// Slips under Coulomb friction, one after the other.
class CoulombSlips {
 public:
  CoulombSlips(const Slider& slider, const Friction& friction) : zeta_(slider.damping_ratio()), friction_(friction) {}

  [[nodiscard]] double static_N() const { return friction_.static_N(); }
  [[nodiscard]] double onset_N() const { return friction_.kinetic_N(); }
  [[nodiscard]] double kinetic_N(const Point& /*at any speed*/) const { return friction_.kinetic_N(); }

  void start(double z0) { slip_ = model::solve_slip(z0, zeta_); }
  [[nodiscard]] bool resticks() const { return slip_.resticks; }
  [[nodiscard]] double tau_end() const { return slip_.tau_end; }
  [[nodiscard]] double z_end() const { return slip_.end.z; }
  [[nodiscard]] Point at(double tau) const {
    const auto point = model::slip_point(slip_.z0, slip_.zeta, tau);
    return {point.z, point.dz};
  }

 private:
  double zeta_;
  Friction friction_;
  model::Slip slip_;
};

/// Solves slips under friction that depends on the speed, one after the other.
class VelocitySlips {
 public:
  VelocitySlips(const model::SpeedUnits& units, const VelocityFriction& friction, double speed_m_per_s)
      : units_(units), friction_(friction), speed_m_per_s_(speed_m_per_s), trace_(units.slip) {}

  [[nodiscard]] double static_N() const { return friction_.static_N(); }
  [[nodiscard]] double onset_N() const { return friction_.onset_N(); }
  [[nodiscard]] double kinetic_N(const Point& point) const {
    return friction_.kinetic_N(speed_m_per_s_ * (1.0 - point.dz));
  }

  void start(double z0) {
    model::ScaledSlip slip = units_.slip;
    slip.lambda = z0 + 2.0 * slip.zeta;
    end_ = model::follow_slip<false>(slip, model::kExact, [](const auto&) {});
    trace_ = model::SlipTrace(slip);
    if (end_.outcome == model::SlipOutcome::NotSolved) runs_away_ = true;
  }
  [[nodiscard]] bool resticks() const { return end_.outcome == model::SlipOutcome::Resticks; }
  [[nodiscard]] double tau_end() const { return end_.node.tau; }
  [[nodiscard]] double z_end() const { return end_.node.state.s - 2.0 * units_.slip.zeta; }
  [[nodiscard]] Point at(double tau) {
    if (runs_away_) return {};
    const std::optional<model::TracePoint> point = trace_.at(tau);
    if (!point) runs_away_ = true;
    return point ? Point{point->s - 2.0 * units_.slip.zeta, 1.0 - point->v} : Point{};
  }
  [[nodiscard]] bool runs_away() const { return runs_away_; }

 private:
  model::SpeedUnits units_;
  VelocityFriction friction_;
  double speed_m_per_s_;
  model::SlipEnd end_;
  model::SlipTrace trace_;
  bool runs_away_ = false;
};

/// The exact motion, cycle after cycle: asked for the force at times that never decrease.
template <class Slips>
class SlidingBody {
 public:
  SlidingBody(const Slider& slider, Slips slips, double speed_m_per_s, const SimulationOptions& options)
      : slider_(slider),
        slips_(std::move(slips)),
        options_(options),
        stiffness_rate_N_per_s_(slider.stiffness_N_per_m() * speed_m_per_s),
        force_scale_N_(stiffness_rate_N_per_s_ / slider.natural_frequency_rad_per_s()),
        scatter_(options.seed ^ 0x9e3779b97f4a7c15ULL) {
    plan_slip(0.0, 0.0);
  }

  double force_N(double time_s) {
    while (slips_.resticks() && time_s > end_s_) plan_slip(end_s_, end_force_N_);
    if (time_s < onset_s_) return in_stick(ramp_force_N_ + stiffness_rate_N_per_s_ * (time_s - ramp_s_));
    return in_slip(slips_.at(slider_.natural_frequency_rad_per_s() * (time_s - onset_s_)));
  }

  [[nodiscard]] const Slips& slips() const { return slips_; }

 private:
  /// Stick from (time, force), then the slip that ends it.
  void plan_slip(double time_s, double force_N) {
    ramp_s_ = time_s;
    ramp_force_N_ = force_N;
    const double zeta = slider_.damping_ratio();
    const double static_N =
        std::max(slips_.onset_N(), slips_.static_N() + options_.static_friction_sd_N * scatter_.draw());
    const double onset_force_N = std::max(force_N, static_N - 2.0 * zeta * force_scale_N_);  // F_s - c V
    onset_s_ = time_s + (onset_force_N - force_N) / stiffness_rate_N_per_s_;
    slips_.start((onset_force_N - slips_.onset_N()) / force_scale_N_);
    end_s_ = onset_s_ + slips_.tau_end() / slider_.natural_frequency_rad_per_s();
    end_force_N_ = slips_.onset_N() + force_scale_N_ * slips_.z_end();
  }

  /// docs/model.md section 7. The spring is stretched at V.
  [[nodiscard]] double in_stick(double spring_N) const {
    return options_.force_view == ForceView::Spring ? spring_N
                                                    : spring_N + 2.0 * slider_.damping_ratio() * force_scale_N_;
  }
  [[nodiscard]] double in_slip(const Point& point) const {
    if (options_.force_view == ForceView::Contact) return slips_.kinetic_N(point);
    const double spring_N = slips_.onset_N() + force_scale_N_ * point.z;
    return options_.force_view == ForceView::Spring
               ? spring_N
               : spring_N + 2.0 * slider_.damping_ratio() * force_scale_N_ * point.dz;
  }

  Slider slider_;
  Slips slips_;
  SimulationOptions options_;
  double stiffness_rate_N_per_s_;
  double force_scale_N_;
  NormalDeviates scatter_;
  double ramp_s_ = 0.0, ramp_force_N_ = 0.0;
  double onset_s_ = 0.0, end_s_ = 0.0, end_force_N_ = 0.0;
};

template <class Slips>
SimulatedTrace trace_of(SlidingBody<Slips>& body, const SimulationOptions& options) {
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

}  // namespace

SimulatedTrace simulate(const Slider& slider, const Friction& friction, double speed_m_per_s,
                        const SimulationOptions& options) {
  SlidingBody body(slider, CoulombSlips(slider, friction), speed_m_per_s, options);
  return trace_of(body, options);
}

Result<SimulatedTrace> simulate(const Slider& slider, const VelocityFriction& friction, double speed_m_per_s,
                                const SimulationOptions& options) {
  const Result<model::SpeedUnits> units = model::in_speed_units(slider, friction, speed_m_per_s);
  if (!units) return units.error();
  SlidingBody body(slider, VelocitySlips(units.value(), friction, speed_m_per_s), speed_m_per_s, options);
  SimulatedTrace trace = trace_of(body, options);
  if (body.slips().runs_away()) return model::no_convergence(units.value().slip);
  return trace;
}

}  // namespace slipfit
