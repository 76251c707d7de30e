#include "fit/report/parameters.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "fit/selection/tiers.hpp"
#include "model/rebound.hpp"
#include "slipfit/core/range.hpp"

namespace slipfit::fit {

Warning averaged_warning(double average_s) {
  return {"samples_averaged",
          fmt::format("sensor averaging over {:.3g} ms was included in the fit: state the averaging time with "
                      "--sensor-average and the mass with --mass if they are known",
                      1e3 * average_s)};
}

namespace {

/// States why a force level is conditional.
constexpr const char* kZeroUnknown = "assumes that the sensor reads 0 without force: state its reading with --zero";
/// Returns zeta where F_k of each slip lies off its mean by a share of what F_s does, and `damping_ratio` is what the
/// troughs give where it does not; 0 where that would be negative.
double damping_where_friction_follows(double damping_ratio, double share) {
  const double rebound = (model::rebound_at(damping_ratio) + share) / (1.0 - share);
  return model::damping_ratio_with(std::min(1.0, rebound));
}

/// States why F_s - F_k and zeta of one speed are conditional. `damping_ratio`: of slips whose scatter determines it.
std::string one_speed(bool levels_differ, std::optional<double> damping_ratio) {
  constexpr double kShare = 0.1;
  std::string reason = "assumes kinetic friction that is the same at every sliding speed";
  if (!levels_differ) reason += " and in every slip";
  if (damping_ratio) {
    reason += fmt::format(" (if it follows a tenth of the scatter of F_s, zeta may be as low as {:.2g})",
                          damping_where_friction_follows(*damping_ratio, kShare));
  }
  return reason + "; one driving speed cannot test this: fit a sweep";
}
/// States why a stiffness that changes along the path is conditional.
constexpr const char* kConstantSpeed =
    "assumes a constant driving speed: only k V is measured, and a speed that changes by as much looks the same";

/// States why w_n and mass that are read from the slips alone are conditional. docs/model.md, section 16.
constexpr const char* kSlipsAlone =
    "assumes friction and a load that stay the same within a slip (a fall by half of F_s - F_k would make w_n 15 % "
    "higher): --mass tests this";
/// States the same where the measured normal force changes within a slip.
constexpr const char* kLoadFollows =
    "the measured normal force follows the force, and friction with it: m includes this; w_n, zeta and F_s - F_k are "
    "those of the slips";
/// States what both depend on, for FitResult::conditional_on.
constexpr const char* kSameWithinSlip =
    "friction (for w_n and m) and a load (for zeta and F_s - F_k, too) that stay the same within a slip";

/// States the source of w_n and mass that are not read from the slips.
constexpr const char* kStatedMass =
    "computed from the stated mass, because the sensor averages over the slips and so conceals w_n";

/// States why the mass is not identified where the force rises after a slip.
constexpr const char* kRiseOfTimeOrDistance =
    "the rise of the force after a slip may be the relaxation of the contact, whose stiffness in the slip is larger: "
    "the interval includes both";
/// Says what A and l of one recording rest on.
constexpr const char* kRiseOfDistance =
    "assumes that the force recovers over a distance of sliding: a contact that relaxes does the same over a time, and "
    "one driving speed cannot distinguish them";

/// What it would take to know zeta well enough. Its errors fall with the root of the cycles; identified from a quarter
/// on.
std::string weak_damping(const Estimate& damping) {
  const double times = std::pow(4.0 * *damping.standard_error / *damping.value, 2);
  const std::string known = fmt::format("its standard error is {:.2g}", *damping.standard_error);
  return times < 100.0 ? fmt::format("{}; {:.2g} times as many cycles, or less noise, would determine it", known, times)
                       : known +
                             ": it cannot be distinguished from 0, unless kinetic friction that falls with sliding "
                             "speed conceals it";
}

/// Returns the cut-off of ageing where the recordings do not determine it: the part of its range that they allow.
Parameter held_cutoff(const AgeingCutoff& cutoff, double stick_s) {
  const std::string why =
      cutoff.ratio > thresholds::kCutoffStickRatio
          ? std::string("ageing without a cut-off time explains the recordings as well")
          : fmt::format("the longest sticks are {:.2g} times as long as the shortest; a ratio of {} is needed",
                        cutoff.ratio, thresholds::kCutoffStickRatio);
  const Interval held_s{stick_s * cutoff.held.low, stick_s * cutoff.held.high};
  const std::string note = fmt::format(
      "{}; predictions use {:.3g} s, and their bands include the other values that the recordings allow, from 0 to the "
      "longest stick of {:.3g} s",
      why, stick_s * cutoff.value, stick_s * cutoff.longest);
  return {ParameterId::AgeingTime,
          {0.5 * (held_s.low + held_s.high), std::nullopt, held_s, note},
          ParameterStatus::Bounded};
}

/// Returns the correlation by the covariance of a model, for the rows and columns `used` (places in kModelParameters).
Correlation correlation_of(const ModelEstimate& estimate, const std::vector<std::size_t>& used) {
  Correlation correlation;
  for (const std::size_t i : used) {
    correlation.names.emplace_back(info(kModelParameters[i]).key);
    correlation.matrix.emplace_back();
    for (const std::size_t j : used) {
      const double scale = std::sqrt(std::max(0.0, estimate.covariance[i][i] * estimate.covariance[j][j]));
      correlation.matrix.back().push_back(i == j ? 1.0 : scale > 0.0 ? estimate.covariance[i][j] / scale : 0.0);
    }
  }
  return correlation;
}

/// Returns one of kModelParameters that the model contains.
Jet value_of(const SlidingModel& model, ParameterId id) {
  switch (id) {
    case ParameterId::Stiffness:
      return model.stiffness;
    case ParameterId::NaturalFrequency:
      return model.omega;
    case ParameterId::DampingRatio:
      return model.zeta;
    case ParameterId::FrictionDifference:
      return model.difference;
    case ParameterId::FrictionSlope:
      return model.slope;
    case ParameterId::Alpha:
      return model.alpha;
    case ParameterId::Ageing:
      return model.ageing;
    case ParameterId::AgeingTime:
      return model.ageing_time;
    case ParameterId::ReloadForce:
      return model.reload->force_N;
    case ParameterId::ReloadLength:
      return model.reload->length_m;
    case ParameterId::StiffnessExponent:
      return model.stiffness_exponent;
    case ParameterId::Relaxation:
      return model.relaxation->share;
    default:
      return model.relaxation->time_s;
  }
}

/// Adds the model for everything that is computed from the fit. It needs all four of k, w_n, zeta and F_s above F_k.
void add_model(const Findings& findings, const SlidingModel& model, FitResult& result) {
  const bool damping_known = findings.held[kDamping] || findings.damping_known();
  const bool resolved =
      !findings.weakens && findings.slip_unresolved.empty() && !findings.difference_bounds && findings.in_newtons;
  if (!resolved || !damping_known || !(model.difference.a > 0.0)) return;
  ModelEstimate estimate{model.stiffness.a, model.omega.a, model.zeta.a, model.difference.a};
  if (findings.law && findings.law->depends_on_speed) {
    estimate.speed_dependence = SpeedDependence{model.slope.a, model.alpha.a};
  }
  if (findings.law && findings.law->ageing) {
    estimate.ageing = Ageing{model.ageing.a, findings.units.stick_s, model.ageing_time.a};
  }
  if (model.reload) estimate.reloading = Reloading{model.reload->force_N.a, model.reload->length_m.a};
  if (findings.law && findings.law->stiffness_grows) {
    estimate.stiffness_trend = StiffnessTrend{model.stiffness_exponent.a, findings.units.speed_m_per_s};
  }
  if (model.relaxation) estimate.relaxing = RelaxingSpring{model.relaxation->share.a, model.relaxation->time_s.a};
  std::vector<std::size_t> used;
  std::vector<Jet> entering;  // the covariance
  for (std::size_t i = 0; i < kModelValues; ++i) {
    const ParameterId id = kModelParameters[i];
    if (estimate.find(id) == nullptr) continue;
    used.push_back(i);
    entering.push_back(enters_as_logarithm(id) ? log(value_of(model, id)) : value_of(model, id));
  }
  const auto freedom = [&](const Jet& value) { return findings.intervals.degrees_of_freedom(value); };
  estimate.degrees_of_freedom = freedom(*std::ranges::min_element(entering, {}, freedom));
  for (std::size_t i = 0; i < used.size(); ++i) {
    for (std::size_t j = 0; j < used.size(); ++j) {
      estimate.covariance[used[i]][used[j]] = findings.intervals.whole_covariance(entering[i], entering[j]);
    }
  }
  estimate.damping_identified = findings.held[kDamping] || findings.damping.ci95->low > 0.0;
  result.correlation = correlation_of(estimate, used);
  result.estimate = estimate;
}

using Id = ParameterId;

/// Holds a set of parameters, one bit each.
using Ids = std::uint32_t;

template <class... Each>
constexpr Ids ids(Each... each) {
  return (... | (Ids{1} << static_cast<std::size_t>(each)));
}

constexpr Ids kDifferences = ids(Id::FrictionDifference, Id::FrictionCoefficientDifference);
constexpr Ids kKinetic = ids(Id::KineticFriction, Id::KineticFrictionCoefficient);
constexpr Ids kForces = kKinetic | ids(Id::StaticFriction, Id::StaticFrictionCoefficient);
constexpr Ids kInertia = ids(Id::NaturalFrequency, Id::Mass);
constexpr Ids kDampings = ids(Id::DampingRatio, Id::DampingCoefficient);
constexpr Ids kLaw = ids(Id::FrictionSlope, Id::Alpha, Id::F0, Id::F1, Id::Ageing, Id::AgeingTime);
constexpr Ids kAfterSlip = ids(Id::ReloadForce, Id::ReloadLength, Id::Relaxation, Id::RelaxationTime);
constexpr Ids kSpring = ids(Id::Stiffness, Id::StiffnessExponent);
constexpr Ids kInSlip = kDifferences | kForces | kInertia | kDampings | kLaw | ids(Id::SensorAverage, Id::SlipDistance);

/// The table of caveats: which parameters each of them concerns.
constexpr Ids concerned_by(About about) {
  switch (about) {
    case About::Slip:
      return kInSlip | kAfterSlip;
    case About::Sampling:
      return kInSlip;
    case About::Stiffness:
      return kSpring | kAfterSlip | ids(Id::Mass, Id::StiffnessRatio);
    case About::StiffnessAlone:
      return kSpring;
    case About::Difference:
      return kDifferences;
    case About::Damping:
      return kDampings;
    case About::Frequency:
    case About::SameWithinSlip:
      return kInertia;
    case About::Average:
      return ids(Id::SensorAverage);
    case About::SlipDistance:
      return ids(Id::SlipDistance);
    case About::Rise:
      return ids(Id::Mass, Id::SlipDistance);
    case About::RiseAlone:
      return ids(Id::ReloadForce, Id::ReloadLength);
    case About::FrictionAtSpeeds:
      return kDifferences | kKinetic | kDampings | ids(Id::SlipDistance);
    case About::Level:
      return kForces;
    case About::Cycles:
      return ~Ids{0};
  }
  return 0;
}

bool concerns(const Caveat& caveat, Id id) {
  return (concerned_by(caveat.about) & ids(id)) != 0;
}

/// Orders statuses from the best to the worst.
int severity(ParameterStatus status) {
  constexpr std::array kOrder{ParameterStatus::Identified, ParameterStatus::Conditional, ParameterStatus::Weak,
                              ParameterStatus::Unidentified};
  return static_cast<int>(std::ranges::find(kOrder, status) - kOrder.begin());
}

struct Verdict {
  ParameterStatus status = ParameterStatus::Identified;
  std::string note;
};

class Reporter {
 public:
  Reporter(const Findings& findings, FitResult& result)
      : f_(findings),
        of_rest_(findings.intervals_at_rest()),
        model_(findings.values, findings.units),
        result_(result),
        caveats_(findings.caveats) {
    add_own_caveats();
  }

