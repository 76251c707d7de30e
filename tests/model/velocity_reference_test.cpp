// The velocity-dependent tier against numbers from programs that share no code with it.

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "model/velocity_slip.hpp"
#include "reference_table.hpp"
#include "slipfit/model/motion.hpp"
#include "support/velocity_motion.hpp"

using namespace slipfit;

namespace {

/// k = w_n = V = 1: times are tau, forces are in k V / w_n.
VelocityMotion unit_motion(double zeta, const VelocityFriction& friction, double speed = 1.0) {
  return velocity_motion(Slider::create(1.0, 1.0, zeta).value(), friction, speed).value();
}

/// Latest point of [low, high] where `holds`, which is true at low and ends once.
template <class Predicate>
double last_point(double low, double high, const Predicate& holds) {
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

TEST_CASE("velocity-dependent cycle agrees with the independent table, existence included") {
  for (auto& row : test::reference_rows("velocity_dependent.csv")) {
    const auto friction = VelocityFriction::create(row["phi_s"], row["phi0"], row["phi1"], row["a"]);
    const Motion motion = unit_motion(row["zeta"], friction.value()).motion;
    INFO("zeta " << row["zeta"] << " phi_s " << row["phi_s"] << " a " << row["a"]);
    REQUIRE(motion.cycle.has_value() == (row["sticks"] == 1.0));
    if (!motion.cycle) continue;
    for (const auto& [value, name] :
         {std::pair{motion.cycle->slip_s, "slip_time"}, std::pair{motion.cycle->stick_s, "stick_time"},
          std::pair{motion.cycle->period_s, "period"}, std::pair{motion.cycle->sticking_degree, "sticking_degree"},
          std::pair{motion.cycle->periodic_displacement_m, "xi"}, std::pair{motion.cycle->end_force_N, "U_end"}}) {
      INFO(name);
      // U_end passes through zero: its scale is the friction.
      const double scale = name == std::string("U_end") ? row["phi_s"] : row[name];
      CHECK(std::abs(value - row[name]) <= 1e-10 * scale);  // the table holds about 11 digits
    }
  }
}

TEST_CASE("exponential friction oscillator: where steady sliding turns stable and where the cycle ends") {
  const auto friction = VelocityFriction::create(1.0, 0.5, 0.5, -2.0).value();
  const double stable_from = *unit_motion(0.05, friction).stability_speed_m_per_s;
  CHECK(stable_from == Approx(1.151293).epsilon(1e-6));
  CHECK(unit_motion(0.05, friction, stable_from * (1.0 - 1e-9)).motion.regime == Regime::StickSlip);
  CHECK(unit_motion(0.05, friction, stable_from * (1.0 + 1e-9)).motion.regime == Regime::StickSlipBistable);
  const auto sticks = [&](double speed) { return unit_motion(0.05, friction, speed).motion.cycle.has_value(); };
  const double ends_at = last_point(1.0, 3.0, sticks);
  CHECK(ends_at == Approx(1.8366).epsilon(1e-5));
  CHECK(unit_motion(0.05, friction, ends_at * (1.0 + 1e-6)).motion.regime == Regime::OscillatorySlip);
}

TEST_CASE("LuGre oscillator: the exact Coulomb model with its viscous damping") {
  // m 1 kg, k 2 N/m, V 0.1 m/s, F_k 1 N, F_s 1.5 N, sigma2 0.4 N s/m. LuGre itself: 6.3627 s.
  const double w_n = std::sqrt(2.0);
  const auto slider = Slider::create(2.0, w_n, 0.4 / (2.0 * w_n)).value();
  const auto friction = VelocityFriction::create(1.5, 1.0, 0.0, -1000.0).value();
  const VelocityMotion result = velocity_motion(slider, friction, 0.1).value();
  CHECK(result.motion.lambda == Approx(3.5355).epsilon(2e-5));
  CHECK(result.total_damping_ratio == Approx(0.1414).epsilon(2e-4));
  REQUIRE(result.motion.cycle);
  CHECK(result.motion.cycle->period_s == Approx(6.4539).epsilon(1e-5));
  CHECK(result.motion.cycle->period_s == Approx(6.3627).epsilon(0.015));  // bristles take up part of the stick
}
