#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"

namespace slipfit {

/// Models of the slips. Each adds one idea to one before it: Velocity and Weakening to Damped.
enum class Tier { Sawtooth, Undamped, Damped, Velocity, Weakening };

/// A cycle in the table `--cycles`: as detected, and as fitted if the fit uses it. Forces are in the unit of the
/// column.
struct Cycle {
  double peak_s = 0.0;
  double trough_s = 0.0;
  double peak_force = 0.0;
  double trough_force = 0.0;
  bool used = false;                  ///< in the fit
  std::optional<double> onset_s;      ///< start of slip by the fit
  std::optional<double> end_s;        ///< end of slip by the fit
  std::optional<double> onset_force;  ///< spring force at the start of slip, F_s - c V
  std::optional<double> level_force;  ///< kinetic level F_k of this cycle
  std::optional<double> residual_rms;
  std::optional<double> recovery_s;  ///< slip and the stick that recovers its drop: the period that it causes
  bool selected = true;              ///< for the fit; false: one of more than it needs
};

/// A tier that was tried, with the reason why it was chosen or rejected.
struct Candidate {
  Tier tier = Tier::Sawtooth;
  std::size_t parameters = 0;  ///< shared ones
  std::optional<double> rms;   ///< residual, unit of the force column
  std::optional<double> aicc;  ///< on the effective sample size
  bool chosen = false;
  std::string reason;
};

struct Residual {
  double rms = 0.0;
  std::optional<double> reduced_chi2;  ///< against the noise measured on the trace
  std::optional<double> whiteness_p;   ///< that white residuals show this lag-1 correlation
};

struct Correlation {
  std::vector<std::string> names;
  std::vector<std::vector<double>> matrix;  ///< symmetric, ones on the diagonal
};

/// A point of the fitted curve, at a sample of the recording; forces in the unit of the column.
struct CurvePoint {
  std::size_t sample = 0;
  double force = 0.0;
  double interference = 0.0;  ///< the part of `force` that the fit attributes to interference (mains, pick-up)
};

/// The mean slope of the force level over the recording.
struct LevelTrend {
  Estimate rate_per_s;                        ///< unit of the force column over s; empty: the level is constant
  LevelReading reading = LevelReading::Open;  ///< of a significant trend
  double in_sticks_per_s = 0.0;           ///< part of the rate that sticks have in addition to k V, by the reported k
  std::optional<Interval> level_range{};  ///< over the recording, from its mean; empty: no significant trend
};

/// Measures of how well the model describes the cycles; the kind of motion depends on them.
struct FitDiagnostics {
  double relative_residual = 0.0;   ///< residual rms over the mean onset force above F_k
  double onset_force_spread = 0.0;  ///< standard deviation over mean of the onset force above F_k
  double onset_force_error = 0.0;   ///< white-noise error of one cycle's onset force, over the mean
  double restick_share = 0.0;       ///< share of the cycles whose slip ends in stick
  double span_share = 0.0;          ///< duration of the cycles over duration of the recording
  double samples_per_slip = 0.0;
  /// The largest slope, for any phases, that the fitted lines add to a straight line through the middle three fifths of
  /// a stick; force per second.
  double stick_slope_by_lines = 0.0;
  double hum_share = 0.0;  ///< amplitude of the fitted mains hum over the mean onset force
};

/// Friction that depends on the sliding speed v: F_k(v) = F_k(0+) + b (exp(alpha v) - 1) / alpha, the law f0 + f1
/// exp(alpha v) of docs/model.md section 5 with b = f1 alpha, which stays known where alpha alone is not.
struct SpeedDependence {
  double slope_N_s_per_m = 0.0;  ///< b, the slope of F_k at v = 0
  double alpha_s_per_m = 0.0;
};

/// Static friction that changes with the stick time t before the slip (contact ageing): F_s - F_k(0+) = D + rate ln((t
/// + cut-off) / (reference + cut-off)), where D is ModelEstimate::friction_difference_N. docs/model.md (18)
struct Ageing {
  double rate_N = 0.0;  ///< below 0 where static friction falls with the stick time
  double reference_stick_s = 1.0;
  double cutoff_s = 0.0;  ///< >= 0; sticks far shorter than it add nothing to static friction
};

/// Force recovery after a slip (reloading hysteresis): over the displacement x of the stick the force rises by force (1
/// - exp(-x / length)) in addition to k x. docs/model.md (25)
struct Reloading {
  double force_N = 0.0;   ///< A > 0
  double length_m = 0.0;  ///< l > 0
};

/// A spring of which a share relaxes (standard linear solid); k is that of the spring before it relaxes. docs/model.md
/// (25c)
struct RelaxingSpring {
  double share = 0.0;   ///< 0 <= share < 1
  double time_s = 1.0;  ///< t_r > 0
};

/// Stiffness that varies with driving speed, k proportional to V^exponent, and w_n of the same mass. docs/model.md (26)
struct StiffnessTrend {
  double exponent = 0.0;
  double speed_m_per_s = 1.0;  ///< at which ModelEstimate has k and w_n

