#include "fit/report/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "fit/inference/intervals.hpp"
#include "fit/inference/solution.hpp"
#include "fit/report/limits.hpp"

namespace slipfit::fit {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDriftMatters = 0.02;

class Reporter {
 public:
  Reporter(const Recording& recording, const TierFits& fits, const Resolution& resolution, FitResult& result)
      : recording_(recording),
        resolution_(resolution),
        result_(result),
        fit_(recording, fits, resolution),
        sawtooth_(fits.sawtooth) {}

  void report() {
    in_newtons_ = recording_.conditions().quantity == ForceQuantity::Force_N;
    report_stiffness();
    report_friction();
    report_dynamics();
    if (resolution_.slip_resolved && in_newtons_) report_model();
  }

 private:
  [[nodiscard]] ParameterStatus graded(double relative_error, double bound) const {
    const bool good = fit_.cycles >= kFewCycles && relative_error < bound;
    return good ? ParameterStatus::Identified : ParameterStatus::Weak;
  }

  void add(std::string name, Estimate estimate, ParameterStatus status, std::string note = {}) {
    if (!note.empty()) estimate.note = std::move(note);
    result_.parameters.push_back({std::move(name), std::move(estimate), status});
  }

  static Linear widened(Linear y, double se) {
    y.se = std::hypot(y.se, se);
    y.se_given_damping = std::hypot(y.se_given_damping, se);
    return y;
  }

  /// Of ln V, and with it of ln k: the data give k V.
  [[nodiscard]] double speed_error() const { return fit_.held.stiffness ? 0.0 : fit_.relative_speed_se; }

  void report_stiffness() {
    const char* name = "stiffness_N_per_m";
    if (!in_newtons_) {
      add(name, {}, ParameterStatus::Unidentified, "the force is a friction coefficient: give --normal-force");
    } else if (fit_.held.stiffness) {
      add(name, {fit_.stiffness, 0.0, Interval{fit_.stiffness, fit_.stiffness}, {}}, ParameterStatus::Fixed);
    } else {
      report_free_stiffness(name);
    }
  }

  void report_free_stiffness(const char* name) {
    Linear y = fit_.linear(std::log(fit_.stiffness), unit_gradient(kLogStiffness), 0.0);
    // Ramps that bend (creep before a slip, a tightening line) have no one slope: k depends on the stretch that is
    // used, by half of what the halves of the ramps differ.
    std::string note = few_cycles();
    if (fit_.bend) {
      y = widened(y, 0.5 * fit_.bend->log_ratio);
      note = fmt::format("ramps begin {:.1f} % {} than they end: the interval allows for it",
                         100.0 * std::abs(fit_.bend->log_ratio), fit_.bend->log_ratio > 0.0 ? "steeper" : "flatter");
      result_.warnings.push_back({"model_misfit", "the sticks are not straight: " + note});
    }
    const double drift = std::abs(fit_.level_trend / (fit_.stiffness * recording_.conditions().speed_m_per_s));
    if (drift > y.se) {
      y = widened(y, drift);
      note =
          fmt::format("the level rises or falls all along: k is off by {:.1f} % if the sensor drifts", 100.0 * drift);
    }
    y = widened(y, speed_error());
    add(name, exponential(fit_.estimate(y)), drift > kDriftMatters ? ParameterStatus::Weak : graded(y.se, 0.05), note);
  }

  [[nodiscard]] std::string few_cycles() const {
    return fit_.cycles < kFewCycles ? fmt::format("only {} cycles", fit_.cycles) : std::string();
  }

  [[nodiscard]] bool sampled() const { return resolution_.samples_per_slip > kSamplesForIdentified; }

  /// Of what is read from the slip: why it is weak.
  [[nodiscard]] std::string what_is_missing() const {
    if (sampled()) return few_cycles();
    return too_few_samples(resolution_.samples_per_slip, recording_.sample_interval_s());
  }

