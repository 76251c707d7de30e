#include "fit/selection/damped_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "fit/cycle/clock_weights.hpp"
#include "fit/cycle/start.hpp"
#include "fit/level/level_order.hpp"
#include "fit/level/mains_hum.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/clipping.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/outliers.hpp"
#include "signal/robust.hpp"

namespace slipfit::fit {
namespace {

/// Enough cycles to find the shared parameters' neighbourhood; the full fit starts from there.
constexpr std::size_t kProbeCycles = 12;
/// Enough to know the shared parameters to an error or two: all cycles then need few steps, however many they are.
constexpr std::size_t kMiddleCycles = 64;
constexpr int kQuickIterations = 8;
constexpr int kCleanPasses = 4;
constexpr int kProbeIterations = 12;
constexpr int kMaxIterations = 60;
constexpr double kRough = 0.1;  // SolveOptions::tolerance
constexpr double kFinal = 1e-3;

class Fitter {
 public:
  Fitter(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
         const HeldParameters& held, const Near& near)
      : recording_(recording), quality_(quality), segmentation_(segmentation), held_values_(held), near_(near) {
    held_ = held_of(held);
    excluded_ = initial_exclusions(recording, quality);
    scales_ = scales_of(recording, quality, segmentation);
  }

  std::optional<DampedFit> fit() {
    start_stiffness_ = held_values_.stiffness_N_per_m.value_or(stiffness_of(recording_, segmentation_));
    if (!(start_stiffness_ > 0.0)) return std::nullopt;
    const std::vector<std::size_t> first_excluded = united(excluded_, near_.excluded);
    cycles_ = cut_cycles(recording_, segmentation_, half_width_s(), first_excluded);
    if (cycles_.size() < thresholds::kFewestFitted) return std::nullopt;
    scales_.time_begin_s = cycles_.front().window_begin_s;
    scales_.time_end_s = cycles_.back().window_end_s;
    const LevelModel level = first_level();
    if (!level.lines_Hz.empty()) {
      const HumLines hum{level.lines_Hz, scales_.time_begin_s};
      cycles_ = cut_cycles(recording_, segmentation_, half_width_s(), first_excluded, hum);
    }
    const std::vector<CycleData> probe = spread_subset(cycles_, std::max<std::size_t>(kProbeCycles, 3 * level.terms));
    std::optional<BlockFit> start = fit_probe(probe, level);
    if (!start) return std::nullopt;
    if (cycles_.size() > 4 * kMiddleCycles) {
      auto middle = fit_from(spread_subset(cycles_, kMiddleCycles), start->level(), start->parameters.globals,
                             kMaxIterations, kRough);
      if (middle) start = std::move(middle);
      if (resting_share(*start) < near_.least_resting) return std::nullopt;
    }
    std::optional<BlockFit> fit =
        fit_from(std::move(cycles_), start->level(), start->parameters.globals, kMaxIterations, kRough);
    if (fit) fit = with_clean_data(std::move(*fit));
    if (!fit) return std::nullopt;
    if (quality_.clock_jitter > thresholds::kWeighedClock) fit = with_clock_weights(std::move(*fit));
    refuse_negative_damping(*fit, kFinal);
    return with_uncertainty({std::move(*fit), false, held_, refused_damping_, half_width_s(), excluded_, {}, {}},
                            tolerated_misfit(quality_));
  }

 private:
  /// A slip lasts 2 (pi - atan lambda) / w_n around its middle; 0.3 half periods on either side are left for the fit to
  /// move its ends.
  [[nodiscard]] double half_width_s() const {
    const double u = start_stiffness_ * scales_.speed_m_per_s * scales_.half_period_s / std::numbers::pi;
    constexpr double kForgotten = 8.0;  // e^-8: what the sensor still shows of the slip in the straight ramp
    return scales_.half_period_s * (1.0 - std::atan2(scales_.force, u) / std::numbers::pi + 0.3) +
           kForgotten * scales_.sensor_lag_s + 0.5 * scales_.sensor_average_s;
  }