  void report() {
    result_.level_trend = f_.level_trend;
    report_stiffness();
    if (model_.stiffness_ratio) {
      report_stiffness_ratio(f_.intervals.interval_of_one_sign(*model_.stiffness_ratio));
    }
    report_friction();
    report_dynamics();
    if (f_.law) report_law();
    report_slip_distance();
    if (model_.reload) report_reload(*model_.reload);
    if (model_.relaxation) report_relaxation(*model_.relaxation);
    if (f_.sensor_average_s) add_held(Id::SensorAverage, *f_.sensor_average_s);
    if (f_.fitted_average) report_average(*f_.fitted_average);
    add_model(f_, model_, result_);
    result_.warnings.insert(result_.warnings.end(), f_.warnings.begin(), f_.warnings.end());
    std::sort(result_.parameters.begin(), result_.parameters.end(),
              [](const Parameter& a, const Parameter& b) { return a.id < b.id; });
  }

 private:
  /// Returns the relative error by which statuses are graded: a quarter of the 95 % interval, which few degrees of
  /// freedom make wide.
  static double relative_error(const Estimate& estimate) {
    return 0.25 * (estimate.ci95->high - estimate.ci95->low) / std::abs(*estimate.value);
  }

  void add_own_caveats() {
    const bool is_one_speed = !f_.law || f_.law->at_one_speed;
    if (f_.held[kLogFrequency]) {
      std::erase_if(caveats_, [](const Caveat& caveat) { return caveat.about == About::Frequency; });
    }
    if (!f_.zero_known) caveats_.insert(caveats_.begin(), {About::Level, ParameterStatus::Conditional, kZeroUnknown});
    if (!(f_.samples_per_slip > thresholds::kSlipSamples)) {
      caveats_.push_back(
          {About::Sampling, ParameterStatus::Weak, too_few_samples(f_.samples_per_slip, f_.sample_interval_s)});
    }
    if (model_.reload) caveats_.push_back({About::Rise, ParameterStatus::Weak, kRiseOfTimeOrDistance});
    if (model_.reload && is_one_speed) {
      caveats_.push_back({About::RiseAlone, ParameterStatus::Conditional, kRiseOfDistance});
    }
    if (is_one_speed || f_.load_response) {
      caveats_.push_back({About::FrictionAtSpeeds, ParameterStatus::Conditional,
                          is_one_speed ? one_speed(f_.levels_differ, damping_by_scatter()) : kLoadFollows});
    }
    if (!f_.frequency_tested) {
      caveats_.push_back(
          {About::SameWithinSlip, ParameterStatus::Conditional, f_.load_response ? kLoadFollows : kSlipsAlone});
    }
    if (f_.cycles < thresholds::kFewestCycles) {
      caveats_.push_back({About::Cycles, ParameterStatus::Weak, fmt::format("only {} cycles", f_.cycles)});
    }
    std::ranges::stable_sort(caveats_, {}, &Caveat::about);
  }

