#include "fit/selection/term_fitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "core/thresholds.hpp"
#include "fit/cycle/start.hpp"
#include "fit/level/level_terms.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/damped_fit.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/outliers.hpp"
#include "fit/selection/rise.hpp"
#include "fit/selection/solution.hpp"
#include "fit/selection/tiers.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::fit {

namespace {

/// Takes the solution of other fits of the same slips, of a neighbour where one is not among them.
void carry_over(const BlockFit& from, BlockFit& to) {
  to.start_at(from.parameters.values);
  to.parameters.level = from.parameters.level;
  std::size_t same = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    while (same + 1 < from.size() && from.data(same).slip < to.data(i).slip) ++same;
    to.parameters.cycles[i] = from.parameters.cycles[same];
  }
}

}  // namespace

BlockFit carried_to(const std::shared_ptr<const CycleSet>& set, const BlockFit& from) {
  BlockFit to(set, from.scales());
  if (to.level() != from.level()) to = to.with_level(from.level(), from.scales());
  carry_over(from, to);
  to.parameters.values(kSensorTime) = from.parameters.values(kSensorTime);
  return with_rise_after(to);
}

BlockFit with_free_time(const BlockFit& fit, FreeTime time) {
  Scales scales = fit.scales();
  scales.free_time = time;
  return fit.with_scales(scales);
}

double gain_on_same_samples(const DampedFit& rich, const DampedFit& poor) {
  BlockFit again = carried_to(rich.blocks.set(), poor.blocks);
  if (!std::isfinite(solve(again, {poor.held, rich.continuous}))) return 0.0;
  // What scatters within the bins of the sticks is in neither sum.
  const double independent =
      effective_samples(rich) * static_cast<double>(rich.blocks.residuals()) / rich.uncertainty.samples;
  return independent * std::log(sum_of_squares(again) / sum_of_squares(rich.blocks)) - 2.0;
}

namespace {

/// W^2 / fall^2 to begin with: w_n W of 1, 2.4, 4 and 8. The sum of squares has several minima.
constexpr std::array kSharesOfFall{0.15, 0.5, 0.75, 0.92};
/// k D_c / (F_s - F_k) to begin with, alone and together with an average.
constexpr std::array kWeakenings{0.05, 0.2, 0.45, 0.75};
constexpr std::array kWeakeningsWithAverage{0.1, 0.45};
/// Length of the rise after slips, in that of the plain fit: behind an average it looks longer.
constexpr std::array kRiseLengths{1.0, 0.5};

constexpr int kRiseStarts = 6;
constexpr double kShortestRiseShare = 0.02;  // of a stick
constexpr double kSlip2 = 5.6;  // W^2 of an average that draws the fall out as much as the slip itself does
constexpr std::size_t kFewCycles = 16;
constexpr std::size_t kLeastEnough = 40;
constexpr std::size_t kMostEnough = 64;
constexpr int kOwnIterations = 6;    // of onsets, forces and levels alone
constexpr int kFirstIterations = 3;  // that show which start of an average is best
constexpr int kDraftIterations = 10;
constexpr int kCompareIterations = 20;
constexpr int kFullIterations = 60;
constexpr int kRiseSteps = 2;            // of a draft, each after the slips of the one before
constexpr double kDraftTolerance = 0.1;  // SolveOptions::tolerance
constexpr double kDescentTolerance = 1e-3;
constexpr double kComparedTolerance = 1e-4;  // sharper than a fit needs: differences of two sums are compared
constexpr double kFinalTolerance = 1e-3;
/// Steps gain little along the valley of D_c or W, zeta and w_n: what ends other fits leaves them an error off.
constexpr double kValleyTolerance = 1e-7;
constexpr double kSameAverage = 0.1;  // of ln W: two starts that led to one minimum
constexpr double kNoDistance = 0.1;   // of its error: a slip distance that is none

double residuals_of(const std::vector<CycleData>& cycles) {
  double residuals = 0.0;
  for (const CycleData& cycle : cycles) residuals += static_cast<double>(cycle.residuals());
  return residuals;
}

double squared_fall_s2(const BlockFit& plain) {
  const double average_s = plain.sensor().average_s;
  return average_s * average_s + kSlip2 * std::exp(-2.0 * plain.parameters.values(kLogFrequency));
}

/// Around the middles of slips seen through such an average. A slow onset begins before the slip of the plain fit.
double half_width_of(const BlockFit& plain, double average_s) {
  return 1.1 * median_slip_s(plain) + shown_beyond_s({plain.sensor().lag_s, average_s});
}

bool explains_more(const Minimum& a, const Minimum& b) {
  return a.minimised < b.minimised;
}

/// The fit, where some cycles are far from their samples with onsets and forces as they are typical of the others: the
/// onset before the middle of the slip, and the force over the drop. Empty where no cycle is far.
std::optional<BlockFit> with_typical_cycles(const BlockFit& fit, const Segmentation& segmentation) {
  constexpr double kFar = 4.0;  // times the median sum of squares
  const std::vector<double> sums = fit.sums_of_squares();
  const double most = kFar * signal::median(sums);
  if (std::ranges::none_of(sums, [&](double sum) { return sum > most; })) return std::nullopt;
  BlockFit typical = fit;
  const Scales& scales = fit.scales();
  const auto slip_of = [&](std::size_t i) -> const DetectedSlip& { return segmentation.slips[fit.data(i).slip]; };
  const auto middle_of = [&](std::size_t i) {
    return (slip_of(i).middle_s - fit.reference_s(i)) / scales.half_period_s;
  };
  std::vector<double> delays;
  std::vector<double> shares;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    delays.push_back(middle_of(i) - fit.parameters.cycles[i][0]);
    shares.push_back(scales.force * fit.parameters.cycles[i][1] / slip_of(i).drop());
  }
  const double delay = signal::median(delays);
  const double share = signal::median(shares);
  for (std::size_t i = 0; i < fit.size(); ++i) {
    if (!(sums[i] > most)) continue;
    typical.parameters.cycles[i][0] = middle_of(i) - delay;
    typical.parameters.cycles[i][1] = share * slip_of(i).drop() / scales.force;
  }
  return typical;
}

