// What slips keep: their own rhythm across lost samples, and the path over which a level repeats.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "analysis/estimate.hpp"
#include "analysis/sweep_checks.hpp"
#include "checks.hpp"
#include "slipfit/pipeline.hpp"
#include "support/recordings.hpp"

namespace slipfit {
namespace {

constexpr double kStep_s = 1e-3;
constexpr double kPeriod_s = 0.5;

/// 40 saw-teeth of 1 N, of which 30 samples are lost in the middle of one stick while the clock runs on.
Recording saw_teeth_with_loss(std::size_t tooth) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.003);
  std::vector<double> time_s, force;
  for (std::size_t i = 0; i < static_cast<std::size_t>(40.0 * kPeriod_s / kStep_s); ++i) {
    const double phase = std::fmod(static_cast<double>(i) * kStep_s / kPeriod_s, 1.0);
    const bool is_lost = i / 500 == tooth && i % 500 >= 250 && i % 500 < 280;
    if (is_lost) continue;
    const double fall = 0.5 * (1.0 + std::cos(M_PI * (phase - 0.95) / 0.05));
    time_s.push_back(static_cast<double>(time_s.size()) * kStep_s);
    force.push_back(2.0 + (phase < 0.95 ? phase / 0.95 : fall) + noise(random));
  }
  return test::recording_of(std::move(time_s), std::move(force), 1e-3);
}

SweepEntry entry_at(double speed_m_per_s, double step_s = 1.0) {
  return {"run", test::recording_of({0.0, step_s}, {0.0, 1.0}, speed_m_per_s)};
}

Analysis moving(MotionClass motion, double frequency_Hz = 0.0) {
  Analysis analysis;
  analysis.motion = motion;
  if (frequency_Hz > 0.0) analysis.frequency.quoted.value = frequency_Hz;
  return analysis;
}

Analysis repeating_over(double path_m) {
  Analysis analysis;
  analysis.tests.push_back({TestKind::LevelRepeats, path_m, 1e-3 * path_m, 1e-9, {}});
  return analysis;
}

}  // namespace

TEST_CASE("samples lost in one stick while the clock runs on are in no frequency") {
  const Analysis analysis = analyze_and_fit(saw_teeth_with_loss(20));
  CHECK(warns(analysis, "broken_rhythm"));
  CHECK(holds(analysis.frequency.quoted, 1.0 / kPeriod_s));
  CHECK_FALSE(warns(analyze_and_fit(saw_teeth_with_loss(100)), "broken_rhythm"));
}

TEST_CASE("oscillations seen through a long average do not show that stick-slip has ended") {
  const std::vector<SweepEntry> entries{entry_at(1e-3, 1e-3), entry_at(2e-3, 1e-3), entry_at(4e-3, 1e-3),
                                        entry_at(8e-3, 1e-3)};
  const std::vector<Analysis> analyses{moving(MotionClass::StickSlip), moving(MotionClass::SteadySliding),
                                       moving(MotionClass::OscillatorySlip, 5.0), moving(MotionClass::SteadySliding)};
  const ObservedEnd clear = observed_end(entries, analyses, {});
  CHECK(*clear.sticks_m_per_s == 1e-3);
  CHECK(*clear.slides_m_per_s == 2e-3);
  FitResult averaged;
  averaged.parameters.push_back({ParameterId::SensorAverage, {}, ParameterStatus::Weak});
  averaged.parameters.back().estimate.value = 0.1;
  const ObservedEnd hidden = observed_end(entries, analyses, averaged);
  CHECK(*hidden.sticks_m_per_s == 1e-3);
  CHECK(*hidden.slides_m_per_s == 8e-3);
  // A step of the clock draws out the fall as well.
  const std::vector<Analysis> swings{moving(MotionClass::StickSlip), moving(MotionClass::OscillatorySlip, 2.4)};
  const std::vector<SweepEntry> fine{entry_at(1e-3, 1e-3), entry_at(2e-3, 1e-3)};
  const std::vector<SweepEntry> coarse{entry_at(1e-3, 0.026), entry_at(2e-3, 0.026)};
  CHECK(observed_end(fine, swings, averaged).slides_m_per_s == 2e-3);
  CHECK_FALSE(observed_end(coarse, swings, averaged).slides_m_per_s);
}

TEST_CASE("levels that repeat over one path at all speeds are texture, after one time a wave of the drive") {
  const std::vector<SweepEntry> entries{entry_at(1e-3), entry_at(3e-3)};
  const Warnings texture = check_level_repeats(entries, {repeating_over(5e-3), repeating_over(5.1e-3)});
  REQUIRE(texture.size() == 1);
  CHECK(texture.front().message.find("5 mm of sliding at every speed: texture") != std::string::npos);
  const Warnings clock = check_level_repeats(entries, {repeating_over(5e-3), repeating_over(15e-3)});
  REQUIRE(clock.size() == 1);
  CHECK(clock.front().message.find("5 s at every speed") != std::string::npos);
  CHECK(check_level_repeats(entries, {repeating_over(5e-3), repeating_over(9e-3)}).empty());
}

TEST_CASE("the share of cycles that a fit uses is that of those it was offered, not of all") {
  FitResult fit;
  fit.cycles.resize(1000);
  for (std::size_t i = 0; i < fit.cycles.size(); ++i) {
    fit.cycles[i].selected = i < 100;  // more than a fit needs
    fit.cycles[i].used = i < 90;
  }
  CHECK(used_share(fit) == Approx(0.9));
  CHECK_FALSE(leaves_out_most(fit));
}

}  // namespace slipfit
