#include "fit/selection/law_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "core/quantile.hpp"
#include "core/student.hpp"
#include "core/thresholds.hpp"

namespace slipfit::fit {

bool is_misfit(const SweepSolution& solution) {
  return solution.chi2 > thresholds::kSweepMisfit * solution.degrees_of_freedom;
}

double speed_ratio(std::span<const SweepRecording> recordings) {
  std::vector<double> speeds;
  for (const SweepRecording& sweep : recordings) {
    if (sweep.role != SweepRole::LeftOut) speeds.push_back(sweep.recording.conditions().speed_m_per_s);
  }
  return ratio_of_ends(speeds);
}

namespace {

constexpr double kSmallestPrinted = 1e-6;  // p values below it depend on the far tails of the scatter

LawChoice choose_by_chance(const SweepFits& fits, double speeds) {
  if (speeds < thresholds::kLeastSpeedRatio) {
    return {false, fmt::format("the speeds span a factor of {:.2g} only, too little to determine alpha", speeds)};
  }
  const std::string chance = fits.p_value > kSmallestPrinted
                                 ? fmt::format("p = {:.2g} under Coulomb friction", fits.p_value)
                                 : std::string("p < 1e-6 under Coulomb friction");
  if (!fits.depends_on_speed) return {false, "Coulomb friction explains the recordings; " + chance};
  return {true, chance};
}

/// Chooses the law by the predictions of omitted recordings; this applies where residuals are larger than the noise.
LawChoice choose_by_left_out(double velocity_error, double coulomb_error) {
  return {
      velocity_error < coulomb_error,
      fmt::format(
          "residuals exceed the noise; the spacing predicted for an omitted recording has an error of {:.2g} % with "
          "F_k(v) and of {:.2g} % under Coulomb friction",
          100.0 * std::expm1(velocity_error), 100.0 * std::expm1(coulomb_error))};
}

/// Speed-dependent friction has two parameters more, its mean slope and its rate.
std::vector<Candidate> candidates_of(const SweepFits& fits, const LawChoice& choice) {
  const double noise2 = fits.velocity.chi2 / fits.velocity.degrees_of_freedom;
  const auto cycles = static_cast<double>(fits.velocity.cycles());
  const auto aicc = [&](double chi2, double parameters) -> std::optional<double> {
    if (!(cycles > parameters + 1.0)) return std::nullopt;
    return chi2 / noise2 + 2.0 * parameters + 2.0 * parameters * (parameters + 1.0) / (cycles - parameters - 1.0);
  };
  const std::optional<double> of_coulomb = fits.coulomb ? aicc(fits.coulomb_chi2, 5.0) : std::nullopt;
  return {{Tier::Damped, 5, std::nullopt, of_coulomb, !choice.velocity, choice.reason},
          {Tier::Velocity, 7, std::nullopt, aicc(fits.velocity.chi2, 7.0), choice.velocity, choice.reason}};
}

/// zeta may be above 0 by its interval, or is held.
bool allows_damping(const SweepOutcome& outcome) {
  const double error = std::sqrt(outcome.spread.covariance(kDamping, kDamping));
  return outcome.solution.held[kDamping] ||
         outcome.values(kDamping) + t_quantile(outcome.spread.degrees_of_freedom) * error > 0.0;
}

/// Under Coulomb friction; with k that goes with the speed where recordings left out are predicted better so.
SweepOutcome coulomb_outcome(const SweepData& data, const SweepFits& fits) {
  SweepOutcome same = outcome_of(data, *fits.coulomb);
  if (!fits.growing) return same;
  SweepOutcome growing = outcome_of(data, *fits.growing);
  const bool is_better = allows_damping(growing) && left_out_error(growing) < left_out_error(same);
  return is_better ? std::move(growing) : std::move(same);
}

}  // namespace

ChosenLaw choose_law(const SweepData& data, SweepFits fits, std::optional<Tier> tier, double speeds) {
  LawChoice choice = tier ? LawChoice{*tier == Tier::Velocity, "asked for by --tier"} : choose_by_chance(fits, speeds);
  // It fits once without each recording: not for a law that is left.
  std::optional<SweepOutcome> outcome;
  if (choice.velocity || !fits.coulomb) {
    fits.velocity = settled(fits.velocity);
    outcome.emplace(outcome_of(data, fits.velocity));
  }
  if (choice.velocity && !tier && fits.coulomb && is_misfit(fits.velocity)) {
    SweepOutcome coulomb = coulomb_outcome(data, fits);
    choice = choose_by_left_out(left_out_error(*outcome), left_out_error(coulomb));
    if (!choice.velocity) outcome.emplace(std::move(coulomb));
  }
  if (!outcome) outcome.emplace(coulomb_outcome(data, fits));
  std::vector<Candidate> candidates = candidates_of(fits, choice);
  return {*std::move(outcome), std::move(choice), std::move(candidates)};
}

}  // namespace slipfit::fit