/// Onsets, forces and levels with rig and contact held; false where a slip has no solution. A search that leaves some
/// cycles far from their samples is repeated from what is typical of the others.
bool solve_own(BlockFit& blocks, const Segmentation& segmentation) {
  SolveOptions options{{}, false, kOwnIterations, kDraftTolerance};
  options.held.fill(true);
  const double sum = solve(blocks, options);
  if (!std::isfinite(sum)) return false;
  std::optional<BlockFit> again = with_typical_cycles(blocks, segmentation);
  if (again && solve(*again, options) < sum) blocks = *std::move(again);
  return true;
}

/// The solution from these parameters on. Empty where a slip has none.
std::optional<Minimum> solved_from(BlockFit blocks, const SolveOptions& options) {
  const double sum = solve(blocks, options);
  return std::isfinite(sum) ? std::optional(Minimum{std::move(blocks), sum}) : std::nullopt;
}

/// Solves to the accuracy that comparing terms needs. A rise after slips is moved to the slips of the solution. Empty
/// where a slip has no solution.
std::optional<Minimum> roughly_settled(BlockFit start, const Held& held, double tolerance) {
  const SolveOptions options{held, false, kCompareIterations, tolerance, true};
  std::optional<Minimum> minimum = solved_from(std::move(start), options);
  for (int i = 0; i < kRiseSteps && minimum && minimum->blocks.level().reloading; ++i) {
    minimum = solved_from(with_rise_after(minimum->blocks), options);
  }
  return minimum;
}

/// The solution but for its rise, which settle_rise settles.
std::optional<BlockFit> settled(BlockFit blocks, const Held& held) {
  const bool has_valley = blocks.scales().law == FrictionLaw::Weakening || blocks.solves_for(kSensorTime);
  std::optional<Minimum> minimum =
      solved_from(std::move(blocks), {held, false, kFullIterations, has_valley ? kValleyTolerance : kFinalTolerance});
  return minimum ? std::optional(std::move(minimum->blocks)) : std::nullopt;
}

/// The best zeta is clearly below 0, or below it where D_c leaves it open.
bool is_negative(const DampedFit& fit) {
  const double zeta = fit.blocks.parameters.values(kDamping);
  const double error = damping_error(fit);
  const bool is_open = fit.blocks.scales().law == FrictionLaw::Weakening && !(error < thresholds::kInformativeDamping);
  return !fit.held[kDamping] && zeta < (is_open ? 0.0 : -thresholds::kLikelySigmas * error);
}

}  // namespace

