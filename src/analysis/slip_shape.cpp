#include "analysis/slip_shape.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/quantile.hpp"
#include "core/thresholds.hpp"
#include "signal/robust.hpp"

namespace slipfit {
namespace {

std::vector<double> rises_over_falls(const Segmentation& segmentation) {
  std::vector<double> ratios;
  for (const DetectedSlip& slip : segmentation.slips) {
    if (slip.rise_s > 0.0 && slip.fall_s > 0.0) ratios.push_back(slip.rise_s / slip.fall_s);
  }
  return ratios;
}

}  // namespace

double median_drop(const Segmentation& segmentation) {
  std::vector<double> drops;
  for (const DetectedSlip& slip : segmentation.slips) drops.push_back(slip.drop());
  return signal::median(std::move(drops));
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

bool is_faint(const Segmentation& segmentation) {
  return median_drop(segmentation) < thresholds::kNoiseDrop * segmentation.noise;
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
  if (ratios.size() + 1 < thresholds::kFewestSudden || signal::median(ratios) < thresholds::kSudden) return false;
  const auto sudden = std::ranges::count_if(ratios, [](double ratio) { return ratio > 0.5 * thresholds::kSudden; });
  return static_cast<double>(sudden) >= thresholds::kSuddenShare * static_cast<double>(ratios.size());
}

bool slips_stand_out(const Segmentation& segmentation) {
  return !is_faint(segmentation) && !is_sine_like(segmentation);
}

}  // namespace slipfit
