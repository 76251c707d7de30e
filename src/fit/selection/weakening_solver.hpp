#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fit/selection/fit_input.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {

/// Fits of the law of friction that weakens over a slip distance (docs/model.md section 9) to the cycles that the
/// Coulomb fit of the same recording has.
class WeakeningSolver {
 public:
  /// A fit of some of the cycles.
  struct Draft {
    BlockFit blocks;
    double sum_of_squares = 0.0;
  };

  /// Where drafts of the shared parameters begin.
  struct Start {
    double log_omega = 0.0;              ///< ln w_n of slips under Coulomb friction: those that weaken last longer
    std::span<const double> weakenings;  ///< of k D_c / (F_s - F_k), of which the best one counts
    int most_iterations = 0;
  };

  static constexpr double kRoughTolerance = 1e-4;  ///< SolveOptions::tolerance: a tenth of an error decides nothing

  /// `half_width_s`: around the middle of a slip, that cycles are cut with.
  WeakeningSolver(const FitInput& input, const DampedFit& coulomb, double half_width_s);

  /// Cycles of the Coulomb fit, cut wider.
  [[nodiscard]] std::vector<CycleData> cycles() const;
  /// So many of the cycles, their slips with no more samples than their shape needs.
  [[nodiscard]] std::vector<CycleData> some_of(const std::vector<CycleData>& cycles, std::size_t count) const;
  /// Some that show what the law explains. Empty where all of them are not much more work.
  [[nodiscard]] std::vector<CycleData> enough_of(const std::vector<CycleData>& cycles) const;
  /// Rough, of the sensor's `average_s`. Empty where no start has a solution.
  [[nodiscard]] std::optional<Draft> draft(const std::vector<CycleData>& cycles, double average_s,
                                           const Start& start) const;
  /// A solution to `tolerance` with the average of `near`, free where it is free there, from its shared parameters on.
  /// Empty where a slip has none.
  [[nodiscard]] std::optional<BlockFit> solved(const std::vector<CycleData>& cycles, const BlockFit& near,
                                               double tolerance) const;
  /// Of all cycles, without the outliers of this law, with what finish_fit adds to the uncertainty. zeta is held at 0
  /// where it came out below.
  [[nodiscard]] std::optional<DampedFit> fit(const std::vector<CycleData>& cycles, const BlockFit& near) const;
  /// False where the best slip distance is none: waves and slips of Coulomb friction have a minimum at D_c = 0.
  [[nodiscard]] bool tells_distance(const BlockFit& blocks) const;

  [[nodiscard]] const Held& held() const { return held_; }

 private:
  /// Of the sensor.
  struct Averaging {
    double seconds = 0.0;
    FreeTime free = FreeTime::None;
  };
  static Averaging averaging_of(const BlockFit& fit) { return {fit.sensor().average_s, fit.scales().free_time}; }

  [[nodiscard]] std::vector<CycleData> cycles_without(const std::vector<std::size_t>& excluded) const;
  /// Empty where there are too few cycles to fit.
  [[nodiscard]] std::optional<BlockFit> blocks_of(const std::vector<CycleData>& cycles, Averaging average,
                                                  const LevelModel& level) const;
  /// With the rise after slips, where there is one, from the ends of the slips on, as the average shows it. Empty where
  /// there are too few cycles to fit.
  [[nodiscard]] std::optional<BlockFit> started(const std::vector<CycleData>& cycles, Averaging average,
                                                const Coordinates& start, const LevelModel& level) const;
  [[nodiscard]] DampedFit unfinished(BlockFit blocks, std::vector<std::size_t> excluded) const;
  [[nodiscard]] std::optional<DampedFit> without_outliers(BlockFit blocks) const;
  [[nodiscard]] std::optional<DampedFit> without_damping(DampedFit fit) const;

  const FitInput& input_;
  const DampedFit& coulomb_;
  Scales scales_;
  Held held_;
  double half_width_s_ = 0.0;
  HumLines hum_;  ///< of the Coulomb fit
};

}  // namespace slipfit::fit
