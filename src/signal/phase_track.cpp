#include "signal/phase_track.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/student.hpp"
#include "core/thresholds.hpp"
#include "signal/robust.hpp"
#include "signal/segments.hpp"

namespace slipfit::signal {
namespace {

constexpr std::size_t kMostSegments = 1024;

/// A phase in every segment, in radians of the fundamental, and the place of the segment.
struct PhasePoint {
  std::size_t segment = 0;
  double phase = 0.0;
};

/// Segments in which the fundamental is weak (a run-in, a gap bridged, the ramp before the first slip) have no phase.
std::vector<PhasePoint> unwrap(const std::vector<Segment>& segments, double advance) {
  std::vector<double> sizes;
  for (const Segment& segment : segments) {
    if (segment.samples > 0.0) sizes.push_back(std::abs(segment.lines[0]));
  }
  const double weakest = 0.4 * median(std::move(sizes));
  std::vector<PhasePoint> points;
  for (std::size_t j = 0; j < segments.size(); ++j) {
    if (segments[j].samples <= 0.0 || std::abs(segments[j].lines[0]) < weakest) continue;
    double phase = std::arg(segments[j].lines[0]);
    if (!points.empty()) {
      const double expected = points.back().phase + advance * static_cast<double>(j - points.back().segment);
      phase += kTurn * std::round((expected - phase) / kTurn);
    }
    points.push_back({j, phase});
  }
  return points;
}

/// The coefficients of a segment, turned back by its phase.
Pattern turned_back(const Segment& segment, double phase, std::size_t harmonics) {
  Pattern turned{};
  const Complex back = std::polar(1.0, -phase);
  Complex power = back;
  for (std::size_t h = 0; h < harmonics; ++h) {
    turned[h] = multiply(segment.lines[h], power);
    power = multiply(power, back);
  }
  return turned;
}

/// Newton steps towards the shift that fits all harmonics best, once the fundamental has given a start.
void refine_by_harmonics(const std::vector<Segment>& segments, std::size_t harmonics, std::vector<PhasePoint>& points) {
  for (int pass = 0; pass < 3; ++pass) {
    Pattern mean{};
    for (const PhasePoint& point : points) {
      const Pattern turned = turned_back(segments[point.segment], point.phase, harmonics);
      for (std::size_t h = 0; h < harmonics; ++h) mean[h] += turned[h] / static_cast<double>(points.size());
    }
    double stiffness = 0.0;
    for (std::size_t h = 0; h < harmonics; ++h) {
      stiffness += static_cast<double>((h + 1) * (h + 1)) * std::norm(mean[h]);
    }
    if (stiffness <= 0.0) return;
    for (PhasePoint& point : points) {
      const Pattern turned = turned_back(segments[point.segment], point.phase, harmonics);
      double pull = 0.0;
      for (std::size_t h = 0; h < harmonics; ++h) {
        pull += static_cast<double>(h + 1) * multiply(turned[h], std::conj(mean[h])).imag();
      }
      point.phase += std::clamp(pull / stiffness, -0.5, 0.5);
    }
  }
}

struct Slope {
  double value = 0.0;  ///< radians a segment
  double variance = 0.0;
  double log_likelihood = 0.0;
};

/// The form of a random walk in the phases of segments: in steps between them (the phase changes in the slip), or
/// averaged over each segment (the phase changes continuously), which makes neighbouring increments similar.
enum class Walk { Stepped, Averaged };

/// Mean increment of the phase for a given walk-to-noise ratio, by generalised least squares on the increments (their
/// covariance has three diagonals), with the restricted likelihood of that ratio.
Slope slope_at(const std::vector<PhasePoint>& points, Walk kind, double walk, double noise) {
  const double shared = kind == Walk::Averaged ? walk / 6.0 : 0.0;  // between neighbours
  const std::size_t n = points.size() - 1;
  double pivot = 0.0;
  double log_det = 0.0;
  double product = 1.0;
  double y = 0.0;  // forward-substituted increment and spacing
  double x = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    const auto spacing = static_cast<double>(points[j + 1].segment - points[j].segment);
    const double beside = j == 0 ? 0.0 : shared - noise;
    const double factor = j == 0 ? 0.0 : beside / pivot;
    pivot = walk * spacing - 2.0 * shared + 2.0 * noise - factor * beside;
    y = points[j + 1].phase - points[j].phase - factor * y;
    x = spacing - factor * x;
    product *= pivot;
    if (product < 1e-200 || product > 1e200 || j + 1 == n) {  // a logarithm now and then is enough
      log_det += std::log(product);
      product = 1.0;
    }
    xx += x * x / pivot;
    xy += x * y / pivot;
    yy += y * y / pivot;
  }
  const double freedom = static_cast<double>(n) - 1.0;
  const double scale = std::max(1e-30, (yy - xy * xy / xx) / freedom);
  return {xy / xx, scale / xx, -0.5 * (freedom * std::log(scale) + log_det + std::log(xx))};
}

/// Slopes for every walk-to-noise ratio of a kind of walk.
std::vector<Slope> slopes_of(const std::vector<PhasePoint>& points, Walk kind) {
  std::vector<Slope> slopes{slope_at(points, kind, 1.0, 0.0)};
  for (double ratio = 1e-4; ratio < 1e3; ratio *= 4.0) slopes.push_back(slope_at(points, kind, ratio, 1.0));
  return slopes;
}

/// The slopes averaged by a power of their likelihood: few increments do not distinguish a weak walk from none, and the
/// standard error has to say so. It contains Student's factor, so that kNormalQuantile of it covers 95 %.
Slope average(const std::vector<Slope>& slopes, double power, std::size_t points) {
  double best = -1e300;
  for (const Slope& slope : slopes) best = std::max(best, slope.log_likelihood);
  Slope mean;
  double total = 0.0;
  for (const Slope& slope : slopes) {
    const double weight = std::exp(power * (slope.log_likelihood - best));
    total += weight;
    mean.value += weight * slope.value;
  }
  mean.value /= total;
  for (const Slope& slope : slopes) {
    const double off = slope.value - mean.value;
    mean.variance += std::exp(power * (slope.log_likelihood - best)) / total * (slope.variance + off * off);
  }
  const double widened = students_factor(static_cast<double>(points) - 2.0);
  mean.variance *= widened * widened;
  return mean;
}

/// Logarithm of the likelihood that the best walk gains over none.
double gain_of_walk(const std::vector<Slope>& slopes, const Slope& none) {
  double best = none.log_likelihood;
  for (const Slope& slope : slopes) best = std::max(best, slope.log_likelihood);
  return best - none.log_likelihood;
}

std::optional<TrackedFrequency> track_once(const Recording& recording, double near_Hz, std::size_t harmonics) {
  if (!(near_Hz > 0.0) || !std::isfinite(near_Hz)) return std::nullopt;  // forces near the largest double overflow
  const double cycles = std::floor(recording.duration_s() * near_Hz);
  double per_segment = std::max(1.0, std::ceil(cycles / static_cast<double>(kMostSegments)));
  std::vector<Segment> segments = cut_segments(recording, near_Hz, per_segment, harmonics);
  Advance advance = advance_of(segments);
  while (segments.size() >= 16) {  // longer segments if noise conceals the phase of short ones
    std::vector<Segment> longer = merge_pairs(segments, advance.radians, harmonics);
    const Advance next = advance_of(longer);
    if (advance.coherence > 0.8 || next.coherence < advance.coherence) break;
    segments = std::move(longer);
    advance = next;
    per_segment *= 2.0;
  }
  std::vector<PhasePoint> points = unwrap(segments, advance.radians);
  if (points.size() < 6) return std::nullopt;
  refine_by_harmonics(segments, harmonics, points);
  const Slope none = slope_at(points, Walk::Stepped, 0.0, 1.0);
  std::vector<Slope> slopes = slopes_of(points, Walk::Stepped);
  slopes.push_back(none);
  const Slope regular = average(slopes, thresholds::kHiddenWalk, points.size());
  const std::vector<Slope> averaged = slopes_of(points, Walk::Averaged);
  slopes.insert(slopes.end(), averaged.begin(), averaged.end());
  // By the root only: the phases of neighbours are not quite as independent as the likelihood has it.
  const Slope slope = average(slopes, 0.5, points.size());
  const double per_radian = near_Hz / (kTurn * per_segment);
  TrackedFrequency found{near_Hz + slope.value * per_radian, std::sqrt(slope.variance) * per_radian, std::nullopt};
  if (gain_of_walk(slopes, none) < thresholds::kWalkGain)
    found.regular_standard_error_Hz = std::sqrt(regular.variance) * per_radian;
  return found;
}

}  // namespace

std::optional<TrackedFrequency> track_frequency(const Recording& recording, double near_Hz, std::size_t harmonics) {
  harmonics = std::clamp<std::size_t>(harmonics, 1, kMostTracked);
  std::optional<TrackedFrequency> found = track_once(recording, near_Hz, harmonics);
  // Segments that are not quite whole cycles cut the pattern elsewhere every time, which looks like a change of phase:
  // gone once they are whole.
  // (With many cycles it averages out, and a pass costs a look at every sample.)
  const int passes = recording.duration_s() * near_Hz < 300.0 ? 3 : 0;
  for (int pass = 0; found && pass < passes; ++pass) {
    const std::optional<TrackedFrequency> again = track_once(recording, found->frequency_Hz, harmonics);
    if (!again) break;
    const double change = std::abs(again->frequency_Hz - found->frequency_Hz);
    found = again;
    if (change < 0.1 * again->standard_error_Hz) break;
  }
  return found;
}

}  // namespace slipfit::signal
