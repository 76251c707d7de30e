#include "fit/contact_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/report/parameters.hpp"
#include "model/root_between.hpp"
#include "model/slip.hpp"

namespace slipfit::fit {

namespace {

/// One cycle as a sensor at the contact sees it: a ramp up to F_s, a fall to F_k within a step of the clock, a plateau
/// while the body slips, a fall to the spring force (plus c V) within a step. Forces in the unit of the column.
struct ContactCycle {
  std::size_t slip = 0;     ///< index into the segmentation
  std::size_t onset = 0;    ///< last sample of the ramp before the slip
  std::size_t end = 0;      ///< last sample of the plateau
  double onset_s = 0.0;     ///< middle of the step in which the slip starts
  double end_s = 0.0;       ///< middle of the step in which it ends
  double plateau = 0.0;     ///< mean force of the slip: F_k
  double onset_jump = 0.0;  ///< ramp at the onset less the plateau: F_s - F_k
  double end_jump = 0.0;    ///< plateau less the ramp at the end
};

struct ContactCycles {
  std::vector<ContactCycle> cycles;
  std::size_t without_edges = 0;  ///< slips without two clear falls; the first and the last may be cut off
  double slope = 0.0;             ///< of the ramps, level's own slope taken off: k V
  double slope_error = 0.0;
  double drift = 0.0;  ///< the level's own slope; 0 where within its error
  double noise = 0.0;  ///< rms of ramps and plateaus about their lines
  double step_s = 0.0;
};

/// The smaller of the two falls of a slip, over the whole swing: below it noise might be taken for an edge.
constexpr double kSmallestFall = 0.1;
constexpr double kHidingSteps = 1.5;  // a longer step leaves the time of the edge unknown

/// Finds the cycles of the contact; the result is empty below 3 cycles with both edges.
class Finder {
 public:
  Finder(const Recording& recording, const Segmentation& segmentation)
      : time_s_(recording.time_s()), force_(recording.force()), slips_(segmentation.slips) {
    found_.step_s = recording.sample_interval_s();
  }

  std::optional<ContactCycles> find() {
    for (std::size_t i = 0; i < slips_.size(); ++i) {
      if (const auto edges = find_edges(i)) {
        found_.cycles.push_back(*edges);
      } else if (i > 0 && i + 1 < slips_.size()) {
        ++found_.without_edges;
      }
    }
    if (found_.cycles.size() < 3) return std::nullopt;
    fit_ramps();
    measure_jumps();
    if (found_.cycles.size() < 3) return std::nullopt;
    return found_;
  }

 private:
  /// Finds the two largest falls from one sample to the next, with the plateau between them.
  [[nodiscard]] std::optional<ContactCycle> find_edges(std::size_t slip) const {
    const DetectedSlip& swing = slips_[slip];
    // The smoothed turning points may lie a sample off the edge.
    const std::size_t begin = swing.peak > 0 ? swing.peak - 1 : 0;
    const std::size_t stop = std::min(swing.trough + 1, force_.size() - 1);
    std::size_t first = begin;
    std::size_t second = begin;
    double first_fall = 0.0;
    double second_fall = 0.0;
    for (std::size_t i = begin; i < stop; ++i) {
      const double fall = force_[i] - force_[i + 1];
      if (fall > first_fall) {
        second = first;
        second_fall = first_fall;
        first = i;
        first_fall = fall;
      } else if (fall > second_fall) {
        second = i;
        second_fall = fall;
      }
    }
    if (!(second_fall > kSmallestFall * swing.drop())) return std::nullopt;
    ContactCycle cycle;
    cycle.slip = slip;
    cycle.onset = std::min(first, second);
    cycle.end = std::max(first, second);
    const auto is_short = [&](std::size_t i) { return time_s_[i + 1] - time_s_[i] < kHidingSteps * found_.step_s; };
    if (cycle.end <= cycle.onset || !is_short(cycle.onset) || !is_short(cycle.end)) return std::nullopt;
    cycle.onset_s = 0.5 * (time_s_[cycle.onset] + time_s_[cycle.onset + 1]);
    cycle.end_s = 0.5 * (time_s_[cycle.end] + time_s_[cycle.end + 1]);
    cycle.plateau = reduce(cycle.onset + 1, cycle.end + 1).mean_y;
    return cycle;
  }

