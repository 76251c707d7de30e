#include "fit/sweep/sweep_solution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/problem/block_fit.hpp"
#include "fit/problem/solve.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::fit {

namespace {

constexpr double kSlowestRate = 0.3;  // alpha v_c with which the search for another law begins
/// Sums of squares to a hundredth of what a parameter gains by chance; slow convergence means that the model does not
/// explain the slips.
constexpr Accuracy kCompared{1e-2, 20};
constexpr Accuracy kRoughly{0.1, 10};

/// Residual rows over parameters: each stick bin counts as its two rows, as it does in chi2.
double residual_freedom(const SweepSolution& solution) {
  const CommonColumns columns(solution.problem());
  double freedom = static_cast<double>(columns.held(solution.held).size()) - static_cast<double>(columns.size());
  if (solution.sweep.sharing.level) freedom += static_cast<double>(solution.sweep.steady.size());
  for (const BlockFit& recording : solution.recordings) {
    for (std::size_t c = 0; c < recording.size(); ++c) {
      freedom += static_cast<double>(recording.model(c).residuals()) - static_cast<double>(recording.columns().own());
    }
  }
  return std::max(1.0, freedom);
}

/// Solves from the solution's parameters on. Returns chi2, infinity where they are outside the model.
double solve(SweepSolution& solution, const Held& held, const Accuracy& accuracy) {
  return solve_together(solution.recordings, solution.sweep,
                        {held, false, accuracy.most_iterations, accuracy.tolerance});
}

SweepSolution moved_by(SweepSolution solution, const NewtonStep& step) {
  const CommonColumns columns(solution.problem());
  for (std::size_t r = 0; r < solution.recordings.size(); ++r) {
    BlockFit& recording = solution.recordings[r];
    const double time = recording.parameters.values(kSensorTime);
    columns.visit(r, recording, recording.parameters,
                  [&](Eigen::Index column, double& value) { value += step.step(column); });
    constexpr double kMost = 0.5;  // of it, where a step leads to none
    double& moved = recording.parameters.values(kSensorTime);
    moved = std::max(kMost * time, moved);
  }
  solution.chi2 = step.sum_of_squares;
  solution.degrees_of_freedom = residual_freedom(solution);
  return solution;
}

}  // namespace

std::size_t SweepSolution::cycles() const {
  std::size_t count = 0;
  for (const BlockFit& recording : recordings) count += recording.size();
  return count;
}

Coordinates SweepSolution::shared() const {
  Coordinates values = Coordinates::Zero();
  for (const BlockFit& recording : recordings) {
    for (const Coordinate coordinate : recording.columns().coordinates()) {
      if (!is_of_recording(coordinate)) values(coordinate) = recording.parameters.values(coordinate);
    }
  }
  return values;
}

const BlockFit* SweepSolution::with_sensor_time() const {
  const auto has_time = [](const BlockFit& recording) { return recording.solves_for(kSensorTime); };
  const auto found = std::find_if(recordings.begin(), recordings.end(), has_time);
  return found == recordings.end() ? nullptr : &*found;
}

std::vector<double> SweepSolution::speeds_m_per_s() const {
  std::vector<double> speeds;
  for (const BlockFit& recording : recordings) speeds.push_back(recording.scales().speed_m_per_s);
  return speeds;
}

bool SweepSolution::can_show_trend(std::size_t fewest) const {
  return recordings.size() >= fewest && ratio_of_ends(speeds_m_per_s()) > thresholds::kTrendSpeedRatio;
}

bool is_misfit(const SweepSolution& solution) {
  return solution.chi2 > thresholds::kSweepMisfit * solution.degrees_of_freedom;
}

std::optional<SweepSolution> at_minimum(SweepSolution solution, const Held& held, const Accuracy& accuracy) {
  solution.held = held;
  solution.chi2 = solve(solution, held, accuracy);
  if (!std::isfinite(solution.chi2)) return std::nullopt;
  solution.degrees_of_freedom = residual_freedom(solution);
  return solution;
}

SweepSolution settled(const SweepSolution& solution) {
  std::optional<SweepSolution> lower = at_minimum(solution, solution.held);
  return lower && lower->chi2 <= solution.chi2 ? *std::move(lower) : solution;
}

