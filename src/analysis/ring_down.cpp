#include "analysis/ring_down.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "analysis/conclusions.hpp"
#include "analysis/detect.hpp"
#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "signal/comb.hpp"
#include "signal/events.hpp"
#include "signal/least_squares.hpp"
#include "signal/smoothing.hpp"

namespace slipfit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kColumns = 6;  // omega, decay, level, slope, cosine and sine
using Normal = Eigen::Matrix<double, kColumns, kColumns>;
using Vector = Eigen::Matrix<double, kColumns, 1>;

/// The oscillation at given values, and the derivatives by all of its parameters.
struct Linearized {
  MatrixXd columns;
  VectorXd residual;
};

Linearized linearized_at(const signal::Samples& samples, double omega, double decay) {
  constexpr double kPerTurn = 2.0 * std::numbers::pi;
  const signal::HarmonicFit fit(samples, {.frequency_Hz = omega / kPerTurn, .decay_per_s = decay});
  Linearized at{MatrixXd(samples.time_s.size(), kColumns), fit.residual()};
  at.columns << fit.by_frequency() / kPerTurn, fit.by_decay(), fit.columns();
  return at;
}

/// Errors by leaving out each half period, or by white residuals, whichever are larger.
std::optional<DampedSine> with_errors(const signal::Samples& samples, double omega, double decay) {
  const auto [columns, residuals] = linearized_at(samples, omega, decay);
  const Normal whole = columns.transpose() * columns;
  std::vector<Normal> parts;
  std::vector<Vector> scores;
  for (Index i = 0; i < columns.rows(); ++i) {
    const auto part = static_cast<std::size_t>(samples.time_s(i) * omega / std::numbers::pi);
    parts.resize(std::max(parts.size(), part + 1), Normal::Zero());
    scores.resize(parts.size(), Vector::Zero());
    parts[part] += columns.row(i).transpose() * columns.row(i);
    scores[part] += residuals(i) * columns.row(i).transpose();
  }
  const auto count = static_cast<double>(parts.size());
  MatrixXd moves(static_cast<Index>(parts.size()), Index{2});
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const Vector move = (whole - parts[part]).ldlt().solve(-scores[part]);
    moves.row(static_cast<Index>(part)) = move.head<2>();
  }
  const double freedom = std::max(1.0, static_cast<double>(columns.rows() - kColumns));
  const Vector white = residuals.squaredNorm() / freedom * whole.ldlt().solve(Normal::Identity()).diagonal();
  const Eigen::RowVector2d scatter =
      (count - 1.0) / count * (moves.rowwise() - moves.colwise().mean()).colwise().squaredNorm();
  const auto error = [&](Index i) { return std::sqrt(std::max(white(i), scatter(i))); };
  if (!std::isfinite(error(0)) || !std::isfinite(error(1))) return std::nullopt;
  return DampedSine{omega, error(0), decay, error(1), count};
}

}  // namespace

std::optional<DampedSine> fit_damped_sine(std::span<const double> time_s, std::span<const double> force,
                                          double omega_rad_per_s, double decay_per_s) {
  if (time_s.size() < static_cast<std::size_t>(kColumns) + 2) return std::nullopt;
  constexpr int kMostSteps = 30;
  constexpr double kEnough = 1e-9;
  constexpr double kFar = 0.3;  // of ln omega: another oscillation
  const auto count = static_cast<Index>(time_s.size());
  const signal::Samples samples{Eigen::Map<const VectorXd>(time_s.data(), count).array() - time_s.front(),
                                Eigen::Map<const VectorXd>(force.data(), count), VectorXd::Ones(count)};
  Eigen::Vector2d at(omega_rad_per_s, decay_per_s);
  for (int step = 0; step < kMostSteps; ++step) {
    const auto [columns, residual] = linearized_at(samples, at(0), at(1));
    const Eigen::Vector2d move = signal::least_squares(columns, residual).head<2>();
    at += move;
    if (!at.allFinite() || std::abs(std::log(at(0) / omega_rad_per_s)) > kFar) return std::nullopt;
    if (move.norm() < kEnough * omega_rad_per_s) return with_errors(samples, at(0), at(1));
  }
  return std::nullopt;
}

