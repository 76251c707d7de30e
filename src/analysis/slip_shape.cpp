#include "analysis/slip_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/line_sums.hpp"
#include "core/quantile.hpp"
#include "core/sample_range.hpp"
#include "core/slip_thresholds.hpp"
#include "core/student.hpp"
#include "core/thresholds.hpp"
#include "signal/robust.hpp"

namespace slipfit {
namespace {

std::vector<double> drops_of(const Segmentation& segmentation) {
  std::vector<double> drops;
  for (const DetectedSlip& slip : segmentation.slips) drops.push_back(slip.drop());
  return drops;
}

std::vector<double> rises_over_falls(const Segmentation& segmentation) {
  std::vector<double> ratios;
  for (const DetectedSlip& slip : segmentation.slips) {
    if (slip.rise_s > 0.0 && slip.fall_s > 0.0) ratios.push_back(slip.rise_s / slip.fall_s);
  }
  return ratios;
}

/// Mean square of the second differences at this step; samples that are masked count for nothing.
double second_difference(std::span<const double> force, const std::vector<bool>& impulses, std::size_t step) {
  double sum = 0.0;
  double count = 0.0;
  const auto is_masked = [&](std::size_t i) { return !impulses.empty() && impulses[i]; };
  for (std::size_t i = step; i + step < force.size(); ++i) {
    if (is_masked(i - step) || is_masked(i) || is_masked(i + step)) continue;
    sum += std::pow(force[i - step] - 2.0 * force[i] + force[i + step], 2);
    count += 1.0;
  }
  return sum / count;
}

/// Twice the log-likelihood of a line through the samples less that of half a cosine from the first to the last of
/// them, each at its best noise.
double evidence_of_line(const Recording& recording, const SampleRange& range) {
  const std::span<const double> time_s = recording.time_s().subspan(range.begin, range.size());
  const std::span<const double> force = recording.force().subspan(range.begin, range.size());
  const double duration_s = time_s.back() - time_s.front();
  if (!(duration_s > 0.0)) return 0.0;
  const auto share = [&](std::size_t i) { return (time_s[i] - time_s.front()) / duration_s; };
  const auto rest_of = [&](const auto& x) {
    const LineSums line = line_sums(force.size(), x, [&](std::size_t i) { return force[i]; });
    return std::max(line.scatter - line.slope() * line.cross, std::numeric_limits<double>::min());
  };
  const double of_line = rest_of(share);
  const double of_cosine = rest_of([&](std::size_t i) { return std::cos(std::numbers::pi * share(i)); });
  return static_cast<double>(force.size()) * std::log(of_cosine / of_line);
}

}  // namespace

double median_drop(const Segmentation& segmentation) {
  return signal::median(drops_of(segmentation));
}

std::vector<double> slip_intervals_s(const Segmentation& segmentation) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < segmentation.slips.size(); ++i) {
    intervals_s.push_back(segmentation.slips[i].middle_s - segmentation.slips[i - 1].middle_s);
  }
  return intervals_s;
}

double mains_share(const Segmentation& segmentation) {
  const double period_s = signal::median(slip_intervals_s(segmentation));
  const double at_50 = period_s * 50.0;
  const double at_60 = period_s * 60.0;
  return std::abs(at_50 - 1.0) < std::abs(at_60 - 1.0) ? at_50 : at_60;
}

double rise_over_fall(const Segmentation& segmentation) {
  return signal::median(rises_over_falls(segmentation));
}

double proven_rise_over_fall(const Segmentation& segmentation) {
  std::vector<double> logs = rises_over_falls(segmentation);
  if (logs.empty()) return 0.0;
  for (double& ratio : logs) ratio = std::log(ratio);
  const double scatter = describe(logs).sd;
  return rise_over_fall(segmentation) *
         std::exp(-kNormalQuantile * scatter / std::sqrt(static_cast<double>(logs.size())));
}

double swing_share(const Segmentation& segmentation) {
  if (segmentation.slips.empty()) return 0.0;
  const auto by_peak = [](const DetectedSlip& a, const DetectedSlip& b) { return a.peak_force < b.peak_force; };
  const auto by_trough = [](const DetectedSlip& a, const DetectedSlip& b) { return a.trough_force < b.trough_force; };
  const double highest = std::ranges::max_element(segmentation.slips, by_peak)->peak_force;
  const double lowest = std::ranges::min_element(segmentation.slips, by_trough)->trough_force;
  double square = 0.0;
  for (const DetectedSlip& slip : segmentation.slips) square += slip.drop() * slip.drop();
  return std::sqrt(square / static_cast<double>(segmentation.slips.size())) / (highest - lowest);
}

