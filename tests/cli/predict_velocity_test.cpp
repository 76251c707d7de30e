#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "run_program.hpp"
#include "support/velocity_motion.hpp"

TEST_CASE("predict from stated friction that depends on the speed gives the exact cycle") {
  const test::ProgramResult result = test::run_slipfit(
      {"predict", "--stiffness", "900", "--natural-frequency", "150", "--damping-ratio", "0.06", "--static-friction",
       "3", "--f0", "1.6", "--f1", "0.4", "--alpha=-8", "--speeds", "10mm/s,40mm/s", "--json"});
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  const nlohmann::json prediction = nlohmann::json::parse(result.out);
  const auto slider = slipfit::Slider::create(900.0, 150.0, 0.06).value();
  const auto friction = slipfit::VelocityFriction::create(3.0, 1.6, 0.4, -8.0).value();
  for (const std::size_t i : {0U, 1U}) {
    const auto exact = slipfit::velocity_motion(slider, friction, i == 0 ? 0.01 : 0.04).value();
    REQUIRE(exact.motion.cycle);
    const nlohmann::json row = prediction["rows"][i];
    // Predictions take the fit's slip, good to 1e-6.
    CHECK(row["period_s"]["value"].get<double>() == Approx(exact.motion.cycle->period_s).epsilon(2e-6));
    CHECK(row["period_s"]["ci95"].is_null());
  }
  CHECK(prediction["critical_speed_m_per_s"]["value"].get<double>() > 0.04);
}