std::optional<TermFitter> TermFitter::create(const FitInput& input, const DampedFit& plain, double beyond_s) {
  TermFitter fitter(input, plain, beyond_s);
  return fitter.cycles_ ? std::optional(std::move(fitter)) : std::nullopt;
}

TermFitter::TermFitter(const FitInput& input, const DampedFit& plain, double beyond_s)
    : input_(input),
      plain_(plain),
      held_(held_of(input.held)),
      fall_s2_(squared_fall_s2(plain.blocks)),
      half_width_s_(half_width_of(plain.blocks, std::sqrt(fall_s2_)) + beyond_s),
      hum_(hum_of(input.recording, plain.blocks)),
      cycles_(set_of(cycles_without(plain.excluded, half_width_s_))) {
  if (!cycles_) return;
  const std::vector<CycleData>& all = cycles_->cycles();
  few_ = set_of(some_of(all, kFewCycles));
  std::vector<CycleData> enough = some_of(all, std::clamp(all.size() / 3, kLeastEnough, kMostEnough));
  enough_ = 2.0 * residuals_of(enough) < residuals_of(all) ? set_of(std::move(enough)) : cycles_;
}

Minima TermFitter::minima(Terms terms, bool is_asked) const {
  std::vector<Minimum> drafts = drafts_of(terms);
  for (Minimum& draft : drafts) draft = descended(std::move(draft));
  std::sort(drafts.begin(), drafts.end(), explains_more);
  const auto is_another = [&](const Minimum& draft) {
    const double ratio = draft.blocks.sensor().average_s / drafts.front().blocks.sensor().average_s;
    const bool is_elsewhere = terms.average && std::abs(std::log(ratio)) > kSameAverage;
    return is_elsewhere && gain_on(*few_, drafts.front(), draft) < kRuledOut;
  };
  Minima minima;
  const auto shows_term = [&](const BlockFit& fit) {
    const bool has_slips = is_asked || has_slips_of_its_own(fit);
    minima.is_complete &= has_slips;
    return has_slips && (is_asked || has_term(fit));
  };
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    if (i > 0 && !is_another(drafts[i])) continue;
    if (shows_term(drafts[i].blocks)) {
      std::optional<Minimum> some = near(drafts[i].blocks);
      minima.is_complete &= some.has_value();
      if (some && shows_term(some->blocks)) minima.found.push_back(*std::move(some));
    }
    if (i > 0) break;
  }
  std::sort(minima.found.begin(), minima.found.end(), explains_more);
  return minima;
}

Minimum TermFitter::plain() const {
  BlockFit some = carried_to(enough_, plain_.blocks);
  const double sum = solve(some, {plain_.held, false, kCompareIterations, kComparedTolerance});
  return {std::move(some), sum};
}

std::optional<Minimum> TermFitter::near(const BlockFit& fit) const {
  return solved(enough_, fit);
}

std::optional<Minimum> TermFitter::behind_filter(const BlockFit& from, std::span<const FilterStart> starts) const {
  Scales scales = scales_of({}, input_.recording.conditions().sensor_average_s.value_or(0.0));
  scales.free_time = FreeTime::Lag;
  std::optional<Minimum> best;
  for (const FilterStart& start : starts) {
    scales.sensor_order = start.order;
    scales.sensor_lag_s = start.lag_s;
    BlockFit blocks = started(BlockFit(few_, scales), from.parameters.values);
    if (!solve_own(blocks, input_.segmentation)) continue;
    std::optional<Minimum> draft =
        solved_from(std::move(blocks), {held_, false, kDraftIterations, kDraftTolerance, true});
    if (draft && (!best || explains_more(*draft, *best))) best = std::move(draft);
  }
  if (best) best = roughly_settled(std::move(best->blocks), held_, kDescentTolerance);
  return best ? near(best->blocks) : std::nullopt;
}

double TermFitter::gain_on_some(const Minimum& better, const Minimum& other) const {
  return gain_on(*enough_, better, other);
}

double TermFitter::gain_on_all(const Minimum& better, const Minimum& other) const {
  return gain_on(*cycles_, better, other);
}

