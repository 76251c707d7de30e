#include "fit/sweep/own_fits.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/parallel.hpp"
#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/intervals.hpp"
#include "fit/selection/average_term.hpp"
#include "fit/selection/damped_fit.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/rise.hpp"
#include "fit/selection/rise_term.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {

namespace {

/// Mean by their errors; empty where they differ by more than these.
std::optional<FittedAverage> mean_of(const std::vector<FittedAverage>& averages) {
  std::vector<Measured> measured;
  measured.reserve(averages.size());
  for (const FittedAverage& one : averages) measured.push_back({one.seconds, one.standard_error_s});
  const WeightedMean mean = weighted_mean(measured);
  if (mean.chance < thresholds::kProven) return std::nullopt;
  // Most of each error is the unknown shape of the kernel, which all share: the mean is known no better than one.
  double error_s = averages.front().standard_error_s;
  for (const FittedAverage& one : averages) error_s = std::min(error_s, one.standard_error_s);
  return FittedAverage{mean.value, error_s};
}

/// Returns the averaging, not stated by the user, that one recording shows; empty where it does not determine it.
std::optional<Smoothing> rounding_of(const SweepRecording& sweep, const DampedFit& fit) {
  if (sweep.recording.conditions().sensor_average_s) return std::nullopt;
  if (fit.average) {
    const double average_s = fit.average->seconds;
    return Smoothing{average_s * average_s / 12.0, average_s * fit.average->standard_error_s / 6.0};
  }
  return repeats_rounding(fit) ? std::nullopt : fit.rounding;
}

/// Mean of the lengths that the recordings find for the rise after a slip, by their errors; empty where none does.
std::optional<double> mean_length_m(const std::vector<std::optional<DampedFit>>& fits) {
  std::vector<Measured> measured;
  for (const auto& fit : fits) {
    if (!fit || !fit->blocks.level().reloading) continue;
    measured.push_back({fit->blocks.parameters.values(kReloadLength), error_of(*fit, kReloadLength)});
  }
  return measured.empty() ? std::nullopt : std::optional(std::exp(weighted_mean(measured).value));
}

class OwnFitter {
 public:
  OwnFitter(std::span<const SweepRecording> recordings, const HeldParameters& held,
            const std::optional<FittedAverage>& known)
      : recordings_(recordings), held_(held), known_(known) {}

  [[nodiscard]] OwnFits fit() const {
    OwnFits own;
    own.single = of_each([this](std::size_t i) {
      return recordings_[i].role == SweepRole::Cycles ? own_draft(input(i)) : std::nullopt;
    });
    share_length(own);
    own.single = of_each([&](std::size_t i) {
      std::optional<DampedFit> fit = std::move(own.single[i]);
      const bool is_open = fit && (!known_ || states_average(i));
      return is_open ? fit_as_sensed(input(i), *std::move(fit)) : std::move(fit);
    });
    if (known_) return averaged(own, *known_);
    share_average(own);
    if (!own.average) own.rounding_s2 = common_rounding_s2(recordings_, own.single);
    return own;
  }

 private:
  /// Fits the recordings side by side: `fit_of` gives the fit of the recording with this index.
  template <class FitOf>
  [[nodiscard]] std::vector<std::optional<DampedFit>> of_each(const FitOf& fit_of) const {
    return in_parallel(recordings_.size(), fit_of);
  }

  [[nodiscard]] FitInput input(std::size_t i) const {
    return {recordings_[i].recording, recordings_[i].quality, recordings_[i].segmentation, held_};
  }

  /// Returns the draft of a recording. A rise that is known only behind an average has the length that it has there.
  [[nodiscard]] static std::optional<DampedFit> own_draft(const FitInput& input) {
    std::optional<RiseDraft> draft = draft_with_rise(input);
    if (!draft) return std::nullopt;
    const std::optional<DampedFit> behind = rise_behind_average(input, *draft);
    if (!behind) return std::move(draft->fit);
    DampedFit& risen = *draft->unproven;
    risen.blocks.parameters.values(kReloadLength) = behind->blocks.parameters.values(kReloadLength);
    risen.uncertainty.covariance(kReloadLength, kReloadLength) = std::pow(error_of(*behind, kReloadLength), 2);
    return std::move(draft->unproven);
  }

  [[nodiscard]] bool states_average(std::size_t i) const {
    return recordings_[i].recording.conditions().sensor_average_s.has_value();
  }

  /// Fits all recordings with the common length: those that are too fast to determine it only where it explains them
  /// better.
  void share_length(OwnFits& own) const {
    own.reload_length_m = mean_length_m(own.single);
    if (!own.reload_length_m) return;
    own.single = of_each([&](std::size_t i) {
      std::optional<DampedFit> fit = std::move(own.single[i]);
      if (!fit) return fit;
      auto other = draft_with_rise_over(*own.reload_length_m, input(i), *fit);
      const bool is_better = other && (fit->blocks.level().reloading || gain_of(*other, *fit) > 0.0);
      return is_better ? std::move(other) : std::move(fit);
    });
  }

  void share_average(OwnFits& own) const {
    std::vector<FittedAverage> averages;
    std::size_t open = 0;
    for (std::size_t i = 0; i < recordings_.size(); ++i) {
      if (!own.single[i] || states_average(i)) continue;
      ++open;
      if (own.single[i]->average) averages.push_back(*own.single[i]->average);
    }
    if (averages.empty()) return;
    const std::optional<FittedAverage> average = mean_of(averages);
    if (!average) return;
    OwnFits together = averaged(own, *average);
    double gain = 0.0;
    for (std::size_t i = 0; i < recordings_.size(); ++i) {
      if (!own.single[i] || states_average(i)) continue;
      if (together.single[i] && !own.single[i]->average) gain += gain_of(*together.single[i], *own.single[i]);
    }
    if (2 * averages.size() < open && !(gain > thresholds::kTierPrice)) return;
    own = std::move(together);
  }

