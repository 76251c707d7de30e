// Simulated recordings with friction that depends on the speed: views, cycles, scatter, and against Coulomb friction.

#include "slipfit/model/simulation.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/velocity_motion.hpp"

using namespace slipfit;

namespace {

const Slider kSlider = Slider::create(5000.0, 900.0, 0.05).value();
constexpr double kSpeed_m_per_s = 0.01;
constexpr std::array<ForceView, 3> kViews{ForceView::Spring, ForceView::Transmitted, ForceView::Contact};

SimulationOptions options_for(ForceView view) {
  return {.duration_s = 0.5, .sample_rate_Hz = 20000.0, .force_view = view};
}

}  // namespace

TEST_CASE("a simulation with alpha 0 is the Coulomb one, noise and scatter included") {
  const auto by_speed = VelocityFriction::create(4.2, 2.2, 1.0, 0.0).value();
  const auto coulomb = Friction::create(4.2, 3.2).value();
  for (const ForceView view : kViews) {
    SimulationOptions options = options_for(view);
    options.noise_rms_N = 0.01;
    options.static_friction_sd_N = 0.1;
    const SimulatedTrace expected = simulate(kSlider, coulomb, kSpeed_m_per_s, options);
    const auto trace = simulate(kSlider, by_speed, kSpeed_m_per_s, options);
    REQUIRE(trace);
    REQUIRE(trace.value().time_s == expected.time_s);
    double worst_N = 0.0;
    for (std::size_t i = 0; i < expected.force_N.size(); ++i) {
      worst_N = std::max(worst_N, std::abs(trace.value().force_N[i] - expected.force_N[i]));
    }
    CHECK(worst_N < 1e-10);
  }
}

TEST_CASE("a simulation with friction that depends on the speed repeats its cycle in every view") {
  const auto friction = VelocityFriction::create(4.2, 2.2, 1.0, -30.0).value();
  const LimitCycle cycle = *velocity_motion(kSlider, friction, kSpeed_m_per_s).value().motion.cycle;
  const auto force_N = [&](ForceView view) {
    return simulate(kSlider, friction, kSpeed_m_per_s, options_for(view)).value().force_N;
  };
  const std::vector<double> spring_N = force_N(ForceView::Spring);
  const std::vector<double> transmitted_N = force_N(ForceView::Transmitted);
  const std::vector<double> contact_N = force_N(ForceView::Contact);

  // From the relaxed spring to the first slip, then period after period.
  const double k_V = kSlider.stiffness_N_per_m() * kSpeed_m_per_s;
  const double first_onset_s = cycle.onset_force_N / k_V;
  const double c_V = kSlider.damping_N_s_per_m() * kSpeed_m_per_s;
  for (std::size_t i = 0; i < spring_N.size(); ++i) {
    const double since_onset_s = static_cast<double>(i) / 20000.0 - first_onset_s;
    if (since_onset_s < 0.0) continue;
    const double in_period_s = std::fmod(since_onset_s, cycle.period_s);
    if (cycle.period_s - in_period_s < 1e-9) continue;  // on the next onset, by rounding
    const std::vector<double> time_s{in_period_s};
    const auto expected = velocity_waveform(kSlider, friction, kSpeed_m_per_s, time_s).value();
    const double v = expected.sliding_speed_m_per_s[0];
    const double spring_at_N = expected.spring_force_N[0];
    INFO("sample " << i << " sliding speed " << v);
    CHECK(spring_N[i] == Approx(spring_at_N).margin(1e-9));
    CHECK(transmitted_N[i] == Approx(spring_at_N + c_V * (1.0 - v / kSpeed_m_per_s)).margin(1e-9));
    const bool slides = in_period_s > 0.0 && in_period_s < cycle.slip_s;
    CHECK(contact_N[i] == Approx(slides ? friction.kinetic_N(v) : spring_at_N + c_V).margin(1e-9));
  }
  const auto [low, high] = std::minmax_element(spring_N.begin() + 5000, spring_N.end());
  CHECK(*low == Approx(cycle.force_trough_N).epsilon(1e-3));
  CHECK(*high == Approx(cycle.force_peak_N).epsilon(1e-3));
}

TEST_CASE("a simulation that does not stick again rings down to the friction of the driving speed") {
  const auto friction = VelocityFriction::create(1.2, 0.5, 0.5, -0.1).value();
  const auto trace =
      simulate(Slider::create(1000.0, 100.0, 0.2).value(), friction, 1.0, options_for(ForceView::Spring));
  REQUIRE(trace);
  CHECK(trace.value().force_N.back() == Approx(friction.kinetic_N(1.0)).epsilon(1e-3));
}

TEST_CASE("a simulation of a slip that runs away is an error") {
  const auto friction = VelocityFriction::create(4.2, 4.0, -1.0, 200.0).value();
  const auto trace = simulate(kSlider, friction, kSpeed_m_per_s, options_for(ForceView::Spring));
  REQUIRE_FALSE(trace);
  CHECK(trace.error().code == "no_convergence");
}