namespace {

/// Swings between neighbouring turning points, in order.
struct Swings {
  std::vector<double> half_periods_s;
  std::vector<double> log_sizes;
  std::vector<std::size_t> turns;  ///< samples where they begin, and where the last one ends
};

struct Start {
  std::size_t begin = 0;  ///< sample from which on the fall is looked for
  double noise = 0.0;     ///< standard deviation of a sample
  double least_fall = 0.0;
};

/// After the largest fall of the trace smoothed over `width` samples, without the swing that follows it.
Swings swings_of(const Recording& recording, const Start& start, std::size_t width) {
  const std::vector<double> trace = signal::RunningMeans(recording.force().subspan(start.begin)).over(width);
  const double noise = start.noise / std::sqrt(static_cast<double>(width));
  signal::TurningPoints turning_points(std::max(thresholds::kNoiseSigmas * noise, 1e-3 * start.least_fall));
  turning_points.add(0, trace);
  const std::vector<std::size_t> turns = turning_points.turns();
  const auto size_of = [&](std::size_t i) { return std::abs(trace[turns[i + 1]] - trace[turns[i]]); };
  std::size_t largest = 0;  // falls begin at even turns
  for (std::size_t i = 2; i + 1 < turns.size(); i += 2) largest = size_of(i) > size_of(largest) ? i : largest;
  Swings swings;
  if (turns.size() < 2 || size_of(largest) < start.least_fall) return swings;
  for (std::size_t i = largest + 2; i + 1 < turns.size(); ++i) {
    swings.half_periods_s.push_back(recording.time_s()[start.begin + turns[i + 1]] -
                                    recording.time_s()[start.begin + turns[i]]);
    swings.log_sizes.push_back(std::log(size_of(i)));
    swings.turns.push_back(start.begin + turns[i] + width / 2);
  }
  if (!swings.turns.empty()) swings.turns.push_back(start.begin + turns.back() + width / 2);
  return swings;
}

/// Returns the oscillation without its end, where it no longer decays at its rate: noise, or another motion.
Swings ring_of(Swings swings) {
  std::size_t count = std::min<std::size_t>(swings.half_periods_s.size(), 1);
  const auto in_rhythm = [&](std::size_t i) {
    const double ratio = swings.half_periods_s[i] / swings.half_periods_s[i - 1];
    return ratio > 0.5 && ratio < 2.0 && (i < 2 || swings.log_sizes[i] < swings.log_sizes[i - 2]);
  };
  while (count < swings.half_periods_s.size() && in_rhythm(count)) ++count;
  swings.half_periods_s.resize(count);
  swings.log_sizes.resize(count);
  swings.turns.resize(count > 0 ? count + 1 : 0);
  return swings;
}

/// Fits the samples of this number of periods by least squares, starting from the turning points.
std::optional<RingDown> by_least_squares(const Recording& recording, const Swings& swings, std::size_t count,
                                         const RingDown& start) {
  constexpr std::size_t kEnough = 20000;  // samples
  const std::size_t begin = swings.turns.front();
  const std::size_t end = std::min(recording.size(), swings.turns[count] + 1);
  const std::size_t every = (end - begin) / kEnough + 1;
  std::vector<double> time_s;
  std::vector<double> force;
  for (std::size_t i = begin; i < end; i += every) {
    time_s.push_back(recording.time_s()[i]);
    force.push_back(recording.force()[i]);
  }
  const double omega = 2.0 * std::numbers::pi * *start.frequency_Hz.value;
  const double ratio = *start.damping_ratio.value;
  const auto sine = fit_damped_sine(time_s, force, omega, omega * ratio / std::sqrt(1.0 - ratio * ratio));
  if (!sine || !(sine->decay_per_s > 0.0)) return std::nullopt;
  const double natural = std::hypot(sine->omega_rad_per_s, sine->decay_per_s);
  const double ratio_error =
      std::hypot(sine->omega_rad_per_s * sine->decay_error_per_s, sine->decay_per_s * sine->omega_error_rad_per_s) *
      sine->omega_rad_per_s / std::pow(natural, 3);
  const double per_turn = 2.0 * std::numbers::pi;
  const double freedom = sine->half_periods - 1.0;
  return RingDown{symmetric(sine->omega_rad_per_s / per_turn, sine->omega_error_rad_per_s / per_turn, freedom),
                  symmetric(sine->decay_per_s / natural, ratio_error, freedom)};
}

/// After the largest fall after `begin` (sample), where it is at least `least_fall`: half periods between turning
/// points, and the logarithmic decrement of the swings between them, the first one aside (the contact still holds).
/// Intervals from their scatter, so that a ring whose frequency or damping changes with its size has wide ones. Empty
/// where fewer than four swings that decay exceed the noise.
std::optional<RingDown> find_ring_down(const Recording& recording, std::size_t begin, double noise, double least_fall) {
  if (begin + 8 > recording.size()) return std::nullopt;
  Swings swings;
  for (std::size_t width = 1; begin + 8 * width < recording.size(); width *= 2) {
    Swings wider = ring_of(swings_of(recording, {begin, noise, least_fall}, width));
    const double half_s = signal::median(wider.half_periods_s);
    // Over a quarter of a half period it shifts no turning point and leaves less noise on each.
    const bool follows = width == 1 || static_cast<double>(width) * recording.sample_interval_s() < 0.25 * half_s;
    if (follows && wider.half_periods_s.size() >= swings.half_periods_s.size()) swings = std::move(wider);
  }
  if (swings.half_periods_s.size() < thresholds::kFewestSwings) return std::nullopt;
  const MeanAndSpread half = describe(swings.half_periods_s);
  // Noise lengthens swings: small ones, of a few times the hysteresis, would let the ring seem to last.
  const double small = std::log(3.0 * thresholds::kNoiseSigmas * noise);
  std::size_t large = swings.log_sizes.size();
  while (large > thresholds::kFewestSwings && swings.log_sizes[large - 1] < small) --large;
  swings.log_sizes.resize(large);
  const LineSums decay = line_sums(
      large, [](std::size_t i) { return static_cast<double>(i); }, [&](std::size_t i) { return swings.log_sizes[i]; });
  if (decay.slope() + 2.0 * decay.slope_error() > 0.0) return std::nullopt;
  // Between turning points the swing shrinks by exp(-pi zeta / sqrt(1 - zeta^2)); a turning point is timed to a sample.
  const double decrement = -decay.slope() / std::numbers::pi;
  const double ratio = decrement / std::hypot(1.0, decrement);
  // Both ends of the line lie higher or lower by what noise does to the smallest swing.
  const double by_noise = 2.0 * noise / std::exp(swings.log_sizes.back()) / static_cast<double>(large);
  const double decay_se = std::hypot(decay.slope_error(), by_noise);
  const double ratio_se = decay_se / std::numbers::pi / std::pow(std::hypot(1.0, decrement), 3);
  const double frequency_Hz = 0.5 / half.mean;
  const double timing = recording.sample_interval_s() / half.mean / half.count;
  const double frequency_se_Hz = frequency_Hz * std::hypot(half.sd / half.mean / std::sqrt(half.count), timing);
  const RingDown by_turns{symmetric(frequency_Hz, frequency_se_Hz, half.count - 1.0),
                          symmetric(ratio, ratio_se, static_cast<double>(large) - 2.0)};
  return by_least_squares(recording, swings, large, by_turns).value_or(by_turns);
}

}  // namespace

