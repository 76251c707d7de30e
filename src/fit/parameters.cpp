#include "fit/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "fit/intervals.hpp"
#include "fit/start.hpp"

namespace slipfit::fit {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kFewCycles = 5;          // below it a scatter says little: nothing is called identified
constexpr double kSamplesForIdentified = 3.0;  // in a slip
constexpr double kBendSigmas = 3.0;
constexpr double kDriftMatters = 0.02;

/// A linear function of the fitted quantities near the solution, with what it owes to zeta.
struct Linear {
  double value = 0.0;
  double se = 0.0;
  double se_given_damping = 0.0;
  double slope = 0.0;  ///< d value / d zeta along the fit
  double degrees_of_freedom = 1.0;
};

Held held_by_user(const TierFits& fits) {
  Held held = fits.damped.held;
  held.damping = fits.damping_held();
  return held;
}

class Reporter {
 public:
  Reporter(const Recording& recording, const TierFits& fits, const Resolution& resolution, FitResult& result)
      : recording_(recording),
        resolution_(resolution),
        result_(result),
        uncertainty_(fits.damped.uncertainty),
        held_(held_by_user(fits)),
        sawtooth_(fits.sawtooth) {
    const double zeta = fits.damped.blocks.parameters.shared[2];
    zeta_free_ = zeta;
    // The best fit with zeta >= 0: where the free one lies below, the fit with zeta = 0.
    at_bound_ = zeta < 0.0 && !held_.damping && fits.undamped.has_value();
    const BlockFit& blocks = at_bound_ ? fits.undamped->blocks : fits.damped.blocks;
    given_damping_ = at_bound_ && !uncertainty_.from_refits ? fits.undamped->uncertainty.covariance
                                                            : uncertainty_.covariance_given_damping;
    const auto& shared = blocks.parameters.shared;
    stiffness_ = std::exp(shared[0]);
    omega_ = std::exp(shared[1]);
    zeta_ = std::max(0.0, shared[2]);
    cycles_ = blocks.size();
    force_ = blocks.scales().force;
    scale_ = stiffness_ * blocks.scales().speed_m_per_s / omega_;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const CycleState state = blocks.state(i);
      const double share = 1.0 / static_cast<double>(blocks.size());
      onset_force_ += share * state.onset_force;
      level_ += share * blocks.model(i).level_at(blocks.reference_s(i), blocks.level_data(),
                                                 blocks.parameters.cycles[i].data());
    }
    trend_ = level_trend(blocks);
    const std::optional<RampBend> bend = ramp_bend(blocks);
    if (bend && std::abs(bend->log_ratio) > kBendSigmas * bend->standard_error) bend_ = bend;
    // A sensor that lags, or creep, moves w_n more than leaving out parts of the slip shows.
    shape_refused_ = fits.damped.refused_damping || fits.damped.misfit;
    damping_se_ = std::sqrt(std::max(0.0, uncertainty_.covariance(kDamping, kDamping)));
    damping_ci_ = fits.damped.held.damping
                      ? Interval{zeta_, zeta_}
                      : damping_interval(zeta_free_, damping_se_, t_quantile(uncertainty_.degrees_of_freedom));
  }

  void report() {
    in_newtons_ = recording_.conditions().quantity == ForceQuantity::Force_N;
    report_stiffness();
    report_friction();
    report_dynamics();
    if (resolution_.slip_resolved && in_newtons_) report_model();
  }

 private:
  Linear linear(double value, const VectorXd& gradient, double scatter_variance) const {
    const double freedom = uncertainty_.degrees_of_freedom;
    const double fitted = std::max(0.0, gradient.dot(uncertainty_.covariance * gradient));
    const double conditional = std::max(0.0, gradient.dot(given_damping_ * gradient));
    Linear result{value, std::sqrt(fitted + scatter_variance), std::sqrt(conditional + scatter_variance), 0.0, freedom};
    const double variance_of_zeta = uncertainty_.covariance(kDamping, kDamping);
    if (variance_of_zeta > 0.0) result.slope = gradient.dot(uncertainty_.covariance.col(kDamping)) / variance_of_zeta;
    // Satterthwaite: the scatter has cycles - 1 degrees of freedom, the fit its own.
    const double total = fitted + scatter_variance;
    if (scatter_variance > 0.0 && total > 0.0) {
      const double scatter_freedom = static_cast<double>(cycles_) - 1.0;
      result.degrees_of_freedom =
          total * total / (fitted * fitted / freedom + scatter_variance * scatter_variance / scatter_freedom);
    }
    return result;
  }

