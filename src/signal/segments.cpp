#include "signal/segments.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace slipfit::signal {
namespace {

constexpr std::size_t kEnoughToLeaveOne = 12;

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

}  // namespace

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

}  // namespace slipfit::signal