double smoothness(const Recording& recording, const Quality& quality, const Segmentation& segmentation) {
  std::vector<double> samples;
  for (const DetectedSlip& slip : segmentation.slips) {
    samples.push_back(static_cast<double>(slip.trough - slip.peak));
  }
  const auto step = static_cast<std::size_t>(std::max(1.0, std::round(signal::median(std::move(samples)) / 8.0)));
  const std::vector<bool>& impulses = quality.impulse_mask;
  const double fine = second_difference(recording.force(), impulses, step);
  const double coarse = second_difference(recording.force(), impulses, 2 * step);
  return 0.5 * std::log2(coarse / fine);
}

bool phase_wanders(const Segmentation& segmentation) {
  constexpr std::size_t kLongest = 16;  // intervals
  constexpr std::size_t kShortest = 8;
  constexpr double kReadingError = 0.1;  // of a sample, by interpolation
  const std::vector<DetectedSlip>& slips = segmentation.slips;
  const std::size_t lag = std::min(kLongest, slips.size() / 4);
  if (lag < kShortest) return false;
  const auto distances = [&](std::size_t intervals) {
    std::vector<double> seconds;
    for (std::size_t i = intervals; i < slips.size(); ++i) {
      seconds.push_back(slips[i].middle_s - slips[i - intervals].middle_s);
    }
    return describe(seconds);
  };
  const MeanAndSpread one = distances(1);
  const MeanAndSpread many = distances(lag);
  const double step_s =
      (slips.back().middle_s - slips.front().middle_s) / static_cast<double>(slips.back().peak - slips.front().peak);
  const double growth = 1.0 + thresholds::kWalkShare * (static_cast<double>(lag) - 1.0);
  return many.sd > std::sqrt(growth) * std::max(one.sd, kReadingError * step_s);
}

bool keeps_mains_phase(const Segmentation& segmentation) {
  return std::abs(mains_share(segmentation) - 1.0) < thresholds::kMainsRhythm && !phase_wanders(segmentation);
}

bool is_faint(const Segmentation& segmentation) {
  // The lower median: of two falls, one that noise may make is half of them.
  return quantile_of(drops_of(segmentation), 0.5) < thresholds::kNoiseDrop * segmentation.noise;
}

bool is_sine_like(const Segmentation& segmentation) {
  std::vector<double> shares = slip_intervals_s(segmentation);
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = segmentation.slips[i + 1].fall_s / shares[i];
  return signal::median(std::move(shares)) > thresholds::kSineFall;
}

bool keeps_rhythm(const Segmentation& segmentation) {
  const MeanAndSpread interval = describe(slip_intervals_s(segmentation));
  return interval.count > 1.0 && interval.sd < thresholds::kRhythm * interval.mean;
}

bool slips_are_sudden(const Segmentation& segmentation) {
  const std::vector<double> ratios = rises_over_falls(segmentation);
  if (ratios.size() + 1 < thresholds::kFewestCycles || signal::median(ratios) < thresholds::kSudden) return false;
  const auto sudden = std::ranges::count_if(ratios, [](double ratio) { return ratio > 0.5 * thresholds::kSudden; });
  return static_cast<double>(sudden) >= thresholds::kSuddenShare * static_cast<double>(ratios.size());
}

bool rises_are_round(const Recording& recording, const Segmentation& segmentation) {
  constexpr std::size_t kFewestSamples = 7;
  std::size_t round = 0;
  std::size_t straight = 0;
  for (std::size_t i = 1; i < segmentation.slips.size(); ++i) {
    const std::size_t begin = segmentation.slips[i - 1].trough;
    const std::size_t end = segmentation.slips[i].peak + 1;
    if (end < begin + kFewestSamples) continue;
    const double evidence = evidence_of_line(recording, {begin, end});
    straight += evidence > thresholds::kEvidence ? 1U : 0U;
    round += evidence < -thresholds::kEvidence ? 1U : 0U;
  }
  return round >= thresholds::kFewestSlips && round > straight;
}

bool slips_stand_out(const Segmentation& segmentation) {
  return !is_faint(segmentation) && !is_sine_like(segmentation);
}

}  // namespace slipfit