  /// Returns zeta where slips that scatter determine it, because all have one F_k.
  [[nodiscard]] std::optional<double> damping_by_scatter() const {
    return f_.onsets_scatter && !f_.levels_differ && !f_.held[kDamping] ? f_.damping.value : std::nullopt;
  }

  /// Returns the status that the interval and the caveats leave to an estimate, and why.
  [[nodiscard]] Verdict verdict_on(Id id, const Estimate& estimate) const {
    Verdict verdict;
    if (!(relative_error(estimate) < info(id).identified_below)) verdict.status = ParameterStatus::Weak;
    for (const Caveat& caveat : caveats_) {
      if (concerns(caveat, id) && severity(caveat.best) > severity(verdict.status)) verdict.status = caveat.best;
    }
    const auto is_reason = [&](const Caveat& caveat) {
      return concerns(caveat, id) && (caveat.best == verdict.status || caveat.best == ParameterStatus::Identified);
    };
    const auto first = std::ranges::find_if(caveats_, is_reason);
    if (first != caveats_.end()) verdict.note = first->reason;
    return verdict;
  }

  /// Returns why a parameter is not known at all; empty where it is.
  [[nodiscard]] std::string why_unknown(Id id) const {
    const auto found = std::ranges::find_if(caveats_, [id](const Caveat& caveat) {
      return caveat.best == ParameterStatus::Unidentified && concerns(caveat, id);
    });
    return found == caveats_.end() ? std::string() : found->reason;
  }

