#include "verdict.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "signal/robust.hpp"

namespace slipfit {
namespace {

// The bounds lie in gaps between recordings of known kind (docs/accuracy.md): residual over onset force is below 0.03
// for simulated and 0.04-0.10 for measured stick-slip, above 0.15 for noise, hum and random walks.
constexpr double kCloseFit = 0.1;
constexpr double kLooseFit = 0.2;
constexpr double kModestSpread = 0.5;  // sd over mean of the onset force, where the fit is loose
constexpr double kWideSpread = 0.7;    // where it is close
constexpr double kRestickShare = 0.8;
// A fall nearly as slow as a sine's leaves room for little stick: then only a close fit in which every slip comes to
// rest (simulated cycles just above the limit: residual below 0.02, all of them) shows that there is any.
constexpr double kSineFall = 0.17;
constexpr double kSineRestickShare = 0.95;
constexpr double kSineFit = 0.05;
constexpr double kDecay = 1.7;      // onset force, first half over second half: a ring-down
constexpr double kSpanShare = 0.5;  // cycles cover less of the recording: they died out
constexpr double kMuchHum = 0.1;    // hum over the onset force: less cannot pass for a slip
constexpr double kMainsRhythm =
    5e-3;                            // the mains keeps its frequency to 0.1 %, intervals of few samples are less exact
constexpr double kNoiseDrop = 14.0;  // drop over noise below which turning points may be noise alone

/// Time of the fall from 80 % to 20 % over the period, median: 0.205 for a sine, 0.3 for an even triangle, less for
/// slips.
double fall_share(const Segmentation& segmentation) {
  std::vector<double> shares;
  for (std::size_t i = 1; i < segmentation.slips.size(); ++i) {
    const double period_s = segmentation.slips[i].middle_s - segmentation.slips[i - 1].middle_s;
    shares.push_back(segmentation.slips[i].fall_s / period_s);
  }
  return signal::median(shares);
}

/// Noise alone makes turning points of this size.
bool is_faint(const Quality& quality, const Segmentation& segmentation) {
  return median_drop(segmentation) < kNoiseDrop * quality.noise_rms;
}

bool is_sine_like(const Segmentation& segmentation) {
  return fall_share(segmentation) > kSineFall;
}

bool no_repetition(const SpectralFrequency& spectral) {
  return !spectral.value_Hz;
}

/// The second half of the recording moves little compared with the first swings: the motion died out.
bool ends_flat(const Recording& recording, const Segmentation& segmentation) {
  const double last_s = segmentation.slips.empty() ? recording.time_s().front() : segmentation.slips.back().middle_s;
  return last_s - recording.time_s().front() < kSpanShare * recording.duration_s();
}

std::optional<Judgement> judge_counts(const Recording& recording, const Quality& quality,
                                      const Segmentation& segmentation, const SpectralFrequency& spectral) {
  const std::size_t count = segmentation.slips.size();
  if (count == 0) return Judgement{Verdict::SteadySliding, "the force has no falls beyond its noise"};
  if (is_faint(quality, segmentation) && no_repetition(spectral)) {
    return Judgement{Verdict::SteadySliding, "the force moves no more than its noise, without repetition"};
  }
  if (count < 3) {
    if (ends_flat(recording, segmentation)) {
      return Judgement{Verdict::SteadySliding, fmt::format("{} fall(s) at the start, then no more", count)};
    }
    return Judgement{Verdict::Undetermined,
                     fmt::format("only {} slip(s): at least 3 are needed; record longer", count)};
  }
  const double cycle_samples = (segmentation.slips.back().middle_s - segmentation.slips.front().middle_s) /
                               static_cast<double>(count - 1) / recording.sample_interval_s();
  if (cycle_samples < 4.0) {
    return Judgement{Verdict::Undetermined,
                     fmt::format("{:.1f} samples a cycle are too few to see slips; sample at least {:.0f} times faster",
                                 cycle_samples, std::ceil(20.0 / cycle_samples))};
  }
  return std::nullopt;
}

/// Swings without sticks that can be told; empty where slips come to rest.
std::optional<Judgement> judge_round_swings(const Quality& quality, const Segmentation& segmentation,
                                            const Evidence& e) {
  const bool sine_like = is_sine_like(segmentation);
  if ((sine_like || e.restick_share < kRestickShare) && is_faint(quality, segmentation)) {
    return Judgement{Verdict::Undetermined,
                     "the swings are not much larger than the noise: no sticks can be told from it"};
  }
  if (sine_like && (e.restick_share < kSineRestickShare || e.relative_residual > kSineFit)) {
    return Judgement{Verdict::OscillatorySlip, "nearly sinusoidal: no straight sticks can be told from an oscillation"};
  }
  if (e.restick_share < kRestickShare) {
    return Judgement{Verdict::OscillatorySlip,
                     fmt::format("{:.0f} % of the slips do not come to rest: oscillation without straight sticks",
                                 100.0 * (1.0 - e.restick_share))};
  }
  return std::nullopt;
}

}  // namespace

double median_drop(const Segmentation& segmentation) {
  std::vector<double> drops;
  for (const DetectedSlip& slip : segmentation.slips) drops.push_back(slip.drop());
  return signal::median(drops);
}

double mains_share(const Segmentation& segmentation) {
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < segmentation.slips.size(); ++i) {
    periods_s.push_back(segmentation.slips[i].middle_s - segmentation.slips[i - 1].middle_s);
  }
  const double period_s = signal::median(std::move(periods_s));
  const double at_50 = period_s * 50.0;
  const double at_60 = period_s * 60.0;
  return std::abs(at_50 - 1.0) < std::abs(at_60 - 1.0) ? at_50 : at_60;
}

