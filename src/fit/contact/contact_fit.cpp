#include "fit/contact/contact_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fit/contact/contact_cycles.hpp"
#include "fit/contact/contact_moments.hpp"
#include "fit/cycle/cycle_table.hpp"
#include "fit/inference/intervals.hpp"
#include "signal/robust.hpp"

namespace slipfit::fit {
namespace {

constexpr double kFewCycles = 5.0;  // below it a scatter says little: nothing is called identified
constexpr double kSamplesForIdentified = 3.0;

class ContactReporter {
 public:
  ContactReporter(const Recording& recording, const ContactCycles& found, const ContactMoments& moments,
                  const ContactSolution& solution, FitResult& result)
      : recording_(recording),
        found_(found),
        jump_sd_(moments.jump_sd),
        value_(solution.value),
        covariance_(solution.covariance),
        result_(result),
        count_(static_cast<double>(found.cycles.size())) {
    speed_m_per_s_ = recording.conditions().speed_m_per_s;
    speed_error_ = recording.conditions().speed_standard_error_m_per_s.value_or(0.0) / speed_m_per_s_;
    zeta_ = std::max(0.0, value_(2));
    samples_per_slip_ = moments.mean(3) / found.step_s;
  }

  void report() {
    weigh();
    tabulate();
    report_parameters();
    report_model();
  }

 private:
  void weigh() {
    std::vector<double> jumps;
    for (const ContactCycle& cycle : found_.cycles) jumps.push_back(cycle.onset_jump);
    const auto half = static_cast<std::ptrdiff_t>(jumps.size() / 2);
    const double jump = std::exp(value_(3));
    Evidence& evidence = result_.evidence;
    evidence.relative_residual = found_.noise / jump;
    evidence.onset_force_spread = jump_sd_ / jump;
    evidence.onset_force_error = std::hypot(found_.slope * found_.step_s / std::sqrt(12.0),
                                            found_.noise / std::sqrt(std::max(1.0, samples_per_slip_))) /
                                 jump;
    evidence.restick_share = count_ / (count_ + static_cast<double>(found_.without_edges));
    evidence.decay =
        signal::median({jumps.begin(), jumps.begin() + half}) / signal::median({jumps.begin() + half, jumps.end()});
    evidence.span_share = (found_.cycles.back().end_s - found_.cycles.front().onset_s) * (count_ + 1.0) / count_ /
                          recording_.duration_s();
    evidence.samples_per_slip = samples_per_slip_;
    result_.residual.rms = found_.noise;
  }

  void tabulate() {
    for (const ContactCycle& cycle : found_.cycles) {
      Cycle& row = result_.cycles[cycle.slip];
      row.used = true;
      row.onset_s = cycle.onset_s;
      row.end_s = cycle.end_s;
      row.onset_force = cycle.plateau + cycle.onset_jump;
      row.level_force = cycle.plateau;
      row.recovery_s = cycle.end_s - cycle.onset_s + (cycle.onset_jump + cycle.end_jump) / found_.slope;
    }
  }

  [[nodiscard]] ParameterStatus graded(double relative_error, double bound) const {
    const bool good = count_ >= kFewCycles && relative_error < bound && samples_per_slip_ > kSamplesForIdentified;
    return good ? ParameterStatus::Identified : ParameterStatus::Weak;
  }

  /// ln of a product of powers of the four solved quantities, the speed taken off ln kV by the caller: `speed_error` of
  /// its logarithm is that of k.
  [[nodiscard]] Estimate power(double logarithm, const Eigen::Vector4d& exponents, double speed_error = 0.0) const {
    const double se = std::hypot(std::sqrt(exponents.dot(covariance_ * exponents)), speed_error);
    return exponential(symmetric(logarithm, se, count_ - 1.0));
  }

  void add(const std::string& name, Estimate estimate, ParameterStatus status, std::string note = {}) {
    if (!note.empty()) estimate.note = std::move(note);
    result_.parameters.push_back({name, std::move(estimate), status});
  }