  void add(Id id, Estimate estimate, ParameterStatus status) {
    result_.parameters.push_back({id, std::move(estimate), status});
  }
  void add(Id id, Estimate estimate, ParameterStatus status, std::string note) {
    estimate.note = std::move(note);
    add(id, std::move(estimate), status);
  }
  ParameterStatus add_graded(Id id, const Estimate& estimate) {
    Verdict verdict = verdict_on(id, estimate);
    add(id, estimate, verdict.status, std::move(verdict.note));
    return verdict.status;
  }
  void add_held(Id id, double value) { add(id, {value, 0.0, Interval{value, value}, {}}, ParameterStatus::Fixed); }
  void add_unknown(Id id, const std::string& why) { add(id, unknown(why), ParameterStatus::Unidentified); }

  [[nodiscard]] Id in_unit(Id force, Id coefficient) const { return f_.in_newtons ? force : coefficient; }

  void report_stiffness() {
    if (!f_.in_newtons) {
      add_unknown(Id::Stiffness, "the force is a friction coefficient: give --normal-force");
    } else if (f_.held[kLogStiffness]) {
      add_held(Id::Stiffness, model_.stiffness.a);
    } else {
      add_graded(Id::Stiffness, f_.intervals.interval_of_one_sign(model_.stiffness));
    }
    if (!f_.law || !f_.law->stiffness_grows) return;
    result_.parameters.back().estimate.note += fmt::format(
        "{}at {:.4g} m/s", result_.parameters.back().estimate.note.empty() ? "" : "; ", f_.units.speed_m_per_s);
    add_graded(Id::StiffnessExponent, f_.intervals.interval_of(model_.stiffness_exponent));
  }

