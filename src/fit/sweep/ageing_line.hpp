#pragma once

#include <Eigen/Dense>
#include <optional>

#include "fit/inference/intervals.hpp"
#include "fit/sweep/sweep_solution.hpp"
#include "model/sliding.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

using Reload = model::RiseOf<Jet>;
using Relaxation = model::RelaxationOf<Jet>;

/// The coordinates in SI with their derivatives. Forces at the reference load.
struct SlidingModel {
  Jet stiffness, omega, zeta, slope, alpha, level, difference, ageing, ageing_time, slip_distance,
      stiffness_exponent;                // k and w_n are those at Units::speed_m_per_s
  std::optional<Jet> stiffness_ratio;    ///< of k at the end of the path to that at its start; empty: k is constant
  std::optional<Reload> reload;          ///< empty: the force does not rise after slips
  std::optional<Relaxation> relaxation;  ///< empty: the spring does not relax

  SlidingModel(const Coordinates& values, const Units& units);

  /// b (exp(alpha v) - 1) / alpha: how far F_k(v) lies above F_k(0+).
  [[nodiscard]] Jet excess_friction(double speed_m_per_s) const;
  /// V times the period of the limit cycle; empty where there is none.
  [[nodiscard]] std::optional<Jet> spacing(double speed_m_per_s, double load) const;
  /// The limit cycle of a given F_s - F_k(0+) at the reference load; empty where there is none.
  [[nodiscard]] std::optional<model::SlidingCycle<Jet>> cycle(double speed_m_per_s, double load,
                                                              const Jet& difference_N) const;

 private:
  [[nodiscard]] model::SlidingBody<Jet> body_at(double speed_m_per_s, double load) const;

  double reference_stick_s_ = 1.0;
  double reference_speed_m_per_s_ = 1.0;
};

/// Holds what the recordings of a sweep say of the cut-off t_c of ageing, in Units::stick_s. A priori t_c lies between
/// 0 and the longest stick, where every root of the share t_c / (t_c + Units::stick_s) is as likely; each is then
/// weighted by how well the line with it fits the recordings.
struct AgeingCutoff {
  static constexpr Eigen::Index kPoints = 64;
  using Grid = Eigen::Array<double, kPoints, 1>;

  double value = 0.0;          ///< by the mean share; lines are drawn with it
  Interval held{};             ///< 95 % lie in it
  double longest = 0.0;        ///< stick, the end of the range
  double ratio = 1.0;          ///< of the longest stick to the shortest
  bool is_determined = false;  ///< by the sticks and the recordings; otherwise it is held over its range
  Grid values, weights;        ///< over the range; the weights add up to 1
};

/// Says whether static friction of a sweep ages, with this cut-off, or is constant (empty).
using StaticFriction = std::optional<AgeingCutoff>;

/// F_s - F_k(0+) / Units::force of each recording.
Eigen::VectorXd differences_of(const SweepSolution& solution);

/// A / Units::force, at the reference load, of the recordings whose sticks rise more steeply after a slip.
Eigen::VectorXd rises_of(const SweepSolution& solution);

/// Returns kStiffnessDrift of the recordings whose stiffness changes along the path.
Eigen::VectorXd drifts_of(const SweepSolution& solution);

/// F_s - F_k(0+) = D + rate ln((stick + t_c) / (Units::stick_s + t_c)) through the recordings' own values. At one speed
/// a larger F_s - F_k makes a longer stick, ageing or not: what moves the stick time here is the driving speed
/// (instrumental variable ln V).
struct AgeingLine {
  Eigen::VectorXd difference_weights, rate_weights;  ///< of the recordings' own F_s - F_k(0+)
  /// Sum of squares of the residuals; of recordings that age, at least what their own errors make it.
  double squares = 0.0;
  /// Holds the covariance of D, rate and cut-off: how the line moves as the cut-off runs through its values.
  Eigen::Matrix3d by_cutoff = Eigen::Matrix3d::Zero();
};

/// Needs two recordings or more with each its own F_s - F_k(0+), and at different speeds.
AgeingLine ageing_line(const SweepSolution& solution, const AgeingCutoff& cutoff);

/// Ages where recordings have each their own static friction and it falls with ln V: along a line within their own
/// errors, or along one that is more likely than scatter around their mean. docs/model.md (20c)
StaticFriction static_friction_of(const SweepSolution& solution);

/// Returns what the sweep shows of static friction outside its speeds. Where the recordings differ, the trend of ln(F_s
/// - F_k(0+)) over ln V may end or double. Where they share one, the result is the trend that may go unnoticed in them,
/// by the evidence that there is none (Schwarz's criterion).
SpeedReach reach_of(const SweepSolution& solution);

}  // namespace slipfit::fit
