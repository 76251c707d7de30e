#include "signal/phase_track.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::signal {

namespace {

constexpr std::size_t kEnoughToLeaveOne = 12;
constexpr std::size_t kMostTracked = 10;
using Pattern = std::array<Complex, kMostTracked>;  ///< one coefficient a harmonic, fundamental first

/// Fourier coefficients of one stretch of whole cycles.
struct Segment {
  double samples = 0.0;  ///< 0: too few for coefficients
  double sum = 0.0;
  Pattern lines{};
};

/// exp(-i w t) over the samples: by rotation where the clock is even, else by sine and cosine of every time.
class Carrier {
 public:
  Carrier(double omega_rad_per_s, double step_s) : omega_(omega_rad_per_s), step_s_(step_s) {
    turn_ = std::polar(1.0, -omega_ * step_s_);
  }
  Complex at(double time_s) {
    const bool as_expected = std::abs(time_s - last_s_ - step_s_) < 1e-3 * step_s_;
    if (as_expected && ++rotated_ < 64) {
      value_ = multiply(value_, turn_);
    } else {
      value_ = std::polar(1.0, -omega_ * time_s);
      rotated_ = 0;
    }
    last_s_ = time_s;
    return value_;
  }

 private:
  double omega_;
  double step_s_;
  double last_s_ = -1e300;
  Complex turn_;
  Complex value_;
  int rotated_ = 0;
};

void add(Segment& segment, Complex carrier, double force, double share, std::size_t harmonics) {
  segment.samples += share;
  segment.sum += share * force;
  const double weighted = share * force;
  double re = carrier.real();
  double im = carrier.imag();
  for (std::size_t h = 0; h < harmonics; ++h) {
    segment.lines[h] += Complex(weighted * re, weighted * im);
    const double next = re * carrier.real() - im * carrier.imag();
    im = re * carrier.imag() + im * carrier.real();
    re = next;
  }
}

double mean_less(std::span<const double> values, double origin) {
  double sum = 0.0;
  for (const double value : values) sum += value - origin;
  return sum / static_cast<double>(values.size());
}

/// Wander is taken off by the slope between the means of the neighbours (means over whole cycles do not see the
/// cycle): the coefficient of t over whole cycles is i / (2 pi h f).
void remove_wander(std::vector<Segment>& segments, double cycle_per_segment, std::size_t harmonics) {
  const auto mean = [&](std::size_t j) { return segments[j].sum / segments[j].samples; };
  std::vector<double> slopes(segments.size(), 0.0);  // a segment
  for (std::size_t j = 0; j < segments.size(); ++j) {
    const std::size_t before = j > 0 && segments[j - 1].samples > 0.0 ? j - 1 : j;
    const std::size_t after = j + 1 < segments.size() && segments[j + 1].samples > 0.0 ? j + 1 : j;
    if (after > before) slopes[j] = (mean(after) - mean(before)) / static_cast<double>(after - before);
  }
  for (std::size_t j = 0; j < segments.size(); ++j) {
    if (segments[j].samples <= 0.0) continue;
    for (std::size_t h = 0; h < harmonics; ++h) {
      segments[j].lines[h] /= segments[j].samples;
      const double turns = kTurn * static_cast<double>(h + 1) * cycle_per_segment;
      segments[j].lines[h] -= Complex(0.0, slopes[j] / turns);
    }
  }
}

/// Coefficients of segments of `cycles` periods each, slow wander taken off. The first of many segments is left empty:
/// the first cycle starts at rest and differs.
std::vector<Segment> cut_segments(const Recording& recording, double frequency_Hz, double cycles,
                                  std::size_t harmonics) {
  const std::span<const double> time = recording.time_s();
  const std::span<const double> force = recording.force();
  const double step = recording.duration_s() / static_cast<double>(recording.size() - 1);
  // Means over a few samples do for the harmonics wanted: eight to a period of the highest one.
  const double highest_Hz = frequency_Hz * static_cast<double>(harmonics);
  const auto factor = static_cast<std::size_t>(std::max(1.0, 1.0 / (8.0 * highest_Hz * step)));
  const double per_segment = cycles / frequency_Hz;
  const auto count = static_cast<std::size_t>((recording.duration_s() + step) / per_segment + 1e-9);
  std::vector<Segment> segments(count);
  Carrier carrier(kTurn * frequency_Hz, step * static_cast<double>(factor));
  const double level = force.front();
  for (std::size_t i = 0; i + factor <= time.size(); i += factor) {
    const double at = mean_less(time.subspan(i, factor), time.front());
    const double value = mean_less(force.subspan(i, factor), level);
    // A sample on a boundary belongs to both sides, each by its share: whole samples would move every boundary by up
    // to half a step, slowly to and fro where the period is nearly a whole number of samples.
    const double cell = static_cast<double>(factor) * step / per_segment;
    const double begin = (at + 0.5 * step) / per_segment - 0.5 * cell;
    const auto j = static_cast<std::size_t>(std::max(0.0, begin));
    const double over = std::clamp((begin + cell - static_cast<double>(j + 1)) / cell, 0.0, 1.0);
    const Complex turned = carrier.at(at);
    if (j < count) add(segments[j], turned, value, 1.0 - over, harmonics);
    if (over > 0.0 && j + 1 < count) add(segments[j + 1], turned, value, over, harmonics);
  }
  const double expected = per_segment / (step * static_cast<double>(factor));
  for (Segment& segment : segments) {
    if (segment.samples < 0.6 * expected) segment = Segment{};
  }
  if (count >= kEnoughToLeaveOne) segments.front() = Segment{};
  remove_wander(segments, cycles, harmonics);
  return segments;
}

/// The mean advance of the fundamental from one segment to the next, and its coherence (0 ... 1).
struct Advance {
  double radians = 0.0;
  double coherence = 0.0;
};

Advance advance_of(const std::vector<Segment>& segments) {
  Complex sum = 0.0;
  double size = 0.0;
  for (std::size_t j = 0; j + 1 < segments.size(); ++j) {
    const Complex product = segments[j + 1].lines[0] * std::conj(segments[j].lines[0]);
    sum += product;
    size += 0.5 * (std::norm(segments[j].lines[0]) + std::norm(segments[j + 1].lines[0]));
  }
  return {std::arg(sum), size > 0.0 ? std::abs(sum) / size : 0.0};
}

/// Half as many segments of twice the length.
std::vector<Segment> merge_pairs(const std::vector<Segment>& segments, double advance_rad, std::size_t harmonics) {
  std::vector<Segment> merged(segments.size() / 2);
  for (std::size_t j = 0; j < merged.size(); ++j) {
    const Segment& first = segments[2 * j];
    const Segment& second = segments[2 * j + 1];
    merged[j].samples = first.samples + second.samples;
    if (merged[j].samples <= 0.0) continue;
    for (std::size_t h = 0; h < harmonics; ++h) {
      const Complex back = std::polar(1.0, -advance_rad * static_cast<double>(h + 1));
      merged[j].lines[h] =
          (first.samples * first.lines[h] + second.samples * second.lines[h] * back) / merged[j].samples;
    }
  }
  return merged;
}

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
