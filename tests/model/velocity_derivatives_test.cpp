// Derivatives of velocity-dependent slips, events on the end of a step, waveforms, and what is refused.

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "model/velocity_slip.hpp"
#include "support/velocity_motion.hpp"

using namespace slipfit;

namespace {

using VelocityValues = std::array<double, kVelocityParameters>;

model::SlipOutcome outcome_of(const model::ScaledSlip& slip) {
  return model::follow_slip<false>(slip, model::kExact, [](const auto&) {}).outcome;
}

double& value(VelocityValues& p, VelocityParameter parameter) {
  return p[static_cast<std::size_t>(parameter)];
}
double value(const VelocityValues& p, VelocityParameter parameter) {
  return p[static_cast<std::size_t>(parameter)];
}

struct Scene {
  Slider slider;
  VelocityFriction friction;
  double speed_m_per_s;
};

Scene scene_of(const VelocityValues& p) {
  return {Slider::create(value(p, VelocityParameter::Stiffness), value(p, VelocityParameter::NaturalFrequency),
                         value(p, VelocityParameter::DampingRatio))
              .value(),
          VelocityFriction::create(value(p, VelocityParameter::StaticFriction), value(p, VelocityParameter::F0),
                                   value(p, VelocityParameter::F1), value(p, VelocityParameter::Alpha))
              .value(),
          value(p, VelocityParameter::Speed)};
}

/// Sticks for a good part of the period, so that a difference does not step over the end of stick-slip.
VelocityValues random_velocity_values(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (;;) {
    VelocityValues p{};
    value(p, VelocityParameter::Stiffness) = uniform(100.0, 5000.0);
    value(p, VelocityParameter::NaturalFrequency) = uniform(20.0, 800.0);
    value(p, VelocityParameter::DampingRatio) = uniform(0.01, 0.3);
    value(p, VelocityParameter::F0) = uniform(0.5, 3.0);
    value(p, VelocityParameter::F1) = uniform(0.1, 2.0);
    const double difference_N = uniform(0.3, 2.0);
    value(p, VelocityParameter::StaticFriction) =
        value(p, VelocityParameter::F0) + value(p, VelocityParameter::F1) + difference_N;
    const double force_N = difference_N / uniform(0.5, 30.0);
    value(p, VelocityParameter::Speed) =
        force_N * value(p, VelocityParameter::NaturalFrequency) / value(p, VelocityParameter::Stiffness);
    value(p, VelocityParameter::Alpha) = uniform(-3.0, 0.05) / value(p, VelocityParameter::Speed);
    const Scene scene = scene_of(p);
    const auto motion = velocity_motion(scene.slider, scene.friction, scene.speed_m_per_s).value().motion;
    if (motion.cycle && motion.cycle->sticking_degree > 0.3) return p;
  }
}

/// Central difference of eighth order: error h^8 f^(9) / 630 and round-off of 1e-12 f / h.
template <class F>
double difference(const F& f, const VelocityValues& p, std::size_t i) {
  const double h = 2e-3 * std::abs(p[i]);
  const auto odd = [&](double steps) {
    VelocityValues up = p;
    VelocityValues down = p;
    up[i] += steps * h;
    down[i] -= steps * h;
    return f(up) - f(down);
  };
  return (672.0 * odd(1.0) - 168.0 * odd(2.0) + 32.0 * odd(3.0) - 3.0 * odd(4.0)) / (840.0 * h);
}

/// Every quantity with derivatives, and the limit cycle's member that has the same value.
constexpr std::array<std::pair<VelocityDerivative VelocityDerivatives::*, double LimitCycle::*>, 8> kQuantities{{
    {&VelocityDerivatives::slip_s, &LimitCycle::slip_s},
    {&VelocityDerivatives::stick_s, &LimitCycle::stick_s},
    {&VelocityDerivatives::period_s, &LimitCycle::period_s},
    {&VelocityDerivatives::periodic_displacement_m, &LimitCycle::periodic_displacement_m},
    {&VelocityDerivatives::onset_force_N, &LimitCycle::onset_force_N},
    {&VelocityDerivatives::end_force_N, &LimitCycle::end_force_N},
    {&VelocityDerivatives::force_peak_N, &LimitCycle::force_peak_N},
    {&VelocityDerivatives::force_trough_N, &LimitCycle::force_trough_N},
}};

}  // namespace