  /// Errors fall with the root of the cycles; identified from a quarter on.
  [[nodiscard]] std::string weak_damping() const {
    if (!sampled()) return what_is_missing();
    const double times = std::pow(4.0 * fit_.damping_se / fit_.zeta, 2);
    const std::string known = fmt::format("known to {:.2g}", fit_.damping_se);
    return times < 100.0 ? fmt::format("{}: {:.2g} times the cycles, or less noise, would tell it", known, times)
                         : known + ", from 0 it cannot be told";
  }

  /// F_s - F_k = A + c V: the spring force at onset is F_s - c V. model.md section 4
  void report_friction() {
    const std::string difference_name = in_newtons_ ? "friction_difference_N" : "friction_coefficient_difference";
    const double drag = 2.0 * fit_.zeta * fit_.scale;
    VectorXd gradient(kQuantities);
    gradient << drag, -drag, 2.0 * fit_.scale, fit_.force, 0.0;
    const double spread = fit_.onset_force_sd;
    difference_ = fit_.linear(fit_.onset_force + drag, gradient, fit_.scatter_variance(spread));
    // A standard error of a third says less than the bound by the drop.
    const bool tells = difference_.se < difference_.value / 3.0;
    if (!resolution_.slip_resolved || !resolution_.damping_resolved || !tells) {
      report_bounded_friction(difference_name);
      return;
    }
    const bool resolved = resolution_.samples_per_slip > kSamplesForIdentified && !fit_.shape_refused;
    const ParameterStatus status = resolved ? graded(difference_.se / difference_.value, 0.1) : ParameterStatus::Weak;
    add(difference_name, fit_.estimate(difference_), status, what_is_missing());

    VectorXd level = unit_gradient(kLevel, fit_.force);
    report_absolute(in_newtons_ ? "static_friction_N" : "static_friction_coefficient",
                    fit_.linear(fit_.level + fit_.onset_force + drag, gradient + level, fit_.scatter_variance(spread)),
                    status);
    report_absolute(in_newtons_ ? "kinetic_friction_N" : "kinetic_friction_coefficient",
                    fit_.linear(fit_.level, level, 0.0), status);
  }

  void report_absolute(const std::string& name, const Linear& y, ParameterStatus status) {
    const bool zero_known = recording_.conditions().zero_force_N.has_value();
    add(name, fit_.estimate(y), zero_known ? status : ParameterStatus::Weak,
        zero_known ? "" : "takes the sensor's zero as right, and is off by what that is off; state it with --zero");
  }

  /// Unresolved slip: F_s - F_k lies between half of the drop (zeta = 0) and the drop (zeta -> 1), lambda >> 1. At
  /// zeta = 0 the drop also has the part that the drive makes up during the slip; 0.485 leaves room for it.
  void report_bounded_friction(const std::string& name) {
    const double spread = t_quantile(static_cast<double>(fit_.cycles) - 1.0) * sawtooth_.drop_sd /
                          std::sqrt(static_cast<double>(fit_.cycles));
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
    const bool resolved = resolution_.samples_per_slip > kSamplesForIdentified && !fit_.shape_refused;
    if (fit_.held.frequency) {
      add(frequency, {fit_.omega, 0.0, Interval{fit_.omega, fit_.omega}, {}}, ParameterStatus::Fixed);
    } else {
      const Linear y = fit_.linear(std::log(fit_.omega), unit_gradient(kLogFrequency), 0.0);
      add(frequency, exponential(fit_.estimate(y)), resolved ? graded(y.se, 0.05) : ParameterStatus::Weak,
          fit_.shape_refused
              ? "the slip is not shaped like a damped oscillation: what w_n means is in doubt beyond the interval"
              : what_is_missing());
    }
    report_mass();
    if (fit_.held.damping) {
      add(damping, {fit_.zeta, 0.0, fit_.damping_ci, {}}, ParameterStatus::Fixed);
    } else if (!resolution_.damping_resolved) {
      add(damping, {}, ParameterStatus::Unidentified, resolution_.reason);
    } else {
      const bool sharp = resolved && fit_.damping_se < 0.25 * fit_.zeta;
      add(damping, {fit_.zeta, fit_.damping_se, fit_.damping_ci, {}}, sharp ? graded(0.0, 1.0) : ParameterStatus::Weak,
          sharp ? few_cycles() : weak_damping());
      report_damping_coefficient();
    }
  }

