#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fit/coordinates.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/cycle_model.hpp"

namespace slipfit::fit {

/// A recording of a sweep that slides steadily: its mean force is F_k(V).
struct SteadyRun {
  double speed_m_per_s = 0.0;
  double load = 1.0;
  double mean_force = 0.0;
  double standard_error = 0.0;
};

/// Residual of a steady recording and its derivatives with respect to the coordinates and the shared level. `units` of
/// the sweep.
struct SteadyResidual {
  double value = 0.0;
  Coordinates by_value = Coordinates::Zero();
  double by_level = 0.0;
};
SteadyResidual steady_residual(const SteadyRun& run, const Units& units, FrictionLaw law, const Coordinates& values,
                               double level);

/// The parameters of a recording in a fit.
struct Parameters {
  /// Those of Columns::coordinates. F_s - F_k(0+) of a recording counts in Population::force.
  Coordinates values = Coordinates::Zero();
  std::vector<double> level;  ///< constant, where there is one, and drift; scaled by Scales::level_unit and force
  std::vector<Local> cycles;
};

/// Points to the parameters of one cycle, which has these of its own. All three must outlive what is returned.
inline CycleValues values_of(const Parameters& parameters, const Columns& columns, const Local& local) {
  const double* const level = parameters.level.data();
  return {&parameters.values, level, level + (columns.has_constant() ? 1 : 0), local.data()};
}

/// Holds a recording in a fit and its current solution. The cycles are blocks next to the shared parameters, as in a
/// bundle adjustment.
class BlockFit {
 public:
  BlockFit(std::shared_ptr<const CycleSet> set, const Scales& scales);
  /// Creates a fit with all parameters 0. It is empty where there are too few cycles to fit (CycleSet::create).
  static std::optional<BlockFit> create(std::vector<CycleData> cycles, std::vector<double> reference_s,
                                        const Scales& scales, LevelModel level);

  /// Returns a fit of the same cycles above another level, with all parameters 0.
  [[nodiscard]] BlockFit with_level(LevelModel level, const Scales& scales) const;

  /// Returns a fit of at most so many of the cycles, from the first to the last, at the same parameters. `most`: at
  /// least thresholds::kFewestSlips.
  [[nodiscard]] BlockFit with_fewer_cycles(std::size_t most) const;

  /// Rig and contact as in `start`; a rise after slips only where that has one.
  void start_at(const Coordinates& start);

  /// Returns a fit of the same cycles at the same parameters, on other scales. A time of the sensor that is free begins
  /// anew where these have another one.
  [[nodiscard]] BlockFit with_scales(const Scales& scales) const;

  /// Weighted sum of squares of one cycle's residuals at the solution; the part inside stick bins is not in it.
  [[nodiscard]] double cycle_sum_of_squares(std::size_t cycle) const;
  /// Returns this sum for every cycle, on all processors where there are many samples.
  [[nodiscard]] std::vector<double> sums_of_squares() const;

  /// Rows of residuals of all cycles together.
  [[nodiscard]] std::size_t residuals() const;

  [[nodiscard]] std::size_t size() const { return models_.size(); }
  [[nodiscard]] const CycleModel& model(std::size_t cycle) const { return models_[cycle]; }
  [[nodiscard]] const CycleData& data(std::size_t cycle) const { return set_->cycles()[cycle]; }
  [[nodiscard]] const std::shared_ptr<const CycleSet>& set() const { return set_; }
  [[nodiscard]] const Scales& scales() const { return scales_; }
  [[nodiscard]] const LevelModel& level() const { return set_->level(); }
  [[nodiscard]] double reference_s(std::size_t cycle) const { return set_->reference_s()[cycle]; }
  [[nodiscard]] const double* level_data() const { return parameters.level.data(); }
  /// Points to the coefficients of the cosine and sine of each line, over Scales::force; it is valid where there are
  /// lines.
  [[nodiscard]] const double* wave_data() const { return level_data() + model(0).first_wave(); }
  [[nodiscard]] CycleValues values(std::size_t cycle) const {
    return values_of(parameters, *columns_, parameters.cycles[cycle]);
  }
  [[nodiscard]] const Columns& columns() const { return *columns_; }
  [[nodiscard]] bool solves_for(Coordinate coordinate) const { return columns_->has(coordinate); }
  /// Returns the times of the sensor at the solution.
  [[nodiscard]] SensorTimes sensor() const { return sensor_of(scales_, parameters.values); }
  /// Returns the state of a cycle by a law in closed form, at a solution; friction that depends on the speed counts as
  /// if it did not.
  [[nodiscard]] CycleState state(std::size_t cycle) const;

  Parameters parameters;

 private:
  std::shared_ptr<const CycleSet> set_;
  Scales scales_;
  std::shared_ptr<const Columns> columns_;
  std::vector<CycleModel> models_;
};

/// Returns the sum of BlockFit::sums_of_squares.
double sum_of_squares(const BlockFit& fit);

/// Share of the slips that come to rest at the solution, under a law in closed form.
double resting_share(const BlockFit& fit);

/// Median time that a slip lasts.
double median_slip_s(const BlockFit& fit);

/// Returns the median time from the end of one slip to the onset of the next.
double median_stick_s(const BlockFit& fit);
/// Returns the median time from onset to onset; a cycle that could not be fitted makes one interval long.
double median_period_s(const BlockFit& fit);

/// States what the recordings of a sweep share besides the contact and the rig; otherwise each has its own.
struct Sharing {
  bool level = false;       ///< F_k(0+): no sensor zero or run-to-run friction between them
  bool difference = false;  ///< F_s - F_k(0+): static friction does not depend on the speed (no ageing)

  friend bool operator==(const Sharing&, const Sharing&) = default;
};

/// Holds what makes one problem of the recordings of a sweep. Steady ones enter where the level is shared.
struct SweepTerms {
  Sharing sharing{};
  std::span<const SteadyRun> steady{};
  Units units{};
};

/// The recordings of one sweep, or one recording, at a solution.
struct Problem {
  std::span<const BlockFit> recordings;
  SweepTerms sweep{};
};

}  // namespace slipfit::fit
