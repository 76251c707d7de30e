#include "speed_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

using namespace slipfit;

namespace test {
namespace {

/// Extension of the spring and its rate, the sliding speed being V - rate.
struct State {
  double extension_m = 0.0;
  double rate_m_per_s = 0.0;
};

class Mass {
 public:
  Mass(const SpeedSweep& model, double speed_m_per_s)
      : model_(model),
        speed_(speed_m_per_s),
        mass_kg_(model.stiffness_N_per_m / (model.omega_rad_per_s * model.omega_rad_per_s)),
        damping_N_s_per_m_(2.0 * model.damping_ratio * model.stiffness_N_per_m / model.omega_rad_per_s) {}

  [[nodiscard]] double damping_N_s_per_m() const { return damping_N_s_per_m_; }

  /// One step of the classical Runge-Kutta method in slip.
  [[nodiscard]] State step(const State& s, double h) const {
    const State a = derivative(s);
    const State b = derivative(plus(s, a, 0.5 * h));
    const State c = derivative(plus(s, b, 0.5 * h));
    const State d = derivative(plus(s, c, h));
    const auto mean = [](double p, double q, double r, double t) { return (p + 2.0 * q + 2.0 * r + t) / 6.0; };
    return plus(s,
                {mean(a.extension_m, b.extension_m, c.extension_m, d.extension_m),
                 mean(a.rate_m_per_s, b.rate_m_per_s, c.rate_m_per_s, d.rate_m_per_s)},
                h);
  }

 private:
  static State plus(const State& s, const State& slope, double h) {
    return {s.extension_m + h * slope.extension_m, s.rate_m_per_s + h * slope.rate_m_per_s};
  }
  [[nodiscard]] State derivative(const State& s) const {
    const double friction = model_.f0_N + model_.f1_N * std::exp(model_.alpha_s_per_m * (speed_ - s.rate_m_per_s));
    const double force = friction - model_.stiffness_N_per_m * s.extension_m - damping_N_s_per_m_ * s.rate_m_per_s;
    return {s.rate_m_per_s, force / mass_kg_};
  }

