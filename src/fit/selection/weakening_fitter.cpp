#include "fit/selection/weakening_fitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/selection/carried_fit.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kTrialCycles = 16;
constexpr double kHopeful = 1.1 * thresholds::kHalvedStack;
constexpr int kTrialIterations = 40;

/// k D_c / (F_s - F_k) to begin with: the sum of squares has several minima.
constexpr std::array kStarts{0.05, 0.2, 0.45, 0.75};

class WeakeningTest {
 public:
  WeakeningTest(const WeakeningSolver& solver, const DampedFit& coulomb, double missed)
      : solver_(solver), coulomb_(coulomb), missed_(missed) {}

  /// False where some of the cycles show that the law will not be taken.
  [[nodiscard]] bool promises(const std::vector<CycleData>& cycles, const BlockFit& near) const {
    const std::vector<CycleData> some = solver_.enough_of(cycles);
    if (some.empty()) return true;
    const std::optional<BlockFit> blocks = solver_.solved(some, near, WeakeningSolver::kRoughTolerance);
    if (!blocks || is_beaten(*blocks) || resting_share(*blocks) < thresholds::kFewRest) return false;
    // In place of an average it need not explain more.
    return coulomb_.average || (explains_enough(*blocks) && solver_.tells_distance(*blocks));
  }

 private:
  /// The Coulomb fit explains these cycles better, beyond chance.
  [[nodiscard]] bool is_beaten(const BlockFit& some) const {
    BlockFit coulomb(some.set(), coulomb_.blocks.scales());
    carry_over(coulomb_.blocks, coulomb);
    const double independent = effective_samples(coulomb_) / coulomb_.uncertainty.samples;
    const double gain = std::log(sum_of_squares(coulomb) / sum_of_squares(some));
    return independent * static_cast<double>(residuals_in(some)) * gain < -thresholds::kTierPrice;
  }

  /// It may miss so much less of the mean shape of a slip that it is taken.
  [[nodiscard]] bool explains_enough(const BlockFit& some) const {
    const StackedResidual after = stacked_residual(some, coulomb_.blocks);
    return after.size * after.size - after.by_chance * after.by_chance < std::pow(kHopeful * missed_, 2);
  }

  const WeakeningSolver& solver_;
  const DampedFit& coulomb_;
  double missed_;
};

}  // namespace

std::optional<DampedFit> fit_weakening(const FitInput& input, const DampedFit& coulomb, std::optional<double> missed) {
  const std::optional<double> stated_s = input.recording.conditions().sensor_average_s;
  const double average_s = stated_s.value_or(0.0);
  // A slow onset begins before the slip of the Coulomb fit.
  const WeakeningSolver solver(input, coulomb,
                               1.1 * median_slip_s(coulomb.blocks) + shown_beyond_s(coulomb.blocks.sensor()));
  const std::vector<CycleData> cycles = solver.cycles();
  const std::optional<WeakeningSolver::Draft> draft =
      solver.draft(solver.some_of(cycles, kTrialCycles), average_s,
                   {coulomb.blocks.parameters.values(kLogFrequency), kStarts, kTrialIterations});
  if (!draft) return std::nullopt;
  const bool may_be_left = missed && !WeakeningTest(solver, coulomb, *missed).promises(cycles, draft->blocks);
  if (may_be_left) return std::nullopt;
  std::optional<DampedFit> fit = solver.fit(cycles, draft->blocks);
  if (fit && !stated_s) {
    fit->rounding = estimate_smoothing(fit->blocks, fit->held, input.recording.sample_interval_s());
  }
  return fit;
}

}  // namespace slipfit::fit
