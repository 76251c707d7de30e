#include "analysis/slip_intervals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/student.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "signal/robust.hpp"

namespace slipfit {
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
  const auto time_s = recording.time_s();
  const double gap_s = thresholds::kGapSteps * recording.sample_interval_s();
  const bool may_have_gaps = !recording.clock_is_even();
  Intervals intervals;
  for (std::size_t i = 2; i < segmentation.slips.size(); ++i) {
    const DetectedSlip& first = segmentation.slips[i - 1];
    const DetectedSlip& second = segmentation.slips[i];
    bool whole = true;
    for (std::size_t j = first.peak + 1; may_have_gaps && j <= second.trough; ++j) {
      whole = whole && time_s[j] - time_s[j - 1] <= gap_s;
    }
    if (whole) intervals.seconds.push_back(second.middle_s - first.middle_s);
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
      "{} interval(s) between slips differ from the period of the others: the stage paused, or samples are missing; "
      "they were left out",
      broken);
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

}  // namespace slipfit