  Estimate estimate(const Linear& y) const {
    const double quantile = t_quantile(y.degrees_of_freedom);
    Estimate result{y.value, y.se, Interval{y.value - quantile * y.se, y.value + quantile * y.se}, {}};
    if (!at_bound_) return result;
    const double moved = y.slope * damping_ci_.high;
    result.ci95 = Interval{y.value + std::min(0.0, moved) - quantile * y.se_given_damping,
                           y.value + std::max(0.0, moved) + quantile * y.se_given_damping};
    result.standard_error = 0.5 * (result.ci95->high - result.ci95->low) / quantile;
    return result;
  }

  static VectorXd unit(Eigen::Index i, double size = 1.0) {
    VectorXd gradient = VectorXd::Zero(kQuantities);
    gradient(i) = size;
    return gradient;
  }

  /// With cycles as the units of resampling the scatter is already in the covariance.
  double scatter_variance(double spread) const {
    return uncertainty_.from_cycles ? 0.0 : spread * spread / static_cast<double>(cycles_);
  }

  ParameterStatus graded(double relative_error, double bound) const {
    const bool good = cycles_ >= kFewCycles && relative_error < bound;
    return good ? ParameterStatus::Identified : ParameterStatus::Weak;
  }

  void add(std::string name, Estimate estimate, ParameterStatus status, std::string note = {}) {
    if (!note.empty()) estimate.note = std::move(note);
    result_.parameters.push_back({std::move(name), std::move(estimate), status});
  }

  void report_stiffness() {
    const char* name = "stiffness_N_per_m";
    if (!in_newtons_) {
      add(name, {}, ParameterStatus::Unidentified, "the force is a friction coefficient: give --normal-force");
    } else if (held_.stiffness) {
      add(name, {stiffness_, 0.0, Interval{stiffness_, stiffness_}, {}}, ParameterStatus::Fixed);
    } else {
      report_free_stiffness(name);
    }
  }

  void report_free_stiffness(const char* name) {
    Linear y = linear(std::log(stiffness_), unit(kLogStiffness), 0.0);
    // Ramps that bend (creep before a slip, a tightening line) have no one slope: k depends on the stretch that is
    // used, by half of what the halves of the ramps differ.
    std::string note = few_cycles();
    if (bend_) {
      const double half = 0.5 * bend_->log_ratio;
      y.se = std::hypot(y.se, half);
      y.se_given_damping = std::hypot(y.se_given_damping, half);
      note = fmt::format("ramps begin {:.1f} % {} than they end: the interval allows for it",
                         100.0 * std::abs(bend_->log_ratio), bend_->log_ratio > 0.0 ? "steeper" : "flatter");
      result_.warnings.push_back({"model_misfit", "the sticks are not straight: " + note});
    }
    const double drift = std::abs(trend_ / (stiffness_ * recording_.conditions().speed_m_per_s));
    if (drift > y.se) {
      y.se = std::hypot(y.se, drift);
      y.se_given_damping = std::hypot(y.se_given_damping, drift);
      note =
          fmt::format("the level rises or falls all along: k is off by {:.1f} % if the sensor drifts", 100.0 * drift);
    }
    add(name, exponential(estimate(y)), drift > kDriftMatters ? ParameterStatus::Weak : graded(y.se, 0.05), note);
  }

  std::string few_cycles() const {
    return cycles_ < kFewCycles ? fmt::format("only {} cycles", cycles_) : std::string();
  }

