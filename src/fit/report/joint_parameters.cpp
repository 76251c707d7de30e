#include "fit/report/joint_parameters.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "fit/report/limits.hpp"

namespace slipfit::fit {
namespace {

class SweepReporter {
 public:
  SweepReporter(const SweepEvidence& evidence, FitResult& result)
      : evidence_(evidence),
        model_(evidence.values, evidence.scales),
        intervals_(evidence.intervals),
        result_(result) {}

  void report() {
    add_positive("stiffness_N_per_m", model_.stiffness, 0.05, evidence_.held[kJointStiffness]);
    add_positive("friction_difference_N", model_.difference, 0.1, false);
    if (ages()) add_ageing();
    add_absolute("static_friction_N", model_.level + model_.difference);
    add_absolute("kinetic_friction_N", model_.level);
    add_positive("natural_frequency_rad_per_s", model_.omega, 0.05, evidence_.held[kJointFrequency]);
    const bool both_held = evidence_.held[kJointStiffness] && evidence_.held[kJointFrequency];
    add_positive("mass_kg", model_.stiffness / (model_.omega * model_.omega), 0.1, both_held);
    add_damping();
    add_friction_law();
    report_model();
  }

 private:
  /// By which statuses are graded: a quarter of the 95 % interval, which few degrees of freedom make wide.
  [[nodiscard]] double error(const SweepJet& y) const { return error(intervals_.plain(y)); }
  [[nodiscard]] static double error(const Estimate& estimate) {
    return 0.25 * (estimate.ci95->high - estimate.ci95->low);
  }

  [[nodiscard]] bool resolved() const {
    return evidence_.samples_per_slip > kSamplesForIdentified && evidence_.cycles >= kFewCycles && !evidence_.misfit;
  }

  void add(std::string name, Estimate estimate, ParameterStatus status, std::string note = {}) {
    estimate.note = std::move(note);
    result_.parameters.push_back({std::move(name), std::move(estimate), status});
  }

  void add_positive(std::string name, const SweepJet& y, double bound, bool fixed) {
    if (fixed) return add(std::move(name), {y.a, 0.0, Interval{y.a, y.a}, {}}, ParameterStatus::Fixed);
    const bool good =
        error(y) < bound * std::abs(y.a) && (resolved() || (name == "stiffness_N_per_m" && !evidence_.misfit));
    add(std::move(name), intervals_.of_one_sign(y), good ? ParameterStatus::Identified : ParameterStatus::Weak,
        good || resolved() ? "" : what_is_missing());
  }

  [[nodiscard]] bool ages() const { return evidence_.static_friction == StaticFriction::Ages; }

  void add_ageing() {
    result_.parameters.back().estimate.note +=
        fmt::format("{}at a stick time of {:.3g} s", result_.parameters.back().estimate.note.empty() ? "" : "; ",
                    evidence_.scales.stick_s);
    const bool good = resolved() && error(model_.ageing) < 0.25 * std::abs(model_.ageing.a);
    add("ageing_N", intervals_.plain(model_.ageing), good ? ParameterStatus::Identified : ParameterStatus::Weak,
        resolved() ? "" : what_is_missing());
  }

  [[nodiscard]] std::string what_is_missing() const {
    if (evidence_.misfit) return "residuals are well above the noise: the interval cannot hold what the model lacks";
    return fmt::format("the slips have {:.1f} samples", evidence_.samples_per_slip);
  }

  void add_absolute(std::string name, const SweepJet& y) {
    const bool good = evidence_.zero_known && resolved() && error(y) < 0.1 * std::abs(y.a);
    add(std::move(name), intervals_.plain(y), good ? ParameterStatus::Identified : ParameterStatus::Weak,
        evidence_.zero_known ? "" : "takes the sensor's zero as right; state it with --zero");
  }

  /// zeta cannot be negative: the interval is cut at 0.
  void add_damping() {
    if (evidence_.held[kJointDamping]) {
      add("damping_ratio", {model_.zeta.a, 0.0, Interval{model_.zeta.a, model_.zeta.a}, {}}, ParameterStatus::Fixed);
      return;
    }
    const SweepJet free = free_damping();
    Estimate zeta = intervals_.plain(free);
    if (zeta.ci95->high <= 0.0) {
      add("damping_ratio", {}, ParameterStatus::Unidentified,
          "the best value is negative: the slips are not shaped like a damped oscillation");
      return;
    }
    zeta.value = std::max(0.0, *zeta.value);
    zeta.ci95->low = std::max(0.0, zeta.ci95->low);
    // Only recordings with one level and one static friction tell damping from friction that depends on the speed.
    const bool sharp = resolved() && evidence_.shares_all && error(free) < 0.25 * *zeta.value;
    add("damping_ratio", zeta, sharp ? ParameterStatus::Identified : ParameterStatus::Weak,
        sharp                  ? ""
        : evidence_.shares_all ? fmt::format("known to {:.2g}, from 0 it cannot be told well", *zeta.standard_error)
                               : "holds for Coulomb friction only: the recordings share no level or static friction");
    Estimate c = intervals_.plain(2.0 * free * model_.stiffness / model_.omega);
    c.value = std::max(0.0, *c.value);
    c.ci95->low = std::max(0.0, c.ci95->low);
    add("damping_coefficient_N_s_per_m", c, sharp ? ParameterStatus::Identified : ParameterStatus::Weak);
  }

