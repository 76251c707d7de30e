// The measured position of a drive in place of its stated speed.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/pipeline.hpp"

namespace slipfit {
namespace {

constexpr double kSpeed_m_per_s = 0.02;

/// A slider of 1000 N/m with the position of its drive, which falls behind by `compliance_m_per_N` times the force. The
/// force is that of a steady drive with a spring in series.
Recording with_drive(double compliance_m_per_N, double stated_m_per_s = kSpeed_m_per_s) {
  const double series_N_per_m = 1000.0 / (1.0 + 1000.0 * compliance_m_per_N);
  const SimulationOptions options{
      .duration_s = 4.0, .sample_rate_Hz = 2000.0, .static_friction_sd_N = 0.02, .noise_rms_N = 0.005};
  const Slider slider = Slider::create(series_N_per_m, 200.0, 0.05).value();
  SimulatedTrace trace = simulate(slider, Friction::create(3.0, 2.5).value(), kSpeed_m_per_s, options);
  std::vector<double> drive_m;
  for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
    drive_m.push_back(kSpeed_m_per_s * trace.time_s[i] - compliance_m_per_N * trace.force_N[i]);
  }
  Conditions conditions;
  conditions.speed_m_per_s = stated_m_per_s;
  return Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions, {}, {}, std::move(drive_m))
      .value();
}

}  // namespace

TEST_CASE("k is the slope of the force against the measured position of a drive that gives way") {
  const Analysis analysis = analyze_and_fit(with_drive(5e-4));
  REQUIRE(analysis.fit);
  CHECK(*analysis.cycles.stick_stiffness.value == Approx(1000.0).epsilon(0.005));
  // 667 by the stated speed. Of half of the drop the drive makes good within the slip: k is not exact there.
  const Estimate k = analysis.fit->stiffness();
  CHECK(*k.value == Approx(1000.0).epsilon(0.03));
  CHECK(k.ci95->low <= 1000.0);
  CHECK(k.ci95->high >= 1000.0);
  REQUIRE(analysis.drive);
  CHECK(analysis.drive->stick_speed_m_per_s == Approx(kSpeed_m_per_s / 1.5).epsilon(0.01));
  CHECK(warns(analysis, "drive_measured"));
  CHECK(warns(analysis, "drive_moves_in_slips"));
  CHECK(analysis.fit->find(ParameterId::NaturalFrequency)->status != ParameterStatus::Identified);
  CHECK(*analysis.derived.pattern_spacing_m.value ==
        Approx(kSpeed_m_per_s / *analysis.frequency.quoted.value).epsilon(1e-9));
}

TEST_CASE("a speed that is stated 3 % too low is corrected by the measured position of the drive") {
  const Analysis analysis = analyze_and_fit(with_drive(0.0, 0.97 * kSpeed_m_per_s));
  REQUIRE(analysis.fit);
  CHECK(*analysis.fit->stiffness().value == Approx(1000.0).epsilon(0.005));
  CHECK_FALSE(warns(analysis, "drive_moves_in_slips"));
}

TEST_CASE("the stated speed is used where the measured drive keeps it, or where another part is measured") {
  CHECK_FALSE(analyze_and_fit(with_drive(0.0)).drive);
  CHECK_FALSE(analyze_and_fit(with_drive(0.0, 0.5 * kSpeed_m_per_s)).drive);
  CHECK_FALSE(analyze_and_fit(with_drive(4e-3)).drive);  // rests between slips, as the body does
}

}  // namespace slipfit
