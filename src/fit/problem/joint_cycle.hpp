#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "fit/cycle/cycle_model.hpp"
#include "model/velocity_track.hpp"

namespace slipfit::fit {

/// Shared by all recordings of a sweep, dimensionless. With F_k(v) = F_k(0+) + b (exp(alpha v) - 1) / alpha
/// (docs/model.md section 5; b = f1 alpha is its slope at v = 0, finite where alpha -> 0 and f1 has no limit) and
/// v_c = JointScales::slip_speed_m_per_s:
enum JointParameter : std::size_t {
  kJointStiffness,  ///< ln k
  kJointFrequency,  ///< ln w_n
  kJointDamping,    ///< zeta, may be negative while fitting
  /// (F_k(v_c) - F_k(0+)) / (2 v_c sqrt(k m)), the mean share of friction in the damping of a slip: the data fix it
  /// whatever alpha is, which the slope at v = 0 is not.
  kFrictionSlope,
  kFrictionRate,  ///< a = alpha v_c
  kJointShared
};
using JointShared = std::array<double, kJointShared>;

/// b / (2 sqrt(k m)) over the parameter kFrictionSlope: a / (exp(a) - 1), and its derivative.
struct SlopeRatio {
  double value = 1.0;
  double derivative = -0.5;
};
SlopeRatio slope_ratio(double a);

struct JointScales {
  double force = 1.0;               ///< of F_k(0+) and of F_s - F_k
  double slip_speed_m_per_s = 1.0;  ///< typical fastest sliding, (F_s - F_k) w_n / k
  double stick_s = 1.0;             ///< typical stick time: static friction that ages is stated for it
};

/// What a recording of the sweep has of its own.
struct JointRun {
  Scales scales;
  double load = 1.0;      ///< normal force over that of the reference: friction is proportional to it
  double noise = 1.0;     ///< rms of the residuals
  double onset_sd = 1.0;  ///< spread of F_s over its cycles
  /// Spread with which a cycle's own level follows F_k(0+); 0 where the level is common to the cycles.
  double level_sd = 0.0;
};

/// Derivatives of residuals, row-major like Ceres; null where not wanted.
struct JointJacobians {
  double* shared = nullptr;
  double* level = nullptr;       ///< F_k(0+) at the reference load / JointScales::force
  double* difference = nullptr;  ///< F_s - F_k(0+) at the reference load / JointScales::force
  double* drift = nullptr;       ///< LevelModel's coefficients but the constant
  double* own = nullptr;
};

/// Values in the same order.
struct JointValues {
  const double* shared = nullptr;
  const double* level = nullptr;
  const double* difference = nullptr;
  const double* drift = nullptr;
  const double* own = nullptr;
};

/// One cycle with friction that depends on the sliding speed: the residuals of CycleModel, one that ties its F_s to
/// the population's, and where the level is per cycle one that ties it to F_k(0+).
class JointCycle {
 public:
  JointCycle(const CycleModel& model, const LevelModel& level, double reference_s, const JointRun& run,
             const JointScales& scales)
      : model_(&model), level_(&level), reference_s_(reference_s), run_(&run), scales_(scales) {}

  [[nodiscard]] std::size_t residuals() const { return model_->residuals() + 1 + (level_->per_cycle ? 1 : 0); }
  [[nodiscard]] std::size_t own_parameters() const { return model_->own_parameters(); }
  [[nodiscard]] std::size_t drift_parameters() const { return level_->columns() - (level_->terms > 0 ? 1 : 0); }

  /// False where the slip has no solution.
  bool evaluate(const JointValues& values, double* residuals, const JointJacobians& jacobians) const;

  /// Slip solution and the numbers around it.
  struct State {
    double omega_rad_per_s = 0.0;
    double force_scale = 0.0;  ///< u = k V / w_n
    double onset_s = 0.0;
    double onset_force = 0.0;  ///< above F_k(0+)
    double z0 = 0.0;
    SlopeRatio ratio;
    model::VelocityTrack track;
  };
  [[nodiscard]] std::optional<State> state(const double* shared, const double* own) const;

 private:
  class Rows;

  const CycleModel* model_;
  const LevelModel* level_;
  double reference_s_;
  const JointRun* run_;
  JointScales scales_;
};

}  // namespace slipfit::fit