  /// The data give k V: a drive that changes its speed shows in the same way.
  void report_stiffness_ratio(const Estimate& ratio) {
    Verdict verdict = verdict_on(Id::StiffnessRatio, ratio);
    if (verdict.status == ParameterStatus::Identified) verdict = {ParameterStatus::Conditional, kConstantSpeed};
    add(Id::StiffnessRatio, ratio, verdict.status, std::move(verdict.note));
  }

  void report_friction() {
    const Id id = in_unit(Id::FrictionDifference, Id::FrictionCoefficientDifference);
    if (f_.difference_bounds) {
      const Interval& bounds = *f_.difference_bounds;
      std::string note = "between half and all of the force drop";
      for (const std::string& why : {f_.slip_unresolved, f_.damping.note}) {
        if (!why.empty() && note.find(why) == std::string::npos) note += "; " + why;
      }
      add(id, {0.5 * (bounds.low + bounds.high), std::nullopt, bounds, {}}, ParameterStatus::Bounded, note);
      return;
    }
    const Estimate difference = of_rest_.interval_of_one_sign(model_.difference);
    const bool ages = f_.law && f_.law->ageing;
    Verdict verdict = verdict_on(id, difference);
    if (ages) add_note(verdict.note, fmt::format("at a stick time of {:.3g} s", f_.units.stick_s));
    add(id, difference, verdict.status, std::move(verdict.note));
    report_absolute(in_unit(Id::StaticFriction, Id::StaticFrictionCoefficient), model_.level + model_.difference);
    report_absolute(in_unit(Id::KineticFriction, Id::KineticFrictionCoefficient), model_.level);
    if (ages) report_ageing();
  }

  void report_ageing() {
    add_graded(Id::Ageing, f_.intervals.interval_of(model_.ageing));
    const AgeingCutoff& cutoff = *f_.law->ageing;
    if (!cutoff.is_determined) return result_.parameters.push_back(held_cutoff(cutoff, f_.units.stick_s));
    add_graded(Id::AgeingTime, f_.intervals.interval_of_one_sign(model_.ageing_time));
  }