  /// All recordings that state none seen through this average.
  [[nodiscard]] OwnFits averaged(const OwnFits& own, const FittedAverage& average) const {
    OwnFits other = own;
    other.single = of_each([&](std::size_t i) {
      const bool is_open = own.single[i] && !states_average(i);
      return is_open ? fit_averaged(i, average, *own.single[i], own.reload_length_m) : own.single[i];
    });
    other.average = average;
    return other;
  }

  [[nodiscard]] std::optional<DampedFit> fit_averaged(std::size_t i, const FittedAverage& average, const DampedFit& own,
                                                      const std::optional<double>& length_m) const {
    const Recording recording = with_average(recordings_[i].recording, average.seconds);
    const FitInput averaged{recording, recordings_[i].quality, recordings_[i].segmentation, held_};
    std::optional<DampedFit> fit = draft_damped(averaged);
    if (fit && length_m && own.blocks.level().reloading) {
      std::optional<DampedFit> risen = draft_with_rise_over(*length_m, averaged, *fit);
      if (risen) fit = std::move(risen);
    }
    if (fit) fit = finish_fit(averaged, *std::move(fit));
    if (fit) fit->average = average;
    return fit;
  }

  std::span<const SweepRecording> recordings_;
  const HeldParameters& held_;
  const std::optional<FittedAverage>& known_;
};

double median_stiffness(const OwnFits& own) {
  std::vector<double> stiffnesses;
  for (const auto& fit : own.single) {
    if (fit) stiffnesses.push_back(std::exp(fit->blocks.parameters.values(kLogStiffness)));
  }
  return median(std::move(stiffnesses));
}

/// Returns the mass that all recordings state, where averaging obscures w_n in all of them.
std::optional<StatedMass> common_mass(std::span<const SweepRecording> recordings, const OwnFits& own,
                                      const HeldParameters& held) {
  std::optional<StatedMass> common;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (!own.single[i]) continue;
    const double average_s = own.single[i]->blocks.sensor().average_s;
    const auto mass = mass_for_frequency(recordings[i].recording.conditions(), held, median_stiffness(own), average_s);
    if (!mass || (common && mass->kg != common->kg)) return std::nullopt;
    common = mass;
  }
  return common;
}

/// Residuals of all recordings, each over its own before.
bool explains_as_well(const OwnFits& with_mass, const OwnFits& free) {
  double square = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < free.single.size(); ++i) {
    if (!free.single[i]) continue;
    if (!with_mass.single[i]) return false;
    square += std::pow(with_mass.single[i]->uncertainty.noise / free.single[i]->uncertainty.noise, 2);
    count += 1.0;
  }
  return std::sqrt(square / count) < thresholds::kContradictedMass;
}

/// The recordings together determine the length of the rise.
OwnFits with_free_rises(OwnFits own) {
  for (std::optional<DampedFit>& fit : own.single) {
    if (fit) fit->blocks = with_free_rise(fit->blocks);
  }
  return own;
}

}  // namespace

std::optional<double> common_rounding_s2(std::span<const SweepRecording> recordings,
                                         const std::vector<std::optional<DampedFit>>& fits) {
  std::vector<Measured> measured;
  double longest_step_s = 0.0;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const std::optional<Smoothing> seen = fits[i] ? rounding_of(recordings[i], *fits[i]) : std::nullopt;
    if (!seen || !(seen->standard_error_s2 > 0.0)) continue;
    measured.push_back({seen->variance_s2, seen->standard_error_s2});
    longest_step_s = std::max(longest_step_s, recordings[i].recording.sample_interval_s());
  }
  if (measured.empty()) return std::nullopt;
  const WeightedMean mean = weighted_mean(measured);
  const Smoothing together{mean.value, mean.standard_error};
  return together.exceeds_step(longest_step_s) ? std::optional(together.largest_variance_s2()) : std::nullopt;
}

OwnFits fit_each(std::span<const SweepRecording> recordings, const HeldParameters& held,
                 const std::optional<FittedAverage>& known) {
  OwnFits own = OwnFitter(recordings, held, known).fit();
  const std::optional<StatedMass> mass = common_mass(recordings, own, held);
  if (!mass) return with_free_rises(std::move(own));
  // As with a stated average, where one was found
  std::vector<Recording> averaged;
  for (const SweepRecording& one : recordings) {
    const Recording& recording = one.recording;
    const bool is_open = own.average && !recording.conditions().sensor_average_s;
    averaged.push_back(is_open ? with_average(recording, own.average->seconds) : recording);
  }
  std::vector<SweepRecording> sweep;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    sweep.push_back({averaged[i], recordings[i].quality, recordings[i].segmentation, recordings[i].role});
  }
  HeldParameters by_mass = held;
  by_mass.natural_frequency_rad_per_s = mass->frequency_rad_per_s(median_stiffness(own));
  OwnFits with_mass = OwnFitter(sweep, by_mass, {}).fit();
  if (!explains_as_well(with_mass, own)) return with_free_rises(std::move(own));
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (with_mass.single[i] && own.single[i]) with_mass.single[i]->average = own.single[i]->average;
  }
  with_mass.average = own.average;
  with_mass.mass = mass;
  return with_free_rises(std::move(with_mass));
}

}  // namespace slipfit::fit
