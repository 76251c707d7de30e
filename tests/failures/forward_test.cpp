// The regions of docs/accuracy/failures_forward.svg, failures_grazing.svg and failures_speed.svg: what slipfit gives
// where forward methods fail.

#include <catch2/catch.hpp>
#include <cmath>

#include "model/velocity_slip.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/paper.hpp"

namespace {

slipfit::Motion scaled_motion(double lambda, double zeta) {
  return slipfit::damped_motion(slipfit::Slider::create(1.0, 1.0, zeta).value(),
                                slipfit::Friction::create(lambda, 0.0).value(), 1.0);
}

}  // namespace

TEST_CASE("grazing: stick-slip is found and refused within 1e-11 of its limit") {
  for (const double zeta : {0.005, 0.02, 0.1, 0.3, 0.8}) {
    const double limit = slipfit::critical_lambda(zeta);
    for (const double distance : {1e-11, 1e-8, 1e-4}) {
      INFO("zeta " << zeta << " distance " << distance);
      CHECK(scaled_motion(limit * (1.0 + distance), zeta).cycle);
      CHECK_FALSE(scaled_motion(limit * (1.0 - distance), zeta).cycle);
    }
  }
}

TEST_CASE("grazing: friction that depends on the speed is solved to 1e-6 of the limit") {
  for (const double zeta : {0.005, 0.02, 0.1, 0.3, 0.8}) {
    const double limit = slipfit::critical_lambda(zeta);
    const auto resticks = [&](double lambda) {
      return slipfit::model::VelocityTrack::solve(lambda - 2.0 * zeta, zeta, 0.0, 0.0)->resticks();
    };
    INFO("zeta " << zeta);
    CHECK(resticks(limit * (1.0 + 1e-6)));
    CHECK_FALSE(resticks(limit * (1.0 - 1e-6)));
  }
}

TEST_CASE("no root: the paper's approximation says no_solution where the exact motion still has an answer") {
  for (const auto& [lambda, zeta] : {std::pair{0.05, 0.05}, std::pair{0.5, 0.05}, std::pair{3.0, 0.3}}) {
    INFO("lambda " << lambda << " zeta " << zeta);
    const auto paper = slipfit::paper_cycle(slipfit::Slider::create(1.0, 1.0, zeta).value(),
                                            slipfit::Friction::create(lambda, 0.0).value(), 1.0);
    REQUIRE_FALSE(paper);
    CHECK(paper.error().code == "no_solution");
    CHECK(scaled_motion(lambda, zeta).cycle.has_value() == (lambda > slipfit::critical_lambda(zeta)));
  }
}

TEST_CASE("overflow: extreme lambda and heavy damping give a finite cycle or none") {
  for (const double lambda : {1e-6, 1.0, 1e8}) {
    for (const double zeta : {0.0, 1e-7, 0.5, 0.999, 1.0, 2.0, 100.0}) {
      INFO("lambda " << lambda << " zeta " << zeta);
      const slipfit::Motion motion = scaled_motion(lambda, zeta);
      CHECK((zeta < 1.0 || !motion.cycle));
      if (!motion.cycle) continue;
      CHECK(std::isfinite(motion.cycle->period_s));
      CHECK(motion.cycle->stick_s >= 0.0);
    }
  }
}

TEST_CASE("divergence: a slip under friction that explodes with the speed has no solution, not a wrong one") {
  constexpr double kLambda = 20.0;
  constexpr double kZeta = 0.05;
  for (const double bend : {8.0, 30.0, 1000.0}) {
    for (const double strength : {-3.0, 3.0}) {
      const double rate = bend / kLambda;
      INFO("alpha V lambda " << bend << " f1 " << strength);
      const auto track =
          slipfit::model::VelocityTrack::solve(kLambda - 2.0 * kZeta, kZeta, strength * kLambda * rate, rate);
      if (!track) continue;
      CHECK(strength > 0.0);  // friction that falls without bound lets the body run away
      CHECK(std::isfinite(track->after().value));
    }
  }
}
