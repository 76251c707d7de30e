#include "fit/selection/stated_mass.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/thresholds.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/rise_term.hpp"

namespace slipfit::fit {
namespace {

double fitted_stiffness(const DampedFit& fit) {
  return std::exp(fit.blocks.parameters.values(kLogStiffness));
}

/// Standard error of a stated mass over the mass: as stated, or what is usual. `conditions` state a mass.
double relative_mass_error(const Conditions& conditions) {
  const auto& error_kg = conditions.mass_standard_error_kg;
  return error_kg ? *error_kg / *conditions.mass_kg : thresholds::kUsualMassError;
}

}  // namespace

double sigmas_of_stated_mass(const Conditions& conditions, const DampedFit& fit) {
  if (!conditions.mass_kg || fit.held[kLogFrequency]) return 0.0;
  const Coordinates log_mass = Coordinates::Unit(kLogStiffness) - 2.0 * Coordinates::Unit(kLogFrequency);
  const double variance = log_mass.dot(fit.uncertainty.covariance * log_mass);
  const double apart = std::log(*conditions.mass_kg) - log_mass.dot(fit.blocks.parameters.values);
  return apart / std::hypot(std::sqrt(std::max(0.0, variance)), relative_mass_error(conditions));
}

bool agrees_with_stated_mass(const Conditions& conditions, const DampedFit& fit) {
  return conditions.mass_kg && std::abs(sigmas_of_stated_mass(conditions, fit)) < thresholds::kClearSigmas;
}

std::optional<StatedMass> mass_for_frequency(const Conditions& conditions, const HeldParameters& held,
                                             double stiffness_N_per_m, double average_s) {
  if (!conditions.mass_kg || held.natural_frequency_rad_per_s) return std::nullopt;
  const StatedMass mass{*conditions.mass_kg, relative_mass_error(conditions)};
  const bool hides = mass.frequency_rad_per_s(stiffness_N_per_m) * average_s > thresholds::kHidingAverage;
  return hides ? std::optional(mass) : std::nullopt;
}

CoordinateMatrix with_mass(const CoordinateMatrix& held, const Coordinates& by_log_frequency, double relative_error) {
  // d ln w_n = (d ln k - d ln m) / 2
  CoordinateMatrix follows = CoordinateMatrix::Identity();
  follows.col(kLogStiffness) += 0.5 * by_log_frequency;
  const Coordinates by_mass = 0.5 * relative_error * by_log_frequency;
  return follows * held * follows.transpose() + by_mass * by_mass.transpose();
}

DampedFit fit_with_mass(const FitInput& input, DampedFit fit) {
  constexpr int kRounds = 2;  // k changes little with w_n
  const double average_s = fit.blocks.sensor().average_s;
  const std::optional<StatedMass> mass =
      mass_for_frequency(input.recording.conditions(), input.held, fitted_stiffness(fit), average_s);
  if (!mass) return fit;
  const Recording recording = fit.average ? with_average(input.recording, average_s) : input.recording;
  HeldParameters held = input.held;
  const FitInput averaged{recording, input.quality, input.segmentation, held};
  double stiffness = fitted_stiffness(fit);
  std::optional<DampedFit> by_mass;
  for (int round = 0; round < kRounds; ++round) {
    held.natural_frequency_rad_per_s = mass->frequency_rad_per_s(stiffness);
    std::optional<RiseDraft> draft = draft_with_rise(averaged);
    if (!draft) return fit;
    by_mass = std::move(draft->fit);
    stiffness = fitted_stiffness(*by_mass);
  }
  const bool contradicts = by_mass->uncertainty.noise > thresholds::kContradictedMass * fit.uncertainty.noise;
  const std::optional<Coordinates> move = moves_by(*by_mass, kLogFrequency);
  if (contradicts || !move) return fit;
  by_mass = finish_fit(averaged, *std::move(by_mass));
  if (!by_mass) return fit;
  by_mass->average = fit.average;
  by_mass->mass_gives_frequency = true;
  by_mass->uncertainty.covariance = with_mass(by_mass->uncertainty.covariance, *move, mass->relative_error);
  return *std::move(by_mass);
}

}  // namespace slipfit::fit