  /// F_s - F_k = A + c V: the spring force at onset is F_s - c V. model.md section 4
  void report_friction() {
    const std::string difference_name = in_newtons_ ? "friction_difference_N" : "friction_coefficient_difference";
    const double drag = 2.0 * zeta_ * scale_;
    VectorXd gradient(kQuantities);
    gradient << drag, -drag, 2.0 * scale_, force_, 0.0;
    const double spread = uncertainty_.onset_force_sd * force_;
    difference_ = linear(onset_force_ + drag, gradient, scatter_variance(spread));
    // A standard error of a third says less than the bound by the drop.
    const bool tells = difference_.se < difference_.value / 3.0;
    if (!resolution_.slip_resolved || !resolution_.damping_resolved || !tells) {
      report_bounded_friction(difference_name);
      return;
    }
    const bool resolved = resolution_.samples_per_slip > kSamplesForIdentified && !shape_refused_;
    const ParameterStatus status = resolved ? graded(difference_.se / difference_.value, 0.1) : ParameterStatus::Weak;
    add(difference_name, estimate(difference_), status, few_cycles());

    VectorXd level = unit(kLevel, force_);
    report_absolute(in_newtons_ ? "static_friction_N" : "static_friction_coefficient",
                    linear(level_ + onset_force_ + drag, gradient + level, scatter_variance(spread)), status);
    report_absolute(in_newtons_ ? "kinetic_friction_N" : "kinetic_friction_coefficient", linear(level_, level, 0.0),
                    status);
  }

  void report_absolute(const std::string& name, const Linear& y, ParameterStatus status) {
    const bool zero_known = recording_.conditions().zero_force_N.has_value();
    add(name, estimate(y), zero_known ? status : ParameterStatus::Weak,
        zero_known ? "" : "takes the sensor's zero as right; state it with --zero");
  }

  /// Unresolved slip: F_s - F_k lies between half of the drop (zeta = 0) and the drop (zeta -> 1), lambda >> 1. At
  /// zeta = 0 the drop also has the part that the drive makes up during the slip; 0.485 leaves room for it.
  void report_bounded_friction(const std::string& name) {
    const double spread =
        t_quantile(static_cast<double>(cycles_) - 1.0) * sawtooth_.drop_sd / std::sqrt(static_cast<double>(cycles_));
    const Interval interval{std::max(0.0, 0.485 * (sawtooth_.drop - spread)), sawtooth_.drop + spread};
    Estimate bounded{
        0.5 * (interval.low + interval.high), std::nullopt, interval,
        "between half of the drop and the drop" + (resolution_.reason.empty() ? "" : "; " + resolution_.reason)};
    add(name, bounded, ParameterStatus::Bounded);
  }

  void report_dynamics() {
    const char* frequency = "natural_frequency_rad_per_s";
    const char* damping = "damping_ratio";
    if (!resolution_.slip_resolved) {
      add(frequency, {}, ParameterStatus::Unidentified, resolution_.reason);
      add(damping, {}, ParameterStatus::Unidentified, resolution_.reason);
      return;
    }
    const bool resolved = resolution_.samples_per_slip > kSamplesForIdentified && !shape_refused_;
    if (held_.frequency) {
      add(frequency, {omega_, 0.0, Interval{omega_, omega_}, {}}, ParameterStatus::Fixed);
    } else {
      const Linear y = linear(std::log(omega_), unit(kLogFrequency), 0.0);
      add(frequency, exponential(estimate(y)), resolved ? graded(y.se, 0.05) : ParameterStatus::Weak,
          shape_refused_
              ? "the slip is not shaped like a damped oscillation: what w_n means is in doubt beyond the interval"
              : few_cycles());
    }
    report_mass();
    if (held_.damping) {
      add(damping, {zeta_, 0.0, damping_ci_, {}}, ParameterStatus::Fixed);
    } else if (!resolution_.damping_resolved) {
      add(damping, {}, ParameterStatus::Unidentified, resolution_.reason);
    } else {
      const bool sharp = resolved && damping_se_ < 0.25 * zeta_;
      add(damping, {zeta_, damping_se_, damping_ci_, {}}, sharp ? graded(0.0, 1.0) : ParameterStatus::Weak,
          sharp ? few_cycles() : fmt::format("known to {:.2g}, from 0 it cannot be told well", damping_se_));
      report_damping_coefficient();
    }
  }

