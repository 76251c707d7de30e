#include "analysis/ring_down.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace slipfit {
namespace {

struct Ring {
  std::vector<double> time_s, force;
};

Ring ring_of(double omega, double decay, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> draw(0.0, 1.0);
  Ring ring;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.1 * i;
    ring.time_s.push_back(3.0 + t);
    ring.force.push_back(2.0 - 0.05 * t + std::exp(-decay * t) * std::cos(omega * t + 1.0) + noise * draw(random));
  }
  return ring;
}

}  // namespace

TEST_CASE("least squares of a decaying oscillation recover its parameters", "[ring_down]") {
  constexpr double kOmega = 5.0;
  constexpr double kDecay = 0.4;
  constexpr int kRings = 200;
  int frequencies = 0;
  int decays = 0;
  for (unsigned seed = 0; seed < kRings; ++seed) {
    const Ring ring = ring_of(kOmega, kDecay, 0.03, seed);
    const auto sine = fit_damped_sine(ring.time_s, ring.force, 1.05 * kOmega, 0.7 * kDecay);
    REQUIRE(sine);
    frequencies += std::abs(sine->omega_rad_per_s - kOmega) < 2.0 * sine->omega_error_rad_per_s ? 1 : 0;
    decays += std::abs(sine->decay_per_s - kDecay) < 2.0 * sine->decay_error_per_s ? 1 : 0;
  }
  // 95 % of 200 are 190 +- 3; errors are the larger ones of two estimates.
  CHECK(frequencies >= 184);
  CHECK(decays >= 184);
}

TEST_CASE("least squares of an oscillation are exact without noise, and empty without an oscillation", "[ring_down]") {
  const Ring ring = ring_of(5.0, 0.4, 0.0, 1);
  const auto sine = fit_damped_sine(ring.time_s, ring.force, 5.2, 0.3);
  REQUIRE(sine);
  CHECK(sine->omega_rad_per_s == Approx(5.0).epsilon(1e-9));
  CHECK(sine->decay_per_s == Approx(0.4).epsilon(1e-9));
  CHECK_FALSE(fit_damped_sine(ring.time_s, ring.force, 12.0, 0.3));  // far from the only one
  const std::vector<double> few(ring.time_s.begin(), ring.time_s.begin() + 7);
  CHECK_FALSE(fit_damped_sine(few, std::vector<double>(7, 1.0), 5.0, 0.4));
}

}  // namespace slipfit