std::optional<RingDown> ring_down_after_release(const Detected& detected) {
  if (detected.signals.segmentation.slips.empty()) return std::nullopt;
  const double noise = detected.whole_quality.noise_rms;
  const double fall = std::max(median_drop(detected.signals.segmentation), thresholds::kNoiseDrop * noise);
  return find_ring_down(*detected.whole, detected.sample_of(detected.recording().size() - 1), noise, fall);
}

namespace {

/// The trace at one time scale, one mean a sample from `half` samples on.
struct Trace {
  std::vector<double> force;
  std::size_t half = 0;
  double noise = 0.0;
};

/// So many samples that the turning points of the run-up exceed the noise, but short against it.
Trace smoothed(const Detected& detected) {
  const std::span<const double> force = detected.whole->force();
  const Segmentation& slips = detected.signals.segmentation;
  const std::size_t width = slips.slips.empty() ? std::max<std::size_t>(1, force.size() / 500) : slips.smoothed_over;
  std::vector<double> means = signal::RunningMeans(force).over(std::min(width, force.size()));
  const double noise = detected.whole_quality.noise_rms / std::sqrt(static_cast<double>(width));
  return {std::move(means), width / 2, noise};
}

/// The part of a recording from the lowest force to the first peak.
struct RunUp {
  std::size_t begin = 0;
  std::size_t peak = 0;
  double rise = 0.0;
};

/// The first rise that is much larger than the sticks between the slips (or, without slips, than what comes after it)
/// and that reaches the level of sliding. A lower peak is one of the ramp, on which a slack line tightens or a holder
/// settles.
std::optional<RunUp> first_large_rise(const Trace& trace, double drop) {
  const auto [low, high] = std::ranges::minmax_element(trace.force);
  const double range = *high - *low;
  const double swing = std::max(drop > 0.0 ? 0.25 * drop : 0.1 * range, 8.0 * trace.noise);
  const double least = std::max(thresholds::kRunUp * drop, thresholds::kNoiseDrop * trace.noise);
  constexpr double kShareOfLevel = 0.75;  // static friction is hardly below kinetic friction
  std::optional<double> level;            // of sliding, once a rise asks for it
  signal::TurningPoints turns(swing);
  std::size_t lowest = 0;  // of those before `looked`
  std::size_t looked = 0;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < trace.force.size(); ++i) {
    turns.add(i, trace.force[i]);
    if (turns.falls().size() == seen) continue;
    const std::size_t peak = turns.falls()[seen++].peak;
    for (; looked < peak; ++looked) lowest = trace.force[looked] < trace.force[lowest] ? looked : lowest;
    const double rise = trace.force[peak] - trace.force[lowest];
    if (!(rise > std::max(least, drop > 0.0 ? 0.0 : 0.5 * range))) continue;
    if (!level) level = median(trace.force);
    if (rise > kShareOfLevel * (*level - trace.force[lowest])) return RunUp{lowest, peak, rise};
  }
  return std::nullopt;
}