  /// A force level depends on the sensor's zero, and on the part of the recording where it has a trend: that is said
  /// whatever else there is to say.
  void report_absolute(Id id, const Jet& y) {
    const Estimate estimate = of_rest_.interval_of(y);
    Verdict verdict = verdict_on(id, estimate);
    const auto of_level = std::ranges::find(caveats_, About::Level, &Caveat::about);
    if (of_level != caveats_.end()) verdict.note = of_level->reason;
    add(id, estimate, verdict.status, std::move(verdict.note));
  }

  void report_dynamics() {
    if (f_.slip_unresolved.empty()) {
      report_frequency();
      return report_damping();
    }
    add_unknown(Id::NaturalFrequency, f_.slip_unresolved);
    add_unknown(Id::DampingRatio, f_.slip_unresolved);
  }

  void report_frequency() {
    const std::string why = why_unknown(Id::NaturalFrequency);
    if (!why.empty() && !f_.held[kLogFrequency]) {
      add_unknown(Id::NaturalFrequency, why);
      return f_.in_newtons ? add_unknown(Id::Mass, why) : void();
    }
    const Estimate omega = f_.intervals.interval_of_one_sign(model_.omega);
    if (f_.mass_gives_frequency) {
      add(Id::NaturalFrequency, omega, ParameterStatus::Conditional, kStatedMass);
    } else if (f_.held[kLogFrequency]) {
      add_held(Id::NaturalFrequency, model_.omega.a);
    } else if (add_graded(Id::NaturalFrequency, omega) == ParameterStatus::Conditional) {
      result_.conditional_on.emplace_back(kSameWithinSlip);
    }
    if (f_.in_newtons) report_mass();
  }

  void report_mass() {
    // m = k / w_n^2; friction that follows the force takes its share of what accelerates. docs/model.md (31)
    const Jet m =
        (1.0 - f_.load_response.value_or(LoadResponse{}).share) * model_.stiffness / (model_.omega * model_.omega);
    if (f_.held[kLogStiffness] && f_.held[kLogFrequency]) return add_held(Id::Mass, m.a);
    if (f_.mass_gives_frequency) {
      return add(Id::Mass, f_.intervals.interval_of_one_sign(m), ParameterStatus::Conditional, kStatedMass);
    }
    Estimate estimate = f_.intervals.interval_of_one_sign(m);
    if (f_.load_response) {
      estimate = widened(estimate, f_.load_response->standard_error / (1.0 - f_.load_response->share));
    }
    if (model_.reload) {
      estimate = including_relaxation(estimate, [this](const Jet& k) { return k / (model_.omega * model_.omega); });
    }
    add_graded(Id::Mass, estimate);
  }

  /// The estimate of a quantity that follows from the stiffness in the slip, with an interval that includes what it is
  /// where the rise after a slip is the relaxation of the spring.
  template <class Quantity>
  [[nodiscard]] Estimate including_relaxation(const Estimate& estimate, const Quantity& of_stiffness) const {
    // What relaxes faster than a slip shows as a stiffer slip alone: rubber has a spectrum of times.
    constexpr double kWithFaster = 4.0 / 3.0;
    const auto by_relaxation = [&](double factor) {
      return f_.intervals.interval_of_one_sign(of_stiffness(instantaneous_stiffness(*model_.reload, factor)));
    };
    const Estimate seen = spanning(estimate, by_relaxation(1.0));
    Estimate all = spanning(seen, by_relaxation(kWithFaster));
    all.value = seen.value;
    return all;
  }