bool slips_stand_out(const Quality& quality, const Segmentation& segmentation) {
  return !is_faint(quality, segmentation) && !is_sine_like(segmentation);
}

Judgement judge_fit(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
                    const SpectralFrequency& spectral, const FitResult* fit) {
  if (auto early = judge_counts(recording, quality, segmentation, spectral)) return *early;
  if (fit == nullptr) {
    return {Verdict::Undetermined, "fewer than 3 cycles have enough samples on both ramps and can be fitted"};
  }
  const Evidence& e = fit->evidence;
  std::size_t used = 0;
  for (const Cycle& cycle : fit->cycles) used += cycle.used ? 1 : 0;
  if (used < 5 && (e.onset_force_spread > 0.2 || e.relative_residual > 0.04)) {
    return {Verdict::Undetermined, fmt::format("only {} usable cycles, and they do not agree", used)};
  }
  // Hum as large as the drop is what the detector sees, and the fit that follows it finds wrong slips good.
  if (is_sine_like(segmentation) && e.hum_share > kMuchHum) {
    return {Verdict::Undetermined, "the swings are as round as the mains hum in them: it hides what else there is"};
  }
  const bool close = e.relative_residual < kCloseFit && e.onset_force_spread < kWideSpread;
  const bool loose = e.relative_residual < kLooseFit && e.onset_force_spread < kModestSpread;
  const bool died = e.decay > kDecay || e.span_share < kSpanShare;
  if (died && (close || loose || e.restick_share < kRestickShare)) {
    return {Verdict::OscillatorySlip, "the swings die out: a ring-down to steady sliding"};
  }
  if (!close && !loose) {
    return {
        Verdict::Undetermined,
        fmt::format("the swings are no stick-slip cycles: residual {:.0f} % of the friction drop, its spread {:.0f} %",
                    100.0 * e.relative_residual, 100.0 * e.onset_force_spread)};
  }
  if (is_sine_like(segmentation) && std::abs(mains_share(segmentation) - 1.0) < kMainsRhythm) {
    return {Verdict::Undetermined, "nearly sinusoidal swings at the rhythm of the mains: they may be its hum"};
  }
  if (auto round = judge_round_swings(quality, segmentation, e)) return *round;
  return {Verdict::StickSlip,
          fmt::format("{} cycles of straight sticks and quick slips, residual {:.1f} % of the friction drop", used,
                      100.0 * e.relative_residual)};
}

Judgement judge_shape(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
                      const SpectralFrequency& spectral) {
  if (auto early = judge_counts(recording, quality, segmentation, spectral)) return *early;
  if (is_faint(quality, segmentation)) {
    return {Verdict::Undetermined, "the falls are not much larger than the noise: only a fit can tell"};
  }
  if (!is_sine_like(segmentation)) {
    return {Verdict::StickSlip, "the force falls much faster than it rises (no model fitted)"};
  }
  return {Verdict::Undetermined, "the force falls about as slowly as it rises: only a fit can tell"};
}

}  // namespace slipfit