  void report_parameters() {
    const bool in_newtons = recording_.conditions().quantity == ForceQuantity::Force_N;
    const double log_k = value_(0) - std::log(speed_m_per_s_);
    const auto relative = [&](const Estimate& e) { return *e.standard_error / *e.value; };
    if (in_newtons) {
      const Estimate k = power(log_k, {1.0, 0.0, 0.0, 0.0}, speed_error_);
      add("stiffness_N_per_m", k, graded(relative(k), 0.05));
    } else {
      add("stiffness_N_per_m", {}, ParameterStatus::Unidentified,
          "the force is a friction coefficient: give --normal-force");
    }
    const Estimate difference = power(value_(3), {0.0, 0.0, 0.0, 1.0});
    add(in_newtons ? "friction_difference_N" : "friction_coefficient_difference", difference,
        graded(relative(difference), 0.1));
    report_absolute(in_newtons);
    const Estimate omega = power(value_(1), {0.0, 1.0, 0.0, 0.0});
    add("natural_frequency_rad_per_s", omega, graded(relative(omega), 0.05));
    if (in_newtons) {
      const Estimate mass = power(log_k - 2.0 * value_(1), {1.0, -2.0, 0.0, 0.0}, speed_error_);
      add("mass_kg", mass, graded(relative(mass), 0.1), "effective: k / w_n^2");
    }
    report_damping(in_newtons);
  }

  /// Plateau and plateau + jump, from the spread over the cycles.
  void report_absolute(bool in_newtons) {
    const bool zero_known = recording_.conditions().zero_force_N.has_value();
    const auto mean_of = [&](const auto& force) {
      double mean = 0.0, square = 0.0;
      for (const ContactCycle& cycle : found_.cycles) mean += force(cycle) / count_;
      for (const ContactCycle& cycle : found_.cycles) square += std::pow(force(cycle) - mean, 2);
      return symmetric(mean, std::sqrt(square / (count_ - 1.0) / count_), count_ - 1.0);
    };
    const auto report = [&](const char* name, const Estimate& estimate) {
      add(name, estimate, zero_known ? graded(0.0, 1.0) : ParameterStatus::Weak,
          zero_known ? "" : "takes the sensor's zero as right, and is off by what that is off; state it with --zero");
    };
    report(in_newtons ? "static_friction_N" : "static_friction_coefficient",
           mean_of([](const ContactCycle& c) { return c.plateau + c.onset_jump; }));
    report(in_newtons ? "kinetic_friction_N" : "kinetic_friction_coefficient",
           mean_of([](const ContactCycle& c) { return c.plateau; }));
  }

  void report_damping(bool in_newtons) {
    const double se = std::sqrt(covariance_(2, 2));
    damping_ = {zeta_, se, damping_interval(value_(2), se, t_quantile(count_ - 1.0)), {}};
    const bool sharp = se < 0.25 * zeta_;
    const ParameterStatus status = sharp ? graded(0.0, 1.0) : ParameterStatus::Weak;
    damping_.note = sharp ? "" : "its error is more than a quarter of it";
    add("damping_ratio", damping_, status);
    if (!in_newtons) return;
    // c = 2 zeta k / w_n, [Paper] eq. (6)
    const double unit_c = 2.0 * std::exp(value_(0) - value_(1)) / speed_m_per_s_;
    const Eigen::Vector4d gradient(zeta_ * unit_c, -zeta_ * unit_c, unit_c, 0.0);
    const double se_c = std::hypot(std::sqrt(gradient.dot(covariance_ * gradient)), zeta_ * unit_c * speed_error_);
    Estimate c = symmetric(zeta_ * unit_c, se_c, count_ - 1.0);
    c.ci95 = Interval{damping_.ci95->low * unit_c, std::max(damping_.ci95->high * unit_c, c.ci95->high)};
    add("damping_coefficient_N_s_per_m", c, status);
  }

