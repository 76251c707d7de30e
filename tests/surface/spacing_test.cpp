#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "support/holds.hpp"
#include "surface/filter.hpp"
#include "surface/measure.hpp"
#include "surface/spacing.hpp"
#include "surfaces.hpp"

using slipfit::Estimate;
using slipfit::measure_surface;
using slipfit::Profile;
using slipfit::Surface;
using slipfit::SurfaceStatus;
using test::holds;

namespace {

Surface measured(const Profile& profile) {
  auto surface = measure_surface(profile);
  REQUIRE(surface);
  return std::move(surface).value();
}

double half_width(const Estimate& estimate) {
  return 0.5 * (estimate.ci95->high - estimate.ci95->low) / *estimate.value;
}

constexpr double kTwoPi = 2.0 * std::numbers::pi;

}  // namespace

TEST_CASE("the interval of a mean distance covers, whether neighbours balance, agree or neither", "[surface]") {
  // 500 series each: a share of 0.95 has a standard deviation of 1 %, and the bound is three of them below.
  for (const double link : {-0.45, 0.0, 0.45}) {
    std::mt19937 generator(7);
    std::normal_distribution<double> normal;
    const double along = link == 0.0 ? 0.0 : (1.0 - std::sqrt(1.0 - 4.0 * link * link)) / (2.0 * link);
    int held = 0;
    for (int k = 0; k < 500; ++k) {
      std::vector<double> distances;
      double last = normal(generator);
      for (int i = 0; i < 25; ++i) {
        const double next = normal(generator);
        distances.push_back(10.0 + next + along * last);
        last = next;
      }
      const auto mean = slipfit::surface::mean_spacing(distances);
      REQUIRE(mean);
      held += mean->ci95.low <= 10.0 && 10.0 <= mean->ci95.high ? 1 : 0;
    }
    CAPTURE(link, held);
    CHECK(held > 0.92 * 500);
  }
  CHECK_FALSE(slipfit::surface::mean_spacing(std::vector<double>{1.0, 2.0, 1.0}));
}

TEST_CASE("a comb counts as far as the distances keep its time", "[surface]") {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  std::vector<double> even;
  std::vector<double> walking;
  double last = normal(generator);
  for (int i = 0; i < 60; ++i) {
    const double next = normal(generator);
    even.push_back(10.0 + next - last);  // places about even marks
    walking.push_back(10.0 + next);
    last = next;
  }
  const slipfit::surface::Clock clock{10.05, 0.001};
  const auto by_clock = slipfit::surface::mean_spacing(even, clock);
  CHECK(by_clock->clock_share > 0.9);
  CHECK(by_clock->value == Approx(10.05).margin(0.005));
  const auto by_ridges = slipfit::surface::mean_spacing(walking, clock);
  CHECK(by_ridges->clock_share < 0.01);
  CHECK(by_ridges->standard_error > 0.08);
  // Ridges seen double or not at all widen the interval of the ridges.
  CHECK(slipfit::surface::mean_spacing(walking, clock, 0.5)->standard_error > 0.5);
}

TEST_CASE("few distances that are alike by luck have a wide interval", "[surface]") {
  // Scatter of 0.2 drawn six at a time, of which those are kept that scatter by less than 0.1. A prior flat in the
  // scatter holds 84 % of these 492, one flat in its logarithm 71 %; the bound is three standard deviations (1.7 %)
  // below the former.
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  int held = 0;
  int kept = 0;
  for (int k = 0; k < 8000; ++k) {
    std::vector<double> distances;
    for (int i = 0; i < 6; ++i) distances.push_back(1.0 + 0.2 * normal(generator));
    if (slipfit::surface::variation(distances) > 0.1) continue;
    const auto mean = slipfit::surface::mean_spacing(distances);
    ++kept;
    held += mean->ci95.low <= 1.0 && 1.0 <= mean->ci95.high ? 1 : 0;
  }
  CAPTURE(kept, held);
  CHECK(kept > 200);
  CHECK(held > 0.78 * kept);
}

TEST_CASE("half of a wave as long as the cut-off passes the Gaussian filter of ISO 16610-21", "[surface]") {
  constexpr double kCutoff = 200.0;
  std::vector<double> wave;
  for (int i = 0; i < 4000; ++i) wave.push_back(std::sin(kTwoPi * i / kCutoff));
  const auto exact = slipfit::surface::gaussian_mean(wave, kCutoff);
  const auto quick = slipfit::surface::waviness(wave, kCutoff);
  // In the middle, where the ends do not reach; the weights end at one cut-off (3e-5), blocks and lines add 1e-3.
  double top = 0.0;
  double apart = 0.0;
  for (std::size_t i = 1000; i < 3000; ++i) {
    top = std::max(top, exact[i]);
    apart = std::max(apart, std::abs(exact[i] - quick[i]));
  }
  CHECK(top == Approx(0.5).margin(2e-3));
  CHECK(apart < 2e-3);
}

