#include "analysis/detect.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/counted.hpp"
#include "core/sample_range.hpp"
#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "signal/defects.hpp"
#include "signal/smoothing.hpp"
#include "signal/stretch.hpp"

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

std::vector<Rise> rises_of(const Recording& recording, const Segmentation& segmentation) {
  constexpr std::size_t kFewestSamples = 5;
  std::vector<Rise> rises;
  for (std::size_t i = 1; i < segmentation.slips.size(); ++i) {
    const DetectedSlip& before = segmentation.slips[i - 1];
    const DetectedSlip& after = segmentation.slips[i];
    const std::size_t fifth = (after.peak - before.trough) / 5;
    const double duration_s = recording.time_s()[after.peak] - recording.time_s()[before.trough];
    if (3 * fifth < kFewestSamples || signal::has_gap(recording, before.trough, after.peak)) continue;
    const auto middle = [&](std::span<const double> values) {
      return values.subspan(before.trough + fifth, 3 * fifth);
    };
    rises.push_back({line_sums(middle(recording.time_s()), middle(recording.force())).slope(),
                     (after.peak_force - before.trough_force) / duration_s, duration_s});
  }
  return rises;
}

bool rises_wander(const Recording& recording, const Segmentation& segmentation) {
  std::vector<double> shares;
  for (const Rise& rise : rises_of(recording, segmentation)) shares.push_back(rise.middle_N_per_s / rise.whole_N_per_s);
  return shares.size() >= thresholds::kFewestSlips && signal::median(std::move(shares)) < thresholds::kSteadyRise;
}

bool rises_are_round(const Recording& recording, const Segmentation& segmentation) {
  constexpr std::size_t kFewestSamples = 7;
  constexpr std::size_t kEnough = 64;  // rises, from the first to the last: more say the same
  const std::size_t stride = 1 + segmentation.slips.size() / kEnough;
  std::size_t round = 0;
  std::size_t straight = 0;
  for (std::size_t i = 1; i < segmentation.slips.size(); i += stride) {
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

namespace {

/// Standard error over mean of the mean of a stationary series (Bartlett's weights; never below what independent values
/// would have by half, which few values cannot show).
double relative_error(const std::vector<double>& values, const MeanAndSpread& of) {
  const auto lags = static_cast<std::size_t>(std::cbrt(of.count));
  double variance = of.sd * of.sd;
  const double independent = variance;
  for (std::size_t lag = 1; lag <= lags && lag + 1 < values.size(); ++lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < values.size(); ++i) product += (values[i] - of.mean) * (values[i - lag] - of.mean);
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(lags + 1);
    variance += 2.0 * weight * product / of.count;
  }
  return std::sqrt(std::max(variance, 0.5 * independent) / of.count) / of.mean;
}

/// The best division of a series into two levels, and their distance in standard errors.
struct Split {
  std::size_t at = 0;
  double before = 0.0;
  double after = 0.0;
  double apart = 0.0;
};

/// Running sums of a series, so that any number of divisions costs linear time.
class RunningSums {
 public:
  explicit RunningSums(const std::vector<double>& values) : origin_(describe(values).mean) {
    for (const double value : values) {
      const double off = value - origin_;  // from the mean of all, so that the squares cancel little
      sums_.push_back(sums_.back() + off);
      squares_.push_back(squares_.back() + off * off);
    }
  }

  [[nodiscard]] MeanAndSpread between(std::size_t begin, std::size_t end) const {
    const auto count = static_cast<double>(end - begin);
    const double mean = (sums_[end] - sums_[begin]) / count;
    const double square = std::max(0.0, squares_[end] - squares_[begin] - count * mean * mean);
    return {origin_ + mean, std::sqrt(square / std::max(1.0, count - 1.0)), count};
  }

 private:
  double origin_;
  std::vector<double> sums_{0.0}, squares_{0.0};
};

Split best_split(const std::vector<double>& values) {
  const RunningSums sums(values);
  Split best;
  const std::size_t edge = std::max<std::size_t>(4, values.size() / 6);
  for (std::size_t at = edge; at + edge <= values.size(); ++at) {
    const MeanAndSpread before = sums.between(0, at);
    const MeanAndSpread after = sums.between(at, values.size());
    const double error = std::sqrt(before.sd * before.sd / before.count + after.sd * after.sd / after.count +
                                   1e-6 * before.mean * before.mean);
    const double apart = std::abs(after.mean - before.mean) / error;
    if (apart > best.apart) best = {at, before.mean, after.mean, apart};
  }
  return best;
}

bool is_change(const Split& split) {
  return split.apart > thresholds::kBeyondScatter &&
         std::abs(split.after / split.before - 1.0) > thresholds::kNotableChange;
}

/// Far off the usual interval by their typical deviation; nearer only between two usual ones: a rhythm may settle.
bool is_broken(const std::vector<double>& deviations, std::size_t i, double usual, double typical) {
  const auto is_beyond = [&](std::size_t of, double share) {
    return deviations[of] > std::max(share * usual, thresholds::kFarOverTypical * typical);
  };
  if (is_beyond(i, thresholds::kFarInterval)) return true;
  const bool is_inside = i > 0 && i + 1 < deviations.size();
  return is_inside && is_beyond(i, thresholds::kOddInterval) && !is_beyond(i - 1, 0.0) && !is_beyond(i + 1, 0.0);
}

}  // namespace

Intervals intervals_of(const Recording& recording, const Segmentation& segmentation) {
  Intervals intervals;
  for (std::size_t i = 2; i < segmentation.slips.size(); ++i) {
    const DetectedSlip& first = segmentation.slips[i - 1];
    const DetectedSlip& second = segmentation.slips[i];
    if (signal::has_gap(recording, first.peak, second.trough)) continue;
    intervals.seconds.push_back(second.middle_s - first.middle_s);
  }
  const double usual = signal::median(intervals.seconds);
  std::vector<double> deviations;
  for (const double interval_s : intervals.seconds) deviations.push_back(std::abs(interval_s - usual));
  const double deviation = signal::median(deviations);
  if (intervals.seconds.size() < 8 || deviation > thresholds::kRegularRest * usual) return intervals;
  std::vector<double> unbroken;
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    if (!is_broken(deviations, i, usual, deviation)) unbroken.push_back(intervals.seconds[i]);
  }
  const std::size_t broken = deviations.size() - unbroken.size();
  return {std::move(unbroken), broken};
}