/// Returns the loading before the first slip of a recording that starts at rest; without stick-slip the force has to
/// stay high after the first peak.
std::optional<RunUp> run_up(const Detected& detected, const Trace& trace, MotionClass motion) {
  const std::vector<DetectedSlip>& slips = detected.signals.segmentation.slips;
  const std::optional<RunUp> ramp = first_large_rise(trace, median_drop(detected.signals.segmentation));
  if (!ramp) return std::nullopt;
  if (motion == MotionClass::StickSlip) {
    const std::size_t first = detected.sample_of(slips.front().trough);
    return ramp->peak + trace.half < first ? ramp : std::nullopt;
  }
  const double low = trace.force[ramp->begin] + 0.25 * ramp->rise;
  const auto after = trace.force.begin() + static_cast<std::ptrdiff_t>(ramp->peak);
  const auto fallen = std::count_if(after, trace.force.end(), [&](double force) { return force < low; });
  const auto all = static_cast<double>(trace.force.end() - after);
  return static_cast<double>(fallen) < thresholds::kReleased * all ? ramp : std::nullopt;
}

/// The first peak over the mean of a hundredth of the ramp: noise lifts the highest sample.
double peak_force(const Recording& recording, const Trace& trace, const RunUp& ramp) {
  const std::size_t width = std::max<std::size_t>(1, (ramp.peak - ramp.begin) / 100);
  const std::size_t at = ramp.peak + trace.half;
  const std::size_t begin = at - std::min(at, 2 * width);
  const auto around = recording.force().subspan(begin, std::min(recording.size() - begin, 4 * width));
  const std::vector<double> means = signal::RunningMeans(around).over(std::min(width, around.size()));
  return *std::ranges::max_element(means);
}