/// Neither sum contains the scatter within the bins of the sticks.
double TermFitter::gain_on(const CycleSet& cycles, const Minimum& better, const Minimum& other) const {
  const double independent = effective_samples(plain_) * residuals_of(cycles.cycles()) / plain_.uncertainty.samples;
  return independent * std::log(sum_of_squares(other.blocks) / sum_of_squares(better.blocks));
}

DampedFit TermFitter::rival_of(const Minimum& minimum) const {
  DampedFit rival{minimum.blocks, false, held_, std::nullopt, half_width_s_, plain_.excluded};
  rival.uncertainty = estimate_uncertainty(rival.blocks, {held_, false});
  rival.uncertainty.covariance *= residuals_of(enough_->cycles()) / residuals_of(cycles_->cycles());
  return with_average_error(std::move(rival));
}

std::optional<DampedFit> TermFitter::draft(const BlockFit& near) const {
  std::optional<Minimum> rough = solved(thin_of(*cycles_), near);
  if (!rough) return std::nullopt;
  const bool wanders = rough->blocks.level().per_cycle;
  std::optional<DampedFit> fit =
      without_outliers(wanders ? with_poorest_level(std::move(rough->blocks)) : std::move(rough->blocks));
  return fit ? settle_rise(input_, with_uncertainty(*std::move(fit), input_.quality)) : std::nullopt;
}

std::optional<DampedFit> TermFitter::fit(const BlockFit& near) const {
  std::optional<DampedFit> fit = draft(near);
  if (fit) fit = finish_fit(input_, *std::move(fit));
  return fit && is_negative(*fit) ? without_damping(*std::move(fit)) : std::move(fit);
}

std::vector<CycleData> TermFitter::cycles_without(const std::vector<std::size_t>& excluded, double half_width_s) const {
  return same_cycles_of(plain_.blocks, cut_cycles(input_.recording, input_.segmentation, half_width_s, excluded, hum_));
}

std::vector<CycleData> TermFitter::some_of(const std::vector<CycleData>& cycles, std::size_t count) const {
  std::vector<CycleData> some = spread_subset(cycles, count);
  const double half_period_s = plain_.blocks.scales().half_period_s;
  for (CycleData& cycle : some) {
    const double middle_s = input_.segmentation.slips[cycle.slip].middle_s;
    cycle = thinned(std::move(cycle), middle_s, half_period_s, input_.recording.sample_interval_s());
  }
  return some;
}

TermFitter::Cycles TermFitter::set_of(std::vector<CycleData> cycles) const {
  std::vector<double> middles = middles_s(input_.segmentation, cycles);
  std::optional<CycleSet> set =
      CycleSet::create(std::move(cycles), std::move(middles), plain_.blocks.level(), plain_.blocks.scales());
  return set ? std::make_shared<const CycleSet>(*std::move(set)) : nullptr;
}

TermFitter::Cycles TermFitter::thin_of(const CycleSet& cycles) const {
  return set_of(some_of(cycles.cycles(), cycles.cycles().size()));
}

std::optional<BlockFit> TermFitter::settled_on(const Cycles& cycles, const BlockFit& near, const Held& held) const {
  const std::optional<BlockFit> thin = settled(carried_to(thin_of(*cycles), near), held);
  return settled(carried_to(cycles, thin ? *thin : near), held);
}

BlockFit TermFitter::started(BlockFit blocks, const Coordinates& values) const {
  set_start(blocks, input_.segmentation, values);
  return with_rise_after(blocks);
}

Scales TermFitter::scales_of(Terms terms, double average_s) const {
  Scales scales = plain_.blocks.scales();
  scales.law = terms.weakening ? FrictionLaw::Weakening : FrictionLaw::Coulomb;
  scales.slip_distance_m = scales.force / std::exp(plain_.blocks.parameters.values(kLogStiffness));
  scales.free_time = FreeTime::None;
  scales.sensor_average_s = average_s;
  return scales;
}

std::vector<TermFitter::Start> TermFitter::starts_of(Terms terms) const {
  std::vector<Start> starts;
  const double stated_s = input_.recording.conditions().sensor_average_s.value_or(0.0);
  const double stated_share = stated_s * stated_s / fall_s2_;
  if (terms.rise) {
    for (const double length_m : lengths_of_rise()) starts.push_back({stated_share, 0.0, length_m});
    return starts;
  }
  if (!terms.average) {
    for (const double weakening : kWeakenings) starts.push_back({stated_share, weakening});
    return starts;
  }
  std::vector<double> shares(kSharesOfFall.begin(), kSharesOfFall.end());
  if (plain_.average) shares.push_back(std::pow(plain_.average->seconds, 2) / fall_s2_);
  for (const double share : shares) {
    if (!terms.weakening) {
      starts.push_back({share, 0.0});
      continue;
    }
    for (const double weakening : kWeakeningsWithAverage) starts.push_back({share, weakening});
  }
  return starts;
}

