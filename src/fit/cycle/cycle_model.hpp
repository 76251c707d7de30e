#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "fit/coordinates.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/law/coulomb.hpp"
#include "fit/law/relaxing.hpp"
#include "fit/law/slip_weakening.hpp"
#include "fit/level/level_model.hpp"

namespace slipfit::fit {

/// The columns of the Jacobian of a recording's cycles: the coordinates that the fit solves for, in the order of
/// Coordinate, then the level's constant, where there is one, the level's other functions, and the cycle's own.
class Columns {
 public:
  Columns(const Scales& scales, const LevelModel& level);

  [[nodiscard]] const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  /// Returns whether the fit solves for the coordinate.
  [[nodiscard]] bool has(Coordinate coordinate) const { return column_[index(coordinate)].has_value(); }
  [[nodiscard]] std::optional<std::size_t> find(Coordinate coordinate) const { return column_[index(coordinate)]; }
  [[nodiscard]] bool has_constant() const { return has_constant_; }
  /// Returns the number of the level's functions besides the constant.
  [[nodiscard]] std::size_t drift() const { return drift_; }
  [[nodiscard]] std::size_t own() const { return own_; }
  /// Returns the number of columns that cycles have in common; they come first.
  [[nodiscard]] std::size_t common() const { return first_drift() + drift_; }
  [[nodiscard]] std::size_t size() const { return common() + own_; }
  [[nodiscard]] std::size_t first_drift() const { return coordinates_.size() + (has_constant_ ? 1 : 0); }

 private:
  static std::size_t index(Coordinate coordinate) { return static_cast<std::size_t>(coordinate); }

  std::vector<Coordinate> coordinates_;
  std::array<std::optional<std::size_t>, kCoordinates> column_{};
  bool has_constant_ = false;
  std::size_t drift_ = 0;
  std::size_t own_ = 0;
};

/// The times of the sensor, of which one may be a parameter.
SensorTimes sensor_of(const Scales& scales, const Coordinates& values);

/// Values of the Legendre polynomials P_0 ... P_(terms-1) at x.
void legendre(double x, std::size_t terms, double* values);

/// The residual rows of a cycle: its samples around the slip, then mean and slope of each stick bin.
struct CycleRows {
  Eigen::ArrayXd force;         ///< measured; per second in rows of slopes
  Eigen::ArrayXd weight;        ///< of the residuals, times the noise
  Eigen::ArrayXd level_weight;  ///< of the level's constant, which does not enter slopes: 0 there, else as `weight`
  Eigen::ArrayXXd level;  ///< the level's functions but for the constant, a column each (slopes in rows of slopes)
};

/// Returns the rows of a cycle without the level's functions.
CycleRows rows_of(const CycleData& cycle);

/// The cycles of a recording as fits use them, at least thresholds::kFewestSlips, with the level's functions at all
/// their rows. Never changed, and so shared by all fits of the recording.
class CycleSet {
 public:
  /// `reference_s`: time of each cycle from which its onset counts. `scales` give the interval on which the polynomial
  /// lives. Empty where there are too few cycles to fit.
  static std::optional<CycleSet> create(std::vector<CycleData> cycles, std::vector<double> reference_s,
                                        LevelModel level, const Scales& scales);

  /// Returns the same cycles above another level.
  [[nodiscard]] CycleSet with_level(LevelModel level, const Scales& scales) const;

  [[nodiscard]] const std::vector<CycleData>& cycles() const { return cycles_; }
  [[nodiscard]] const std::vector<double>& reference_s() const { return reference_s_; }
  [[nodiscard]] const LevelModel& level() const { return level_; }
  [[nodiscard]] const CycleRows& rows(std::size_t cycle) const { return rows_[cycle]; }
  /// Step of the cycle's samples around the slip, of which some may be missing; 0 on an uneven clock.
  [[nodiscard]] double even_step_s(std::size_t cycle) const { return even_step_s_[cycle]; }

 private:
  CycleSet(std::vector<CycleData> cycles, std::vector<double> reference_s, LevelModel level, const Scales& scales);

