#include "fit/sweep/law_choice.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/intervals.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/selection/tiers.hpp"
#include "fit/sweep/own_fits.hpp"
#include "fit/sweep/sweep_solution.hpp"

namespace slipfit::fit {

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
  const Intervals intervals(outcome.spread);
  const Jet zeta(outcome.values(kDamping), static_cast<int>(kDamping));
  return outcome.solution.held[kDamping] || zeta.a + intervals.quantile(zeta) * intervals.standard_error(zeta) > 0.0;
}

/// Under Coulomb friction; with k that varies with driving speed where recordings left out are predicted better so.
SweepOutcome coulomb_outcome(const SweepData& data, const SweepFits& fits) {
  SweepOutcome same = outcome_of(data, *fits.coulomb);
  if (!fits.growing) return same;
  SweepOutcome growing = outcome_of(data, *fits.growing);
  const bool is_better = allows_damping(growing) && left_out_error(growing) < left_out_error(same);
  return is_better ? std::move(growing) : std::move(same);
}

/// Returns how far friction that depends on the speed moves zeta, F_k and F_s - F_k, to the far ends of their intervals
/// there. Under any law F_s - F_k lies between half of the drop and the drop.
OtherLaw law_of(const SweepData& data, const SweepSolution& velocity, const SweepOutcome& coulomb) {
  const StaticFriction& kind = coulomb.static_friction;
  const Coordinates values = coordinates_of(velocity, kind);
  const CoordinateMatrix covariance = spread_of(data, velocity, normals_of(velocity.problem()), kind).with_scatter();
  OtherLaw other{FrictionLaw::Exponential, values(kDifference), Coordinates::Zero()};
  for (const auto i : {kDamping, kLevel, kDifference}) {
    const double move = values(i) - coulomb.values(i);
    other.move(i) = move + std::copysign(kNormalQuantile * std::sqrt(covariance(i, i)), move);
  }
  const double most = std::log(2.0) * coulomb.values(kDifference);
  other.move(kDifference) = std::clamp(other.move(kDifference), -most, most);
  return other;
}

}  // namespace

ChosenLaw choose_law(const SweepData& data, const SweepFits& fits, std::optional<Tier> tier, double speeds) {
  LawChoice choice = tier ? LawChoice{*tier == Tier::Velocity, "asked for by --tier"} : choose_by_chance(fits, speeds);
  std::optional<SweepOutcome> coulomb;
  if (choice.velocity && !tier && fits.coulomb && is_misfit(fits.velocity)) {
    coulomb = coulomb_outcome(data, fits);
    const double velocity_error = left_out_error(with_left_out(data, fits.velocity));
    choice = choose_by_left_out(velocity_error, left_out_error(*coulomb));
  }
  const bool depends_on_speed = choice.velocity || !fits.coulomb;
  if (!depends_on_speed && !coulomb) coulomb = coulomb_outcome(data, fits);
  std::optional<SweepOutcome> velocity;
  if (depends_on_speed) velocity = outcome_of(data, settled(fits.velocity));
  if (velocity && coulomb && !allows_damping(*velocity) && allows_damping(*coulomb)) {
    choice = {false, "residuals exceed the noise, and damping would be negative with F_k(v)"};
    velocity.reset();
  }
  // Where residuals exceed the noise, neither chance nor recordings left out show that friction does not depend on the
  // speed.
  if (!velocity && !tier && is_misfit(coulomb->solution)) {
    coulomb->other_law = law_of(data, fits.velocity, *coulomb);
  }
  SweepOutcome outcome = velocity ? *std::move(velocity) : *std::move(coulomb);
  std::vector<Candidate> candidates = candidates_of(fits, choice);
  return {std::move(outcome), std::move(choice), std::move(candidates)};
}

