// What makes slips, ripple, chatter and hum different kinds of motion.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "analysis/classify.hpp"
#include "analysis/detect.hpp"
#include "checks.hpp"
#include "core/thresholds.hpp"
#include "signal/mains.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {
namespace {

constexpr double kPi = std::numbers::pi;

Recording recorded(std::vector<double> force, double sample_rate_Hz, double speed_m_per_s = 0.01,
                   std::optional<double> drive_path_m = {}) {
  Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  conditions.drive_path_m = drive_path_m;
  std::vector<double> time_s;
  for (std::size_t i = 0; i < force.size(); ++i) time_s.push_back(static_cast<double>(i) / sample_rate_Hz);
  return Recording::create(std::move(time_s), std::move(force), conditions).value();
}

/// From 0 to 1, as round as a sine.
double round_rise(double share) {
  return 0.5 - 0.5 * std::cos(kPi * share);
}

/// Two steps, which no straight stick is close to.
double stepped_rise(double share) {
  const double step = std::floor(2.0 * share);
  return (step + std::min(1.0, 5.0 * (2.0 * share - step))) / 2.0;
}

/// Ripple of a drive, once in 10 mm of its path: rises that take `ratio` times as long as the falls.
Recording cogging(double ripples, double speed_m_per_s, double ratio, std::optional<double> drive_path_m = {}) {
  constexpr double kPath_m = 0.01;
  constexpr double kSamplesOfRipple = 150.0;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> force;
  const double rise = ratio / (1.0 + ratio);
  for (double place = 0.0; place < ripples; place += 1.0 / kSamplesOfRipple) {
    const double phase = std::fmod(place, 1.0);
    const double height = phase < rise ? stepped_rise(phase / rise) : 1.0 - round_rise((phase - rise) / (1.0 - rise));
    // A second wave over the path, so that no slip of the model is close.
    force.push_back(5.0 + 2.0 * height + 0.4 * std::sin(2.0 * kPi * 0.37 * place) + 0.01 * normal(random));
  }
  return recorded(std::move(force), kSamplesOfRipple * speed_m_per_s / kPath_m, speed_m_per_s, drive_path_m);
}

/// Low swings of very different size and length on a steady level.
Recording chatter(double zero_N) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::vector<double> force;
  while (force.size() < 6000) {
    const double swing_N = 0.5 + 0.5 * even(random);
    const auto samples = static_cast<std::size_t>(20.0 + 180.0 * even(random) * even(random));
    for (std::size_t i = 0; i < samples; ++i) {
      force.push_back(zero_N + swing_N * std::sin(2.0 * kPi * static_cast<double>(i) / static_cast<double>(samples)));
    }
  }
  std::normal_distribution<double> noise(0.0, 0.005);
  for (double& value : force) value += noise(random);
  return recorded(std::move(force), 1000.0);
}

/// A body on a spring under Coulomb friction whose static friction scatters from stick to stick, lambda = 1.1: nearly a
/// sine. Scaled, so that it repeats at about `frequency_Hz`.
Recording round_slips(double frequency_Hz, double scatter, double duration_s) {
  constexpr double kSampleRate_Hz = 2000.0;
  constexpr int kSteps = 20;
  constexpr double kZeta = 0.05;
  constexpr double kLambda = 1.1;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const double omega = 6.5766 * frequency_Hz;  // by counting the slips without scatter
  const double step = omega / kSampleRate_Hz / kSteps;
  double stretch = 0.0, speed = 0.0, limit = kLambda * (1.0 + scatter * normal(random));
  bool sticks = true;
  std::vector<double> force;
  while (static_cast<double>(force.size()) < duration_s * kSampleRate_Hz) {
    force.push_back(3.0 + stretch + 0.003 * normal(random));
    for (int i = 0; i < kSteps; ++i) {
      const double push = stretch - 2.0 * kZeta * speed;
      if (sticks) {
        stretch += step;
        sticks = stretch < limit;
      } else {
        const double before = speed;
        speed += step * push;
        stretch += step * (1.0 - 0.5 * (before + speed));
        sticks = speed <= 0.0 && push < 0.0;
        if (sticks) limit = kLambda * (1.0 + scatter * normal(random));
        if (sticks) speed = 0.0;
      }
    }
  }
  return recorded(std::move(force), kSampleRate_Hz);
}