  void add_friction_law() {
    if (!evidence_.depends_on_speed) return withhold_law("not needed or not told: " + evidence_.law_reason);
    const Estimate slope = through_rate([](const SweepModel& model) { return model.slope; });
    const bool steep = resolved() && error(slope) < 0.25 * std::abs(*slope.value);
    add("friction_slope_N_s_per_m", slope, steep ? ParameterStatus::Identified : ParameterStatus::Weak);
    const double relative = error(model_.alpha) / std::abs(model_.alpha.a);
    // Nearer to 0 than 3 standard errors: those that come out so large by chance would be reported, the others not.
    if (!(relative < 1.0 / 3.0)) {
      return withhold_law(
          fmt::format("only the product f1 alpha can be told: {:.3g} N s/m, 95 % interval {:.3g} to {:.3g}",
                      *slope.value, slope.ci95->low, slope.ci95->high));
    }
    const std::string bends = "the speeds show little of the curvature; f1 alpha is known better";
    const std::string zero = evidence_.zero_known ? "" : "takes the sensor's zero as right; state it with --zero";
    const auto graded = [&](double error) {
      return error < 0.25 && resolved() ? ParameterStatus::Identified : ParameterStatus::Weak;
    };
    const auto noted = [&](ParameterStatus status) { return status == ParameterStatus::Weak ? bends : ""; };
    add("alpha_s_per_m", intervals_.of_one_sign(model_.alpha), graded(relative), noted(graded(relative)));
    const auto f1 = [](const SweepModel& model) { return model.slope / model.alpha; };
    const auto f0 = [](const SweepModel& model) { return model.level - model.slope / model.alpha; };
    const Estimate high_speed = through_rate(f0);
    const Estimate strength = through_rate(f1);
    // f1 = slope / alpha bends with alpha: where alpha is not sharp, the tails reach further than the interval shows.
    const ParameterStatus status = graded(std::max(2.0 * relative, error(strength) / std::abs(*strength.value)));
    add("f0_N", high_speed, evidence_.zero_known ? status : ParameterStatus::Weak, zero);
    add("f1_N", strength, status, noted(status));
    if (!evidence_.reference_normal_force_N) return;
    add("mu0", over_load(high_speed), evidence_.zero_known ? status : ParameterStatus::Weak, zero);
    add("mu1", over_load(strength), status, noted(status));
  }

  [[nodiscard]] Estimate through_rate(const std::function<SweepJet(const SweepModel&)>& quantity) const {
    return intervals_.through_rate(evidence_.values, evidence_.scales, quantity);
  }

  [[nodiscard]] Estimate over_load(const Estimate& force) const {
    const double load = *evidence_.reference_normal_force_N;
    return {*force.value / load,
            *force.standard_error / load,
            Interval{force.ci95->low / load, force.ci95->high / load},
            {}};
  }

  void withhold_law(const std::string& reason) {
    for (const char* name : {"alpha_s_per_m", "f0_N", "f1_N"}) add(name, {}, ParameterStatus::Unidentified, reason);
  }

  /// For everything that is computed from the fit. Needs zeta, and F_s above F_k.
  void report_model() {
    const Interval damping = *intervals_.plain(free_damping()).ci95;
    const bool damping_known = evidence_.held[kJointDamping] || damping.high > 0.0;
    if (!damping_known || !(model_.difference.a > 0.0)) return;
    // In the order of ModelEstimate::covariance; of the positive ones the logarithm.
    const std::array<SweepJet, kModelValues> all{log(model_.stiffness),  log(model_.omega), model_.zeta,
                                                 log(model_.difference), model_.slope,      model_.alpha,
                                                 model_.ageing};
    ModelEstimate estimate{model_.stiffness.a, model_.omega.a, model_.zeta.a, model_.difference.a};
    if (evidence_.depends_on_speed) estimate.speed_dependence = SpeedDependence{model_.slope.a, model_.alpha.a};
    if (ages()) estimate.ageing = Ageing{model_.ageing.a, evidence_.scales.stick_s};
    std::vector<std::size_t> used{0, 1, 2, 3};
    if (evidence_.depends_on_speed) used.insert(used.end(), {4, 5});
    if (ages()) used.push_back(6);
    Correlation correlation;
    for (const std::size_t i : used) {
      correlation.names.emplace_back(kModelValueNames[i]);
      correlation.matrix.emplace_back();
      for (const std::size_t j : used) {
        const double covariance = intervals_.covariance(all[i], all[j]);
        const double scale = intervals_.error(all[i]) * intervals_.error(all[j]);
        estimate.covariance[i][j] = covariance;
        correlation.matrix.back().push_back(i == j ? 1.0 : scale > 0.0 ? covariance / scale : 0.0);
      }
    }
    estimate.degrees_of_freedom = intervals_.degrees_of_freedom();
    estimate.damping_identified = evidence_.held[kJointDamping] || damping.low > 0.0;
    result_.correlation = std::move(correlation);
    result_.estimate = estimate;
  }

  /// zeta where nothing cuts it at 0.
  [[nodiscard]] SweepJet free_damping() const {
    SweepJet free = model_.zeta;
    free.a = evidence_.free_damping_ratio;
    return free;
  }

  const SweepEvidence& evidence_;
  SweepModel model_;
  const SweepIntervals& intervals_;
  FitResult& result_;
};

}  // namespace

void report_sweep(const SweepEvidence& evidence, FitResult& result) {
  SweepReporter(evidence, result).report();
}

}  // namespace slipfit::fit
