#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/carried_fit.hpp"
#include "fit/selection/fitted_average.hpp"
#include "fit/selection/weakening_fitter.hpp"

namespace slipfit::fit {
namespace {

using Draft = WeakeningSolver::Draft;

/// T_b^2 over what slip and average together draw the fall out by, to begin with: W = w_n T_b of 1, 2.4, 4 and 8.
constexpr std::array kSharesOfFall{0.15, 0.5, 0.75, 0.92};
/// k D_c / (F_s - F_k) beside each of them, and beside the best of them.
constexpr std::array kBesideEach{0.1};
constexpr std::array kBesideBest{0.45};
constexpr std::size_t kBest = 2;
constexpr double kSlip2 = 5.6;  // W^2 of an average that draws the fall out as much as the slip itself does
constexpr std::size_t kDraftCycles = 16;
constexpr int kDraftIterations = 10;
constexpr std::size_t kDescents = 3;  // of the starts
constexpr int kDescentIterations = 20;
constexpr double kSameAverage = 0.1;  // of ln T_b: two starts that led to one minimum
constexpr double kRuledOut = 60.0;    // of AICc by all samples: few of the cycles tell less

bool explains_more(const Draft& a, const Draft& b) {
  return a.sum_of_squares < b.sum_of_squares;
}

/// What slip and average together draw the fall out by, T_b^2 + kSlip2 / w_n^2.
double squared_fall_s2(const DampedFit& coulomb) {
  const double average_s = coulomb.blocks.sensor().average_s;
  return average_s * average_s + kSlip2 * std::exp(-2.0 * coulomb.blocks.parameters.values(kLogFrequency));
}

class AveragedWeakening {
 public:
  AveragedWeakening(const FitInput& input, const DampedFit& coulomb)
      : input_(input),
        coulomb_(coulomb),
        fall_s2_(squared_fall_s2(coulomb)),
        solver_(input, coulomb, 1.1 * median_slip_s(coulomb.blocks) + 0.5 * std::sqrt(fall_s2_)) {}

  [[nodiscard]] AveragedWeakenings minima() const {
    AveragedWeakenings found;
    const std::vector<CycleData> cycles = solver_.cycles();
    const std::vector<CycleData> enough = solver_.enough_of(cycles);
    for (const Draft& draft : minima_of(solver_.some_of(cycles, kDraftCycles))) {
      const Start start = enough.empty() ? Start{draft.blocks, false} : refined(draft.blocks, enough);
      std::optional<DampedFit> fit;
      if (start.blocks) fit = solver_.fit(cycles, *start.blocks);
      if (fit && !has_no_average(fit->blocks)) {
        found.fits.push_back(with_average_error(*std::move(fit)));
      } else if (!start.is_simpler) {
        found.is_complete = false;
      }
    }
    return found;
  }

 private:
  /// Where a fit of all cycles begins, if it does.
  struct Start {
    std::optional<BlockFit> blocks{};
    bool is_simpler = false;  ///< the best slip distance, or average, is none, and so a simpler fit the same one
  };

  /// Of more cycles.
  [[nodiscard]] Start refined(const BlockFit& draft, const std::vector<CycleData>& enough) const {
    std::optional<BlockFit> some = solver_.solved(enough, draft, WeakeningSolver::kRoughTolerance);
    if (!some || !has_slips_of_its_own(*some)) return {};
    if (!solver_.tells_distance(*some) || has_no_average(*some)) return {std::nullopt, true};
    return {*std::move(some)};
  }

  /// They come to rest, and the average is shorter than a stick.
  [[nodiscard]] bool has_slips_of_its_own(const BlockFit& fit) const {
    if (resting_share(fit) < thresholds::kFewRest) return false;
    return fit.sensor().average_s + median_slip_s(fit) < median_period_s(coulomb_.blocks);
  }

  /// Of some of the cycles, from averages that take from little to nearly all of the fall.
  [[nodiscard]] std::vector<Draft> drafts_of(const std::vector<CycleData>& some) const {
    std::vector<double> shares(kSharesOfFall.begin(), kSharesOfFall.end());
    if (coulomb_.average) shares.push_back(std::pow(coulomb_.average->seconds, 2) / fall_s2_);
    std::vector<Draft> drafts;
    for (const double share : shares) {
      std::optional<Draft> draft = draft_of(some, share, kBesideEach);
      if (draft) drafts.push_back(*std::move(draft));
    }
    std::sort(drafts.begin(), drafts.end(), explains_more);
    for (std::size_t i = 0; i < std::min(kBest, drafts.size()); ++i) {
      const double average_s = drafts[i].blocks.sensor().average_s;
      std::optional<Draft> draft = draft_of(some, average_s * average_s / fall_s2_, kBesideBest);
      if (draft && explains_more(*draft, drafts[i])) drafts[i] = *std::move(draft);
    }
    std::sort(drafts.begin(), drafts.end(), explains_more);
    return drafts;
  }

  /// Beside an average that takes this share of the fall.
  [[nodiscard]] std::optional<Draft> draft_of(const std::vector<CycleData>& some, double share,
                                              std::span<const double> weakenings) const {
    const double log_omega = 0.5 * std::log(kSlip2 / ((1.0 - share) * fall_s2_));
    return solver_.draft(some, std::sqrt(share * fall_s2_), {log_omega, weakenings, kDraftIterations});
  }

  /// The best minimum of some of the cycles, and the next one where they do not rule it out.
  [[nodiscard]] std::vector<Draft> minima_of(const std::vector<CycleData>& some) const {
    std::vector<Draft> drafts = drafts_of(some);
    if (drafts.empty()) return drafts;
    drafts.erase(drafts.begin() + static_cast<std::ptrdiff_t>(std::min(drafts.size(), kDescents)), drafts.end());
    for (Draft& draft : drafts) draft = descended(std::move(draft));
    std::sort(drafts.begin(), drafts.end(), explains_more);
    const auto next = std::find_if(drafts.begin() + 1, drafts.end(),
                                   [&](const Draft& draft) { return is_another(draft, drafts.front()); });
    std::vector<Draft> minima{drafts.front()};
    if (next != drafts.end()) minima.push_back(*next);
    return minima;
  }

  [[nodiscard]] bool is_another(const Draft& draft, const Draft& best) const {
    const double ratio = draft.blocks.sensor().average_s / best.blocks.sensor().average_s;
    const double behind = effective_samples(coulomb_) * std::log(draft.sum_of_squares / best.sum_of_squares);
    return std::abs(std::log(ratio)) > kSameAverage && behind < kRuledOut;
  }

  /// Averages within a step of the clock cannot be told from none.
  [[nodiscard]] bool has_no_average(const BlockFit& blocks) const {
    return blocks.sensor().average_s < input_.recording.sample_interval_s();
  }

  /// With the average free.
  [[nodiscard]] Draft descended(Draft draft) const {
    draft.blocks = with_free_time(draft.blocks, FreeTime::Average);
    BlockFit blocks = draft.blocks;
    if (!std::isfinite(solve(blocks, {solver_.held(), false, true, kDescentIterations})) || !has_slips(blocks)) {
      return draft;
    }
    const double sum = sum_of_squares(blocks);
    return sum < draft.sum_of_squares ? Draft{std::move(blocks), sum} : std::move(draft);
  }

  const FitInput& input_;
  const DampedFit& coulomb_;
  double fall_s2_;
  WeakeningSolver solver_;
};

}  // namespace

AveragedWeakenings fit_averaged_weakening(const FitInput& input, const DampedFit& coulomb) {
  return AveragedWeakening(input, coulomb).minima();
}

}  // namespace slipfit::fit