Recording hum(double frequency_Hz, double duration_s) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> force;
  for (int i = 0; i < static_cast<int>(duration_s * 2000.0); ++i) {
    force.push_back(3.0 + std::sin(2.0 * kPi * frequency_Hz * i / 2000.0) + 0.003 * normal(random));
  }
  return recorded(std::move(force), 2000.0);
}

Segmentation falls_of(const Recording& recording) {
  return find_slips(recording, assess_quality(recording));
}

}  // namespace

TEST_CASE("few falls after rises that take three times as long are not stick-slip") {
  const double ripples = GENERATE(6.3, 8.3);
  const Recording ripple = cogging(ripples, 0.001, 2.45);
  REQUIRE(falls_of(ripple).slips.size() >= 5);
  CHECK(analyze_and_fit(ripple).motion != MotionClass::StickSlip);
  CHECK(analyze(ripple).motion != MotionClass::StickSlip);
}

TEST_CASE("ripple over the stated drive path is steady sliding, which has no slips") {
  const Recording ripple = cogging(25.3, 0.001, 4.5, 0.01);
  const Analysis analysis = analyze_and_fit(ripple);
  CHECK(analysis.motion == MotionClass::SteadySliding);
  CHECK(analysis.motion_reason.find("drive path") != std::string::npos);
  CHECK_FALSE(analysis.frequency.quoted.value);
  CHECK(analysis.cycles.count == 0);
  CHECK(analysis.cycles.used == 0);
  CHECK_FALSE(analysis.frequency.counted.value);
  CHECK(std::ranges::none_of(analysis.cycle_table, [](const Cycle& cycle) { return cycle.used; }));
  CHECK(analyze_and_fit(cogging(25.3, 0.001, 4.5, 0.0083)).motion != MotionClass::SteadySliding);
}

TEST_CASE("ripple over one path at two speeds is geometry in a sweep") {
  const std::vector<SweepEntry> entries{{"slow", cogging(25.3, 0.001, 4.5)}, {"fast", cogging(25.3, 0.01, 4.5)}};
  const SweepAnalysis sweep = analyze_sweep(entries);
  REQUIRE_FALSE(sweep.warnings.empty());
  CHECK(sweep.warnings.front().code == "frequency_does_not_follow_speed");
  for (const Analysis& analysis : sweep.recordings) {
    CHECK(analysis.motion == MotionClass::Undetermined);
    CHECK_FALSE(analysis.frequency.quoted.value);
  }
}

TEST_CASE("large irregular swings are not steady sliding, whatever the zero of the sensor") {
  const double zero_N = GENERATE(0.0, 3.0, 300.0);
  const Analysis analysis = analyze_and_fit(chatter(zero_N));
  CHECK(analysis.motion == MotionClass::Undetermined);
  CHECK(analysis.motion_reason.find("irregular") != std::string::npos);
  CHECK(analysis.cycles.period_s);
}

TEST_CASE("large irregular swings stay what they are where samples are missing") {
  const Recording whole = chatter(0.0);
  std::mt19937_64 random(2);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (random() % 20 != 0) kept.push_back(i);
  }
  const Recording part = whole.selected(kept);
  const double smooth_whole = smoothness(whole, assess_quality(whole), falls_of(whole));
  const double smooth_part = smoothness(part, assess_quality(part), falls_of(part));
  CHECK(smooth_part == Approx(smooth_whole).margin(0.2));
  CHECK(analyze_and_fit(part).motion == MotionClass::Undetermined);
}

TEST_CASE("nearly sinusoidal slips near the mains differ from its hum by their phase") {
  const double frequency_Hz = GENERATE(49.8, 50.0, 60.0);
  CAPTURE(frequency_Hz);
  const Recording slips = round_slips(frequency_Hz, 0.04, 5.0);
  CHECK(phase_wanders(falls_of(slips)));
  const Analysis analysis = analyze_and_fit(slips);
  CHECK((analysis.motion == MotionClass::StickSlip || analysis.motion == MotionClass::OscillatorySlip));
  REQUIRE(analysis.frequency.quoted.value);
  CHECK(*analysis.frequency.quoted.value == Approx(frequency_Hz).epsilon(0.01));
  CHECK_FALSE(phase_wanders(falls_of(hum(frequency_Hz, 5.0))));
  CHECK(analyze_and_fit(hum(frequency_Hz, 5.0)).motion == MotionClass::Undetermined);
}

