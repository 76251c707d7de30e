// The fit's own dense slip against the exact tiers.

#include "model/velocity_slip.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "model/slip.hpp"
#include "support/velocity_motion.hpp"

using namespace slipfit;
using model::VelocityTrack;

namespace {

struct RandomSlip {
  double lambda, zeta, strength, rate;
};

RandomSlip random_slip(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  return {std::exp(uniform(std::log(0.5), std::log(200.0))), uniform(0.0, 0.3), uniform(0.0, 5.0), uniform(-3.0, 0.01)};
}

}  // namespace

TEST_CASE("track: end of slip, waveform and derivatives agree with the exact velocity-dependent tier") {
  std::mt19937_64 random(79);
  double worst_force = 0.0;
  double worst_derivative = 0.0;
  int compared = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const RandomSlip s = random_slip(random);
    INFO("lambda " << s.lambda << " zeta " << s.zeta << " strength " << s.strength << " rate " << s.rate);
    const Slider slider = Slider::create(1.0, 1.0, s.zeta).value();
    const double onset_N = 10.0;
    const auto friction =
        VelocityFriction::create(onset_N + s.lambda, onset_N - s.strength, s.strength, s.rate).value();
    const auto exact = velocity_derivatives(slider, friction, 1.0).value();
    const auto track = VelocityTrack::solve(s.lambda - 2.0 * s.zeta, s.zeta, s.strength * s.rate, s.rate);
    REQUIRE(track);
    REQUIRE(track->resticks() == exact.has_value());
    if (!exact) continue;
    // Where a slip grazes rest, its end is a matter of square roots.
    if (exact->stick_s.value < 0.2 * exact->period_s.value) continue;
    ++compared;
    const double size = 1.0 + s.lambda;
    CHECK(track->tau_end() == Approx(exact->slip_s.value).epsilon(1e-6));
    std::vector<double> tau;
    for (int i = 0; i <= 60; ++i) tau.push_back(exact->period_s.value * i / 60.0);
    const auto waveform = velocity_waveform(slider, friction, 1.0, tau).value();
    for (std::size_t i = 0; i < tau.size(); ++i) {
      worst_force = std::max(worst_force, std::abs(track->at(tau[i]).z + onset_N - waveform.spring_force_N[i]) / size);
    }

    // z(tau) = intercept + tau after the slip: intercept = z_end - tau_end.
    const auto intercept_by = [&](VelocityParameter p) { return exact->end_force_N.by(p) - exact->slip_s.by(p); };
    const model::TrackValue line = track->after();
    const double by_z0 = intercept_by(VelocityParameter::StaticFriction);
    // At fixed z0 = lambda - 2 zeta; at a fixed F_k(0+) = f0 + f1; slope = f1 alpha.
    const double by_zeta = intercept_by(VelocityParameter::DampingRatio) + 2.0 * by_z0;
    const double by_strength = intercept_by(VelocityParameter::F1) - intercept_by(VelocityParameter::F0);
    const double by_alpha = intercept_by(VelocityParameter::Alpha);
    const double by_slope_and_rate = line.d_slope * s.strength + line.d_rate;
    for (const auto& [fast, slow] :
         {std::pair{line.d_z0, by_z0}, std::pair{line.d_zeta, by_zeta}, std::pair{line.d_slope * s.rate, by_strength},
          std::pair{by_slope_and_rate, by_alpha}}) {
      const double error = std::abs(fast - slow) / (std::abs(slow) + size);
      worst_derivative = std::max(worst_derivative, error);
    }
  }
  CHECK(compared > 100);
  CHECK(worst_force < 1e-6);
  CHECK(worst_derivative < 1e-6);
}

TEST_CASE("track: far from ordinary parameters it agrees with the exact tier or gives nothing") {
  // Thin layers at rest (rate -20) and friction that runs away (rate > 0, strength < 0) have given wrong ends of slip.
  std::mt19937_64 random(89);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int compared = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double lambda = std::exp(uniform(std::log(0.3), std::log(1e4)));
    const double zeta = uniform(0.0, 0.5);
    const double strength = uniform(-1.0, 1.0) * std::exp(uniform(-3.0, 5.0));
    const double rate = (trial % 7 == 0 ? 1.0 : -1.0) * std::exp(uniform(-7.0, 3.0));
    const double onset_N = std::abs(strength) + 1.0;
    const auto friction = VelocityFriction::create(onset_N + lambda, onset_N - strength, strength, rate).value();
    const auto exact = velocity_motion(Slider::create(1.0, 1.0, zeta).value(), friction, 1.0);
    const auto track = VelocityTrack::solve(lambda - 2.0 * zeta, zeta, strength * rate, rate);
    INFO("lambda " << lambda << " zeta " << zeta << " strength " << strength << " rate " << rate);
    const bool runs_away = !exact && strength < 0.0 && rate > 0.0;
    if (runs_away && track) CHECK_FALSE(track->resticks());
    if (!exact || !exact.value().motion.cycle) continue;
    const LimitCycle& cycle = *exact.value().motion.cycle;
    // Friction that grows by more than exp(10) within a slip is a wall: following it is stiff, and fits give up.
    if (rate * lambda <= 10.0) REQUIRE(track);
    if (!track) continue;
    CHECK(track->resticks());
    if (cycle.sticking_degree < 0.2) continue;
    ++compared;
    CHECK(track->tau_end() == Approx(cycle.slip_s).epsilon(2e-6));
  }
  CHECK(compared > 1000);
}

TEST_CASE("track: friction linear in the speed agrees with the closed form of viscous damping") {
  std::mt19937_64 random(83);
  double worst = 0.0;
  for (int trial = 0; trial < 300; ++trial) {
    const RandomSlip s = random_slip(random);
    const double slope = 0.2 * (s.strength - 2.5) / 2.5;  // of either sign
    if (s.zeta + 0.5 * slope < 0.0) continue;
    const double z0 = s.lambda - 2.0 * s.zeta;
    const auto track = VelocityTrack::solve(z0, s.zeta, slope, 0.0);
    REQUIRE(track);
    // z - slope is a free oscillation with the damping zeta + slope / 2.
    const model::Slip slip = model::solve_slip(z0 - slope, s.zeta + 0.5 * slope);
    INFO("z0 " << z0 << " zeta " << s.zeta << " slope " << slope);
    REQUIRE(track->resticks() == slip.resticks);
    if (slip.resticks && slip.end.ddz > -0.05) continue;  // grazes
    CHECK(track->tau_end() == Approx(slip.tau_end).epsilon(1e-6));
    for (double tau = 0.0; tau < slip.tau_end; tau += 0.2) {
      const model::WavePoint closed = model::slip_wave(slip, tau);
      const model::TrackPoint point = track->at(tau);
      const double size = 1.0 + s.lambda;
      for (const double error :
           {point.z - slope - closed.z, point.d_tau - closed.d_tau, point.d_z0 - closed.d_z0,
            point.d_zeta - closed.d_zeta, point.d_slope - (1.0 - closed.d_z0 + 0.5 * closed.d_zeta)}) {
        worst = std::max(worst, std::abs(error) / size);
      }
    }
  }
  CHECK(worst < 1e-6);
}