  /// The level model to begin with: the polynomial that the middles justify, or one level a cycle.
  [[nodiscard]] LevelModel first_level() const {
    std::vector<double> middles;
    std::vector<double> drops;
    for (const CycleData& cycle : cycles_) {
      const DetectedSlip& slip = segmentation_.slips[cycle.slip];
      middles.push_back(0.5 * (slip.peak_force + slip.trough_force));
      drops.push_back(slip.drop());
    }
    const std::vector<double> times_s = middles_s(cycles_);
    const std::size_t terms = choose_level_terms(times_s, middles);
    const double left = unexplained_level(times_s, middles, drops, terms);
    const bool well_sampled = scales_.half_period_s > thresholds::kWellSampled * recording_.sample_interval_s();
    const bool wanders = well_sampled && left > thresholds::kWanderingShare * 2.0 * scales_.force &&
                         left > thresholds::kWanderingNoises * scales_.noise && cycles_.size() >= kProbeCycles;
    return {wanders, wanders ? 0 : terms, segmentation_.mains_Hz, near_.reloading};
  }

  [[nodiscard]] std::vector<double> middles_s(const std::vector<CycleData>& cycles) const {
    std::vector<double> values;
    values.reserve(cycles.size());
    for (const CycleData& cycle : cycles) values.push_back(segmentation_.slips[cycle.slip].middle_s);
    return values;
  }

  /// Finds level model and neighbourhood of the shared parameters on a few cycles.
  std::optional<BlockFit> fit_probe(const std::vector<CycleData>& probe, const LevelModel& level) {
    std::optional<BlockFit> fit = fit_from_starts(probe, level);
    if (!fit) return std::nullopt;
    start_ = fit->parameters.globals;
    // Damping is free before levels are compared: a level a cycle takes up what a wrong zeta does to the troughs.
    if (!std::isfinite(solve(*fit, {held_, false, true, kProbeIterations, kRough}))) return std::nullopt;
    const bool may_wander = near_.level_per_cycle || reduced_chi2(*fit) > thresholds::kSuspectChi2;
    if (!level.per_cycle && probe.size() > level.terms && may_wander) {
      const Globals globals = near_.globals.value_or(fit->parameters.globals);
      auto wandering = fit_from(probe, {true, 0, level.lines_Hz, level.reloading}, globals, kProbeIterations, kRough);
      if (wandering && explains_more(*wandering, *fit)) fit = std::move(wandering);
    }
    refuse_negative_damping(*fit, kRough);
    return fit;
  }

  [[nodiscard]] bool explains_more(const BlockFit& wandering, const BlockFit& polynomial) const {
    const Uncertainty rich = estimate_uncertainty(wandering, {held_, false});
    const Uncertainty poor = estimate_uncertainty(polynomial, {held_, false});
    const auto extra = static_cast<double>(wandering.size() - polynomial.level().terms);
    const double noise2 = std::pow(rich.noise / scales_.noise, 2);
    return (poor.chi2 - rich.chi2) / extra > thresholds::kWanderingRatio * noise2;
  }

  /// Where the search begins: several frequencies where the fall is hardly sampled or drawn out.
  [[nodiscard]] std::vector<Globals> starts() const {
    if (near_.globals) return {*near_.globals};
    std::vector<double> stretches{1.0};
    if (scales_.half_period_s < 6.0 * recording_.sample_interval_s()) stretches = {1.0, 1.6, 1.0 / 0.6};
    // Lag and averaging draw the fall out.
    const double smoothed_s = std::max(scales_.sensor_lag_s, 0.3 * scales_.sensor_average_s);
    if (smoothed_s > 0.05 * scales_.half_period_s) stretches = {1.0, 1.4, 2.0};
    const double zeta = held_values_.damping_ratio.value_or(0.05);
    std::vector<Globals> globals;
    for (const double stretch : stretches) {
      const double omega = held_values_.natural_frequency_rad_per_s.value_or(
          stretch * std::numbers::pi / (scales_.half_period_s * std::sqrt(1.0 - zeta * zeta)));
      globals.push_back({std::log(start_stiffness_), std::log(omega), zeta});
    }
    return globals;
  }