TEST_CASE("derivatives of velocity-dependent cycles agree with eighth-order differences") {
  std::mt19937_64 random(61);
  for (int trial = 0; trial < 60; ++trial) {
    const VelocityValues p = random_velocity_values(random);
    const auto cycle_at = [](const VelocityValues& q) {
      const Scene scene = scene_of(q);
      return *velocity_motion(scene.slider, scene.friction, scene.speed_m_per_s).value().motion.cycle;
    };
    const Scene scene = scene_of(p);
    const auto exact = velocity_derivatives(scene.slider, scene.friction, scene.speed_m_per_s).value();
    REQUIRE(exact);
    const LimitCycle cycle = cycle_at(p);
    for (std::size_t quantity = 0; quantity < kQuantities.size(); ++quantity) {
      const auto derivative = kQuantities[quantity].first;
      const auto member = kQuantities[quantity].second;
      const double size = std::abs(cycle.*member);
      CHECK(((*exact).*derivative).value == Approx(cycle.*member).epsilon(1e-11).margin(1e-11 * cycle.force_peak_N));
      for (std::size_t i = 0; i < kVelocityParameters; ++i) {
        INFO("trial " << trial << " quantity " << quantity << " parameter " << i);
        const double expected = difference([&](const VelocityValues& q) { return cycle_at(q).*member; }, p, i);
        CHECK(((*exact).*derivative).gradient[i] ==
              Approx(expected).epsilon(1e-7).margin(1e-7 * size / std::abs(p[i])));
      }
    }
  }
}

TEST_CASE("the end of a slip is the same whether a step ends on it, or one ulp before or after it") {
  std::mt19937_64 random(67);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  int ends_before = 0;
  int ends_after = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const double rate = -3.0 * any(random);
    const model::ScaledSlip slip{1.0 + 30.0 * any(random), 0.1 * any(random), {5.0 * any(random) * rate, rate}};
    model::SlipWalker<true> walker(slip, model::kExact);
    while (walker.advance() && walker.to.state.v > 0.0) {
    }
    const model::SlipNode rest = *model::speed_event(walker).rest;
    const double length = rest.tau - walker.from.tau;
    for (const double step : {length, std::nextafter(length, 0.0), std::nextafter(length, 10.0)}) {
      auto again = walker;
      again.to = again.inside(step);
      const bool before = again.to.state.v > 0.0;
      ++(before ? ends_before : ends_after);
      if (before) REQUIRE(again.advance());
      const auto event = model::speed_event(again);
      INFO("trial " << trial << " lambda " << slip.lambda << " rate " << rate);
      REQUIRE(event.rest);
      CHECK(event.rest->tau == Approx(rest.tau).epsilon(1e-12));
      const double margin = 1e-10 * (1.0 + slip.lambda);
      CHECK(event.rest->state.s == Approx(rest.state.s).epsilon(1e-9).margin(margin));
      for (std::size_t p = 0; p < model::kScaledParameters; ++p) {
        CHECK(event.rest->state.ds[p] == Approx(rest.state.ds[p]).epsilon(1e-9).margin(margin));
        CHECK(event.rest->state.dv[p] == Approx(rest.state.dv[p]).epsilon(1e-9).margin(margin));
      }
    }
  }
  CHECK(ends_before > 20);
  CHECK(ends_after > 20);
}

TEST_CASE("a velocity-dependent waveform starts, ends and sticks as its cycle says") {
  std::mt19937_64 random(71);
  for (int trial = 0; trial < 50; ++trial) {
    const VelocityValues p = random_velocity_values(random);
    const Scene scene = scene_of(p);
    const LimitCycle cycle = *velocity_motion(scene.slider, scene.friction, scene.speed_m_per_s).value().motion.cycle;
    const std::vector<double> time_s{0.0, 0.0, cycle.slip_s, cycle.period_s};
    const auto waveform = velocity_waveform(scene.slider, scene.friction, scene.speed_m_per_s, time_s).value();
    INFO("trial " << trial);
    REQUIRE(waveform.slip_s);
    CHECK(*waveform.slip_s == Approx(cycle.slip_s).epsilon(1e-12));
    const double tolerance_N = 1e-10 * (cycle.force_peak_N - cycle.force_trough_N);
    CHECK(waveform.spring_force_N[0] == Approx(cycle.onset_force_N).margin(tolerance_N));
    CHECK(waveform.spring_force_N[2] == Approx(cycle.end_force_N).margin(tolerance_N));
    CHECK(waveform.spring_force_N[3] == Approx(cycle.onset_force_N).margin(tolerance_N));
    CHECK(waveform.sliding_speed_m_per_s[0] == 0.0);
    CHECK(waveform.sliding_speed_m_per_s[2] == Approx(0.0).margin(1e-8 * scene.speed_m_per_s));
    CHECK(waveform.sliding_speed_m_per_s[3] == 0.0);
  }
}

TEST_CASE("a slip that does not stick again rings down to steady sliding") {
  const Slider slider = Slider::create(1000.0, 100.0, 0.2).value();
  const auto friction = VelocityFriction::create(1.2, 0.5, 0.5, -0.1).value();
  const auto motion = velocity_motion(slider, friction, 1.0).value();
  CHECK(motion.motion.regime == Regime::OscillatorySlip);
  const std::vector<double> time_s{0.0, 0.01, 5.0};
  const auto waveform = velocity_waveform(slider, friction, 1.0, time_s).value();
  CHECK_FALSE(waveform.slip_s);
  CHECK(waveform.sliding_speed_m_per_s[2] == Approx(1.0).epsilon(1e-9));
  CHECK(waveform.spring_force_N[2] == Approx(friction.kinetic_N(1.0)).epsilon(1e-9));
  CHECK_FALSE(velocity_derivatives(slider, friction, 1.0).value().has_value());
}

