#include "fit/selection/damped_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/thresholds.hpp"
#include "fit/cycle/start.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/level/hum.hpp"
#include "fit/level/level_terms.hpp"
#include "fit/problem/normals.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/outliers.hpp"
#include "fit/selection/rise.hpp"
#include "fit/selection/tiers.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::fit {

namespace {

/// Enough cycles to find the shared parameters' neighbourhood; the full fit starts from there.
constexpr std::size_t kProbeCycles = kFewestWandering;
/// Enough to know the shared parameters to an error or two: all cycles then need few steps, however many they are.
constexpr std::size_t kMiddleCycles = 64;
constexpr std::size_t kManyCycles = 2 * kMiddleCycles;
constexpr int kMiddleIterations = 20;  // slow convergence means that the model does not explain the slips
constexpr int kQuickIterations = 8;
constexpr int kCleanPasses = 4;
constexpr int kProbeIterations = 12;
constexpr int kRoughIterations = 20;
constexpr int kMaxIterations = 60;
constexpr double kMuchDamping = 0.2;
constexpr double kRough = 0.1;  // SolveOptions::tolerance
constexpr double kFinal = 1e-3;

/// Returns the sum of squares that one linear step by this coordinate gains where all others follow.
double gain_by(Coordinate coordinate, const BlockFit& fit, Held held) {
  const Problem problem{{&fit, 1}};
  const std::vector<Normal> normals = normals_of(problem);
  const double with = newton_step(problem, normals, held).gain;
  held[static_cast<std::size_t>(coordinate)] = true;
  return with - newton_step(problem, normals, held).gain;
}

/// Returns by how much ln k seems to change, either way from its mean, because the level changes more quickly in some
/// cycles than in others: a level that belongs to friction is not in the sticks, though the model has it there.
double change_by_level(const BlockFit& fit) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const double slope = level_slope(fit, i, fit.reference_s(i));
    least = std::min(least, slope);
    most = std::max(most, slope);
  }
  return 0.5 * (most - least) / (std::exp(fit.parameters.values(kLogStiffness)) * fit.scales().speed_m_per_s);
}

class Fitter {
 public:
  Fitter(const FitInput& input, const AbortPredicate& should_abort)
      : recording_(input.recording),
        quality_(input.quality),
        segmentation_(input.segmentation),
        held_values_(input.held),
        should_abort_(should_abort),
        held_(held_of(input.held)),
        scales_(scales_of(recording_, quality_, segmentation_)),
        excluded_(initial_exclusions(recording_, quality_)) {}

  std::optional<DampedFit> fit() {
    std::optional<BlockFit> start = started();
    if (!start) return std::nullopt;
    const bool are_many = cycles_.size() > kManyCycles;
    if (are_many) {
      auto middle = fit_middle(*start, start->level().lines_Hz);
      if (middle) start = with_settled_hum(*std::move(middle));
      start = or_wandering(*std::move(start), kRough);
      if (should_abort_ && should_abort_(*start)) return std::nullopt;
    }
    std::optional<BlockFit> fit =
        fit_from(std::move(cycles_), start->level(), start->parameters.values, kMaxIterations, kRough);
    if (fit && !are_many) {
      fit = or_wandering(*std::move(fit), kRough);
      if (should_abort_ && should_abort_(*fit)) return std::nullopt;
    }
    const std::size_t excluded = excluded_.size();
    if (fit) fit = with_clean_data(std::move(*fit));
    if (!fit) return std::nullopt;
    if (std::optional<BlockFit> drifting = with_drift(*fit)) {
      scales_.stiffness_drifts = true;  // of all later fits, too
      fit = with_clean_data(*std::move(drifting));
      if (!fit) return std::nullopt;
    }
    if (excluded_.size() > excluded) fit = or_wandering(*std::move(fit), kFinal);  // outliers may have led there
    if (!fit->level().lines_Hz.empty()) fit = with_hum_in_bins(*std::move(fit));
    if (quality_.clock_jitter > thresholds::kUnevenClock) fit = with_clock_weights(std::move(*fit));
    if (!refuse_negative_damping(*fit, kFinal)) return std::nullopt;
    return with_uncertainty(
        {std::move(*fit), false, held_, refused_damping_, half_width_s(start_stiffness_, scales_), excluded_},
        quality_);
  }