  /// Short runs with zeta held, the best of them.
  [[nodiscard]] std::optional<BlockFit> fit_from_starts(const std::vector<CycleData>& cycles,
                                                        const LevelModel& level) const {
    BlockFit fit(cycles, middles_s(cycles), scales_, level);
    SolveOptions quick{held_, false, true, kQuickIterations, kRough};
    quick.held[kDamping] = true;
    double best_cost = std::numeric_limits<double>::infinity();
    Parameters best;
    for (const Globals& start : starts()) {
      set_start(fit, segmentation_, start);
      const double cost = solve(fit, quick);
      if (cost >= best_cost) continue;
      best_cost = cost;
      best = fit.parameters;
      if (reduced_chi2(fit) < thresholds::kSuspectChi2) return fit;  // nothing left to find
    }
    if (!std::isfinite(best_cost)) return std::nullopt;
    fit.parameters = best;
    return fit;
  }

  [[nodiscard]] std::optional<BlockFit> fit_from(std::vector<CycleData> cycles, const LevelModel& level,
                                                 const Globals& globals, int max_iterations, double tolerance) const {
    std::vector<double> middles = middles_s(cycles);
    BlockFit fit(std::move(cycles), std::move(middles), scales_, level);
    set_start(fit, segmentation_, globals);
    if (!std::isfinite(solve(fit, {held_, false, true, max_iterations, tolerance}))) return std::nullopt;
    return fit;
  }

  /// A damping ratio clearly below 0 (jackknife where residuals are not white) means that slips are not shaped like the
  /// model's: zeta is held at 0 from here on, and called unidentified.
  void refuse_negative_damping(BlockFit& fit, double tolerance) {
    const double zeta = fit.parameters.globals[2];
    if (held_[kDamping] || !(zeta < 0.0) || reduced_chi2(fit) < thresholds::kSuspectChi2) return;
    const Uncertainty uncertainty = estimate_uncertainty(fit, {held_, false});
    const double se = std::sqrt(std::max(0.0, uncertainty.covariance(kDamping, kDamping)));
    if (!(zeta + thresholds::kNegativeSigmas * se < 0.0)) return;
    refused_damping_ = zeta;
    held_[kDamping] = true;
    // Start again from the features: the other parameters have followed the wrong zeta.
    set_start(fit, segmentation_, {start_[0], start_[1], 0.0});
    solve(fit, {held_, false, true, kMaxIterations, tolerance});
  }

  /// Leaves out samples far from the fit and slips that it cannot explain, takes mains hum into the model, and refits.
  /// Where there was much hum, again: the next residuals show its frequency and the outliers more clearly.
  std::optional<BlockFit> with_clean_data(BlockFit fit) {
    for (int pass = 0; pass < kCleanPasses; ++pass) {
      Residuals residuals = residuals_of(recording_, fit);
      const std::optional<StickRipple> ripple =
          find_stick_ripple(recording_, fit, residuals, tolerated_misfit(quality_));
      residuals = without(std::move(residuals), excluded_);
      const std::vector<std::size_t> outliers = find_outliers(residuals, scales_.noise);
      const std::vector<std::size_t> censored = beyond_clip(recording_, quality_, residuals, scales_.noise);
      const std::vector<std::size_t> bad = unexplained_slips(fit);
      const std::vector<double> lines_Hz = find_hum(recording_, fit, std::move(residuals.value), outliers, ripple);
      const bool is_clean = outliers.empty() && censored.empty() && bad.empty() && lines_Hz.empty();
      if (is_clean && (pass > 0 || near_.excluded.empty())) {
        if (pass == 0) solve(fit, {held_, false, true, kMaxIterations, kFinal});  // it was only rough so far
        return fit;
      }
      excluded_ = united(excluded_, united(outliers, censored));
      std::optional<BlockFit> next = refit(std::move(fit), bad, lines_Hz);
      if (!next) return std::nullopt;
      fit = std::move(*next);
      const double hum_power = 0.5 * std::pow(hum_amplitude(fit), 2);
      if (hum_power < thresholds::kBlurringHum * reduced_chi2(fit) * scales_.noise * scales_.noise) break;
    }
    return fit;
  }