TEST_CASE("the form of a bent and tilted specimen is removed, and nothing else", "[surface]") {
  std::vector<double> heights;
  for (int i = 0; i < 500; ++i) heights.push_back(3.0 + 0.1 * i - 2e-4 * i * i);
  for (const double rest : slipfit::surface::without_form(heights)) CHECK(std::abs(rest) < 1e-9);
}

TEST_CASE("RSm of triangles is their width", "[surface]") {
  std::vector<double> heights;
  for (int i = 0; i < 3000; ++i) heights.push_back(std::abs(i % 60 - 30) - 15.0);
  const auto width = slipfit::surface::mean_element_width(heights, 300.0);
  REQUIRE(width);
  CHECK(*width == Approx(60.0).margin(0.1));
  CHECK(slipfit::surface::standard_cutoff_m(60e-6) == 250e-6);
}

TEST_CASE("the intervals contain the spacing of regular and of scattering ridges", "[surface]") {
  // Each profile holds with 95 %: of 60 fewer than 52 is beyond three standard deviations.
  int held = 0;
  int answered = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const test::Ridged ridged{25.0 + seed, 0.004 * seed, 0.1, 30.0 + 2.0 * seed};
    const Surface surface = measured(test::ridged_profile(ridged, seed));
    if (!surface.spacing_m.value) continue;
    ++answered;
    held += holds(surface.spacing_m, ridged.spacing * 1e-6) ? 1 : 0;
  }
  CAPTURE(answered, held);
  CHECK(answered >= 50);
  CHECK(held >= 0.87 * answered);
}

TEST_CASE("regular ridges have a narrow interval, scattering ridges a wide one", "[surface]") {
  const Surface regular = measured(test::ridged_profile({40.0, 0.0, 0.05, 50.0}, 1));
  CHECK(regular.status == SurfaceStatus::Periodic);
  CHECK(half_width(regular.spacing_m) < 0.005);
  CHECK(regular.ridges >= 48);
  CHECK(*regular.rsm_m == Approx(40e-6).epsilon(0.02));
  CHECK(*regular.asymmetry > 2.0);
  CHECK(*regular.ridge_height.value == Approx(1e-6).epsilon(0.25));
  const Surface scattering = measured(test::ridged_profile({40.0, 0.15, 0.05, 150.0}, 1));
  CHECK(*scattering.spacing_sd_m == Approx(6e-6).epsilon(0.25));
  CHECK(holds(scattering.spacing_m, 40e-6));
  CHECK(half_width(scattering.spacing_m) < 0.05);
}

TEST_CASE("ridges that are all seen have no wider interval than their scatter asks for", "[surface]") {
  double sum = 0.0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    sum += half_width(measured(test::ridged_profile({40.0, 0.12, 0.02, 150.0}, seed)).spacing_m);
  }
  CAPTURE(sum / 20.0);
  CHECK(sum / 20.0 < 1.15 * 1.96 * 0.12 / std::sqrt(150.0));  // independent widths; it does not know that they are
}

TEST_CASE("a turned-around track has the same spacing and its inverse asymmetry", "[surface]") {
  Profile profile = test::ridged_profile({40.0, 0.05, 0.05, 50.0}, 4);
  const Surface there = measured(profile);
  std::reverse(profile.height.begin(), profile.height.end());
  const Surface back = measured(profile);
  CHECK(*back.spacing_m.value == Approx(*there.spacing_m.value).epsilon(0.01));
  CHECK(*back.asymmetry * *there.asymmetry == Approx(1.0).epsilon(0.2));
}

TEST_CASE("a coarse and a fine pattern are both reported", "[surface]") {
  const Profile coarse = test::ridged_profile({150.0, 0.02, 0.02, 40.0}, 3);
  const Profile both = test::profile_of(coarse.height.size(), [&](std::size_t i) {
    return coarse.height[i] + 0.3e-6 * std::sin(kTwoPi * static_cast<double>(i) / 13.3);
  });
  const Surface surface = measured(both);
  CHECK(holds(surface.spacing_m, 150e-6));
  REQUIRE(surface.fine_spacing_m.value);
  CHECK(*surface.fine_spacing_m.value == Approx(13.3e-6).epsilon(0.02));
  CHECK_FALSE(measured(coarse).fine_spacing_m.value);
}

