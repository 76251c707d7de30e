#include "fit/contact/contact_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "fit/contact/contact_cycles.hpp"
#include "fit/contact/contact_moments.hpp"
#include "fit/cycle/cycle_table.hpp"
#include "fit/report/findings.hpp"

namespace slipfit::fit {
namespace {

double samples_per_slip(const ContactCycles& found, const ContactMoments& moments) {
  return moments.mean(3) / found.step_s;
}

FitDiagnostics diagnostics_of(const Recording& recording, const ContactCycles& found, const ContactMoments& moments,
                              double jump) {
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

void tabulate(const ContactCycles& found, std::vector<Cycle>& cycles) {
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

/// Error of the mean plateau, and how it goes with that of the mean jump, over the cycles.
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
  spread.covariance(kLogStiffness, kLogStiffness) +=
      std::pow(conditions.speed_standard_error_m_per_s.value_or(0.0) / conditions.speed_m_per_s, 2);
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
  result.conditional_on = conditions_of(recording, Tier::Damped);
  result.cycles = detected_cycles(recording, segmentation);
  result.diagnostics = diagnostics_of(recording, *found, moments, std::exp(solution->value(3)));
  result.residual.rms = found->noise;
  tabulate(*found, result.cycles);
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
  if (options.curve) result.curve = curve_of(recording, *found);
  return result;
}

}  // namespace slipfit::fit