std::optional<SweepSolution> with_rate(const SweepSolution& solution, double rate) {
  SweepSolution moved = solution;
  for (BlockFit& recording : moved.recordings) recording.parameters.values(kFrictionRate) = rate;
  Held held = solution.held;
  held[kFrictionRate] = true;
  return at_minimum(std::move(moved), held);
}

std::optional<SweepSolution> with_law(const SweepSolution& solution, FrictionLaw law) {
  SweepSolution other = solution;
  for (BlockFit& recording : other.recordings) {
    Scales scales = recording.scales();
    scales.law = law;
    recording = recording.with_scales(scales);
    // The other laws have friction that changes ever less.
    double& rate = recording.parameters.values(kFrictionRate);
    rate = std::min(rate, -kSlowestRate);
  }
  return at_minimum(std::move(other), solution.held);
}

std::optional<SweepSolution> with_exponent(SweepSolution solution, const Held& held) {
  for (BlockFit& recording : solution.recordings) {
    Scales scales = recording.scales();
    scales.population->log_speed = std::log(scales.speed_m_per_s / solution.sweep.units.speed_m_per_s);
    recording = recording.with_scales(scales);
  }
  return at_minimum(std::move(solution), held);
}

std::optional<SweepSolution> with_held(const SweepSolution& solution, Coordinate coordinate, double change) {
  SweepSolution other = solution;
  for (BlockFit& recording : other.recordings) recording.parameters.values(coordinate) += change;
  return at_minimum(std::move(other), solution.held);
}

std::optional<SweepSolution> with_motion(SweepSolution solution, const FreeMotion& motion) {
  Held held = solution.held;
  held[kLogFrequency] = held[kDamping] = true;
  for (BlockFit& recording : solution.recordings) {
    recording.parameters.values(kLogFrequency) = motion.values(0);
    recording.parameters.values(kDamping) = motion.values(1);
  }
  return at_minimum(std::move(solution), held);
}

std::optional<NormalSolution> leave_out(const NormalSolution& all, std::size_t recording) {
  constexpr double kSmallGain = 1.0;  // in variances of the residuals: a step within the error of all is good
  const SweepSolution& solution = all.solution;
  if (solution.recordings.size() < 3) return std::nullopt;
  NormalSolution others{solution, {}};
  others.solution.recordings.erase(others.solution.recordings.begin() + static_cast<std::ptrdiff_t>(recording));
  others.normals = normals_without(solution.problem(), recording, all.normals, others.solution.problem());
  const NewtonStep step = newton_step(others.solution.problem(), others.normals, solution.held);
  const double variance = std::max(1.0, solution.chi2 / solution.degrees_of_freedom);
  if (step.step.allFinite() && step.gain < kSmallGain * variance) {
    others.solution = moved_by(std::move(others.solution), step);
    return others;
  }
  const Accuracy accuracy = is_misfit(solution) ? kCompared : Accuracy{};
  std::optional<SweepSolution> refitted = at_minimum(std::move(others.solution), solution.held, accuracy);
  if (!refitted) return std::nullopt;
  others.solution = *std::move(refitted);
  others.normals = normals_of(others.solution.problem());
  return others;
}