  /// All cycles as they are, roughly.
  std::optional<BlockFit> rough() {
    const std::optional<BlockFit> start = started();
    if (!start) return std::nullopt;
    return fit_from(std::move(cycles_), start->level(), start->parameters.values, kRoughIterations, kRough);
  }

 private:
  /// Cuts the cycles and fits a few of them.
  std::optional<BlockFit> started() {
    start_stiffness_ = held_values_.stiffness_N_per_m.value_or(stiffness_of(recording_, segmentation_));
    if (!(start_stiffness_ > 0.0)) return std::nullopt;
    cycles_ = cut();
    if (cycles_.size() < thresholds::kFewestSlips) return std::nullopt;
    scales_.time_begin_s = cycles_.front().window_begin_s;
    scales_.time_end_s = cycles_.back().window_end_s;
    const LevelModel level = first_level(recording_, segmentation_, cycles_, scales_);
    if (!level.lines_Hz.empty()) cycles_ = cut({level.lines_Hz, scales_.time_begin_s});
    return fit_probe(spread_subset(cycles_, std::max<std::size_t>(kProbeCycles, 3 * level.terms)), level);
  }

  /// Finds level model and neighbourhood of the shared parameters on a few cycles.
  std::optional<BlockFit> fit_probe(const std::vector<CycleData>& probe, const LevelModel& level) {
    std::optional<BlockFit> fit = fit_from_starts(probe, level);
    if (!fit) return std::nullopt;
    start_ = fit->parameters.values;
    // Damping is free before levels are compared: a level a cycle takes up what a wrong zeta does to the troughs.
    if (!std::isfinite(solve(*fit, {held_, false, kProbeIterations, kRough}))) return std::nullopt;
    const bool may_wander = reduced_chi2(*fit) > thresholds::kSuspectChi2;
    if (!level.per_cycle && probe.size() > level.terms && may_wander) {
      auto wandering = fit_from(probe, {true, 0, level.lines_Hz}, fit->parameters.values, kProbeIterations, kRough);
      if (wandering && level_wanders(*wandering, *fit)) fit = std::move(wandering);
    }
    if (!refuse_negative_damping(*fit, kRough)) return std::nullopt;
    return fit;
  }

  [[nodiscard]] std::optional<BlockFit> fit_middle(const BlockFit& near, const std::vector<double>& lines_Hz) const {
    LevelModel level = near.level();
    level.lines_Hz = lines_Hz;
    // What decides whether all are fitted has to be settled.
    const double tolerance = should_abort_ ? kFinal : kRough;
    return fit_from(spread_subset(cycles_, kMiddleCycles), level, near.parameters.values, kMiddleIterations, tolerance);
  }

  /// The spectrum determines the frequencies of lines less well than a fit of some cycles from the first to the last.
  [[nodiscard]] BlockFit with_settled_hum(BlockFit middle) {
    for (int pass = 0; pass < kCleanPasses && !middle.level().lines_Hz.empty(); ++pass) {
      const Residuals residuals = without(residuals_of(recording_, middle), excluded_);
      const std::vector<double> lines_Hz = refine_hum(recording_, middle, residuals.value);
      if (is_same_hum(middle, lines_Hz)) break;
      cycles_ = cut({lines_Hz, scales_.time_begin_s});
      std::optional<BlockFit> next = fit_middle(middle, lines_Hz);
      if (!next) break;
      middle = *std::move(next);
    }
    return middle;
  }

  /// The same cycles with a level each from little damping, where they explain more: troughs that lie on one level
  /// while the peaks scatter look like slips with much damping, from which the search does not return.
  [[nodiscard]] BlockFit or_wandering(BlockFit fit, double tolerance) const {
    const bool is_damped = !held_[kDamping] && fit.parameters.values(kDamping) > kMuchDamping;
    if (!is_damped || fit.level().per_cycle || fit.size() < kFewestWandering) return fit;
    const LevelModel level{true, 0, fit.level().lines_Hz};
    std::optional<BlockFit> wandering = fit_from(fit.set()->cycles(), level, start_, kMaxIterations, tolerance);
    return wandering && level_wanders(*wandering, fit) ? *std::move(wandering) : std::move(fit);
  }