namespace {

/// Times of relaxation to begin with, between the shortest stick of the sweep (0) and the longest (1), in logarithms.
constexpr std::array kStartTimes{-0.3, 0.2, 0.6, 1.0};
constexpr double kStartRelaxation = 0.3;
constexpr int kRounds = 2;            // each with the typical cycles of the solution before
constexpr double kLongestTime = 2.0;  // of the longest stick: what relaxes later is at rest in all recordings

double speed_of(const DampedFit& fit) {
  return fit.blocks.scales().speed_m_per_s;
}

bool shows_rise(const DampedFit& fit) {
  const auto rises = [](const Coordinates& rival) { return rival(kReloadForce) > 0.0; };
  return fit.blocks.level().reloading || std::any_of(fit.rivals.begin(), fit.rivals.end(), rises);
}

/// Returns whether k differs between the recordings by more than its errors explain.
bool stiffness_differs(const SweepData& data) {
  std::vector<Measured> measured;
  for (const std::size_t i : data.fitted) {
    const DampedFit& fit = *data.single[i];
    measured.push_back({fit.blocks.parameters.values(kLogStiffness), error_of(fit, kLogStiffness)});
    if (!(measured.back().standard_error > 0.0)) return false;
  }
  return weighted_mean(measured).chance < thresholds::kSignificant;
}

bool may_relax(const SweepData& data, const HeldParameters& held) {
  if (held.stiffness_N_per_m || data.fitted.size() < 2) return false;
  std::vector<double> speeds;
  for (const std::size_t i : data.fitted) speeds.push_back(speed_of(*data.single[i]));
  if (!(ratio_of_ends(speeds) > thresholds::kTrendSpeedRatio)) return false;
  const bool rises =
      std::any_of(data.fitted.begin(), data.fitted.end(), [&](std::size_t i) { return shows_rise(*data.single[i]); });
  return rises || stiffness_differs(data);
}

/// Slope of the whole stick: what the rise regains is part of it.
double log_secant(const BlockFit& fit, double stick_m) {
  const double log_stiffness = fit.parameters.values(kLogStiffness);
  if (!fit.level().reloading) return log_stiffness;
  const double rise = fit.scales().force * fit.parameters.values(kReloadForce) *
                      -std::expm1(-stick_m / std::exp(fit.parameters.values(kReloadLength)));
  return std::log(std::exp(log_stiffness) + std::max(0.0, rise) / stick_m);
}

RelaxingCycles typical_cycles(const BlockFit& fit, double longest_s) {
  const double omega = std::exp(fit.parameters.values(kLogFrequency));
  return {omega * median_slip_s(fit), omega * median_period_s(fit), longest_s};
}

/// Returns the recordings with springs that relax, their sticks otherwise straight.
SweepData relaxing_springs(double longest_s, SweepData data) {
  for (const std::size_t i : data.fitted) {
    data.single[i]->continuous = false;  // ramps that bend are not joined
    BlockFit& blocks = data.single[i]->blocks;
    Scales scales = blocks.scales();
    scales.relaxing = typical_cycles(blocks, longest_s);
    const Parameters own = blocks.parameters;
    const double secant = log_secant(blocks, scales.speed_m_per_s * median_stick_s(blocks));
    LevelModel level = blocks.level();
    level.reloading = nullptr;
    blocks = blocks.with_level(std::move(level), scales);
    blocks.parameters = own;
    blocks.parameters.values(kReloadForce) = blocks.parameters.values(kReloadLength) = 0.0;
    blocks.parameters.values(kLogStiffness) = secant;
    blocks.parameters.values(kRelaxation) = kStartRelaxation;
  }
  return data;
}

/// The recordings at this solution, with its typical cycles.
SweepData at_solution(const SweepSolution& solution, SweepData data) {
  for (std::size_t r = 0; r < data.fitted.size(); ++r) {
    const BlockFit& solved = solution.recordings[r];
    BlockFit& blocks = data.single[data.fitted[r]]->blocks;
    Scales scales = blocks.scales();
    scales.relaxing = typical_cycles(solved, scales.relaxing->longest_s);
    blocks = blocks.with_scales(scales);
    blocks.parameters.values.head<3>() = solved.parameters.values.head<3>();
    blocks.parameters.values.segment<2>(kRelaxation) = solved.parameters.values.segment<2>(kRelaxation);
    blocks.parameters.cycles = solved.parameters.cycles;
  }
  return data;
}

/// Common parameters that the data determine.
double freedom_of(const SweepSolution& solution) {
  const CommonColumns columns(solution.problem());
  return static_cast<double>(columns.size()) - static_cast<double>(columns.held(solution.held).size());
}

/// The recordings without an average that nobody stated: a spring that relaxes in a slip rounds it, too.
SweepData without_average(SweepData data) {
  for (const std::size_t i : data.fitted) {
    DampedFit& fit = *data.single[i];
    if (!fit.average) continue;
    Scales scales = fit.blocks.scales();
    scales.sensor_average_s = 0.0;
    scales.free_time = FreeTime::None;
    fit.blocks = fit.blocks.with_scales(scales);
    fit.average.reset();
    fit.fall_caveat.clear();
  }
  data.average.reset();
  return data;
}

/// The recordings with a spring that relaxes, and the fit of the rig to them.
struct Relaxing {
  SweepData data;
  SweepSolution solution;
};
std::optional<Relaxing> best_of_starts(const SweepData& data, const HeldParameters& held) {
  std::vector<double> sticks_s;
  for (const std::size_t i : data.fitted) sticks_s.push_back(median_stick_s(data.single[i]->blocks));
  const auto [shortest, longest] = std::minmax_element(sticks_s.begin(), sticks_s.end());
  SweepData relaxing = relaxing_springs(kLongestTime * *longest, data);
  std::optional<Relaxing> best;
  for (const double place : kStartTimes) {
    const double log_time = std::log(*shortest) + place * std::log(*longest / *shortest);
    for (const std::size_t i : data.fitted) relaxing.single[i]->blocks.parameters.values(kRelaxationTime) = log_time;
    std::optional<SweepSolution> next = fit_rig(relaxing, held, RigFit::Rough);
    if (!next || (best && !(next->chi2 < best->solution.chi2))) continue;
    best = Relaxing{relaxing, *std::move(next)};
  }
  for (int round = 0; best && round < kRounds; ++round) {
    best->data = at_solution(best->solution, std::move(best->data));
    std::optional<SweepSolution> next = fit_rig(best->data, held);
    if (!next) return std::nullopt;
    best->solution = *std::move(next);
  }
  return best;
}

/// Returns the gain in chi2 of one fit of the rig over another, in its own variance, less the price of its additional
/// parameters.
double gain_of(const SweepSolution& fit, const SweepSolution& other) {
  const double variance = std::max(1.0, fit.chi2 / fit.degrees_of_freedom);
  return (other.chi2 - fit.chi2) / variance - 2.0 * (freedom_of(fit) - freedom_of(other));
}

}  // namespace

