#include "signal/events.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <span>

#include "core/statistics.hpp"
#include "signal/stretch.hpp"
#include "slipfit/signal/cycles.hpp"
#include "traces.hpp"

using namespace slipfit;

namespace {

struct Scene {
  std::vector<double> time_s;
  std::vector<double> force;

  [[nodiscard]] Segmentation slips() const {
    const Recording recording = traces::recording(time_s, force);
    return find_slips(recording, assess_quality(recording));
  }
};

/// 40 s of slips at 1 Hz, sampled at 1 kHz, with a drop of 1 that takes 0.05 s.
Scene saw(traces::Generator& generator) {
  Scene scene{traces::clock(40000, 1000.0), {}};
  scene.force = traces::saw_tooth({1.0, 0.0, 0.05}, scene.time_s, generator);
  for (double& force : scene.force) force += 5.0;
  return scene;
}

}  // namespace

TEST_CASE("ringing after a slip belongs to it") {
  traces::Generator generator(1);
  Scene scene = saw(generator);
  const std::vector<double> plain = scene.force;
  double since_s = 1.0;
  for (std::size_t i = 1; i < plain.size(); ++i) {
    since_s = plain[i] < plain[i - 1] - 0.01 ? 0.0 : since_s + 1e-3;
    scene.force[i] += 0.5 * std::exp(-since_s / 0.05) * std::cos(2.0 * std::numbers::pi * 60.0 * since_s);
  }
  traces::add_noise(scene.force, 0.01, generator);
  const Segmentation found = scene.slips();
  CHECK(found.slips.size() >= 39);
  CHECK(found.slips.size() <= 41);
}

TEST_CASE("a pick-up line of any frequency makes no slips") {
  const double frequency_Hz = GENERATE(10.0, 37.0, 100.0, 333.0);
  traces::Generator generator(2);
  Scene scene = saw(generator);
  traces::add_sine(scene.force, scene.time_s, frequency_Hz, 0.1);
  traces::add_noise(scene.force, 0.02, generator);
  const Segmentation found = scene.slips();
  CHECK(found.slips.size() >= 39);
  CHECK(found.slips.size() <= 41);
}

TEST_CASE("slips of six times the noise are found where it is smoothed") {
  traces::Generator generator(3);
  Scene scene = saw(generator);
  traces::add_noise(scene.force, 0.16, generator);
  const Segmentation found = scene.slips();
  CHECK(found.smoothed_over > 1);
  CHECK(found.slips.size() >= 38);
  CHECK(found.slips.size() <= 41);
}

TEST_CASE("white noise has no slips") {
  traces::Generator generator(4);
  Scene scene{traces::clock(20000, 1000.0), std::vector<double>(20000, 3.0)};
  traces::add_noise(scene.force, 0.1, generator);
  CHECK(scene.slips().slips.empty());
}

TEST_CASE("run-up and release are no part of the sliding stretch") {
  traces::Generator generator(5);
  Scene scene = saw(generator);
  const std::size_t begin = 8000;
  const std::size_t end = 32000;
  for (std::size_t i = 0; i < begin; ++i) {
    scene.force[i] = 5.0 * std::max(0.0, static_cast<double>(i) - 3000.0) / static_cast<double>(begin - 3000);
  }
  for (std::size_t i = end; i < scene.force.size(); ++i) {
    const double since_s = 1e-3 * static_cast<double>(i - end);
    scene.force[i] = 5.0 * std::exp(-3.0 * since_s) * std::cos(2.0 * std::numbers::pi * 7.0 * since_s);
  }
  traces::add_noise(scene.force, 0.01, generator);
  const Segmentation found = scene.slips();
  // The first slip may begin up to a period after the ramp has ended.
  CHECK(static_cast<double>(found.sliding_begin) == Approx(begin).margin(1200));
  CHECK(static_cast<double>(found.sliding_end) == Approx(end).margin(1000));
}

TEST_CASE("a pause splits the sliding, and the longer part is analysed") {
  traces::Generator generator(6);
  Scene scene = saw(generator);
  for (std::size_t i = 12000; i < 16000; ++i) scene.force[i] = scene.force[11999];
  traces::add_noise(scene.force, 0.01, generator);
  const Segmentation found = scene.slips();
  CHECK(found.sliding_begin >= 12000);
  CHECK(found.sliding_begin <= 17200);
  CHECK(found.sliding_end == scene.force.size());
}

TEST_CASE("slips all along are not cut") {
  traces::Generator generator(7);
  Scene scene = saw(generator);
  traces::add_noise(scene.force, 0.02, generator);
  const Segmentation found = scene.slips();
  CHECK(found.sliding_begin == 0);
  CHECK(found.sliding_end == scene.force.size());
}

TEST_CASE("slips on the scale of the whole are those that a part shows by itself") {
  const double noise = GENERATE(0.02, 0.16);
  traces::Generator generator(8);
  Scene scene = saw(generator);
  traces::add_noise(scene.force, noise, generator);
  const Recording whole = traces::recording(scene.time_s, scene.force);
  const Segmentation of_whole = find_slips(whole, assess_quality(whole));
  CHECK((of_whole.smoothed_over > 1) == (noise > 0.1));
  const Recording part = whole.part(3000, 40000);
  const Quality quality = assess_quality(part);
  const Segmentation searched = find_slips(part, quality);
  const Segmentation told = find_slips(part, quality, of_whole.smoothed_over);
  REQUIRE(told.slips.size() == searched.slips.size());
  for (std::size_t i = 0; i < told.slips.size(); ++i) {
    CHECK(told.slips[i].middle_s == Approx(searched.slips[i].middle_s).margin(0.005));
  }
}

TEST_CASE("noise as smooth as that behind a filter makes no slips on the slopes of the sticks") {
  const auto samples = GENERATE(as<std::size_t>(), 4, 8, 16);
  CAPTURE(samples);
  traces::Generator generator(3);
  Scene scene = saw(generator);
  traces::add_noise(scene.force, 0.05, generator);
  for (int pass = 0; pass < 4; ++pass) {  // four means in a row fall off as a filter of fourth order does
    std::vector<double> filtered = scene.force;
    for (std::size_t i = 0; i + samples <= filtered.size(); ++i) {
      const std::span<const double> window(scene.force.data() + i, samples);
      filtered[i] = mean_of(window);
    }
    scene.force = filtered;
  }
  const Segmentation found = scene.slips();
  CHECK(found.slips.size() >= 39);
  CHECK(found.slips.size() <= 41);
}