  std::vector<CycleData> cycles_;
  std::vector<double> reference_s_;
  LevelModel level_;
  std::vector<CycleRows> rows_;
  std::vector<double> even_step_s_;
};

/// A cycle's own numbers, scaled: onset time (from its reference, in half periods), force at onset above the level and,
/// where the level is per cycle, the level. The last is not used otherwise.
using Local = std::array<double, 3>;

/// Points to the parameters of a cycle's residuals.
struct CycleValues {
  const Coordinates* shared = nullptr;  ///< those of Columns::coordinates are read
  /// The level's constant; not read where it has none: a level per cycle outside a sweep. In a sweep a level per cycle
  /// follows this one.
  const double* constant = nullptr;
  const double* drift = nullptr;  ///< coefficients of the level's other functions
  const double* local = nullptr;
};

/// Holds the physical numbers of one cycle that do not depend on the friction law.
struct CycleFrame {
  double stiffness_N_per_m = 0.0;
  double omega_rad_per_s = 0.0;
  double zeta = 0.0;
  double force_scale = 0.0;  ///< u = k V / w_n
  double onset_s = 0.0;
  double onset_force = 0.0;  ///< above the level, A

  [[nodiscard]] double z0() const { return onset_force / force_scale; }
  [[nodiscard]] double tau_at(double time_s) const { return omega_rad_per_s * (time_s - onset_s); }
};

/// One cycle by a law in closed form.
struct CycleState : CycleFrame {
  std::variant<CoulombCycle, WeakeningCycle, RelaxingCycle> motion;

  [[nodiscard]] double slip_s() const {
    return std::visit([](const auto& law) { return law.tau_end(); }, motion) / omega_rad_per_s;
  }
  [[nodiscard]] bool resticks() const {
    return std::visit([](const auto& law) { return law.resticks(); }, motion);
  }
  /// Spring force above the level of the stick after the slip, continued to the onset, over force_scale.
  [[nodiscard]] double intercept() const {
    return std::visit([](const auto& law) { return law.intercept(); }, motion);
  }
  /// Returns the force above the level, as the sensor shows it.
  [[nodiscard]] double force_at(double time_s) const {
    const double tau = tau_at(time_s);
    return force_scale * std::visit([tau](const auto& law) { return double{law.at(tau).z}; }, motion);
  }
};

/// The rise after slips around one slip.
struct CycleRise {
  double force = 0.0;  ///< A
  RiseAroundSlip share;

  /// Returns the contribution to the force.
  [[nodiscard]] double at(double time_s) const { return force * share.at(time_s).value; }
};

/// Holds the times at which the sticks around a slip end and begin. They follow from the middle of the slip, which is
/// exact enough for how k changes within a stick.
struct StickEnds {
  double end_s = 0.0;    ///< of the stick before the slip
  double begin_s = 0.0;  ///< of the stick after it

  StickEnds(double middle_s, const Scales& scales)
      : end_s(middle_s - 0.5 * scales.half_period_s), begin_s(middle_s + 0.5 * scales.half_period_s) {}

  /// Returns the time from the end of the stick that is at the slip; it is 0 within the slip.
  [[nodiscard]] double from_slip(double time_s) const {
    return std::min(time_s - end_s, 0.0) + std::max(time_s - begin_s, 0.0);
  }
};

/// Holds what bends the sticks around one slip: the rise after slips, and k that changes along the path.
struct StickBend {
  /// Holds mean and least-squares slope over a bin.
  struct Line {
    double mean = 0.0;
    double slope = 0.0;
  };

  std::optional<CycleRise> rise{};
  double curvature = 0.0;  ///< k V d ln k / dt, N/s^2
  StickEnds ends;

  /// Returns the force that bent sticks have more than straight ones.
  [[nodiscard]] double at(double time_s) const {
    return 0.5 * curvature * std::pow(ends.from_slip(time_s), 2) + (rise ? rise->at(time_s) : 0.0);
  }
  [[nodiscard]] Line over(const StickBin& bin) const;
};

/// The residuals of one cycle: (data - model) / noise for every sample around the slip, and two for each stick bin (its
/// mean and its slope, weighted as the samples in it). The model is a friction law (law/) as the sensor shows it
/// (shown_motion.hpp) above a level. In a sweep one residual more ties F_s of the cycle to the population's, and one
/// ties a level of its own to F_k(0+).
class CycleModel {
 public:
  /// The set, the scales and the columns must outlive the model.
  CycleModel(const CycleSet& set, std::size_t cycle, const Scales& scales, const Columns& columns);