  SpeedSweep model_;
  double speed_;
  double mass_kg_;
  double damping_N_s_per_m_;
};

constexpr double kStep = 2e-3;  // of 1 / w_n: errors near 1e-11 inside a slip, 1e-6 of an oscillation at its end

/// Spring extension at the end of a slip, and how long it takes; from stick at `extension_m`.
struct SlipEnd {
  double extension_m = 0.0;
  double duration_s = 0.0;
};

SlipEnd slide(const SpeedSweep& model, double speed_m_per_s, double extension_m) {
  const Mass mass(model, speed_m_per_s);
  const double h = kStep / model.omega_rad_per_s;
  State state{extension_m, speed_m_per_s};
  for (int i = 1;; ++i) {
    state = mass.step(state, h);
    if (i * kStep > 10.0) return {state.extension_m, i * h};  // more than a swing: it does not stick
    if (i > 10 && state.rate_m_per_s >= speed_m_per_s) return {state.extension_m, i * h};
  }
}

/// F_s after a stick, never below F_k.
double aged_N(const SpeedSweep& model, double static_friction_N, double stick_s) {
  if (model.ageing_N == 0.0) return static_friction_N;
  return std::max(static_friction_N + model.ageing_N * std::log(stick_s + model.ageing_cutoff_s),
                  model.f0_N + model.f1_N);
}

/// The spring is stretched until F_s - cV pulls.
double onset_extension_m(const SpeedSweep& model, double static_friction_N, double speed_m_per_s) {
  return (static_friction_N - Mass(model, speed_m_per_s).damping_N_s_per_m() * speed_m_per_s) / model.stiffness_N_per_m;
}

/// Stick after many cycles that begin with a stick of 10 s; 0 where it dies out.
struct LimitCycle {
  double stick_s = 0.0, slip_s = 0.0;
};

LimitCycle limit_cycle(const SpeedSweep& model, double speed_m_per_s) {
  constexpr int kCycles = 300;
  LimitCycle cycle{10.0, 0.0};
  for (int i = 0; i < (model.ageing_N == 0.0 ? 1 : kCycles); ++i) {
    const auto onset_m = [&](double stick_s) {
      return onset_extension_m(model, aged_N(model, model.static_friction_N, stick_s), speed_m_per_s);
    };
    const SlipEnd end = slide(model, speed_m_per_s, onset_m(cycle.stick_s));
    const double slip_s = end.duration_s;
    // The ramp meets F_s(t) from below: iterated from a stick that is too long.
    double stick_s = cycle.stick_s;
    for (int j = 0; j < kCycles; ++j) stick_s = (onset_m(stick_s) - end.extension_m) / speed_m_per_s;
    const double swing_s = 2.0 * std::acos(-1.0) / model.omega_rad_per_s;
    if (slip_s > 1.2 * swing_s || !(stick_s > 1e-3 * swing_s)) return {};
    cycle = {stick_s, slip_s};
  }
  return cycle;
}

double typical_stick_s(const SpeedSweep& model, double speed_m_per_s) {
  return limit_cycle(model, speed_m_per_s).stick_s;
}

std::vector<double> forces_N(const SpeedSweep& model, double speed_m_per_s, double dt_s, std::size_t samples,
                             std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Mass mass(model, speed_m_per_s);
  const auto draw = [&] { return model.static_friction_N + model.static_friction_sd_N * normal(random); };
  const int substeps = static_cast<int>(std::ceil(dt_s * model.omega_rad_per_s / kStep));
  const double h = dt_s / substeps;
  double static_N = draw();
  double stick_s = 0.9 * typical_stick_s(model, speed_m_per_s);
  const double first_N = aged_N(model, model.static_friction_N, stick_s);
  State state{0.9 * onset_extension_m(model, first_N, speed_m_per_s), speed_m_per_s};
  bool sticks = true;
  std::vector<double> forces;
  for (std::size_t i = 0; i < samples; ++i) {
    forces.push_back(model.stiffness_N_per_m * state.extension_m + model.noise_rms_N * normal(random));
    for (int step = 0; step < substeps; ++step) {
      if (!sticks) {
        state = mass.step(state, h);
        sticks = state.rate_m_per_s >= speed_m_per_s;
        if (sticks) state.rate_m_per_s = speed_m_per_s, static_N = draw(), stick_s = 0.0;
        continue;
      }
      stick_s += h;
      state.extension_m += speed_m_per_s * h;
      const double onset_m = onset_extension_m(model, aged_N(model, static_N, stick_s), speed_m_per_s);
      if (state.extension_m >= onset_m) {
        state = mass.step({onset_m, speed_m_per_s}, (state.extension_m - onset_m) / speed_m_per_s + 1e-3 * h);
        sticks = false;
      }
    }
  }
  return forces;
}

}  // namespace

double spacing_m(const SpeedSweep& model, double speed_m_per_s) {
  const LimitCycle cycle = limit_cycle(model, speed_m_per_s);
  return speed_m_per_s * (cycle.stick_s + cycle.slip_s);
}

double slip_s(const SpeedSweep& model, double speed_m_per_s) {
  return slide(model, speed_m_per_s, onset_extension_m(model, model.static_friction_N, speed_m_per_s)).duration_s;
}

SweepEntry record(const SpeedSweep& model, double speed_m_per_s, std::uint64_t seed) {
  constexpr double kCycles = 25.0;
  std::mt19937_64 random(seed);
  const double dt_s = 0.15 / model.omega_rad_per_s;  // about 25 samples a slip
  const double duration_s = kCycles * spacing_m(model, speed_m_per_s) / speed_m_per_s;
  std::vector<double> force = forces_N(model, speed_m_per_s, dt_s, static_cast<std::size_t>(duration_s / dt_s), random);
  std::vector<double> time(force.size());
  for (std::size_t i = 0; i < time.size(); ++i) time[i] = static_cast<double>(i) * dt_s;
  Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  conditions.sensor_average_s = 0.0;  // samples are of an instant
  return {std::to_string(speed_m_per_s), Recording::create(std::move(time), std::move(force), conditions).value()};
}

std::vector<SweepEntry> record(const SpeedSweep& model, const std::vector<double>& speeds_m_per_s, std::uint64_t seed) {
  std::vector<SweepEntry> entries;
  for (const double speed : speeds_m_per_s) entries.push_back(record(model, speed, seed + entries.size()));
  return entries;
}

}  // namespace test