namespace {

constexpr std::size_t kStartCycles = 16;  // of each recording, on which starts are compared

/// Moves each cycle of `all`, which is where `few` began, as the one before it among the few has moved, or to where
/// that one is, if it has no slip otherwise.
void follow(const BlockFit& few, BlockFit& all) {
  all.parameters.values = few.parameters.values;
  all.parameters.level = few.parameters.level;
  std::size_t next = 0;
  Local there{};
  Local move{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    Local& own = all.parameters.cycles[i];
    if (next < few.size() && few.data(next).slip == all.data(i).slip) {
      there = few.parameters.cycles[next++];
      for (std::size_t j = 0; j < own.size(); ++j) move[j] = there[j] - own[j];
    }
    for (std::size_t j = 0; j < own.size(); ++j) own[j] += move[j];
    if (!std::isfinite(all.cycle_sum_of_squares(i))) own = there;
  }
}

/// The solution of a few cycles of each recording, whose chi2 it has, with the other cycles where these suggest.
SweepSolution drafted(SweepSolution start, const Held& held, const Accuracy& accuracy) {
  SweepSolution few = start;
  for (BlockFit& recording : few.recordings) recording = recording.with_fewer_cycles(kStartCycles);
  start.chi2 = solve(few, held, accuracy);
  for (std::size_t r = 0; r < few.recordings.size(); ++r) follow(few.recordings[r], start.recordings[r]);
  return start;
}

/// Returns the recordings of the sweep as their own fits left them.
SweepSolution start_of(const SweepData& data, Sharing sharing, FrictionLaw law) {
  SweepSolution solution;
  solution.sweep = {sharing, data.steady, data.units};
  for (const std::size_t i : data.fitted) {
    const DampedFit& single = *data.single[i];
    const Scales scales = scales_in_sweep(data, i, law);
    BlockFit recording(single.blocks.set(), scales);
    const auto& level = single.blocks.parameters.level;
    const std::ptrdiff_t skip = single.blocks.level().terms > 0 ? 1 : 0;
    std::copy(level.begin() + skip, level.end(), recording.parameters.level.begin() + 1);
    recording.parameters.level[0] = level_of(single) / scales.population->force;
    recording.parameters.values.segment<4>(kRelaxation) = single.blocks.parameters.values.segment<4>(kRelaxation);
    recording.parameters.values(kStiffnessDrift) = single.blocks.parameters.values(kStiffnessDrift);
    recording.parameters.values(kDifference) = mean_onset_force(single) / scales.population->force;
    recording.parameters.cycles = single.blocks.parameters.cycles;
    solution.recordings.push_back(std::move(recording));
  }
  return solution;
}

class SweepFitter {
 public:
  SweepFitter(const SweepData& data, const HeldParameters& held) : data_(data), fixed_(held) {}

  [[nodiscard]] std::optional<SweepSolution> fit_rig(RigFit kind) const {
    const Kind rig{FrictionLaw::Coulomb, kind == RigFit::StiffnessGrows};
    std::optional<SweepSolution> draft = draft_of(rig, {false, false});
    return kind == RigFit::Rough ? std::move(draft) : finished(std::move(draft), rig);
  }

  [[nodiscard]] std::optional<SweepFits> fit() const {
    constexpr Sharing kAll{true, true};
    std::optional<SweepSolution> velocity = with_shares({FrictionLaw::Exponential}, kAll).agreed;
    if (!velocity) return std::nullopt;
    SweepFits fits{*std::move(velocity), std::nullopt};
    const Sharing shares = fits.velocity.sweep.sharing;
    Shares coulomb = with_shares({FrictionLaw::Coulomb}, shares);
    if (coulomb.most) {
      constexpr double kExtra = 2.0;  // slope and rate
      fits.coulomb_chi2 = coulomb.most->chi2;
      fits.p_value = chance(coulomb.most->chi2 - fits.velocity.chi2, kExtra, fits.velocity);
      // Friction that depends on the speed may explain levels that differ under Coulomb friction.
      fits.coulomb = std::move(coulomb.agreed ? coulomb.agreed : coulomb.most);
      fits.growing = with_growing_stiffness(*fits.coulomb);
    }
    fits.depends_on_speed = fits.p_value < thresholds::kSignificant;
    return fits;
  }

 private:
  struct Kind {
    FrictionLaw law = FrictionLaw::Coulomb;
    bool stiffness_grows = false;  ///< with the speed
  };

  /// Chance of such a gain in chi2 by `extra` parameters (or constraints taken off).
  static double chance(double gain, double extra, const SweepSolution& rich) {
    const double ratio = gain / extra / (rich.chi2 / rich.degrees_of_freedom);
    if (!(ratio > 0.0)) return 1.0;
    return fisher_above(ratio, extra, rich.degrees_of_freedom);
  }