  /// Returns the fit with k that changes along the path. The result is empty where k is held, where a linear step gains
  /// too little, or where errors or a level that belongs to friction explain the change. docs/model.md (26a)
  [[nodiscard]] std::optional<BlockFit> with_drift(const BlockFit& fit) const {
    if (held_[kLogStiffness]) return std::nullopt;
    Scales scales = fit.scales();
    scales.stiffness_drifts = true;
    BlockFit all = fit.with_scales(scales);
    BlockFit some = all.with_fewer_cycles(kMiddleCycles);
    if (!(gain_by(kStiffnessDrift, some, held_) > thresholds::kTierPrice * reduced_chi2(some))) return std::nullopt;
    if (!std::isfinite(solve(some, {held_, false, kMiddleIterations, kRough}))) return std::nullopt;
    const Problem problem{{&some, 1}};
    const CoordinateMatrix covariance = jackknife_covariance(problem, normals_of(problem), select(some), held_);
    const double drift = some.parameters.values(kStiffnessDrift);
    const double error = std::sqrt(std::max(0.0, covariance(kStiffnessDrift, kStiffnessDrift)));
    const double least = std::max(thresholds::kNegligible, thresholds::kSureSigmas * error) + change_by_level(some);
    if (!(std::abs(drift) > least)) return std::nullopt;
    all.start_at(some.parameters.values);
    if (!std::isfinite(solve(all, {held_, false, kMaxIterations, kRough}))) return std::nullopt;
    return all;
  }

  /// Short runs with zeta held, the best of them.
  [[nodiscard]] std::optional<BlockFit> fit_from_starts(const std::vector<CycleData>& cycles,
                                                        const LevelModel& level) const {
    std::optional<BlockFit> fit = BlockFit::create(cycles, middles_s(segmentation_, cycles), scales_, level);
    if (!fit) return fit;
    SolveOptions quick{held_, false, kQuickIterations, kRough};
    quick.held[kDamping] = true;
    double best_cost = std::numeric_limits<double>::infinity();
    Parameters best;
    const double step_s = recording_.sample_interval_s();
    for (const Coordinates& start : first_values(start_stiffness_, held_values_, scales_, step_s)) {
      set_start(*fit, segmentation_, start);
      const double cost = solve(*fit, quick);
      if (cost >= best_cost) continue;
      best_cost = cost;
      best = fit->parameters;
      if (reduced_chi2(*fit) < thresholds::kSuspectChi2) return fit;  // nothing left to find
    }
    if (!std::isfinite(best_cost)) return std::nullopt;
    fit->parameters = best;
    return fit;
  }

  [[nodiscard]] std::optional<BlockFit> fit_from(std::vector<CycleData> cycles, const LevelModel& level,
                                                 const Coordinates& start, int max_iterations, double tolerance) const {
    std::vector<double> middles = middles_s(segmentation_, cycles);
    std::optional<BlockFit> fit = BlockFit::create(std::move(cycles), std::move(middles), scales_, level);
    if (!fit) return fit;
    set_start(*fit, segmentation_, start);
    if (!std::isfinite(solve(*fit, {held_, false, max_iterations, tolerance}))) return std::nullopt;
    return fit;
  }

  /// A damping ratio clearly below 0 (jackknife where residuals are not white) means that slips are not shaped like the
  /// model's: zeta is held at 0 from here on, and called unidentified. False where the fit is of no use then.
  [[nodiscard]] bool refuse_negative_damping(BlockFit& fit, double tolerance) {
    const double zeta = fit.parameters.values(kDamping);
    if (held_[kDamping] || !(zeta < 0.0) || reduced_chi2(fit) < thresholds::kSuspectChi2) return true;
    const Uncertainty uncertainty = estimate_uncertainty(fit, {held_, false});
    const double se = std::sqrt(std::max(0.0, uncertainty.covariance(kDamping, kDamping)));
    if (!(zeta + thresholds::kLikelySigmas * se < 0.0)) return true;
    refused_damping_ = zeta;
    held_[kDamping] = true;
    // Start again from the features: the other parameters have followed the wrong zeta.
    set_start(fit, segmentation_, oscillator(start_(kLogStiffness), start_(kLogFrequency), 0.0));
    return std::isfinite(solve(fit, {held_, false, kMaxIterations, tolerance}));
  }