TEST_CASE("a reported frequency that is not the count states its method") {
  for (const double duration_s : {0.35, 0.7, 1.0, 2.0}) {
    for (const double frequency_Hz : {48.0, 59.1, 61.0}) {
      CAPTURE(duration_s, frequency_Hz);
      const Analysis analysis = analyze_and_fit(round_slips(frequency_Hz, 0.02, duration_s));
      const FrequencyReport& report = analysis.frequency;
      if (!report.quoted.value || !report.counted.value) continue;
      const bool agree = std::abs(*report.quoted.value / *report.counted.value - 1.0) < 0.05;
      CHECK((agree || !report.quoted.note.empty()));
      CHECK(*report.quoted.value == Approx(frequency_Hz).epsilon(0.05));
    }
  }
}

TEST_CASE("multiples of the slips' frequency are not called harmonics of the mains") {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::vector<double> force;
  constexpr double kSlips_Hz = 9.998;
  for (int i = 0; i < 10000; ++i) {
    const double phase = std::fmod(kSlips_Hz * i / 2000.0, 1.0);
    const double fall = 0.5 * (1.0 + std::cos(kPi * (phase - 0.97) / 0.03));
    const double ring = phase < 0.4 ? 0.1 * std::exp(-20.0 * phase) * std::sin(2.0 * kPi * 25.0 * phase) : 0.0;
    force.push_back(2.0 + (phase < 0.97 ? phase / 0.97 : fall) + ring + 0.002 * normal(random));
  }
  const Analysis analysis = analyze_and_fit(recorded(std::move(force), 2000.0, 1e-3));
  REQUIRE(analysis.frequency.quoted.value);
  for (const auto& lines : {analysis.frequency.lines, analysis.frequency.spectral.suspicious_lines}) {
    for (const SuspiciousLine& line : lines) {
      CAPTURE(line.frequency_Hz, line.reason);
      CHECK(std::abs(std::remainder(line.frequency_Hz, kSlips_Hz)) > 0.3);
    }
  }
}

TEST_CASE("a spectrum has lines of one mains") {
  constexpr double kBin_Hz = 0.5;
  std::vector<double> power(2000, 1e-6);
  const auto put = [&](double frequency_Hz, double value) {
    power[static_cast<std::size_t>(frequency_Hz / kBin_Hz)] = value;
  };
  for (const double line_Hz : {50.0, 100.0, 150.0}) put(line_Hz, 1.0);
  for (const double line_Hz : {60.0, 120.0}) put(line_Hz, 0.01);
  const std::vector<signal::MainsLine> lines = signal::find_mains(power, kBin_Hz, kBin_Hz);
  REQUIRE(lines.size() == 3);
  for (const signal::MainsLine& line : lines) CHECK(line.mains_Hz == 50.0);
}

/// Falls of a tenth of the time between them, with these drops, once in a second.
Segmentation falls(const std::vector<double>& drops, double noise) {
  Segmentation segmentation;
  segmentation.noise = noise;
  for (std::size_t i = 0; i < drops.size(); ++i) {
    const double second = static_cast<double>(i);
    segmentation.slips.push_back({100 * i + 90, 100 * i + 100, 2.0, 2.0 - drops[i], second, 0.06, 0.54});
  }
  return segmentation;
}

TEST_CASE("large irregular swings that ring are not steady sliding, those of noise are") {
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal(0.0, 0.5);
  std::vector<double> force(2000);
  for (double& value : force) value = normal(random);
  const Recording recording = recorded(std::move(force), 100.0, 0.001);
  Estimates estimates;
  double time_s = 0.0;
  for (std::size_t i = 0; i < 40; ++i) {
    time_s += i % 2 == 0 ? 0.1 : 0.9;
    estimates.signals.segmentation.slips.push_back({50 * i, 50 * i + 4, 1.0, -1.0, time_s, 0.04, 0.04});
  }
  estimates.signals.segmentation.noise = 0.01;
  estimates.signals.quality.noise_rms = 0.01;
  CHECK(classify(recording, estimates).motion == MotionClass::Undetermined);
  estimates.signals.quality.noise_rms = 0.5;
  CHECK(classify(recording, estimates).motion == MotionClass::SteadySliding);
}