  /// m = k / w_n^2
  void report_mass() {
    if (!in_newtons_) return;
    VectorXd gradient = unit(kLogStiffness);
    gradient(kLogFrequency) = -2.0;
    const Linear y = linear(std::log(stiffness_ / (omega_ * omega_)), gradient, 0.0);
    const bool both_held = held_.stiffness && held_.frequency;
    const bool resolved = resolution_.samples_per_slip > kSamplesForIdentified && !shape_refused_;
    add("mass_kg", exponential(estimate(y)),
        both_held  ? ParameterStatus::Fixed
        : resolved ? graded(y.se, 0.1)
                   : ParameterStatus::Weak,
        "effective: k / w_n^2");
  }

  /// c = 2 zeta k / w_n, [Paper] eq. (6)
  void report_damping_coefficient() {
    if (!in_newtons_) return;
    const double unit_c = 2.0 * stiffness_ / omega_;
    VectorXd gradient(kQuantities);
    gradient << zeta_ * unit_c, -zeta_ * unit_c, unit_c, 0.0, 0.0;
    Estimate c = estimate(linear(zeta_ * unit_c, gradient, 0.0));
    c.ci95 = Interval{damping_ci_.low * unit_c, std::max(damping_ci_.high * unit_c, c.ci95->high)};
    const bool sharp = resolution_.samples_per_slip > kSamplesForIdentified && damping_se_ < 0.25 * zeta_;
    add("damping_coefficient_N_s_per_m", c, sharp ? graded(0.0, 1.0) : ParameterStatus::Weak);
  }

  /// Covariance of (ln k, ln w_n, zeta, ln dF) for everything that follows.
  void report_model() {
    if (!resolution_.damping_resolved || !(difference_.se < difference_.value / 3.0)) return;
    const double drag = 2.0 * zeta_ * scale_;
    MatrixXd gradients = MatrixXd::Zero(kQuantities, 4);
    gradients(kLogStiffness, 0) = gradients(kLogFrequency, 1) = gradients(kDamping, 2) = 1.0;
    gradients.col(3) << drag, -drag, 2.0 * scale_, force_, 0.0;
    gradients.col(3) /= difference_.value;
    MatrixXd covariance = gradients.transpose() * uncertainty_.covariance * gradients;
    const double spread = uncertainty_.onset_force_sd * force_ / difference_.value;
    covariance(3, 3) += scatter_variance(spread);
    ModelEstimate model;
    model.stiffness_N_per_m = stiffness_;
    model.natural_frequency_rad_per_s = omega_;
    model.damping_ratio = zeta_;
    model.friction_difference_N = difference_.value;
    model.degrees_of_freedom = std::min(difference_.degrees_of_freedom, uncertainty_.degrees_of_freedom);
    model.damping_identified = held_.damping || damping_ci_.low > 0.0;
    Correlation correlation{
        {"stiffness_N_per_m", "natural_frequency_rad_per_s", "damping_ratio", "friction_difference_N"}, {}};
    for (Eigen::Index i = 0; i < 4; ++i) {
      std::vector<double> row;
      for (Eigen::Index j = 0; j < 4; ++j) {
        model.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = covariance(i, j);
        const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
        row.push_back(i == j ? 1.0 : scale > 0.0 ? covariance(i, j) / scale : 0.0);
      }
      correlation.matrix.push_back(row);
    }
    result_.estimate = model;
    result_.correlation = correlation;
  }

  const Recording& recording_;
  const Resolution& resolution_;
  FitResult& result_;
  const Uncertainty& uncertainty_;
  Held held_;
  const SawtoothFit& sawtooth_;
  MatrixXd given_damping_;
  bool at_bound_ = false;
  bool in_newtons_ = true;
  bool shape_refused_ = false;    // slips are not shaped like the model's: w_n and mass are weak
  double trend_ = 0.0;            // of levels of their own, force a second
  std::optional<RampBend> bend_;  // where it is no chance
  double zeta_free_ = 0.0, zeta_ = 0.0, damping_se_ = 0.0;
  Interval damping_ci_;
  double stiffness_ = 0.0, omega_ = 0.0, scale_ = 0.0, force_ = 1.0;
  double onset_force_ = 0.0, level_ = 0.0;
  std::size_t cycles_ = 0;
  Linear difference_;
};

}  // namespace

void report_parameters(const Recording& recording, const TierFits& fits, const Resolution& resolution,
                       FitResult& result) {
  Reporter(recording, fits, resolution, result).report();
}

}  // namespace slipfit::fit
