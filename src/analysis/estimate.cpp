#include "analysis/estimate.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <future>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/detect.hpp"
#include "analysis/harmonic_null.hpp"
#include "analysis/ranges.hpp"
#include "core/parallel.hpp"
#include "core/thresholds.hpp"
#include "fit/fit_unless.hpp"
#include "signal/smoothing.hpp"

namespace slipfit {
namespace {

struct TimedFrequency {
  SpectralFrequency spectral;
  double seconds = 0.0;
};

TimedFrequency frequency_of(const Recording& recording, const Signals& signals) {
  const Stopwatch stopwatch;
  const std::vector<bool>& impulses = signals.quality.impulse_mask;
  const Spectrum spectrum = compute_spectrum(recording, impulses);
  // A count of noise or hum would draw the spectrum to its own multiple.
  const Estimate counted = count_frequency(recording, signals.segmentation);
  const Segmentation& slips = signals.segmentation;
  const bool are_slips = slips_stand_out(slips) || (!is_faint(slips) && phase_wanders(slips) && keeps_rhythm(slips));
  const std::optional<double> hint_Hz = are_slips ? counted.value : std::nullopt;
  SpectralFrequency spectral = find_frequency(recording, spectrum, hint_Hz, impulses);
  return {std::move(spectral), stopwatch.elapsed_s()};
}

double misfit_of(double relative_residual, double onset_force_spread) {
  return relative_residual + 0.3 * onset_force_spread;
}

/// Returns the misfit of the cycles: residual and spread over the onset force. A missing fit is the worst, and so is
/// one with cycles in less than half of the detected slips, which are then not slips: subtracting a rhythm near the
/// mains as hum leaves such remains.
double misfit_of(const std::optional<FitResult>& fit) {
  if (!fit || leaves_out_most(*fit)) return std::numeric_limits<double>::infinity();
  return misfit_of(fit->diagnostics.relative_residual, fit->diagnostics.onset_force_spread);
}

/// So many neighbouring slips, as found in the whole, from the middle of a recording that has two more.
Excerpt excerpt_of(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
                   std::size_t slips) {
  const std::vector<DetectedSlip>& all = segmentation.slips;
  assert(all.size() >= slips + 2);
  const auto first = static_cast<std::ptrdiff_t>((all.size() - slips) / 2);
  const auto last = first + static_cast<std::ptrdiff_t>(slips);
  const std::size_t begin = (all.begin() + first - 1)->trough;
  const std::size_t end = (all.begin() + last)->peak + 1;
  Excerpt excerpt{recording.part(begin, end), quality, segmentation};
  if (!quality.impulse_mask.empty()) {
    const auto mask = quality.impulse_mask.begin();
    excerpt.quality.impulse_mask.assign(mask + static_cast<std::ptrdiff_t>(begin),
                                        mask + static_cast<std::ptrdiff_t>(end));
  }
  excerpt.segmentation.slips.assign(all.begin() + first, all.begin() + last);
  for (DetectedSlip& slip : excerpt.segmentation.slips) {
    slip.peak -= begin;
    slip.trough -= begin;
  }
  excerpt.segmentation.sliding_begin = 0;
  excerpt.segmentation.sliding_end = end - begin;
  return excerpt;
}

/// Decides whether lines of the mains conceal slips or resemble them: detects the slips after subtraction and compares
/// the fits.
class BeneathHum {
 public:
  BeneathHum(const Recording& recording, const FitOptions& options) : recording_(recording), options_(options) {}

  /// A few neighbouring slips are fitted so much better beneath the mains that the fit of those seen is not needed.
  /// Where it is so much worse, all of them are not tried. For recordings of many slips.
  [[nodiscard]] bool is_sure(const Signals& seen) {
    find_slips(seen);
    if (!slips_ || std::min(slips_->slips.size(), seen.segmentation.slips.size()) < kFewSlips + 2) return false;
    const double ratio = misfit_of_few(seen.quality, *slips_) / misfit_of_few(seen.quality, seen.segmentation);
    if (ratio > kSure) slips_.reset();
    is_sure_ = kSure * ratio < thresholds::kClearlyBetter;
    return is_sure_;
  }

  /// Lines of the mains in the level take up some noise by themselves: a fit beneath them has to be clearly better.
  [[nodiscard]] Estimates better_of(Estimates seen) {
    find_slips(seen.signals);
    const Quality& quality = seen.signals.quality;
    if (!slips_ || should_abort(quality, misfit_of(seen.fit))) return seen;
    std::optional<FitResult> other = fit_recording(recording_, quality, *slips_, options_);
    const double misfit = misfit_of(other);
    if (is_sure_ && !std::isfinite(misfit)) {
      seen.fit = fit_recording(recording_, quality, seen.signals.segmentation, options_);
    }
    if (!(misfit < thresholds::kClearlyBetter * misfit_of(seen.fit))) return seen;
    seen.signals.segmentation = *std::move(slips_);
    seen.signals.spectral = frequency_of(recording_, seen.signals).spectral;
    seen.fit = std::move(other);
    return seen;
  }

 private:
  static constexpr std::size_t kFewSlips = 64;
  static constexpr double kSure = 2.0;  // by which the misfit may change from a few slips, or a rough fit

  void find_slips(const Signals& seen) {
    if (!is_searched_) slips_ = find_slips_beneath_hum(recording_, seen.quality, seen.segmentation);
    is_searched_ = true;
  }