  /// Sets the starting values to the medians of the recordings' own fits.
  void set_start(SweepSolution& solution) const {
    Coordinates first = Coordinates::Zero();
    for (const Coordinate i : {kLogStiffness, kLogFrequency, kDamping}) {
      std::vector<double> values;
      for (const std::size_t r : data_.fitted) values.push_back(data_.single[r]->blocks.parameters.values(i));
      first(i) = signal::median(values);
    }
    first(kDamping) = std::clamp(first(kDamping), 0.0, 0.3);
    if (fixed_.stiffness_N_per_m) first(kLogStiffness) = std::log(*fixed_.stiffness_N_per_m);
    if (fixed_.natural_frequency_rad_per_s) first(kLogFrequency) = std::log(*fixed_.natural_frequency_rad_per_s);
    if (fixed_.damping_ratio) first(kDamping) = *fixed_.damping_ratio;
    for (BlockFit& recording : solution.recordings) {
      recording.parameters.values.head<kOfSlip>() = first.head<kOfSlip>();
    }
    std::vector<double> levels;
    std::vector<double> differences;
    for (const BlockFit& recording : solution.recordings) {
      levels.push_back(recording.parameters.level[0]);
      differences.push_back(recording.parameters.values(kDifference));
    }
    for (BlockFit& recording : solution.recordings) {
      if (solution.sweep.sharing.level) recording.parameters.level[0] = signal::median(levels);
      if (solution.sweep.sharing.difference) recording.parameters.values(kDifference) = signal::median(differences);
    }
  }

  /// The best of starts from the recordings' own fits at several rates: a wrong sign of alpha is a minimum of its own.
  [[nodiscard]] std::optional<SweepSolution> draft_of(const Kind& kind, Sharing sharing) const {
    SweepSolution start = start_of(data_, sharing, kind.law);
    set_start(start);
    const Held held = held_of(fixed_);
    if (kind.law == FrictionLaw::Coulomb) return existing(drafted(std::move(start), held, kRoughly));
    Held quick = held;
    quick[kFrictionRate] = true;
    constexpr std::array kStartRates{-1.0, 1.0, -4.0};
    std::vector<SweepSolution> drafts = in_parallel(kStartRates.size(), [&](std::size_t i) {
      SweepSolution at_rate = start;
      for (BlockFit& recording : at_rate.recordings) recording.parameters.values(kFrictionRate) = kStartRates[i];
      return drafted(std::move(at_rate), quick, kRoughly);
    });
    const auto best = std::ranges::min_element(drafts, {}, &SweepSolution::chi2);
    return std::isfinite(best->chi2) ? existing(drafted(std::move(*best), held, kCompared)) : std::nullopt;
  }

  /// Empty where the model has no solution.
  static std::optional<SweepSolution> existing(SweepSolution solution) {
    return std::isfinite(solution.chi2) ? std::optional(std::move(solution)) : std::nullopt;
  }

  /// The minimum of all cycles from a draft on.
  [[nodiscard]] std::optional<SweepSolution> finished(std::optional<SweepSolution> draft, const Kind& kind) const {
    if (!draft) return std::nullopt;
    const Held held = held_of(fixed_);
    if (kind.stiffness_grows) return with_exponent(*std::move(draft), held);
    return at_minimum(*std::move(draft), held, kind.law == FrictionLaw::Coulomb ? Accuracy{} : kCompared);
  }

  [[nodiscard]] std::optional<SweepSolution> fit(const Kind& kind, Sharing sharing) const {
    return finished(draft_of(kind, sharing), kind);
  }

  /// Fits of one kind.
  struct Shares {
    std::optional<SweepSolution> most;    ///< that share as much as they may
    std::optional<SweepSolution> agreed;  ///< that share as much of that as the data agree with
  };

  /// Sharing both, then one of the two, else nothing. `most`: what may be shared.
  [[nodiscard]] Shares with_shares(const Kind& kind, Sharing most) const {
    const auto fits = [&](std::initializer_list<Sharing> sharings) {
      return in_parallel(sharings.size(), [&](std::size_t i) { return fit(kind, sharings.begin()[i]); });
    };
    std::vector<std::optional<SweepSolution>> ends = most == Sharing{} ? fits({most}) : fits({most, {}});
    Shares shares{ends.front(), std::move(ends.back())};
    std::optional<SweepSolution>& free = shares.agreed;
    if (!free) return shares;
    const auto is_taken = [&](const std::optional<SweepSolution>& shared) {
      if (!shared) return false;
      // With more freedom no fit can be worse: where it is, it had ended in another minimum.
      if (shared->chi2 < free->chi2) {
        std::optional<SweepSolution> better = released(*shared);
        if (better && better->chi2 < free->chi2) free = std::move(better);
      }
      return chance_of_sharing(*shared, *free) > thresholds::kProven;
    };
    if (is_taken(shares.most)) return {shares.most, shares.most};
    if (!most.level || !most.difference) return shares;
    for (std::optional<SweepSolution>& shared : fits({{false, true}, {true, false}})) {
      if (is_taken(shared)) return {std::move(shares.most), std::move(shared)};
    }
    return shares;
  }