  /// Weights depend on the model, the model on the weights: three rounds settle both to a percent of an error.
  [[nodiscard]] BlockFit with_clock_weights(BlockFit fit) const {
    for (int round = 0; round < 3; ++round) {
      std::vector<CycleData> cycles = weigh_by_slope(fit);
      std::vector<double> middles = middles_s(cycles);
      BlockFit weighted(std::move(cycles), std::move(middles), scales_, fit.level());
      weighted.parameters = fit.parameters;
      if (!std::isfinite(solve(weighted, {held_, false, true, kMaxIterations, kFinal}))) return fit;
      fit = std::move(weighted);
    }
    return fit;
  }

  /// Cuts again without the slips `bad`, with hum lines in the level, and fits from the present solution, whose cycles
  /// make room for the new ones.
  [[nodiscard]] std::optional<BlockFit> refit(BlockFit fit, const std::vector<std::size_t>& bad,
                                              const std::vector<double>& lines_Hz) const {
    const Parameters start = std::move(fit.parameters);
    LevelModel level = fit.level();
    std::vector<std::size_t> slips;
    for (std::size_t i = 0; i < fit.size(); ++i) slips.push_back(fit.data(i).slip);
    { const BlockFit released = std::move(fit); }
    std::vector<CycleData> kept;
    const HumLines hum{lines_Hz, scales_.time_begin_s};
    for (CycleData& cycle : cut_cycles(recording_, segmentation_, half_width_s(), excluded_, hum)) {
      if (std::find(bad.begin(), bad.end(), cycle.slip) == bad.end()) {
        kept.push_back(std::move(cycle));
      } else if (!kept.empty()) {
        kept.back().continuous_with_next = false;
      }
    }
    if (kept.size() < thresholds::kFewestFitted) return std::nullopt;
    level.lines_Hz = lines_Hz;
    std::vector<double> middles = middles_s(kept);
    BlockFit refit(std::move(kept), std::move(middles), scales_, level);
    refit.parameters.globals = start.globals;
    std::copy_n(start.level.begin(), level.terms, refit.parameters.level.begin());
    std::size_t old = 0;
    for (std::size_t i = 0; i < refit.size(); ++i) {
      while (old + 1 < slips.size() && slips[old] < refit.data(i).slip) ++old;  // a last slip may be new
      refit.parameters.cycles[i] = start.cycles[old];
    }
    if (!std::isfinite(solve(refit, {held_, false, true, kMaxIterations, kFinal}))) return std::nullopt;
    return refit;
  }

  const Recording& recording_;
  const Quality& quality_;
  const Segmentation& segmentation_;
  HeldParameters held_values_;
  const Near& near_;
  Held held_;
  double start_stiffness_ = 0.0;
  Globals start_{};
  std::optional<double> refused_damping_;
  Scales scales_;
  std::vector<std::size_t> excluded_;  // in ascending order
  std::vector<CycleData> cycles_;
};

}  // namespace

std::optional<DampedFit> draft_damped(const Recording& recording, const Quality& quality,
                                      const Segmentation& segmentation, const HeldParameters& held, const Near& near) {
  if (segmentation.slips.size() < thresholds::kFewestFitted) return std::nullopt;
  return Fitter(recording, quality, segmentation, held, near).fit();
}

std::optional<DampedFit> fit_damped(const Recording& recording, const Quality& quality,
                                    const Segmentation& segmentation, const HeldParameters& held) {
  std::optional<DampedFit> draft = draft_damped(recording, quality, segmentation, held);
  return draft ? finish_fit(recording, quality, segmentation, *std::move(draft)) : std::nullopt;
}

}  // namespace slipfit::fit