TEST_CASE("feed marks of turning have their spacing, and a warning explains how to distinguish them", "[surface]") {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  const Surface surface = measured(test::profile_of(3000, [&](std::size_t i) {
    const double place = std::remainder(static_cast<double>(i) / 62.5, 1.0);
    return 1e-6 * (4.0 * place * place + 0.1 * normal(generator));
  }));
  CHECK(holds(surface.spacing_m, 62.5e-6));
  REQUIRE(!surface.warnings.empty());
  CHECK(surface.warnings.front().code == "origin_not_known");
  CHECK(surface.warnings.front().message.find("same spacing outside the track") != std::string::npos);
}

TEST_CASE("waves as even as the ridges but far lower are not the pattern", "[surface]") {
  const Profile ridged = test::ridged_profile({36.0, 0.006, 0.0, 176.0}, 3);
  const Profile both = test::profile_of(ridged.height.size(), [&](std::size_t i) {
    return ridged.height[i] + 0.04e-6 * std::sin(kTwoPi * static_cast<double>(i) / (7.7 * 36.0));
  });
  CHECK(holds(measured(both).spacing_m, 36e-6));
}

TEST_CASE("ridges that scatter under much roughness have no confident wrong spacing", "[surface]") {
  // Round ridges that scatter by 0.3 of their distance under roughness of 0.6 of their height.
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    double begin = 0.0;
    double end = 0.0;
    const Profile profile = test::profile_of(5000, [&](std::size_t i) {
      while (end <= static_cast<double>(i)) {
        begin = end;
        end += 50.0 * std::max(0.2, 1.0 + 0.3 * normal(generator));
      }
      return 1e-6 *
             (std::sin(kTwoPi / 2.0 * (static_cast<double>(i) - begin) / (end - begin)) + 0.6 * normal(generator));
    });
    const Surface surface = measured(profile);
    CAPTURE(seed);
    if (!surface.spacing_m.value || half_width(surface.spacing_m) > 0.1) continue;
    CHECK(std::abs(*surface.spacing_m.value - 50e-6) < surface.spacing_m.ci95->high - surface.spacing_m.ci95->low);
  }
}

TEST_CASE("random surfaces, waves and a scratch get no spacing with a small interval", "[surface]") {
  for (unsigned seed = 0; seed < 25; ++seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    double slow = 0.0;
    const double memory = 1.0 - std::pow(10.0, -0.5 - 2.0 * seed / 25.0);
    for (const bool scratched : {false, true}) {
      const Profile profile = test::profile_of(2000 + 100 * seed, [&](std::size_t i) {
        slow = memory * slow + normal(generator);
        const double from = (static_cast<double>(i) - 900.0) / 20.0;
        return 1e-7 * (slow + 0.2 * normal(generator) - (scratched ? 60.0 * std::exp(-from * from) : 0.0));
      });
      const Surface surface = measured(profile);
      CAPTURE(seed, scratched);
      CHECK((!surface.spacing_m.value || half_width(surface.spacing_m) > 0.1));
    }
  }
}

TEST_CASE("blocks of a coded image are no pattern of the surface", "[surface]") {
  Profile profile = test::ridged_profile({16.0, 0.0, 0.02, 100.0}, 2);
  CHECK(measured(profile).spacing_m.value);
  profile.block_samples = 8.0;
  const Surface surface = measured(profile);
  CHECK(surface.status == SurfaceStatus::Undetermined);
  CHECK_FALSE(surface.spacing_m.value);
}

TEST_CASE("holes up to a tenth are bridged and counted, more are refused", "[surface]") {
  Profile profile = test::ridged_profile({40.0, 0.0, 0.05, 40.0}, 1);
  const double hole = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < profile.height.size(); i += 12) profile.height[i] = hole;
  const Surface surface = measured(profile);
  CHECK(holds(surface.spacing_m, 40e-6));
  CHECK(std::any_of(surface.warnings.begin(), surface.warnings.end(),
                    [](const slipfit::Warning& w) { return w.code == "holes_bridged"; }));
  for (std::size_t i = 0; i < profile.height.size(); i += 5) profile.height[i] = hole;
  CHECK(measure_surface(profile).error().code == "too_many_holes");
}