  /// Leaves out samples far from the fit and slips that it cannot explain, takes interference into the model, and
  /// refits. Where there was interference, again: it conceals weaker lines and outliers.
  std::optional<BlockFit> with_clean_data(BlockFit fit) {
    for (int pass = 0; pass < kCleanPasses; ++pass) {
      Residuals residuals = without(residuals_of(recording_, fit), excluded_);
      const std::vector<std::size_t> outliers = find_outliers(residuals, scales_.noise);
      const std::vector<std::size_t> censored = beyond_clip(recording_, quality_, residuals, scales_.noise);
      const std::vector<std::size_t> bad = unexplained_slips(fit);
      const std::vector<double> lines_Hz = find_hum(recording_, fit, std::move(residuals.value), outliers);
      if (outliers.empty() && censored.empty() && bad.empty() && lines_Hz.empty()) {
        if (pass == 0) solve(fit, {held_, false, kMaxIterations, kFinal});  // it was only rough so far
        break;
      }
      excluded_ = united(excluded_, united(outliers, censored));
      const bool is_settled = lines_Hz.empty() || is_same_hum(fit, lines_Hz);
      std::optional<BlockFit> next = recut(std::move(fit), bad, lines_Hz);
      if (!next || !std::isfinite(solve(*next, {held_, false, kMaxIterations, kFinal}))) return std::nullopt;
      fit = std::move(*next);
      if (is_settled) break;
    }
    return fit;
  }

  /// Weights depend on the model, the model on the weights: three rounds settle both to a percent of an error.
  [[nodiscard]] BlockFit with_clock_weights(BlockFit fit) const {
    for (int round = 0; round < 3; ++round) {
      std::vector<CycleData> cycles = weigh_by_slope(fit);
      std::vector<double> middles = middles_s(segmentation_, cycles);
      std::optional<BlockFit> weighted = BlockFit::create(std::move(cycles), std::move(middles), scales_, fit.level());
      if (!weighted) return fit;
      weighted->parameters = fit.parameters;
      if (!std::isfinite(solve(*weighted, {held_, false, kMaxIterations, kFinal}))) return fit;
      fit = *std::move(weighted);
    }
    return fit;
  }

  /// Cut again without the slips `bad`, with these lines in the level, near the solution of `fit`, whose cycles make
  /// room for the new ones. Empty where too few are left.
  [[nodiscard]] std::optional<BlockFit> recut(BlockFit fit, const std::vector<std::size_t>& bad,
                                              const std::vector<double>& lines_Hz) const {
    const std::vector<double> hum_start = hum_at_other_frequencies(fit, lines_Hz);
    const Parameters start = std::move(fit.parameters);
    const Scales scales = fit.scales();
    LevelModel level = fit.level();
    std::vector<std::size_t> slips;
    for (std::size_t i = 0; i < fit.size(); ++i) slips.push_back(fit.data(i).slip);
    { const BlockFit released = std::move(fit); }
    std::vector<CycleData> kept;
    for (CycleData& cycle : cut({lines_Hz, scales.time_begin_s})) {
      if (std::find(bad.begin(), bad.end(), cycle.slip) == bad.end()) {
        kept.push_back(std::move(cycle));
      } else if (!kept.empty()) {
        kept.back().continuous_with_next = false;
      }
    }
    level.lines_Hz = lines_Hz;
    std::vector<double> middles = middles_s(segmentation_, kept);
    std::optional<BlockFit> anew = BlockFit::create(std::move(kept), std::move(middles), scales, level);
    if (!anew) return std::nullopt;
    Parameters& parameters = anew->parameters;
    parameters.values = start.values;
    const auto before_lines = static_cast<std::ptrdiff_t>(level.terms);
    std::copy_n(start.level.begin(), before_lines, parameters.level.begin());
    std::copy(hum_start.begin(), hum_start.end(), parameters.level.begin() + before_lines);
    std::size_t old = 0;
    for (std::size_t i = 0; i < anew->size(); ++i) {
      while (old + 1 < slips.size() && slips[old] < anew->data(i).slip) ++old;  // a last slip may be new
      parameters.cycles[i] = start.cycles[old];
    }
    return anew;
  }

  /// Returns the fit with the scatter in its sticks computed without its hum.
  [[nodiscard]] BlockFit with_hum_in_bins(BlockFit fit) const {
    std::vector<CycleData> cycles = same_cycles_of(fit, cut(hum_of(recording_, fit)));
    std::vector<double> middles = middles_s(segmentation_, cycles);
    std::optional<BlockFit> same = BlockFit::create(std::move(cycles), std::move(middles), fit.scales(), fit.level());
    if (!same || same->size() != fit.size()) return fit;
    same->parameters = std::move(fit.parameters);
    return *std::move(same);
  }