Estimate count_frequency(const Recording& recording, const Segmentation& segmentation) {
  const std::vector<double> intervals_s = intervals_of(recording, segmentation).seconds;
  const MeanAndSpread interval = describe(intervals_s);
  if (interval.count < 1.0) return unknown("fewer than 3 slips");
  const double value = 1.0 / interval.mean;
  if (interval.count < 2.0) return {value, std::nullopt, std::nullopt, "one interval gives no standard error"};
  return symmetric(value, value * relative_error(intervals_s, interval), interval.count - 1.0);
}

std::optional<std::string> broken_rhythm(const Recording& recording, const Segmentation& segmentation) {
  const std::size_t broken = intervals_of(recording, segmentation).broken;
  if (broken == 0) return std::nullopt;
  return fmt::format(
      "{} between slips {} from the period of the others: the stage paused, samples are missing, or slips are cut "
      "short; {} left out",
      counted(broken, "interval"), broken == 1 ? "differs" : "differ", broken == 1 ? "it was" : "they were");
}

bool pace_changes(const Segmentation& segmentation) {
  std::vector<double> seconds;
  for (std::size_t i = 2; i < segmentation.slips.size(); ++i) {
    seconds.push_back(segmentation.slips[i].middle_s - segmentation.slips[i - 1].middle_s);
  }
  return is_change(best_split(seconds));
}

std::optional<std::string> change_on_the_way(const Segmentation& segmentation) {
  const std::vector<DetectedSlip>& slips = segmentation.slips;
  std::vector<double> seconds, drops;
  for (std::size_t i = 2; i < slips.size(); ++i) {
    seconds.push_back(slips[i].middle_s - slips[i - 1].middle_s);
    drops.push_back(slips[i].drop());
  }
  const Split interval = best_split(seconds);
  const Split drop = best_split(drops);
  if (!is_change(interval) && !is_change(drop)) return std::nullopt;
  const bool pace = is_change(interval) && interval.apart >= drop.apart;
  const Split& split = pace ? interval : drop;
  return fmt::format(
      "{} changes from {:.4g}{} before {:.6g} s to {:.4g}{} after it: one number is a mean of both; analyse each part "
      "with --window T0:T1",
      pace ? "the interval between slips" : "the drop", split.before, pace ? " s" : "", slips[split.at + 2].middle_s,
      split.after, pace ? " s" : "");
}

namespace {

/// `scale`: of the slips, where it is known.
Excerpt excerpt_of(const Recording& recording, SampleRange stretch, std::optional<std::size_t> scale = std::nullopt) {
  Recording part = recording.part(stretch.begin, stretch.end);
  Quality quality = assess_quality(part);
  Segmentation slips = find_slips(part, quality, scale);
  return {std::move(part), std::move(quality), std::move(slips)};
}

/// Returns the scale at which the sliding part is analysed; it is that of the whole recording if the part is nearly all
/// of it.
std::optional<std::size_t> scale_of_part(const Segmentation& slips, std::size_t samples) {
  constexpr double kNearlyAll = 0.9;
  const auto sliding = static_cast<double>(slips.sliding_end - slips.sliding_begin);
  if (sliding < kNearlyAll * static_cast<double>(samples)) return std::nullopt;
  return slips.smoothed_over;
}

void take(Detected& detected, Excerpt part, std::size_t begin) {
  detected.begin = begin;
  detected.part = std::move(part.recording);
  detected.signals.quality = std::move(part.quality);
  detected.signals.segmentation = std::move(part.segmentation);
}

/// Takes the stretch that slides: that of the slips where they are sudden, else the plateau of a steady run. A
/// ring-down is recognised by what follows it, waves and noise by the whole.
void narrow(Detected& detected) {
  const Recording& recording = detected.recording();
  const Segmentation& slips = detected.signals.segmentation;
  const SampleRange whole{0, recording.size()};
  const SampleRange sliding{slips.sliding_begin, slips.sliding_end};
  if (sliding != whole) {
    Excerpt part = excerpt_of(recording, sliding, scale_of_part(slips, recording.size()));
    if (slips_are_sudden(part.segmentation)) return take(detected, std::move(part), sliding.begin);
  } else if (slips_are_sudden(slips)) {
    return;
  }
  const SampleRange plateau = signal::plateau(recording.force());
  if (plateau != whole) take(detected, excerpt_of(recording, plateau), plateau.begin);
}

}  // namespace

Detected detect(const Recording& recording) {
  const Stopwatch stopwatch;
  Detected detected;
  detected.whole = &recording;
  detected.kept = signal::first_of_repeats(recording.force());
  if (!detected.kept.empty()) detected.part = recording.selected(detected.kept);
  Signals& signals = detected.signals;
  signals.quality = assess_quality(detected.recording());
  signals.segmentation = find_slips(detected.recording(), signals.quality);
  detected.whole_quality = signals.quality;
  if (!recording.provenance().window_given) narrow(detected);
  detected.seconds = stopwatch.elapsed_s();
  return detected;
}

}  // namespace slipfit