  /// The stiffness that acts in a slip where the rise after it is the relaxation of the spring: the secant of a whole
  /// stick, with what has relaxed in half a slip. `factor`: on what relaxes. docs/model.md (25a)
  [[nodiscard]] Jet instantaneous_stiffness(const Reload& reload, double factor) const {
    constexpr double kMost = 1.0;  // more than a third of the rise hidden in the slip is not foreseen so
    const double path_m = f_.units.speed_m_per_s * f_.units.stick_s;
    const Jet in_slip = 0.5 * std::numbers::pi * f_.units.speed_m_per_s / model_.omega / reload.length_m;
    const Jet regained = reload.force_N * (1.0 - exp(-path_m / reload.length_m)) / path_m;
    return model_.stiffness + factor * regained * exp(in_slip.a < kMost ? in_slip : Jet(kMost));
  }

  /// Adds an independent relative error to a positive estimate.
  static Estimate widened(Estimate estimate, double relative) {
    const double before = *estimate.standard_error / *estimate.value;
    const double after = std::hypot(before, relative);
    const auto moved = [&](double end) { return *estimate.value * std::pow(end / *estimate.value, after / before); };
    estimate.ci95 = Interval{moved(estimate.ci95->low), moved(estimate.ci95->high)};
    estimate.standard_error = *estimate.value * after;
    return estimate;
  }

  /// Between two positive values of which either may be right.
  static Estimate spanning(const Estimate& one, const Estimate& other) {
    Estimate both = one;
    both.value = std::sqrt(*one.value * *other.value);
    both.ci95 = Interval{std::min(one.ci95->low, other.ci95->low), std::max(one.ci95->high, other.ci95->high)};
    both.standard_error = 0.5 * (both.ci95->high - both.ci95->low) / kNormalQuantile;
    return both;
  }

  void report_damping() {
    if (f_.held[kDamping]) return add_held(Id::DampingRatio, model_.zeta.a);
    if (!f_.damping_known()) return add_unknown(Id::DampingRatio, f_.damping.note);
    const auto [status, why] = verdict_on(Id::DampingRatio, f_.damping);
    const bool is_wide = status == ParameterStatus::Weak && why.empty();
    add(Id::DampingRatio, f_.damping, status, is_wide ? weak_damping(f_.damping) : why);
    if (!f_.in_newtons) return;
    // c = 2 zeta k / w_n, [Paper] eq. (6); zeta is never negative, and nor is c.
    const Jet unit = 2.0 * model_.stiffness / model_.omega;
    Jet zeta = model_.zeta;
    zeta.a = f_.free_damping_ratio.value_or(zeta.a);
    Estimate c = f_.intervals.interval_of(zeta * unit);
    c.value = std::max(0.0, *c.value);
    c.ci95 = Interval{f_.damping.ci95->low * unit.a, std::max(f_.damping.ci95->high * unit.a, c.ci95->high)};
    add(Id::DampingCoefficient, c, status, status == ParameterStatus::Conditional ? why : "");
  }

  void report_slip_distance() {
    const std::string why = why_unknown(Id::SlipDistance);
    if (!why.empty()) return add_unknown(Id::SlipDistance, why);
    if (!f_.weakens || !f_.slip_unresolved.empty()) return;
    const Estimate distance = f_.intervals.interval_of_one_sign(model_.slip_distance);
    const bool is_informative = relative_error(distance) < thresholds::kInformativeError;
    if (!is_informative) return add_unknown(Id::SlipDistance, "it cannot be distinguished from 0, Coulomb friction");
    // D_c is what the slip shows of k D_c / (F_s - F_k).
    const auto of_stiffness = [this](const Jet& k) { return model_.slip_distance * model_.stiffness / k; };
    add_graded(Id::SlipDistance, model_.reload ? including_relaxation(distance, of_stiffness) : distance);
  }

  void report_average(const Estimate& average) {
    const std::string why = why_unknown(Id::SensorAverage);
    if (!why.empty()) return add_unknown(Id::SensorAverage, why);
    add_graded(Id::SensorAverage, average);
  }

  /// The rise begins where the slips end: what rounds or misses these moves it.
  void report_reload(const Reload& reload) {
    if (f_.in_newtons) add_graded(Id::ReloadForce, f_.intervals.interval_of_one_sign(reload.force_N));
    add_graded(Id::ReloadLength, f_.intervals.interval_of_one_sign(reload.length_m));
  }