TEST_CASE("rises have no gap, whatever the clock scatters by") {
  const auto rises = [](double gap_s) {
    std::vector<double> time_s, force;
    Segmentation segmentation;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 200; ++j) {
        const double step_s = j % 10 == 0 ? 0.03 : 0.01;  // one in ten steps is three times as long
        const double before_s = time_s.empty() ? 0.0 : time_s.back();
        time_s.push_back(before_s + (i == 3 && j == 100 ? gap_s : step_s));
        force.push_back(static_cast<double>(j) / 200.0);
      }
      const std::size_t peak = force.size() - 1;
      if (i > 0) segmentation.slips.back().trough = peak - 199;
      segmentation.slips.push_back({peak, peak, 1.0, 0.0, time_s.back(), 0.01, 2.0});
    }
    Conditions conditions;
    conditions.speed_m_per_s = 0.001;
    const auto recording = Recording::create(std::move(time_s), std::move(force), conditions);
    return rises_of(recording.value(), segmentation).size();
  };
  CHECK(rises(0.03) == 5);
  CHECK(rises(0.5) == 4);
}

TEST_CASE("sudden falls at random are slips where the force rises between them, and irregular where it wanders") {
  const auto classified = [](const auto& rise) {
    std::vector<double> force;
    Estimates estimates;
    for (std::size_t i = 0; i < 20; ++i) {
      const std::size_t samples = i % 3 == 0 ? 50 : 150;
      for (std::size_t j = 0; j < samples; ++j)
        force.push_back(rise(static_cast<double>(j) / static_cast<double>(samples)));
      const std::size_t peak = force.size() - 1;
      for (std::size_t j = 0; j < 5; ++j) force.push_back(0.8 - 0.2 * static_cast<double>(j));
      estimates.signals.segmentation.slips.push_back(
          {peak, force.size() - 1, force[peak], 0.0, 0.01 * static_cast<double>(peak), 0.03, 0.3});
    }
    return classify(recorded(std::move(force), 100.0, 0.001), estimates);
  };
  CHECK(classified([](double x) { return x; }).motion == MotionClass::StickSlip);
  const Classification wanders =
      classified([](double x) { return std::min(1.0, 10.0 * x) + 0.2 * std::sin(30.0 * x); });
  CHECK(wanders.motion == MotionClass::Undetermined);
  CHECK(wanders.reason.find("irregular") != std::string::npos);
}

TEST_CASE("nine falls that no model fits have to be twice as sudden as ten") {
  const auto kind_of = [](std::size_t count, double ratio) {
    Estimates estimates;
    Segmentation& segmentation = estimates.signals.segmentation = falls(std::vector<double>(count, 1.0), 0.01);
    for (DetectedSlip& slip : segmentation.slips) slip.rise_s = ratio * slip.fall_s;
    return classify(recorded(std::vector<double>(2000, 1.0), 100.0, 0.001), estimates).motion;
  };
  CHECK(kind_of(10, 4.5) == MotionClass::StickSlip);
  CHECK(kind_of(9, 4.5) == MotionClass::Undetermined);
  CHECK(kind_of(9, 9.0) == MotionClass::StickSlip);
}

TEST_CASE("whether a fit that determines nothing is loose or worse does not change the answer") {
  const Recording recording = recorded(std::vector<double>(2000, 1.0), 100.0, 0.001);
  Estimates estimates;
  estimates.signals.segmentation = falls(std::vector<double>(20, 1.0), 0.01);
  FitResult fit;
  fit.cycles.resize(20);
  for (Cycle& cycle : fit.cycles) cycle.used = true;
  fit.diagnostics.restick_share = 1.0;
  fit.diagnostics.span_share = 1.0;
  fit.diagnostics.onset_force_spread = 0.1;
  Parameter difference;
  difference.id = ParameterId::FrictionDifference;
  const auto classified = [&](double residual, ParameterStatus status) {
    fit.diagnostics.relative_residual = residual;
    difference.status = status;
    fit.parameters = {difference};
    estimates.fit = fit;
    return classify(recording, estimates);
  };
  for (const double residual : {0.17, 0.22}) {
    const Classification found = classified(residual, ParameterStatus::Unidentified);
    CHECK(found.motion == MotionClass::StickSlip);
    CHECK_FALSE(found.model_fits);
  }
  CHECK(classified(0.17, ParameterStatus::Weak).model_fits);
  CHECK(classified(0.05, ParameterStatus::Unidentified).model_fits);
}

