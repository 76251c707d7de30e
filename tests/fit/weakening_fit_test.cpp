#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "fit/scene.hpp"
#include "model/weakening.hpp"

namespace slipfit {
namespace {

/// The scene with friction that weakens over a share of (F_s - F_k) / k; F_s scatters by `jitter` of F_s - F_k.
Recording weakening_recording(const Scene& s, double share) {
  std::mt19937_64 random(s.seed);
  std::normal_distribution<double> normal;
  const double unit_N = s.stiffness * s.speed / s.omega;
  const double lambda = (s.static_N - s.kinetic_N) / unit_N;
  const auto next_slip = [&] {
    const double z0 = lambda * (1.0 + s.jitter * normal(random)) - 2.0 * s.zeta;
    return std::pair{z0, model::WeakeningSlip(z0, s.zeta, share * lambda)};
  };
  auto [z0, slip] = next_slip();
  const double step = slip.tau_end() / s.samples_per_slip;
  double onset = lambda;
  std::vector<double> time_s, force;
  for (double cycles = 0.0; cycles < s.cycles; ++cycles) {
    auto [next_z0, next] = next_slip();
    const double next_onset = onset + next_z0 - slip.intercept();
    for (double tau = step * static_cast<double>(time_s.size()); tau < next_onset;
         tau = step * static_cast<double>(time_s.size())) {
      time_s.push_back(tau / s.omega);
      const double noise_N = s.noise * (s.static_N - s.kinetic_N) * normal(random);
      force.push_back(s.kinetic_N + unit_N * slip.at(tau - onset).z + noise_N);
    }
    onset = next_onset;
    slip = next;
  }
  Conditions conditions;
  conditions.speed_m_per_s = s.speed;
  conditions.zero_force_N = 0.0;
  return Recording::create(std::move(time_s), std::move(force), conditions).value();
}

Scene soft_contact() {
  return {.cycles = 40.0, .jitter = 0.03, .noise = 0.01};
}

const Candidate* weakening_candidate(const Analysis& analysis) {
  for (const Candidate& candidate : analysis.fit->candidates) {
    if (candidate.tier == Tier::Weakening) return &candidate;
  }
  return nullptr;
}

}  // namespace

TEST_CASE("a slip distance is found with the other parameters where slips start slowly and end abruptly") {
  const double share = GENERATE(0.15, 0.4);
  Scene s = soft_contact();
  s.seed = GENERATE(range<std::uint64_t>(1, 4));
  CAPTURE(share, s.seed);
  const Analysis analysis = analyze_and_fit(weakening_recording(s, share));
  REQUIRE(analysis.fit);
  REQUIRE(analysis.fit->tier == Tier::Weakening);
  const double difference_N = s.static_N - s.kinetic_N;
  for (const auto& [name, truth] :
       {std::pair{"slip_distance_m", share * difference_N / s.stiffness}, std::pair{"stiffness_N_per_m", s.stiffness},
        std::pair{"natural_frequency_rad_per_s", s.omega}, std::pair{"damping_ratio", s.zeta},
        std::pair{"friction_difference_N", difference_N}}) {
    INFO(name);
    const Estimate& estimate = parameter(analysis, name).estimate;
    REQUIRE(estimate.standard_error);
    // Thirty numbers: one in four hundred lies outside three standard errors.
    CHECK(std::abs(*estimate.value - truth) < 3.5 * *estimate.standard_error);
    CHECK(*estimate.value == Approx(truth).epsilon(0.2));
  }
  CHECK(weakening_candidate(analysis)->chosen);
  // What Coulomb friction would say of other speeds does not hold.
  CHECK_FALSE(analysis.fit->estimate);
  CHECK_FALSE(analysis.derived.critical_speed_m_per_s.value);
}

TEST_CASE("Coulomb friction gets no slip distance, and is not asked for one") {
  Scene s = soft_contact();
  s.seed = GENERATE(range<std::uint64_t>(1, 9));
  CAPTURE(s.seed);
  const Analysis analysis = analyze_and_fit(record(s));
  REQUIRE(analysis.fit);
  CHECK(analysis.fit->tier != Tier::Weakening);
  CHECK(weakening_candidate(analysis) == nullptr);
}

TEST_CASE("intervals behind an average hold what a slip distance too short to be told does to them") {
  Scene s = soft_contact();
  s.noise = 0.0;
  s.zeta = 0.1;
  s.samples_per_slip = 60.0;
  s.seed = GENERATE(range<std::uint64_t>(1, 5));
  CAPTURE(s.seed);
  const Recording recording =
      moving_average(weakening_recording(s, 0.04), 45, 0.01 * (s.static_N - s.kinetic_N), s.seed);
  const Analysis analysis = analyze_and_fit(recording);
  REQUIRE(analysis.fit);
  for (const auto& [name, truth] :
       {std::pair{"natural_frequency_rad_per_s", s.omega}, std::pair{"damping_ratio", s.zeta}}) {
    INFO(name);
    const std::optional<Interval>& ci95 = parameter(analysis, name).estimate.ci95;
    REQUIRE(ci95);
    // Eight numbers: one in twenty lies outside its interval, one in four hundred outside one that is half as wide
    // again.
    const double room = 0.25 * (ci95->high - ci95->low);
    CHECK(ci95->low - room <= truth);
    CHECK(ci95->high + room >= truth);
  }
}

TEST_CASE("slips that weaken show no average of the sensor: it would have to explain them better, and surely") {
  const auto [share, noise, samples, seed] =
      GENERATE(table<double, double, double, std::uint64_t>({{0.08, 0.025, 25.0, 4},
                                                             {0.08, 0.025, 25.0, 12},
                                                             {0.08, 0.025, 25.0, 13},
                                                             {0.04, 0.025, 50.0, 8},
                                                             {0.08, 0.002, 25.0, 12},
                                                             {0.04, 0.002, 50.0, 14}}));
  Scene s = soft_contact();
  s.zeta = 0.12;
  s.jitter = 0.0;
  s.cycles = 30.0;
  s.noise = noise;
  s.samples_per_slip = samples;
  s.seed = seed;
  CAPTURE(share, noise, samples, seed);
  const Analysis analysis = analyze_and_fit(weakening_recording(s, share));
  REQUIRE(analysis.fit);
  CHECK_FALSE(analysis.fit->estimate_of(ParameterId::SensorAverage).value);
  const Estimate omega = analysis.fit->natural_frequency();
  if (omega.value) CHECK(std::abs(*omega.value - s.omega) < 3.5 * *omega.standard_error);
}

TEST_CASE("a slip distance that is asked for in vain is unknown with the reason") {
  FitOptions options;
  options.tier = Tier::Weakening;
  Scene s = soft_contact();
  SECTION("few samples in a slip") {
    s.samples_per_slip = 4.0;
    const Analysis analysis = analyze_and_fit(record(s), options);
    REQUIRE(analysis.fit);
    CHECK(analysis.fit->tier == Tier::Weakening);
    for (const char* const name : {"slip_distance_m", "natural_frequency_rad_per_s"}) {
      INFO(name);
      CHECK(parameter(analysis, name).status == ParameterStatus::Unidentified);
      CHECK_FALSE(parameter(analysis, name).estimate.note.empty());
    }
  }
  SECTION("Coulomb friction") {
    const Analysis analysis = analyze_and_fit(record(s), options);
    REQUIRE(analysis.fit);
    CHECK(analysis.fit->tier == Tier::Weakening);
    for (const Parameter& p : analysis.fit->parameters) {
      INFO(p.name());
      if (p.id == ParameterId::SlipDistance) CHECK_FALSE(p.estimate.note.empty());
      const bool is_of_sticks = p.id == ParameterId::Stiffness || p.id == ParameterId::StaticFriction;
      if (!is_of_sticks) CHECK(p.status != ParameterStatus::Identified);
    }
  }
}

}  // namespace slipfit