  [[nodiscard]] std::size_t residuals() const { return data_->residuals() + ties(); }
  [[nodiscard]] const Columns& columns() const { return *columns_; }
  /// Returns the index of the lines' first cosine in the level's parameters, whose last ones are the lines' cosines and
  /// sines.
  [[nodiscard]] std::size_t first_wave() const {
    return (columns_->has_constant() ? 1 : 0) + columns_->drift() - 2 * level_->lines_Hz.size();
  }
  [[nodiscard]] const CycleData& data() const { return *data_; }
  /// Friction that depends on the speed has no closed form.
  [[nodiscard]] bool is_integrated() const { return depends_on_speed(scales_.law); }

  /// Residuals and, unless null, their Jacobian (residuals() x columns().size(), column after column). False where the
  /// slip has no solution.
  bool evaluate(const CycleValues& values, double* residuals, double* jacobian) const;

  /// Returns whether the slip has a solution in closed form.
  [[nodiscard]] bool is_inside(const CycleValues& values) const {
    return state(*values.shared, values.local).has_value();
  }

  /// Returns the state in closed form, as the sensor shows it; friction that depends on the speed counts as if it did
  /// not. It is empty where the slip has no solution. `shared` applies at Units::speed_m_per_s where k varies with the
  /// speed.
  [[nodiscard]] std::optional<CycleState> state(const Coordinates& shared, const double* local) const;
  /// Returns the level without hum. `level` points to the constant, where there is one, and the drift.
  [[nodiscard]] double level_at(double time_s, const double* level, const double* local) const;
  [[nodiscard]] double hum_at(double time_s, const double* level) const;
  /// Returns what bends the sticks, if anything does.
  [[nodiscard]] StickBend bend(const Coordinates& shared) const;

 private:
  class Rows;

  [[nodiscard]] std::optional<CycleRise> rise(const Coordinates& shared) const;
  /// Returns k V d ln k / dt per kStiffnessDrift, of a cycle with this stiffness.
  [[nodiscard]] double curvature_by_drift(double stiffness_N_per_m) const {
    return 2.0 * stiffness_N_per_m * scales_.speed_m_per_s / (scales_.time_end_s - scales_.time_begin_s);
  }
  /// Returns the derivative of the cycle's ln k by a coordinate through which it differs from that of other cycles: by
  /// the speed of the recording, or by the place along its path, from -1 to 1.
  [[nodiscard]] double share_of(Coordinate coordinate) const;
  /// Returns the coordinates as they apply to this cycle: w_n follows k as that of the same mass.
  [[nodiscard]] Coordinates of_cycle(const Coordinates& shared) const;
  /// `here`: of_cycle.
  [[nodiscard]] CycleFrame frame(const Coordinates& here, const double* local) const;
  [[nodiscard]] std::size_t ties() const { return scales_.population ? 1 + (level_->per_cycle ? 1 : 0) : 0; }
  template <class Law>
  void fill(const Law& law, const CycleFrame& frame, const std::optional<CycleRise>& rise, const Rows& rows) const;

  const CycleData* data_;
  const LevelModel* level_;
  const CycleRows* rows_;
  const Columns* columns_;
  Scales scales_;
  double reference_s_;
  double even_step_s_;
};

// Inline: asked for every sample of the recording.

inline double CycleModel::level_at(double time_s, const double* level, const double* local) const {
  if (level_->per_cycle) return scales_.level + scales_.force * local[2];
  const double constant = scales_.level_zero() + scales_.level_unit() * level[0];
  if (level_->terms == 1) return constant;
  const double x = scales_.place_at(time_s);
  // Legendre polynomials by their recurrence
  double sum = 0.0;
  double value = x;
  double before = 1.0;
  for (std::size_t n = 1; n < level_->terms; ++n) {
    sum += level[n] * value;
    const auto order = static_cast<double>(n);
    const double next = ((2.0 * order + 1.0) * x * value - order * before) / (order + 1.0);
    before = value;
    value = next;
  }
  return constant + scales_.force * sum;
}

inline double CycleModel::hum_at(double time_s, const double* level) const {
  double sum = 0.0;
  const double* pair = level + first_wave();
  for (const double line_Hz : level_->lines_Hz) {
    const double phase = 2.0 * std::numbers::pi * line_Hz * (time_s - scales_.time_begin_s);
    sum += pair[0] * std::cos(phase) + pair[1] * std::sin(phase);
    pair += 2;
  }
  return scales_.force * sum;
}

}  // namespace slipfit::fit
