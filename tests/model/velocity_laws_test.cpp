// What must hold for velocity-dependent friction whatever the parameters are.

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "model/velocity_law.hpp"
#include "model/velocity_slip.hpp"
#include "slipfit/model/velocity_friction.hpp"

using namespace slipfit;

namespace {

model::SlipOutcome outcome_of(const model::ScaledSlip& slip) {
  return model::follow_slip<false>(slip, model::kExact, [](const auto&) {}).outcome;
}

}  // namespace

TEST_CASE("laws of friction begin alike, bend as they say, and know their derivatives") {
  const model::LawShape shape =
      GENERATE(model::LawShape::Exponential, model::LawShape::Hyperbolic, model::LawShape::Logarithmic);
  for (const double rate : {-4.0, -0.3, -1e-5}) {
    for (const double v : {1e-3, 0.4, 3.0}) {
      const model::ScaledLaw law{0.7, rate, shape};
      const model::ExcessFriction g = law.at(v);
      const double bend = shape == model::LawShape::Exponential  ? std::exp(rate * v)
                          : shape == model::LawShape::Hyperbolic ? std::pow(1.0 - 0.5 * rate * v, -2.0)
                                                                 : 1.0 / (1.0 - rate * v);
      CHECK(g.d_speed == Approx(0.7 * bend).epsilon(1e-12).margin(1e-15));  // expm1 + 1 rounds
      const double h = 1e-4 * v;
      CHECK(g.d_speed == Approx((law.at(v + h).value - law.at(v - h).value) / (2.0 * h)).epsilon(1e-6));
      CHECK(g.d_slope == Approx(g.value / 0.7).epsilon(1e-12));
      const double r = 1e-4 * std::abs(rate);
      const double above = model::ScaledLaw{0.7, rate + r, shape}.at(v).value;
      const double below = model::ScaledLaw{0.7, rate - r, shape}.at(v).value;
      // The difference of the two loses digits where friction hardly depends on the rate.
      CHECK(g.d_rate == Approx((above - below) / (2.0 * r)).epsilon(1e-5).margin(1e-15 * g.value / r));
    }
  }
}

TEST_CASE("a slip that is overdamped above the driving speed settles without integration") {
  // w = v - 1 obeys w'' + (2 zeta + g'(v)) w' + w = 0, and the factor of w' exceeds 2 where w > 0: w crosses 0 only
  // once.
  const model::ScaledSlip slip{7.5, 0.1, {18.6, 3.4}};
  int steps = 0;
  const auto end = model::follow_slip<true>(slip, model::kForFits, [&](const auto&) { ++steps; });
  CHECK(end.outcome == model::SlipOutcome::Settles);
  CHECK(steps == 0);
  CHECK_FALSE(model::VelocityTrack::solve(slip.lambda - 2.0 * slip.zeta, slip.zeta, slip.law));
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