  /// Returns ln of k at a speed relative to k at the reference speed.
  [[nodiscard]] double log_growth_at(double at_m_per_s) const {
    return exponent * std::log(at_m_per_s / speed_m_per_s);
  }
};

/// The trend of F_s - F_k(0+) outside the speeds of a sweep, where no law of friction is established.
struct SpeedReach {
  double slowest_m_per_s = 0.0;
  double fastest_m_per_s = 0.0;
  /// Half-width of the 95 % interval of d ln(F_s - F_k(0+)) / d ln V outside the speeds, around the model; empty if the
  /// recordings are too few, or too similar in speed, to show a trend.
  std::optional<double> trend;

  /// Returns ln of the ratio to the nearest of its speeds; 0 between them.
  [[nodiscard]] double distance_to(double speed_m_per_s) const;
  /// Returns the distance in ln V outside the speeds at which the fitted law is established; as distance_to(), but
  /// starting before the ends of the sweep.
  [[nodiscard]] double distance_beyond(double speed_m_per_s) const;
  /// Returns the half-width of the 95 % interval of ln(F_s - F_k(0+)) that the trend causes at this speed; it is 0
  /// without a trend and between the recordings except near their ends, where a line through the recordings already
  /// misses curvature.
  [[nodiscard]] double half_width_at(double speed_m_per_s) const;
};

/// The uncertainty of predictions at other speeds from one recording, which shows neither ageing nor velocity
/// dependence. docs/model.md section 13
struct SingleSpeed {
  double speed_m_per_s = 0.0;
  /// Smallest standard errors of (ln k, ln w_n, zeta, ln(F_s - F_k(0+))) at other speeds; 0 if the parameter is
  /// identified or fixed.
  std::array<double, 4> least_errors{};

  /// Returns |ln| of the ratio of a speed to that of the recording.
  [[nodiscard]] double distance_to(double other_m_per_s) const {
    return std::abs(std::log(other_m_per_s / speed_m_per_s));
  }
};

/// The fitted model as one point with its covariance, from which everything else is computed.
struct ModelEstimate {
  double stiffness_N_per_m = 0.0;
  double natural_frequency_rad_per_s = 0.0;
  double damping_ratio = 0.0;          ///< >= 0
  double friction_difference_N = 0.0;  ///< F_s - F_k(0+)
  /// The covariance of kModelParameters, of the logarithms of those that enter as logarithms, including the scatter of
  /// the cycles; exactly 0 for those that the model does not contain.
  std::array<std::array<double, kModelValues>, kModelValues> covariance{};
  double degrees_of_freedom = 1.0;                    ///< of Student's t
  bool damping_identified = false;                    ///< zeta is known well enough to ask for critical speeds
  std::optional<SpeedDependence> speed_dependence{};  ///< empty: Coulomb friction
  std::optional<Ageing> ageing{};                     ///< empty: the same static friction after every stick
  std::optional<Reloading> reloading{};               ///< empty: sticks are straight
  std::optional<StiffnessTrend> stiffness_trend{};    ///< empty: the same k at every speed
  std::optional<RelaxingSpring> relaxing{};           ///< empty: the spring does not relax
  std::optional<SpeedReach> reach{};                  ///< of a sweep
  std::optional<SingleSpeed> single_speed{};          ///< of one recording, where a prediction is asked for
  std::optional<double> normal_force_N{};             ///< that the forces belong to, where loads are known

  /// Returns one of kModelParameters; null where the model does not contain it.
  [[nodiscard]] double* find(ParameterId id);
  [[nodiscard]] const double* find(ParameterId id) const;
};

struct FitResult {
  Tier tier = Tier::Sawtooth;
  FitDiagnostics diagnostics;
  LevelTrend level_trend;                   ///< of one recording
  std::optional<ModelEstimate> estimate;    ///< empty where the slip is not resolved or forces have no newtons
  bool mass_gives_frequency = false;        ///< w_n is that of the stated mass: averaging of the samples conceals it
  std::vector<std::string> conditional_on;  ///< what the numbers assume ("Coulomb friction", ...)
  std::vector<Candidate> candidates;
  Residual residual;
  std::vector<Parameter> parameters;  ///< in the order of docs/formats.md; absent: the tier does not have it
  std::optional<Correlation> correlation;
  std::vector<Cycle> cycles;
  std::vector<CurvePoint> curve;  ///< samples that the fit covers
  Warnings warnings;

  /// Returns the parameter, or null if the fit does not contain it.
  [[nodiscard]] const Parameter* find(ParameterId id) const;
  /// Returns the estimate of a parameter; it is empty, without a reason, if the fit does not contain the parameter.
  [[nodiscard]] Estimate estimate_of(ParameterId id) const;
  [[nodiscard]] Estimate stiffness() const { return estimate_of(ParameterId::Stiffness); }
  [[nodiscard]] Estimate friction_difference() const { return estimate_of(ParameterId::FrictionDifference); }
  [[nodiscard]] Estimate natural_frequency() const { return estimate_of(ParameterId::NaturalFrequency); }
  [[nodiscard]] Estimate damping_ratio() const { return estimate_of(ParameterId::DampingRatio); }
};

}  // namespace slipfit