/// Returns starting lengths from the shortest that the clock resolves to the longest, in m.
std::vector<double> TermFitter::lengths_of_rise() const {
  const double speed = plain_.blocks.scales().speed_m_per_s;
  const double stick_m = speed * median_stick_s(plain_.blocks);
  const double shortest_m = std::max(2.0 * speed * input_.recording.sample_interval_s(), kShortestRiseShare * stick_m);
  const double longest_m = kLongestRise * stick_m;
  std::vector<double> lengths;
  if (!(longest_m > shortest_m)) return lengths;
  for (int i = 0; i < kRiseStarts; ++i) {
    lengths.push_back(shortest_m * std::pow(longest_m / shortest_m, static_cast<double>(i) / (kRiseStarts - 1)));
  }
  return lengths;
}

std::optional<Minimum> TermFitter::begun(Terms terms, const Start& start, double rise_length) const {
  Coordinates near = plain_.blocks.parameters.values;
  // The slower onset makes a slip longer: so much slower is w_n without it.
  if (!held_[kLogFrequency]) {
    near(kLogFrequency) =
        0.5 * std::log(kSlip2 / ((1.0 - start.share_of_fall) * fall_s2_)) + std::log1p(0.6 * start.weakening);
  }
  if (!held_[kDamping]) near(kDamping) = 0.05;
  near(kSlipDistance) = std::sqrt(start.weakening);
  BlockFit blocks = started(BlockFit(few_, scales_of(terms, std::sqrt(start.share_of_fall * fall_s2_))), near);
  blocks.parameters.values(kReloadLength) += std::log(rise_length);
  if (terms.rise) blocks = with_rise_over(start.length_m, input_, plain_.blocks, blocks);
  if (!solve_own(blocks, input_.segmentation)) return std::nullopt;
  return solved_from(std::move(blocks), {held_, false, kFirstIterations, kDraftTolerance, true});
}

std::optional<Minimum> TermFitter::drafted(Terms terms, Minimum begun) const {
  const SolveOptions options{held_, false, kDraftIterations, kDraftTolerance, true};
  auto& [blocks, sum] = begun;
  sum = solve(blocks, options);
  for (int i = 0; i < kRiseSteps && plain_.blocks.level().reloading && std::isfinite(sum); ++i) {
    blocks = with_rise_after(blocks);
    sum = solve(blocks, options);
  }
  if (!std::isfinite(sum) || !rises(blocks)) return std::nullopt;
  if (terms.average) blocks = with_free_time(blocks, FreeTime::Average);
  if (terms.rise) blocks = with_free_rise(blocks);
  return begun;
}

std::vector<Minimum> TermFitter::drafts_of(Terms terms) const {
  const std::span<const double> rise_lengths(kRiseLengths.data(),
                                             plain_.blocks.level().reloading ? kRiseLengths.size() : 1);
  const std::vector<Start> starts = starts_of(terms);
  std::vector<Minimum> drafts;
  for (auto next = starts.begin(); next != starts.end();) {
    const double share = next->share_of_fall;
    std::optional<Minimum> best;
    for (; next != starts.end() && next->share_of_fall == share; ++next) {
      for (const double rise_length : rise_lengths) {
        std::optional<Minimum> one = begun(terms, *next, rise_length);
        if (one && (!best || explains_more(*one, *best))) best = std::move(one);
      }
    }
    if (best) best = drafted(terms, *std::move(best));
    if (best) drafts.push_back(*std::move(best));
  }
  std::sort(drafts.begin(), drafts.end(), explains_more);
  return drafts;
}

Minimum TermFitter::descended(Minimum draft) const {
  std::optional<Minimum> lower = roughly_settled(draft.blocks, held_, kDescentTolerance);
  return lower && explains_more(*lower, draft) ? *std::move(lower) : std::move(draft);
}