  [[nodiscard]] std::vector<CycleData> cut(const HumLines& hum = {}) const {
    return cut_cycles(recording_, segmentation_, half_width_s(start_stiffness_, scales_), excluded_, hum);
  }

  const Recording& recording_;
  const Quality& quality_;
  const Segmentation& segmentation_;
  const HeldParameters& held_values_;
  const AbortPredicate& should_abort_;
  Held held_;
  Scales scales_;
  std::vector<std::size_t> excluded_;  // in ascending order
  double start_stiffness_ = 0.0;
  Coordinates start_ = Coordinates::Zero();
  std::optional<double> refused_damping_;
  std::vector<CycleData> cycles_;
};

}  // namespace

std::optional<DampedFit> draft_damped(const FitInput& input, const AbortPredicate& should_abort) {
  if (input.segmentation.slips.size() < thresholds::kFewestSlips) return std::nullopt;
  return Fitter(input, should_abort).fit();
}

std::optional<BlockFit> rough_fit(const FitInput& input) {
  if (input.segmentation.slips.size() < thresholds::kFewestSlips) return std::nullopt;
  return Fitter(input, {}).rough();
}

namespace {

/// Worse than the damped fit by twice what the tiers must differ by: joined ramps would make it worse still.
bool is_lost(double loose_chi2, const DampedFit& damped) {
  constexpr double kLost = 20.0;
  const double worse = (loose_chi2 - sum_of_squares(damped.blocks)) / damped.uncertainty.chi2;
  return effective_samples(damped) * std::log1p(worse) > kLost;
}

/// Returns whether the damped fit does not rule zeta = 0 out, and its cycles are where the undamped fit has them.
bool is_near(const DampedFit& damped) {
  constexpr double kNear = 2.0;
  return std::abs(damped.blocks.parameters.values(kDamping)) < kNear * damping_error(damped);
}

}  // namespace

std::optional<DampedFit> fit_undamped(const DampedFit& damped, bool may_lose) {
  const BlockFit& from = damped.blocks;
  BlockFit blocks = from;
  blocks.parameters.values(kDamping) = 0.0;
  Held held = damped.held;
  held[kDamping] = true;
  bool lost = false;
  if (!is_near(damped)) {
    // From a zeta far below 0 the joined ramps hold the cycles where they are, at a false minimum: loose ones first.
    SolveOptions rough{held, false};
    rough.tolerance = 0.1;
    const double loose_chi2 = solve(blocks, rough);
    if (!std::isfinite(loose_chi2)) return std::nullopt;
    lost = may_lose && is_lost(loose_chi2, damped);
  }
  const bool joined = damped.continuous && !lost;
  if (!lost && !std::isfinite(solve(blocks, {held, joined}))) return std::nullopt;
  DampedFit result{std::move(blocks),   joined,          held, damped.refused_damping,
                   damped.half_width_s, damped.excluded, {},   damped.misfit};
  result.uncertainty = estimate_uncertainty(result.blocks, {held, joined});
  // Where the free zeta lies below 0 by chance, 0 is hardly worse: residuals twice as large are a false minimum.
  const bool is_false =
      from.parameters.values(kDamping) < 0.0 && result.uncertainty.noise > 2.0 * damped.uncertainty.noise;
  return is_false ? std::nullopt : std::optional(std::move(result));
}

std::vector<CycleData> same_cycles_of(const BlockFit& fit, std::vector<CycleData> cut) {
  std::vector<CycleData> same;
  std::size_t next = 0;
  for (CycleData& cycle : cut) {
    while (next < fit.size() && fit.data(next).slip < cycle.slip) ++next;
    if (next == fit.size() || fit.data(next).slip != cycle.slip) continue;
    cycle.continuous_with_next = fit.data(next).continuous_with_next;
    same.push_back(std::move(cycle));
  }
  return same;
}

bool level_wanders(const BlockFit& wandering, const BlockFit& polynomial) {
  const auto extra = static_cast<double>(wandering.size() - polynomial.level().terms);
  const double gain = sum_of_squares(polynomial) - sum_of_squares(wandering);
  return gain / extra > thresholds::kWanderingRatio * reduced_chi2(wandering);
}

}  // namespace slipfit::fit