  /// Force over time in the samples [begin, end).
  [[nodiscard]] LineSums reduce(std::size_t begin, std::size_t end) const {
    return line_sums(
        end - begin, [&](std::size_t i) { return time_s_[begin + i]; },
        [&](std::size_t i) { return force_[begin + i]; });
  }

  /// Samples of the ramp between two neighbouring slips; empty (end <= begin) where there is none.
  [[nodiscard]] LineSums ramp_after(std::size_t i) const {
    const ContactCycle& before = found_.cycles[i];
    const ContactCycle& after = found_.cycles[i + 1];
    if (after.slip != before.slip + 1 || after.onset + 1 < before.end + 3) return {};
    return reduce(before.end + 1, after.onset + 1);
  }

  /// One slope for all ramps; what the plateaus drift by is taken off (a level that moves bends every ramp by it).
  void fit_ramps() {
    double spread = 0.0, cross = 0.0, rest = 0.0, freedom = -1.0;
    for (std::size_t i = 0; i < found_.cycles.size(); ++i) {
      ramps_.push_back(i + 1 < found_.cycles.size() ? ramp_after(i) : LineSums{});
      spread += ramps_.back().square;
      cross += ramps_.back().cross;
    }
    if (!(spread > 0.0)) return;
    const double slope = cross / spread;
    for (const LineSums& ramp : ramps_) {
      if (ramp.count == 0.0) continue;
      rest += ramp.scatter - 2.0 * slope * ramp.cross + slope * slope * ramp.square;
      freedom += ramp.count - 1.0;
    }
    for (const ContactCycle& cycle : found_.cycles) {
      const LineSums plateau = reduce(cycle.onset + 1, cycle.end + 1);
      rest += plateau.scatter;
      freedom += plateau.count - 1.0;
    }
    const LineSums level = level_of_plateaus();
    const double drift = level.square > 0.0 ? level.slope() : 0.0;
    const double level_rest = std::max(0.0, level.scatter - drift * level.cross);
    const double drift_error2 = level_rest / std::max(1.0, level.count - 2.0) / level.square;
    found_.noise = std::sqrt(std::max(0.0, rest / std::max(1.0, freedom)));
    // A drift within its error is none: taking it off would only add its noise.
    const bool drifts = drift * drift > 9.0 * drift_error2;
    ramp_slope_ = slope;
    found_.drift = drifts ? drift : 0.0;
    found_.slope = slope - found_.drift;
    found_.slope_error = std::sqrt(found_.noise * found_.noise / spread + (drifts ? drift_error2 : 0.0));
  }

  /// Plateau means as points of a line.
  [[nodiscard]] LineSums level_of_plateaus() const {
    return line_sums(
        found_.cycles.size(), [&](std::size_t i) { return found_.cycles[i].onset_s; },
        [&](std::size_t i) { return found_.cycles[i].plateau; });
  }

  /// Jumps against the ramps on either side; cycles without both ramps are dropped.
  void measure_jumps() {
    std::vector<ContactCycle> kept;
    for (std::size_t i = 1; i + 1 < found_.cycles.size(); ++i) {
      ContactCycle cycle = found_.cycles[i];
      const LineSums& before = ramps_[i - 1];
      const LineSums& after = ramps_[i];
      if (before.count == 0.0 || after.count == 0.0) continue;
      const double moved = 0.5 * found_.drift * (cycle.end_s - cycle.onset_s);  // of the level, in half a plateau
      cycle.onset_jump = before.mean_y + ramp_slope_ * (cycle.onset_s - before.mean_x) - cycle.plateau + moved;
      cycle.end_jump = cycle.plateau + moved - after.mean_y - ramp_slope_ * (cycle.end_s - after.mean_x);
      kept.push_back(cycle);
    }
    found_.cycles = std::move(kept);
  }