std::optional<Minimum> TermFitter::solved(const Cycles& cycles, const BlockFit& near) const {
  if (cycles->cycles().size() == near.size()) {
    return roughly_settled(carried_to(cycles, near), held_, kComparedTolerance);
  }
  Scales scales = near.scales();
  scales.sensor_average_s = near.sensor().average_s;
  scales.sensor_lag_s = near.sensor().lag_s;
  BlockFit blocks = started(BlockFit(cycles, scales).with_level(near.level(), scales), near.parameters.values);
  blocks.parameters.level = near.parameters.level;
  if (!solve_own(blocks, input_.segmentation)) return std::nullopt;
  return roughly_settled(std::move(blocks), held_, kComparedTolerance);
}

bool TermFitter::has_slips_of_its_own(const BlockFit& fit) const {
  return resting_share(fit) >= thresholds::kRestickShare &&
         fit.sensor().average_s + median_slip_s(fit) < median_period_s(plain_.blocks);
}

/// Waves and slips of Coulomb friction have a minimum at D_c = 0, and an average within a step of the clock cannot be
/// distinguished from none.
bool TermFitter::has_term(const BlockFit& fit) const {
  const bool is_averaged =
      fit.scales().free_time != FreeTime::Average || fit.sensor().average_s >= input_.recording.sample_interval_s();
  if (fit.scales().law != FrictionLaw::Weakening || !is_averaged) return is_averaged;
  DampedFit some{fit, false, held_};
  some.uncertainty = estimate_uncertainty(fit, {held_, false});
  return sigmas_of_distance(some) > kNoDistance;
}

/// A level of its own in every cycle may be what the plain fit misses of the slips: a polynomial in its place where it
/// explains as much.
BlockFit TermFitter::with_poorest_level(BlockFit wandering) const {
  const Scales& scales = wandering.scales();
  LevelModel level = first_level(input_.recording, input_.segmentation, cycles_->cycles(), scales);
  if (level.per_cycle) return wandering;
  level.lines_Hz = wandering.level().lines_Hz;
  level.reloading = wandering.level().reloading;
  BlockFit polynomial = started(wandering.with_level(std::move(level), scales), wandering.parameters.values);
  polynomial.parameters.values = wandering.parameters.values;
  std::optional<Minimum> settled = roughly_settled(std::move(polynomial), held_, kComparedTolerance);
  const bool is_enough = settled && !level_wanders(wandering, settled->blocks);
  return is_enough ? std::move(settled->blocks) : std::move(wandering);
}

/// The outliers are those of the model of `rough`: those of the plain fit may be what its model misses. Empty where
/// they leave too few cycles.
std::optional<DampedFit> TermFitter::without_outliers(const BlockFit& rough) const {
  const std::vector<std::size_t> initial = initial_exclusions(input_.recording, input_.quality);
  const Residuals residuals = without(fit::residuals_of(input_.recording, rough), initial);
  const double noise = rough.scales().noise;
  const std::vector<std::size_t> outliers = find_outliers(residuals, noise);
  const std::vector<std::size_t> censored = beyond_clip(input_.recording, input_.quality, residuals, noise);
  std::vector<std::size_t> excluded = united(initial, united(outliers, censored));
  // No wider than they need: what bends is seen in the sticks.
  const bool is_averaged = rough.solves_for(kSensorTime);
  const double half_width_s = is_averaged ? half_width_s_ : half_width_of(plain_.blocks, rough.sensor().average_s);
  const Cycles clean = set_of(cycles_without(excluded, half_width_s));
  if (!clean) return std::nullopt;
  std::optional<BlockFit> blocks = settled_on(clean, rough, held_);
  if (!blocks) return std::nullopt;
  return DampedFit{*std::move(blocks), false, held_, std::nullopt, half_width_s, std::move(excluded)};
}

/// zeta is held at 0, and called unknown, as it is without the terms.
std::optional<DampedFit> TermFitter::without_damping(DampedFit fit) const {
  fit.refused_damping = fit.blocks.parameters.values(kDamping);
  fit.held[kDamping] = true;
  fit.blocks.parameters.values(kDamping) = 0.0;
  std::optional<BlockFit> blocks = settled_on(fit.blocks.set(), fit.blocks, fit.held);
  if (!blocks) return std::nullopt;
  fit.blocks = *std::move(blocks);
  return finish_settled(input_, std::move(fit));
}

}  // namespace slipfit::fit