TEST_CASE("a force is no noise where as many falls as slips are needed stand out, however many do not") {
  const Recording recording = recorded(std::vector<double>(2000, 1.0), 100.0, 0.001);
  const auto motion_with = [&](std::size_t large) {
    std::vector<double> drops(15, 0.9);
    std::fill_n(drops.begin() + 5, large, 3.0);
    Signals signals;
    signals.segmentation = falls(drops, 1.0 / thresholds::kNoiseDrop);
    return classify_by_shape(recording, signals).motion;
  };
  CHECK(motion_with(thresholds::kFewestSlips - 1) == MotionClass::SteadySliding);
  CHECK(motion_with(thresholds::kFewestSlips) != MotionClass::SteadySliding);
}

TEST_CASE("half of the falls no larger than noise makes them is faint, however many they are") {
  const double noise = 1.0 / thresholds::kNoiseDrop;
  CHECK(is_faint(falls({0.9, 2.0}, noise)));
  CHECK(is_faint(falls({0.9, 0.7, 2.0}, noise)));
  CHECK(is_faint(falls({2.0, 0.9, 0.7, 2.0}, noise)));
  CHECK_FALSE(is_faint(falls({2.0, 0.9, 2.0}, noise)));
  CHECK_FALSE(is_faint(falls({2.0, 2.0}, noise)));
}

/// Straight rises and falls in turn, with a little noise.
std::vector<double> saw(double cycles, double samples, double rise_share) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(0.0, 0.003);
  std::vector<double> force;
  for (double place = 0.0; place < cycles; place += 1.0 / samples) {
    const double phase = std::fmod(place, 1.0);
    force.push_back(3.0 + (phase < rise_share ? phase / rise_share : (1.0 - phase) / (1.0 - rise_share)) +
                    normal(random));
  }
  return force;
}

TEST_CASE("a force with the other sign is no oscillation, and the reason says so") {
  const Analysis upright = analyze_and_fit(recorded(saw(40.0, 100.0, 0.9), 1000.0));
  CHECK(upright.motion == MotionClass::StickSlip);
  const Analysis reversed = analyze_and_fit(recorded(saw(40.0, 100.0, 0.1), 1000.0));
  CHECK(reversed.motion == MotionClass::Undetermined);
  CHECK_THAT(reversed.motion_reason, Catch::Contains("the other sign"));
}

TEST_CASE("a force that only rises is not known to slide, and one that has a trend does") {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal(0.0, 0.01);
  std::vector<double> ramp, trend;
  for (int i = 0; i < 5000; ++i) {
    ramp.push_back(1e-3 * i + normal(random));
    trend.push_back(5.0 + 2e-4 * i + normal(random));
  }
  CHECK(analyze_and_fit(recorded(ramp, 1000.0)).motion == MotionClass::Undetermined);
  CHECK(analyze_and_fit(recorded(trend, 1000.0)).motion == MotionClass::SteadySliding);
}

TEST_CASE("sticks at another speed of the drive are told from the rest") {
  // 30 cycles at one speed, then 20 whose sticks rise a tenth faster.
  const double rate_Hz = 1000.0;
  std::vector<double> force;
  for (int cycle = 0; cycle < 50; ++cycle) {
    const int samples = cycle < 30 ? 110 : 100;
    for (int i = 0; i < samples; ++i) force.push_back(3.0 + 1.0 * i / samples);
    for (int i = 0; i < 10; ++i) force.push_back(3.0 + 0.5 * (1.0 + std::cos(kPi * i / 10.0)));
  }
  std::mt19937_64 random(10);
  std::normal_distribution<double> normal(0.0, 0.002);
  for (double& value : force) value += normal(random);
  const Analysis analysis = analyze_and_fit(recorded(force, rate_Hz));
  const OtherSticks& others = analysis.cycles.other_sticks;
  CHECK(others.count > 15);
  CHECK(others.count <= 20);
  CHECK(*others.stiffness.value == Approx(1.0 / 0.1 / 0.01).epsilon(0.01));
  CHECK(*analysis.cycles.stick_stiffness.value == Approx(1.0 / 0.11 / 0.01).epsilon(0.01));
}

}  // namespace slipfit