  void report_relaxation(const Relaxation& relaxation) {
    add_graded(Id::Relaxation, f_.intervals.interval_of_one_sign(relaxation.share));
    add_graded(Id::RelaxationTime, f_.intervals.interval_of_one_sign(relaxation.time_s));
  }

  static std::string why_only_slope(const Estimate& slope) {
    if (!slope.value || !slope.ci95) return "the data determine neither f1 nor alpha, nor their product";
    return fmt::format("only the product f1 alpha is determined: {:.3g} N s/m, 95 % interval {:.3g} to {:.3g}",
                       *slope.value, slope.ci95->low, slope.ci95->high);
  }

  void report_law() {
    if (!f_.law->depends_on_speed) return withhold_law("not required by the data: " + f_.law->reason);
    const Estimate slope = along([](const SlidingModel& model) { return model.slope; });
    add_graded(Id::FrictionSlope, slope);
    const Estimate alpha = f_.intervals.interval_of_one_sign(model_.alpha);
    // Nearer to 0 than 3 standard errors: those that come out so large by chance would be reported, the others not.
    const double relative = relative_error(f_.intervals.interval_of(model_.alpha));
    if (!(relative < thresholds::kInformativeError)) return withhold_law(why_only_slope(within(slope, kAnyNumber)));
    const std::string bends = "the speeds show little of the curvature; f1 alpha is known better";
    const auto noted = [&](ParameterStatus status) { return status == ParameterStatus::Weak ? bends : ""; };
    const ParameterStatus of_alpha = verdict_on(Id::Alpha, alpha).status;
    add(Id::Alpha, alpha, of_alpha, noted(of_alpha));
    const Estimate f0 = along([](const SlidingModel& model) { return model.level - model.slope / model.alpha; });
    const Estimate f1 = along([](const SlidingModel& model) { return model.slope / model.alpha; });
    // f1 = slope / alpha bends with alpha: where alpha is not sharp, the tails reach further than the interval shows.
    const bool sharp = 2.0 * relative < info(Id::F1).identified_below;
    const ParameterStatus status = sharp ? verdict_on(Id::F1, f1).status : ParameterStatus::Weak;
    report_law_forces(f0, f1, status, noted(status));
  }

  void report_law_forces(const Estimate& f0, const Estimate& f1, ParameterStatus status, const std::string& note) {
    const bool is_absolute = f_.zero_known || status != ParameterStatus::Identified;
    const ParameterStatus of_level = is_absolute ? status : ParameterStatus::Conditional;
    const std::string zero = f_.zero_known ? note : kZeroUnknown;
    add(Id::F0, f0, of_level, zero);
    add(Id::F1, f1, status, note);
    if (!f_.law->reference_normal_force_N) return;
    const auto over_load = [load = *f_.law->reference_normal_force_N](const Estimate& force) {
      const Interval ci95{force.ci95->low / load, force.ci95->high / load};
      return Estimate{*force.value / load, *force.standard_error / load, ci95, {}};
    };
    add(Id::Mu0, over_load(f0), of_level, zero);
    add(Id::Mu1, over_load(f1), status, note);
  }

  [[nodiscard]] Estimate along(const std::function<Jet(const SlidingModel&)>& quantity) const {
    return f_.intervals.interval_along(quantity(model_), [&](const Coordinates& move) {
      return quantity(SlidingModel(f_.values + move, f_.units)).a;
    });
  }

  void withhold_law(const std::string& reason) {
    for (const Id id : {Id::Alpha, Id::F0, Id::F1}) add_unknown(id, reason);
  }

  const Findings& f_;
  Intervals of_rest_;
  SlidingModel model_;
  FitResult& result_;
  std::vector<Caveat> caveats_;  ///< by precedence
};

}  // namespace

bool Findings::has_caveat(About about) const {
  return std::ranges::any_of(caveats, [about](const Caveat& caveat) { return caveat.about == about; });
}

void report_parameters(const Findings& findings, FitResult& result) {
  Reporter(findings, result).report();
}

}  // namespace slipfit::fit
