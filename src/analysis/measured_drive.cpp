#include "analysis/measured_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "analysis/detect.hpp"
#include "core/sample_range.hpp"
#include "core/statistics.hpp"
#include "core/thresholds.hpp"

namespace slipfit {
namespace {

/// The oscillator that decides how far the body follows a motion of the drive in a slip.
struct Oscillator {
  double omega_rad_per_s = 0.0;
  double damping_ratio = 0.0;
};

std::size_t sample_at(std::span<const double> time_s, double seconds) {
  return static_cast<std::size_t>(std::ranges::lower_bound(time_s, seconds) - time_s.begin());
}

/// Returns the slips, each from its first sample to the first one at rest: by the fit where it has them, else from peak
/// to trough.
std::vector<SampleRange> slips_of(const Recording& recording, const Segmentation& segmentation, const FitResult* fit) {
  const std::span<const double> time_s = recording.time_s();
  std::vector<SampleRange> slips;
  for (std::size_t i = 0; i < segmentation.slips.size(); ++i) {
    SampleRange slip{segmentation.slips[i].peak, segmentation.slips[i].trough};
    if (fit != nullptr && i < fit->cycles.size() && fit->cycles[i].onset_s && fit->cycles[i].end_s) {
      slip = {sample_at(time_s, *fit->cycles[i].onset_s), sample_at(time_s, *fit->cycles[i].end_s)};
    }
    const bool follows = slips.empty() || slip.begin > slips.back().end;
    if (follows && slip.end > slip.begin && slip.end < recording.size()) slips.push_back(slip);
  }
  return slips;
}

Oscillator oscillator_of(const Recording& recording, const std::vector<SampleRange>& slips, const FitResult* fit) {
  constexpr double kUsualDamping = 0.05;
  const std::optional<double> omega = fit != nullptr ? fit->natural_frequency().value : std::nullopt;
  const std::optional<double> zeta = fit != nullptr ? fit->damping_ratio().value : std::nullopt;
  if (omega && zeta) return {*omega, *zeta};
  std::vector<double> durations_s;
  durations_s.reserve(slips.size());
  for (const SampleRange& slip : slips)
    durations_s.push_back(recording.time_s()[slip.end] - recording.time_s()[slip.begin]);
  return {std::numbers::pi / median(std::move(durations_s)), kUsualDamping};
}

/// The position of the drive less that at the stated speed, without the steps of its encoder: a mean over two of
/// them, and over three samples at least.
std::vector<double> deviation_of(const Recording& recording) {
  const std::span<const double> position_m = recording.drive_m();
  const std::span<const double> time_s = recording.time_s();
  std::size_t changes = 1;
  for (std::size_t i = 1; i < position_m.size(); ++i) changes += position_m[i] != position_m[i - 1] ? 1U : 0U;
  const std::size_t half = std::max<std::size_t>(1, position_m.size() / changes);
  std::vector<double> off_m(position_m.size());
  std::vector<double> sums{0.0};
  for (std::size_t i = 0; i < off_m.size(); ++i) {
    off_m[i] = position_m[i] - recording.conditions().speed_m_per_s * (time_s[i] - time_s[0]);
    sums.push_back(sums.back() + off_m[i]);
  }
  for (std::size_t i = 0; i < off_m.size(); ++i) {
    const std::size_t reach = std::min({half, i, off_m.size() - 1 - i});
    off_m[i] = (sums[i + reach + 1] - sums[i - reach]) / static_cast<double>(2 * reach + 1);
  }
  return off_m;
}

/// Force against position of the drive in the sticks, each without its mean.
struct Regression {
  double stiffness_N_per_m = 0.0;
  double standard_error = 0.0;
  double speed_m_per_s = 0.0;  ///< mean speed of the drive in the sticks
};

std::optional<Regression> regress(const Recording& recording, const std::vector<double>& off_m,
                                  const std::vector<SampleRange>& slips) {
  constexpr double kEnds = 0.1;  // of a stick at either end, where a slip may begin or end
  const auto place = [&](std::size_t i) {
    return off_m[i] + recording.conditions().speed_m_per_s * (recording.time_s()[i] - recording.time_s()[0]);
  };
  LineSums all;
  double moved_m = 0.0, seconds = 0.0;
  for (std::size_t s = 1; s < slips.size(); ++s) {
    const auto less = static_cast<std::size_t>(kEnds * static_cast<double>(slips[s].begin - slips[s - 1].end));
    const std::size_t begin = slips[s - 1].end + less;
    const std::size_t end = slips[s].begin - less;
    if (end < begin + 4) continue;
    const LineSums stick = line_sums(
        end - begin, [&](std::size_t i) { return place(begin + i); },
        [&](std::size_t i) { return recording.force()[begin + i]; });
    all.count += stick.count - 1.0;
    all.square += stick.square;
    all.cross += stick.cross;
    all.scatter += stick.scatter;
    moved_m += place(end - 1) - place(begin);
    seconds += recording.time_s()[end - 1] - recording.time_s()[begin];
  }
  if (!(all.count > 2.0) || !(all.square > 0.0) || !(all.cross > 0.0)) return std::nullopt;
  const double variance = std::max(0.0, all.scatter - all.slope() * all.cross) / (all.count - 1.0) / all.square;
  return Regression{all.slope(), std::sqrt(variance), moved_m / seconds};
}

/// What a motion of the drive by off_m adds to the force: all of it while the body sticks; in a slip what the body
/// does not follow.
std::vector<double> force_of(const std::vector<double>& off_m, const Recording& recording,
                             const std::vector<SampleRange>& slips, double stiffness_N_per_m, const Oscillator& body) {
  constexpr int kSubsteps = 8;
  const std::span<const double> time_s = recording.time_s();
  std::vector<double> added(off_m.size(), 0.0);
  auto slip = slips.begin();
  double at_onset = 0.0, origin_m = off_m.front();
  double follows = 0.0, rate = 0.0;  // force by the motion of the body, and its derivative
  for (std::size_t i = 1; i < off_m.size(); ++i) {
    while (slip != slips.end() && i > slip->end) ++slip;
    const bool is_slip = slip != slips.end() && i > slip->begin;
    if (!is_slip) {
      added[i] = added[i - 1] + stiffness_N_per_m * (off_m[i] - off_m[i - 1]);
      continue;
    }
    if (i == slip->begin + 1) at_onset = added[i - 1], origin_m = off_m[i - 1], follows = rate = 0.0;
    const double step_s = (time_s[i] - time_s[i - 1]) / kSubsteps;
    const double speed = (off_m[i] - off_m[i - 1]) / std::max(time_s[i] - time_s[i - 1], 1e-300);
    for (int j = 0; j < kSubsteps; ++j) {
      const double drive_m = off_m[i - 1] + speed * (j + 0.5) * step_s - origin_m;
      const double square = body.omega_rad_per_s * body.omega_rad_per_s;
      const double damping = 2.0 * body.damping_ratio * body.omega_rad_per_s;
      rate -=
          step_s * (square * (follows + stiffness_N_per_m * drive_m) + damping * (rate + stiffness_N_per_m * speed));
      follows += step_s * rate;
    }
    added[i] = at_onset + follows + stiffness_N_per_m * (off_m[i] - origin_m);
  }
  return added;
}

/// The line through what is added at the onsets of slips: what is left does not move the level of the force.
LineSums trend_at_onsets(const std::vector<double>& added, const Recording& recording,
                         const std::vector<SampleRange>& slips) {
  return line_sums(
      slips.size(), [&](std::size_t i) { return recording.time_s()[slips[i].begin]; },
      [&](std::size_t i) { return added[slips[i].begin]; });
}

/// Median over the slips of how far the drive moves in them more than at its speed in the sticks, which is lower
/// than the stated one by this much.
double moved_in_slips_m(const std::vector<double>& off_m, double excess_m_per_s, const Recording& recording,
                        const std::vector<SampleRange>& slips) {
  std::vector<double> moved_m;
  for (const SampleRange& slip : slips) {
    const double seconds = recording.time_s()[slip.end] - recording.time_s()[slip.begin];
    moved_m.push_back(std::abs(off_m[slip.end] - off_m[slip.begin] + excess_m_per_s * seconds));
  }
  return median(std::move(moved_m));
}

bool is_of_drive(const Recording& recording, const std::vector<SampleRange>& slips, double stick_speed_m_per_s) {
  constexpr double kStated = 0.05;     // farther off, the column or the statement is wrong
  constexpr double kLeastStick = 0.3;  // a body moves in slips alone
  const std::span<const double> x_m = recording.drive_m();
  const double moved_m = x_m[slips.back().begin] - x_m[slips.front().begin];
  const double mean = moved_m / (recording.time_s()[slips.back().begin] - recording.time_s()[slips.front().begin]);
  const double stated = recording.conditions().speed_m_per_s;
  return std::abs(mean / stated - 1.0) < kStated && stick_speed_m_per_s > kLeastStick * stated;
}

}  // namespace

std::optional<SteadyDrive> at_steady_drive(const Recording& recording, const Segmentation& segmentation,
                                           const FitResult* fit) {
  constexpr std::size_t kFewest = 4;
  if (recording.drive_m().empty() || recording.provenance().strokes > 0 || !slips_are_sudden(segmentation)) {
    return std::nullopt;
  }
  const std::vector<SampleRange> slips = slips_of(recording, segmentation, fit);
  if (slips.size() < kFewest) return std::nullopt;
  const std::vector<double> off_m = deviation_of(recording);
  const std::optional<Regression> sticks = regress(recording, off_m, slips);
  if (!sticks || !is_of_drive(recording, slips, sticks->speed_m_per_s)) return std::nullopt;
  std::vector<double> removed =
      force_of(off_m, recording, slips, sticks->stiffness_N_per_m, oscillator_of(recording, slips, fit));
  const LineSums trend = trend_at_onsets(removed, recording, slips);
  double square = 0.0;
  std::vector<double> force(removed.size());
  for (std::size_t i = 0; i < removed.size(); ++i) {
    removed[i] -= trend.at(recording.time_s()[i]);
    square += removed[i] * removed[i];
    force[i] = recording.force()[i] - removed[i];
  }
  Conditions conditions = recording.conditions();
  conditions.speed_m_per_s += trend.slope() / sticks->stiffness_N_per_m;
  const double unsteadiness = std::sqrt(square / static_cast<double>(removed.size())) / median_drop(segmentation);
  const bool is_at_stated =
      std::abs(conditions.speed_m_per_s / recording.conditions().speed_m_per_s - 1.0) < thresholds::kNegligible;
  if (is_at_stated && unsteadiness < thresholds::kNegligible) return std::nullopt;
  auto steady =
      Recording::create({recording.time_s().begin(), recording.time_s().end()}, std::move(force), conditions,
                        recording.provenance(), {recording.normal_force_N().begin(), recording.normal_force_N().end()});
  if (!steady) return std::nullopt;
  const double excess_m_per_s = recording.conditions().speed_m_per_s - conditions.speed_m_per_s;
  const double in_slips = moved_in_slips_m(off_m, excess_m_per_s, recording, slips);
  const Estimate stiffness{sticks->stiffness_N_per_m, sticks->standard_error, {}, {}};
  const double share = sticks->stiffness_N_per_m * in_slips / median_drop(segmentation);
  return SteadyDrive{std::move(steady).value(), std::move(removed), stiffness, share};
}

FitResult as_measured(FitResult fit, const Recording& recording, const SteadyDrive& drive) {
  const std::vector<double>& removed = drive.removed;
  for (Cycle& cycle : fit.cycles) {
    if (!cycle.onset_s || !cycle.onset_force) continue;
    const double force = removed[std::min(sample_at(recording.time_s(), *cycle.onset_s), removed.size() - 1)];
    *cycle.onset_force += force;
    if (cycle.level_force) *cycle.level_force += force;
  }
  for (CurvePoint& point : fit.curve) point.force += removed[point.sample];
  for (Parameter& parameter : fit.parameters) {
    Estimate& k = parameter.estimate;
    if (parameter.id != ParameterId::Stiffness || !k.value || !k.ci95 || !k.standard_error) continue;
    const double slope = *drive.stiffness_N_per_m.value;
    const double reach = kNormalQuantile * *drive.stiffness_N_per_m.standard_error;
    k.ci95 = Interval{std::min(k.ci95->low, slope - reach), std::max(k.ci95->high, slope + reach)};
    k.standard_error = std::max(*k.standard_error, std::abs(slope - *k.value) / kNormalQuantile);
  }
  return fit;
}

}  // namespace slipfit