  void report_model() {
    if (recording_.conditions().quantity != ForceQuantity::Force_N) return;
    ModelEstimate model;
    model.stiffness_N_per_m = std::exp(value_(0)) / speed_m_per_s_;
    model.natural_frequency_rad_per_s = std::exp(value_(1));
    model.damping_ratio = zeta_;
    model.friction_difference_N = std::exp(value_(3));
    model.degrees_of_freedom = count_ - 1.0;
    model.damping_identified = damping_.ci95->low > 0.0;
    Eigen::Matrix4d covariance = covariance_;
    covariance(0, 0) += speed_error_ * speed_error_;
    Correlation correlation{
        {"stiffness_N_per_m", "natural_frequency_rad_per_s", "damping_ratio", "friction_difference_N"}, {}};
    for (Eigen::Index i = 0; i < 4; ++i) {
      correlation.matrix.emplace_back();
      for (Eigen::Index j = 0; j < 4; ++j) {
        model.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = covariance(i, j);
        correlation.matrix.back().push_back(i == j ? 1.0
                                                   : covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j)));
      }
    }
    result_.estimate = model;
    result_.correlation = std::move(correlation);
  }

  const Recording& recording_;
  const ContactCycles& found_;
  double jump_sd_;
  Eigen::Vector4d value_;
  Eigen::Matrix4d covariance_;
  FitResult& result_;
  double count_;
  double speed_m_per_s_ = 0.0, speed_error_ = 0.0, zeta_ = 0.0, samples_per_slip_ = 0.0;
  Estimate damping_;
};

/// Ramp up to the onset and plateau of every cycle; no ramp where the slip before it is not among them.
std::vector<CurvePoint> curve_of(const Recording& recording, const ContactCycles& found) {
  std::vector<CurvePoint> curve;
  std::size_t begin = 0;
  std::optional<std::size_t> slip_before;
  for (const ContactCycle& cycle : found.cycles) {
    if (!slip_before || cycle.slip != *slip_before + 1) begin = cycle.onset;
    const double top = cycle.plateau + cycle.onset_jump;
    for (std::size_t i = begin; i <= cycle.onset; ++i) {
      curve.push_back({i, top - (found.slope + found.drift) * (cycle.onset_s - recording.time_s()[i])});
    }
    for (std::size_t i = cycle.onset + 1; i <= cycle.end; ++i) curve.push_back({i, cycle.plateau});
    begin = cycle.end + 1;
    slip_before = cycle.slip;
  }
  return curve;
}

}  // namespace

std::optional<FitResult> fit_contact(const Recording& recording, const Segmentation& segmentation,
                                     const FitOptions& options) {
  const std::optional<ContactCycles> found = find_contact_cycles(recording, segmentation);
  if (!found || !(found->slope > 0.0)) return std::nullopt;
  const ContactMoments moments = moments_of(*found);
  const std::optional<ContactSolution> solution = solve_moments(moments);
  if (!solution) return std::nullopt;
  FitResult result;
  result.tier = Tier::Damped;
  result.candidates = {{Tier::Damped, 3, found->noise, std::nullopt, true,
                        "a sensor at the contact: slope of the ramps, both jumps and the slip time give all of it"}};
  result.conditional_on.emplace_back(
      "Coulomb friction (one speed cannot tell zeta and F_s - F_k from friction that depends on speed)");
  result.cycles = detected_cycles(recording, segmentation);
  ContactReporter(recording, *found, moments, *solution, result).report();
  if (!options.fixed.empty() || options.tier) {
    result.warnings.push_back({"option_ignored", "--fix and --tier do not apply to a sensor at the contact"});
  }
  if (recording.conditions().sensor_bandwidth_Hz) {
    result.warnings.push_back({"option_ignored",
                               "--sensor-bandwidth does not apply to a sensor at the contact: a lag longer than a "
                               "sample rounds the jumps that are taken here, and w_n and zeta are then wrong"});
  }
  if (options.curve) result.curve = curve_of(recording, *found);
  return result;
}

}  // namespace slipfit::fit