TEST_CASE("where steady sliding is unstable a slip from stick sticks again, whatever the parameters") {
  // docs/model.md (17). Runs away, if at all, where the friction falls ever faster.
  std::mt19937_64 random(73);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int sticks = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const double rate = uniform(-6.0, 2.0);
    const double zeta = trial % 2 == 0 ? uniform(0.0, 0.5) : uniform(0.0, 3.0);
    const double total = -std::exp(uniform(std::log(1e-3), std::log(0.5)));
    const model::ScaledLaw law{2.0 * (total - zeta) / std::exp(rate), rate};
    const model::ScaledSlip slip{trial % 3 == 0 ? uniform(0.0, 0.02) : uniform(0.0, 30.0), zeta, law};
    INFO("lambda " << slip.lambda << " zeta " << zeta << " total " << total << " rate " << rate);
    const auto outcome = outcome_of(slip);
    CHECK((outcome == model::SlipOutcome::Resticks || outcome == model::SlipOutcome::NotSolved));
    if (rate < 0.0) CHECK(outcome == model::SlipOutcome::Resticks);
    if (outcome == model::SlipOutcome::Resticks) ++sticks;
  }
  CHECK(sticks > 2000);
}

TEST_CASE("a slip that has turned back once never sticks, though it may ring for long") {
  std::mt19937_64 random(97);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  int slides_on = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double rate = -5.0 * any(random);
    const double total = 0.02 * any(random);
    const double zeta = total + 0.3 * any(random);
    const model::ScaledSlip slip{0.5 * any(random), zeta, {2.0 * (total - zeta) / std::exp(rate), rate}};
    if (outcome_of(slip) != model::SlipOutcome::TurnsBack) continue;
    ++slides_on;
    model::SlipTrace trace(slip);
    REQUIRE(trace.at(500.0));
    CHECK_FALSE(trace.tau_end());
  }
  CHECK(slides_on > 100);
}

TEST_CASE("impossible velocity-dependent friction is refused by name, value and range") {
  const auto message = [](double static_N, double f0_N, double f1_N, double alpha_s_per_m) {
    const auto friction = VelocityFriction::create(static_N, f0_N, f1_N, alpha_s_per_m);
    return friction ? std::string() : friction.error().message;
  };
  const double nan = std::nan("");
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(message(2.0, nan, 1.0, -1.0) == "f0 (N) is nan, expected a finite number");
  CHECK(message(2.0, 1.0, infinite, -1.0) == "f1 (N) is inf, expected a finite number");
  CHECK(message(2.0, 1.0, 0.5, -infinite) == "alpha (s/m) is -inf, expected a finite number");
  CHECK(message(2.0, 1.0, -1.5, -1.0) == "f0 + f1 (N) is -0.5, expected a number >= 0");
  CHECK(message(1.4, 1.0, 0.5, -1.0) == "static friction (N) is 1.4, expected a number not below f0 + f1");
  CHECK(message(nan, 1.0, 0.5, -1.0) == "static friction (N) is nan, expected a number not below f0 + f1");
  CHECK(message(2.0, 1.0, 0.5, 3.0).empty());
}

TEST_CASE("what a velocity-dependent slip cannot be solved for is an error, not a number") {
  const Slider slider = Slider::create(1000.0, 100.0, 0.05).value();
  const auto code = [&](const VelocityFriction& friction, double speed_m_per_s) {
    const auto motion = velocity_motion(slider, friction, speed_m_per_s);
    const auto derivatives = velocity_derivatives(slider, friction, speed_m_per_s);
    REQUIRE(motion.ok() == derivatives.ok());
    if (motion) return std::string();
    CHECK(derivatives.error().code == motion.error().code);
    CHECK(motion.error().message.find('\n') == std::string::npos);
    return motion.error().code;
  };
  const auto weakening = VelocityFriction::create(3.0, 1.0, 1.0, -10.0).value();
  CHECK(code(weakening, 0.01).empty());
  CHECK(code(weakening, 0.0) == "parameter_out_of_range");
  CHECK(code(weakening, -0.01) == "parameter_out_of_range");
  CHECK(code(weakening, std::nan("")) == "parameter_out_of_range");
  CHECK(code(weakening, 1e-320) == "parameter_out_of_range");
  // Friction that falls ever faster with the speed drives the slip to infinity.
  CHECK(code(VelocityFriction::create(3.0, 2.0, -1.0, 50.0).value(), 0.1) == "no_convergence");
  CHECK(code(VelocityFriction::create(3.0, 1.0, 1.0, 1e4).value(), 0.1) == "parameter_out_of_range");
}