  /// Returns the fit with k that depends on the speed; empty where one k of all recordings explains them.
  [[nodiscard]] std::optional<SweepSolution> with_growing_stiffness(const SweepSolution& same) const {
    const bool may_grow = !fixed_.stiffness_N_per_m && same.can_show_trend(thresholds::kFewestRecordings);
    if (!may_grow) return std::nullopt;
    const std::optional<SweepSolution> growing = with_exponent(same, same.held);
    if (!growing || !(chance(same.chi2 - growing->chi2, 1.0, *growing) < thresholds::kSignificant)) return std::nullopt;
    return with_shares({FrictionLaw::Coulomb, true}, {true, true}).agreed;
  }

  /// Returns the probability of so much more misfit by what the recordings share.
  [[nodiscard]] double chance_of_sharing(const SweepSolution& shared, const SweepSolution& free) const {
    const Sharing& sharing = shared.sweep.sharing;
    const double steady = sharing.level ? static_cast<double>(data_.steady.size()) : 0.0;
    const double shared_kinds = (sharing.level ? 1.0 : 0.0) + (sharing.difference ? 1.0 : 0.0);
    const double constraints = static_cast<double>(data_.fitted.size() - 1) * shared_kinds + steady;
    return chance(shared.chi2 - free.chi2, constraints, free);
  }

  /// Returns the solution with nothing shared, started from a shared one.
  [[nodiscard]] static std::optional<SweepSolution> released(const SweepSolution& shared) {
    SweepSolution free = shared;
    free.sweep.sharing = {};
    return at_minimum(std::move(free), shared.held, kCompared);
  }

  const SweepData& data_;
  HeldParameters fixed_;
};

}  // namespace

std::optional<SweepSolution> fit_rig(const SweepData& data, const HeldParameters& held, RigFit kind) {
  return SweepFitter(data, held).fit_rig(kind);
}

std::optional<SweepFits> solve_sweep(const SweepData& data, const FitOptions& options) {
  if (!data.mass) return SweepFitter(data, options.held).fit();
  constexpr int kMostRounds = 3;
  constexpr double kSmallChange = 1e-3;  // of ln w_n: k hardly depends on it
  HeldParameters held = options.held;
  std::vector<double> logs;
  for (const std::size_t i : data.fitted) logs.push_back(data.single[i]->blocks.parameters.values(kLogStiffness));
  double stiffness = std::exp(signal::median(std::move(logs)));
  const auto log_stiffness = [](const SweepSolution& solution) {
    return solution.recordings.front().parameters.values(kLogStiffness);
  };
  std::optional<SweepFits> fits;
  for (int round = 0; round < kMostRounds; ++round) {
    held.natural_frequency_rad_per_s = data.mass->frequency_rad_per_s(stiffness);
    fits = SweepFitter(data, held).fit();
    if (!fits) return fits;
    const SweepSolution& solution = fits->coulomb ? *fits->coulomb : fits->velocity;
    const double next = std::exp(log_stiffness(solution));
    if (std::abs(std::log(next / std::exchange(stiffness, next))) < 2.0 * kSmallChange) break;
  }
  for (int round = 0; round < kMostRounds && fits->growing; ++round) {
    const Coordinates& values = fits->growing->recordings.front().parameters.values;
    const double log_frequency = std::log(data.mass->frequency_rad_per_s(std::exp(log_stiffness(*fits->growing))));
    const double change = log_frequency - values(kLogFrequency);
    if (std::abs(change) < kSmallChange) break;
    fits->growing = with_held(*fits->growing, kLogFrequency, change);
  }
  return fits;
}

}  // namespace slipfit::fit