SweepData with_relaxation(SweepData data, std::span<const SweepRecording> recordings, const HeldParameters& held) {
  if (!may_relax(data, held)) return data;
  const std::optional<SweepSolution> plain = fit_rig(data, held);
  if (!plain) return data;
  std::optional<Relaxing> best = best_of_starts(data, held);
  if (data.average) {
    std::optional<Relaxing> instead = best_of_starts(without_average(data), held);
    if (instead && (!best || !(gain_of(best->solution, instead->solution) > thresholds::kTierPrice))) {
      best = std::move(instead);
    }
  }
  const auto exceeds = [&](const SweepSolution& other) {
    return gain_of(best->solution, other) > thresholds::kTierPrice;
  };
  // A wrong speed or a wrong file also makes k vary with the speed, but then the fit leaves a misfit.
  if (!best || is_misfit(best->solution) || !exceeds(*plain)) return data;
  const std::optional<SweepSolution> growing = fit_rig(data, held, RigFit::StiffnessGrows);
  if (!growing || !exceeds(*growing)) return data;
  for (std::size_t r = 0; r < data.fitted.size(); ++r) {
    const std::size_t i = data.fitted[r];
    DampedFit& fit = *best->data.single[i];
    if (fit.rounding) {
      fit.rounding = estimate_smoothing(best->solution.recordings[r], best->solution.held,
                                        recordings[i].recording.sample_interval_s());
    }
  }
  if (!best->data.average) best->data.rounding_s2 = common_rounding_s2(recordings, best->data.single);
  return std::move(best->data);
}

}  // namespace slipfit::fit