/// Slope of the ramp from 20 % to 80 % of the rise over the speed. The interval holds how the slope changes on the way:
/// its scatter between fifths of the ramp.
Estimate loading_stiffness(const Recording& recording, const Trace& trace, const RunUp& ramp) {
  const auto reaches = [&](double share) {
    std::size_t i = ramp.begin;
    while (trace.force[i] < trace.force[ramp.begin] + share * ramp.rise) ++i;
    return i + trace.half;
  };
  const std::size_t begin = reaches(0.2);
  const std::size_t count = reaches(0.8) - begin + 1;
  constexpr std::size_t kParts = 5;
  if (count < 4 * kParts) return unknown("the loading ramp has too few samples");
  if (!recording.conditions().speed_is_known) return unknown(kNoSpeed);
  const auto part = [&](std::size_t from, std::size_t samples) {
    return line_sums(recording.time_s().subspan(begin + from, samples),
                     recording.force().subspan(begin + from, samples))
        .slope();
  };
  std::vector<double> slopes;
  for (std::size_t i = 0; i < kParts; ++i) slopes.push_back(part(i * (count / kParts), count / kParts));
  const double speed = recording.conditions().speed_m_per_s;
  const double se = describe(slopes).sd / std::sqrt(static_cast<double>(kParts));
  return symmetric(part(0, count) / speed, se / speed, kParts - 1.0);
}

/// After the release where there is one, after the first peak of a motion that died out otherwise.
std::optional<RingDown> ring_down_of(const Detected& detected, MotionClass motion, const std::optional<RunUp>& ramp) {
  if (motion == MotionClass::StickSlip) return ring_down_after_release(detected);
  if (!ramp) return std::nullopt;
  const double noise = detected.whole_quality.noise_rms;
  return find_ring_down(*detected.whole, ramp->peak, noise, std::max(0.3 * ramp->rise, thresholds::kNoiseDrop * noise));
}

}  // namespace

Transients find_transients(const Detected& detected, MotionClass motion) {
  const Trace trace = smoothed(detected);
  const std::optional<RunUp> ramp = run_up(detected, trace, motion);
  constexpr double kManyFreedoms = 100.0;
  Transients transients;
  transients.loading_stiffness_N_per_m = transients.breakaway_force = unknown("the recording contains no loading ramp");
  transients.ring_down_frequency_Hz = transients.ring_down_damping_ratio = unknown("no free ring-down was found");
  if (ramp) {
    transients.loading_stiffness_N_per_m = loading_stiffness(*detected.whole, trace, *ramp);
    transients.breakaway_force = symmetric(peak_force(*detected.whole, trace, *ramp), trace.noise, kManyFreedoms);
  }
  if (const auto ring = ring_down_of(detected, motion, ramp)) {
    transients.ring_down_frequency_Hz = ring->frequency_Hz;
    transients.ring_down_damping_ratio = ring->damping_ratio;
  }
  return transients;
}

}  // namespace slipfit