  std::span<const double> time_s_;
  std::span<const double> force_;
  const std::vector<DetectedSlip>& slips_;
  ContactCycles found_;
  std::vector<LineSums> ramps_;  // after each cycle
  double ramp_slope_ = 0.0;      // of the ramps as measured, drift included
};

/// Holds the four means over the cycles with their errors: ln(k V), onset jump, end jump, slip time.
struct ContactMoments {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double jump_sd = 0.0;  ///< spread of the onset jump over cycles
};

/// (ln k V, ln w_n, zeta, ln (F_s - F_k)) and their covariance; zeta may come out slightly negative.
struct ContactSolution {
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
};

enum Moment : Eigen::Index { kLogSlope, kOnsetJump, kEndJump, kSlipTime };

constexpr double kLowestDamping = -0.1;
constexpr double kHighestDamping = 0.6;

/// Left over from the two equations for given moments; both 0 at the solution.
Eigen::Vector2d equations(const Eigen::Vector4d& moments, double log_omega, double zeta) {
  const double omega = std::exp(log_omega);
  const double u = std::exp(moments(kLogSlope)) / omega;
  const model::Slip slip = model::solve_slip(moments(kOnsetJump) / u - 2.0 * zeta, zeta);
  return {slip.tau_end - omega * moments(kSlipTime),
          u * (slip.end.z + 2.0 * zeta) / moments(kEndJump) + 1.0};  // in stick the sensor sees k u + c V
}

/// The root of a function that changes its sign between `low` and `high`; empty where it does not.
template <class F>
std::optional<double> root(const F& f, double low, double high) {
  if (!(f(low) * f(high) <= 0.0)) return std::nullopt;
  return model::root_between(f, low, high);
}

/// ln w_n from the slip time alone: tau_end lies between pi and a damped turn, and falls as w_n grows.
std::optional<double> log_omega_for(const Eigen::Vector4d& moments, double zeta) {
  const double turn = 6.4 / std::sqrt(1.0 - zeta * zeta);
  return root([&](double log_omega) { return equations(moments, log_omega, zeta)(0); },
              std::log(2.5 / moments(kSlipTime)), std::log(turn / moments(kSlipTime)));
}

/// Returns by how much the mean error of an edge can repeat where its phase against the clock does. It is the largest
/// gap in the phases of a regular recording, in steps. It is 0 where the edges scatter by more than a step: then the
/// spread over the cycles shows the error.
double phase_gap(const ContactCycles& found, double ContactCycle::*edge) {
  const std::size_t count = found.cycles.size();
  const LineSums line = line_sums(
      count, [&](std::size_t i) { return static_cast<double>(found.cycles[i].slip); },
      [&](std::size_t i) { return found.cycles[i].*edge; });
  double scatter = 0.0;
  std::vector<double> phases;
  for (const ContactCycle& c : found.cycles) {
    const double line_s = line.at(static_cast<double>(c.slip));
    scatter += (c.*edge - line_s) * (c.*edge - line_s);
    phases.push_back(line_s / found.step_s - std::floor(line_s / found.step_s));
  }
  if (std::sqrt(scatter / static_cast<double>(count)) > found.step_s) return 0.0;
  std::sort(phases.begin(), phases.end());
  double gap = 1.0 - phases.back() + phases.front();
  for (std::size_t i = 1; i < count; ++i) gap = std::max(gap, phases[i] - phases[i - 1]);
  return gap;
}

ContactMoments moments_of(const ContactCycles& found) {
  ContactMoments moments;
  const auto count = static_cast<double>(found.cycles.size());
  std::vector<Eigen::Vector4d> values;
  double half_ramp_s = 0.0;
  for (const ContactCycle& c : found.cycles) {
    values.emplace_back(std::log(found.slope), c.onset_jump, c.end_jump, c.end_s - c.onset_s);
    moments.mean += values.back() / count;
    half_ramp_s += 0.5 * (c.onset_jump + c.end_jump) / found.slope / count;
  }
  for (const Eigen::Vector4d& value : values) {
    const Eigen::Vector4d d = value - moments.mean;
    moments.covariance += d * d.transpose() / (count - 1.0) / count;
  }
  moments.jump_sd = std::sqrt(moments.covariance(kOnsetJump, kOnsetJump) * count);
  // An onset timed too late by dt: the ramp is read too high, the slip too short. An end: the ramp too high, the jump
  // to it too small, the slip too long.
  const Eigen::Vector4d onset(0.0, found.slope, 0.0, -1.0);
  const Eigen::Vector4d end(0.0, 0.0, -found.slope, 1.0);
  const double onset_s = phase_gap(found, &ContactCycle::onset_s) * found.step_s;
  const double end_s = phase_gap(found, &ContactCycle::end_s) * found.step_s;
  moments.covariance += onset_s * onset_s / 12.0 * onset * onset.transpose();
  moments.covariance += end_s * end_s / 12.0 * end * end.transpose();
  const Eigen::Vector4d slope(1.0 / found.slope, half_ramp_s, half_ramp_s, 0.0);
  moments.covariance += found.slope_error * found.slope_error * slope * slope.transpose();
  return moments;
}

/// Solves slip time and end jump of the model for w_n and zeta. Empty where no zeta in (-0.1, 0.6) does.
std::optional<ContactSolution> solve_moments(const ContactMoments& moments) {
  const Eigen::Vector4d& m = moments.mean;
  if (!(m(kOnsetJump) > 0.0) || !(m(kEndJump) > 0.0) || !(m(kSlipTime) > 0.0) || !m.allFinite()) return std::nullopt;
  const auto left_of_jump = [&](double zeta) {
    const std::optional<double> log_omega = log_omega_for(m, zeta);
    return log_omega ? equations(m, *log_omega, zeta)(1) : std::nan("");
  };
  const std::optional<double> zeta = root(left_of_jump, kLowestDamping, kHighestDamping);
  if (!zeta) return std::nullopt;
  const double log_omega = *log_omega_for(m, *zeta);

  // Implicit function theorem with central differences: the equations are smooth in all six arguments.
  Eigen::Matrix2d by_unknown;
  Eigen::Matrix<double, 2, 4> by_moment;
  constexpr double kStep = 1e-5;
  by_unknown.col(0) = (equations(m, log_omega + kStep, *zeta) - equations(m, log_omega - kStep, *zeta)) / (2.0 * kStep);
  by_unknown.col(1) = (equations(m, log_omega, *zeta + kStep) - equations(m, log_omega, *zeta - kStep)) / (2.0 * kStep);
  for (Eigen::Index i = 0; i < 4; ++i) {
    Eigen::Vector4d step = Eigen::Vector4d::Zero();
    step(i) = kStep * (i == kLogSlope ? 1.0 : m(i));
    by_moment.col(i) =
        (equations(m + step, log_omega, *zeta) - equations(m - step, log_omega, *zeta)) / (2.0 * step(i));
  }
  Eigen::Matrix4d response = Eigen::Matrix4d::Zero();
  response(0, kLogSlope) = 1.0;
  response.middleRows<2>(1) = -by_unknown.inverse() * by_moment;
  response(3, kOnsetJump) = 1.0 / m(kOnsetJump);
  ContactSolution solution;
  solution.value << m(kLogSlope), log_omega, *zeta, std::log(m(kOnsetJump));
  solution.covariance = response * moments.covariance * response.transpose();
  if (!solution.covariance.allFinite()) return std::nullopt;
  return solution;
}

double samples_per_slip(const ContactCycles& found, const ContactMoments& moments) {
  return moments.mean(3) / found.step_s;
}

FitDiagnostics contact_diagnostics(const Recording& recording, const ContactCycles& found,
                                   const ContactMoments& moments, double jump) {
  const auto count = static_cast<double>(found.cycles.size());
  FitDiagnostics diagnostics;
  diagnostics.samples_per_slip = samples_per_slip(found, moments);
  diagnostics.relative_residual = found.noise / jump;
  diagnostics.onset_force_spread = moments.jump_sd / jump;
  diagnostics.onset_force_error = std::hypot(found.slope * found.step_s / std::sqrt(12.0),
                                             found.noise / std::sqrt(std::max(1.0, diagnostics.samples_per_slip))) /
                                  jump;
  diagnostics.restick_share = count / (count + static_cast<double>(found.without_edges));
  diagnostics.span_share =
      (found.cycles.back().end_s - found.cycles.front().onset_s) * (count + 1.0) / count / recording.duration_s();
  return diagnostics;
}

void tabulate_contact(const ContactCycles& found, std::vector<Cycle>& cycles) {
  for (const ContactCycle& cycle : found.cycles) {
    Cycle& row = cycles[cycle.slip];
    row.used = true;
    row.onset_s = cycle.onset_s;
    row.end_s = cycle.end_s;
    row.onset_force = cycle.plateau + cycle.onset_jump;
    row.level_force = cycle.plateau;
    row.recovery_s = cycle.end_s - cycle.onset_s + (cycle.onset_jump + cycle.end_jump) / found.slope;
  }
}

/// Holds the variance of the mean plateau and its covariance with the mean jump, over the cycles.
struct PlateauFindings {
  double mean = 0.0, variance = 0.0, with_jump = 0.0;
};

PlateauFindings plateau_of(const ContactCycles& found, double mean_jump) {
  const auto count = static_cast<double>(found.cycles.size());
  PlateauFindings result;
  for (const ContactCycle& cycle : found.cycles) result.mean += cycle.plateau / count;
  for (const ContactCycle& cycle : found.cycles) {
    const double off = cycle.plateau - result.mean;
    result.variance += off * off / (count - 1.0) / count;
    result.with_jump += off * (cycle.onset_jump - mean_jump) / (count - 1.0) / count;
  }
  return result;
}

Findings findings_of(const Recording& recording, const ContactCycles& found, const ContactMoments& moments,
                     const ContactSolution& solution) {
  const Conditions& conditions = recording.conditions();
  const double jump = std::exp(solution.value(3));
  const PlateauFindings plateau = plateau_of(found, moments.mean(1));
  Coordinates values = Coordinates::Zero();
  values(kLogStiffness) = solution.value(0) - std::log(conditions.speed_m_per_s);
  values(kLogFrequency) = solution.value(1);
  values(kDamping) = std::max(0.0, solution.value(2));
  values(kLevel) = plateau.mean;
  values(kDifference) = jump;
  Spread spread;
  constexpr std::array kPlaces{kLogStiffness, kLogFrequency, kDamping, kDifference};
  const std::array<double, 4> units{1.0, 1.0, 1.0, jump};
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    for (std::size_t j = 0; j < kPlaces.size(); ++j) {
      spread.covariance(kPlaces[i], kPlaces[j]) =
          units[i] * units[j] * solution.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  spread.covariance(kLevel, kLevel) = plateau.variance;
  spread.covariance(kLevel, kDifference) = spread.covariance(kDifference, kLevel) = plateau.with_jump;
  spread.covariance(kLogStiffness, kLogStiffness) += std::pow(conditions.relative_speed_error(), 2);
  spread.degrees_of_freedom = static_cast<double>(found.cycles.size()) - 1.0;
  const double se = std::sqrt(spread.covariance(kDamping, kDamping));
  const Interval damping = damping_interval(solution.value(2), se, t_quantile(spread.degrees_of_freedom));
  Findings findings{values, {}, Intervals(spread), {values(kDamping), se, damping, {}}};
  findings.in_newtons = conditions.quantity == ForceQuantity::Force_N;
  findings.zero_known = conditions.zero_force_N.has_value();
  findings.cycles = found.cycles.size();
  findings.frequency_tested = true;  // the plateaus show the friction within the slips
  findings.samples_per_slip = samples_per_slip(found, moments);
  findings.sample_interval_s = found.step_s;
  return findings;
}

/// Ramp up to the onset and plateau of every cycle; no ramp where the slip before it is not among them.
std::vector<CurvePoint> contact_curve(const Recording& recording, const ContactCycles& found) {
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
  const std::optional<ContactCycles> found = Finder(recording, segmentation).find();
  if (!found || !(found->slope > 0.0)) return std::nullopt;
  const ContactMoments moments = moments_of(*found);
  const std::optional<ContactSolution> solution = solve_moments(moments);
  if (!solution) return std::nullopt;
  FitResult result;
  result.tier = Tier::Damped;
  result.candidates = {{Tier::Damped, 3, found->noise, std::nullopt, true,
                        "a sensor at the contact: slope of the ramps, both jumps and the slip time give all of it"}};
  result.conditional_on = conditions_of(recording, Tier::Damped);
  result.cycles = detected_cycles(recording, segmentation);
  result.diagnostics = contact_diagnostics(recording, *found, moments, std::exp(solution->value(3)));
  result.residual.rms = found->noise;
  tabulate_contact(*found, result.cycles);
  report_parameters(findings_of(recording, *found, moments, *solution), result);
  const Held held = held_of(options.held);
  if (options.tier || std::find(held.begin(), held.end(), true) != held.end()) {
    result.warnings.push_back({"option_ignored", "--fix and --tier do not apply to a sensor at the contact"});
  }
  if (recording.conditions().sensor_bandwidth_Hz) {
    result.warnings.push_back(
        {"option_ignored",
         "--sensor-bandwidth and --sensor-filter do not apply to a sensor at the contact: a lag longer than a "
         "sample rounds the jumps that are taken here, and w_n and zeta are then wrong"});
  }
  if (options.curve) result.curve = contact_curve(recording, *found);
  return result;
}

}  // namespace slipfit::fit