  /// Returns the misfit of a few cycles with the lines of the mains in the level.
  [[nodiscard]] double misfit_of_few(const Quality& quality, const Segmentation& segmentation) const {
    Excerpt few = excerpt_of(recording_, quality, segmentation, kFewSlips);
    few.segmentation.mains_Hz = slips_->mains_Hz;
    return rough_misfit_of(few.recording, few.quality, few.segmentation);
  }

  [[nodiscard]] double rough_misfit_of(const Recording& recording, const Quality& quality,
                                       const Segmentation& segmentation) const {
    const auto misfit = fit::rough_misfit({recording, quality, segmentation, options_.held});
    if (!misfit || 2 * misfit->cycles < segmentation.slips.size()) return std::numeric_limits<double>::infinity();
    return misfit_of(misfit->relative_residual, misfit->onset_force_spread);
  }

  /// No more slips than are tried roughly in no time, and beneath the mains they fit much worse.
  [[nodiscard]] bool should_abort(const Quality& quality, double misfit_seen) const {
    return slips_->slips.size() <= kFewSlips && std::isfinite(misfit_seen) &&
           rough_misfit_of(recording_, quality, *slips_) > kSure * misfit_seen;
  }

  const Recording& recording_;
  const FitOptions& options_;
  bool is_searched_ = false;
  bool is_sure_ = false;
  std::optional<Segmentation> slips_;
};

/// Swings that three sines follow so closely that there is no stick to fit.
bool is_pure_wave(const Recording& recording, const Signals& signals) {
  const Segmentation& segmentation = signals.segmentation;
  const double most = thresholds::kPureWave * median_drop(segmentation);
  if (segmentation.slips.size() < thresholds::kFewestCycles || signals.quality.noise_rms > most) return false;
  if (!is_sine_like(segmentation)) return false;
  const double counted_Hz = 1.0 / signal::median(slip_intervals_s(segmentation));
  const std::optional<double> rms = harmonic_residual_rms(recording, counted_Hz);
  return rms && *rms < most;
}

/// The fit of the recording under a steady drive where the position of the drive is measured and it moves unsteadily.
/// What it adds depends on the natural frequency: the fit is repeated with the new one.
Estimates against_drive(const Recording& recording, Estimates estimates, const FitOptions& options) {
  constexpr int kPasses = 3;
  const Signals& signals = estimates.signals;
  std::optional<FitResult> fit = estimates.fit;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::optional<SteadyDrive> drive = at_steady_drive(recording, signals.segmentation, fit ? &*fit : nullptr);
    if (!drive) return estimates;
    std::optional<FitResult> steady = fit_recording(drive->recording, signals.quality, signals.segmentation, options);
    if (!steady) return estimates;
    fit = steady;
    estimates.fit = as_measured(*std::move(steady), recording, *drive);
    estimates.drive = std::move(drive);
  }
  return estimates;
}

}  // namespace

double used_share(const FitResult& fit) {
  const auto used = static_cast<double>(std::ranges::count_if(fit.cycles, &Cycle::used));
  const auto offered = static_cast<double>(std::ranges::count_if(fit.cycles, &Cycle::selected));
  return offered > 0.0 ? used / offered : 1.0;
}

bool leaves_out_most(const FitResult& fit) {
  return used_share(fit) < 0.5;
}

Estimates estimate_frequency(const Detected& detected) {
  Estimates estimates{detected.signals, {}};
  TimedFrequency timed = frequency_of(detected.recording(), estimates.signals);
  estimates.signals.spectral = std::move(timed.spectral);
  estimates.frequency_s = timed.seconds;
  return estimates;
}

Estimates estimate(const Detected& detected, const FitOptions& options) {
  const Recording& recording = detected.recording();
  Estimates estimates{detected.signals, {}};
  // Named, and so copied: where there is no thread, async begins anew with what it was given.
  const auto spectrum_task = [&] { return frequency_of(recording, detected.signals); };
  std::future<TimedFrequency> frequency = std::async(launch_policy(), for_other_thread(spectrum_task));
  const auto take_frequency = [&] {
    if (!frequency.valid()) return;
    TimedFrequency timed = frequency.get();
    estimates.signals.spectral = std::move(timed.spectral);
    estimates.frequency_s = timed.seconds;
  };
  BeneathHum beneath(recording, options);
  const auto is_hum = [&] {
    take_frequency();
    return may_be_hum(estimates.signals) && beneath.is_sure(estimates.signals);
  };
  const Stopwatch stopwatch;
  const Signals& seen = estimates.signals;
  const bool is_wave = is_pure_wave(recording, seen);
  if (!is_wave) estimates.fit = fit::fit_unless(is_hum, recording, seen.quality, seen.segmentation, options);
  take_frequency();
  if (!is_wave && may_be_hum(estimates.signals)) estimates = beneath.better_of(std::move(estimates));
  if (!is_wave) estimates = against_drive(recording, std::move(estimates), options);
  if (estimates.fit) estimates.fit = in_range(*std::move(estimates.fit), recording.conditions());
  estimates.fit_s = stopwatch.elapsed_s();
  return estimates;
}

bool may_be_hum(const Signals& signals) {
  const double drop = median_drop(signals.segmentation);
  for (const SuspiciousLine& line : signals.spectral.suspicious_lines) {
    if (line.swing >= kHarmlessHum * drop) return true;
  }
  const double share = mains_share(signals.segmentation);
  return share > 0.9 && share < 1.1;
}

}  // namespace slipfit
