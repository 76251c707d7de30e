// What a cycle keeps of its samples, against sums formed one sample after the other.

#include "fit/cycle/cycle_data.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "fit/cycle/start.hpp"
#include "fit/selection/outliers.hpp"
#include "scene.hpp"

using namespace slipfit;
using namespace slipfit::fit;

namespace {

constexpr double kHalfWidth_s = 0.03;

struct Recorded {
  Recording recording;
  Quality quality;
  Segmentation segmentation;
};

Recorded recorded() {
  const Scene scene{.jitter = 0.05, .noise = 0.01, .drift_over_drop = 0.5};
  Recording recording = record(scene);
  Quality quality = assess_quality(recording);
  Segmentation segmentation = find_slips(recording, quality);
  return {std::move(recording), std::move(quality), std::move(segmentation)};
}

/// Some by themselves, some side by side, at the edges of bins too.
std::vector<std::size_t> some_samples(std::size_t size) {
  std::vector<std::size_t> samples;
  for (std::size_t i = 5; i < size; i += 37) samples.push_back(i);
  for (std::size_t i = 300; i < 320; ++i) samples.push_back(i);
  std::sort(samples.begin(), samples.end());
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  return samples;
}

std::size_t index_at(const Recording& recording, double time_s) {
  const auto time = recording.time_s();
  return static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), time_s) - time.begin());
}

/// The bin of the samples from `begin` to `end`, one after the other.
StickBin reduced(const Recording& recording, std::size_t begin, std::size_t end,
                 const std::vector<std::size_t>& excluded, const HumLines& hum) {
  std::vector<double> t, f;
  for (std::size_t i = begin; i < end; ++i) {
    if (std::binary_search(excluded.begin(), excluded.end(), i)) continue;
    t.push_back(recording.time_s()[i]);
    f.push_back(recording.force()[i]);
  }
  StickBin bin;
  bin.count = static_cast<double>(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    bin.time_s += t[i] / bin.count;
    bin.force += f[i] / bin.count;
  }
  for (std::size_t i = 0; i < t.size(); ++i) {
    bin.time_spread += std::pow(t[i] - bin.time_s, 2);
    bin.slope += (t[i] - bin.time_s) * (f[i] - bin.force);
  }
  bin.slope /= bin.time_spread;
  for (std::size_t i = 0; i < t.size(); ++i) {
    bin.scatter += std::pow(f[i] - bin.force - bin.slope * (t[i] - bin.time_s), 2);
  }
  for (const double line_Hz : hum.frequencies_Hz) {
    std::complex<double> mean, slope;
    for (const double t_s : t) {
      const auto wave = std::polar(1.0, 2.0 * std::numbers::pi * line_Hz * (t_s - hum.begin_s));
      mean += wave / bin.count;
      slope += (t_s - bin.time_s) * wave / bin.time_spread;
    }
    bin.lines.push_back({{mean.real(), mean.imag()}, {slope.real(), slope.imag()}});
  }
  return bin;
}

void check_equal(const StickBin& bin, const StickBin& expected) {
  CHECK(bin.count == expected.count);
  CHECK(bin.time_s == Approx(expected.time_s).epsilon(1e-12));
  CHECK(bin.force == Approx(expected.force).epsilon(1e-12));
  CHECK(bin.slope == Approx(expected.slope).epsilon(1e-9));
  CHECK(bin.time_spread == Approx(expected.time_spread).epsilon(1e-9));
  CHECK(bin.scatter == Approx(expected.scatter).epsilon(1e-8));
  REQUIRE(bin.lines.size() == expected.lines.size());
  const double per_time = 1.0 / std::sqrt(expected.time_spread / expected.count);
  for (std::size_t i = 0; i < bin.lines.size(); ++i) {
    for (std::size_t k : {0U, 1U}) {
      CHECK(bin.lines[i].mean[k] == Approx(expected.lines[i].mean[k]).margin(1e-9));
      CHECK(bin.lines[i].slope[k] == Approx(expected.lines[i].slope[k]).margin(1e-9 * per_time));
    }
  }
}

}  // namespace

TEST_CASE("a bin holds the sums of its samples without those left out, and those of a mains line") {
  const Recorded r = recorded();
  const std::vector<std::size_t> excluded = GENERATE_COPY(std::vector<std::size_t>{}, some_samples(r.recording.size()));
  // A line far below, one within and one above the length of a bin, and one near the sampling rate's half.
  const HumLines hum{{0.01, 50.0, 250.0, 0.49 / r.recording.sample_interval_s()}, 0.3};
  const auto cycles = cut_cycles(r.recording, r.segmentation, kHalfWidth_s, excluded, hum);
  REQUIRE(cycles.size() > 20);
  for (const CycleData& cycle : cycles) {
    const double middle_s = r.segmentation.slips[cycle.slip].middle_s;
    const auto check = [&](const std::vector<StickBin>& bins, std::size_t begin, std::size_t end) {
      for (std::size_t part = 0; part < bins.size(); ++part) {
        const std::size_t from = begin + part * (end - begin) / bins.size();
        const std::size_t to = begin + (part + 1) * (end - begin) / bins.size();
        check_equal(bins[part], reduced(r.recording, from, to, excluded, hum));
      }
    };
    const std::size_t slip_begin = index_at(r.recording, middle_s - kHalfWidth_s);
    const std::size_t slip_end = index_at(r.recording, middle_s + kHalfWidth_s);
    check(cycle.bins_before, index_at(r.recording, cycle.window_begin_s), slip_begin);
    check(cycle.bins_after, slip_end, index_at(r.recording, cycle.window_end_s));
    for (const std::size_t sample : cycle.samples) {
      CHECK(!std::binary_search(excluded.begin(), excluded.end(), sample));
      CHECK((sample >= slip_begin && sample < slip_end));
    }
  }
}