  /// m = k / w_n^2
  void report_mass() {
    if (!in_newtons_) return;
    VectorXd gradient = unit_gradient(kLogStiffness);
    gradient(kLogFrequency) = -2.0;
    const Linear y =
        widened(fit_.linear(std::log(fit_.stiffness / (fit_.omega * fit_.omega)), gradient, 0.0), speed_error());
    const bool both_held = fit_.held.stiffness && fit_.held.frequency;
    const bool resolved = resolution_.samples_per_slip > kSamplesForIdentified && !fit_.shape_refused;
    add("mass_kg", exponential(fit_.estimate(y)),
        both_held  ? ParameterStatus::Fixed
        : resolved ? graded(y.se, 0.1)
                   : ParameterStatus::Weak,
        "effective: k / w_n^2");
  }

  /// c = 2 zeta k / w_n, [Paper] eq. (6)
  void report_damping_coefficient() {
    if (!in_newtons_) return;
    const double unit_c = 2.0 * fit_.stiffness / fit_.omega;
    VectorXd gradient(kQuantities);
    gradient << fit_.zeta * unit_c, -fit_.zeta * unit_c, unit_c, 0.0, 0.0;
    Estimate c =
        fit_.estimate(widened(fit_.linear(fit_.zeta * unit_c, gradient, 0.0), fit_.zeta * unit_c * speed_error()));
    c.ci95 = Interval{fit_.damping_ci.low * unit_c, std::max(fit_.damping_ci.high * unit_c, c.ci95->high)};
    const bool sharp = resolution_.samples_per_slip > kSamplesForIdentified && fit_.damping_se < 0.25 * fit_.zeta;
    add("damping_coefficient_N_s_per_m", c, sharp ? graded(0.0, 1.0) : ParameterStatus::Weak);
  }

  /// Covariance of (ln k, ln w_n, zeta, ln dF) for everything that follows.
  void report_model() {
    if (!resolution_.damping_resolved || !(difference_.se < difference_.value / 3.0)) return;
    const double drag = 2.0 * fit_.zeta * fit_.scale;
    MatrixXd gradients = MatrixXd::Zero(kQuantities, 4);
    gradients(kLogStiffness, 0) = gradients(kLogFrequency, 1) = gradients(kDamping, 2) = 1.0;
    gradients.col(3) << drag, -drag, 2.0 * fit_.scale, fit_.force, 0.0;
    gradients.col(3) /= difference_.value;
    MatrixXd covariance = gradients.transpose() * fit_.uncertainty.covariance * gradients;
    const double spread = fit_.onset_force_sd / difference_.value;
    covariance(3, 3) += fit_.scatter_variance(spread);
    covariance(0, 0) += speed_error() * speed_error();
    ModelEstimate model;
    model.stiffness_N_per_m = fit_.stiffness;
    model.natural_frequency_rad_per_s = fit_.omega;
    model.damping_ratio = fit_.zeta;
    model.friction_difference_N = difference_.value;
    model.degrees_of_freedom = std::min(difference_.degrees_of_freedom, fit_.uncertainty.degrees_of_freedom);
    model.damping_identified = fit_.held.damping || fit_.damping_ci.low > 0.0;
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
  const Solution fit_;
  const SawtoothFit& sawtooth_;
  bool in_newtons_ = true;
  Linear difference_;
};

}  // namespace

void report_parameters(const Recording& recording, const TierFits& fits, const Resolution& resolution,
                       FitResult& result) {
  Reporter(recording, fits, resolution, result).report();
}

}  // namespace slipfit::fit
