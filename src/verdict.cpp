#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
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
// Rise over fall, in time: 1 for waves and noise; at least 2.3 for straight sticks where the fall is below kSineFall.
constexpr double kSudden = 3.0;
constexpr double kSuddenShare = 0.9;
constexpr double kSquare = 1.3;
constexpr std::size_t kFewestSudden = 5;
constexpr double kRhythm = 0.25;  // scatter over mean of the intervals of what repeats
constexpr double kRipple = 0.1;   // of the mean force: smaller round swings are pick-up or ripple on steady sliding

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
bool is_faint(const Segmentation& segmentation) {
  return median_drop(segmentation) < kNoiseDrop * segmentation.noise;
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// How much longer the rises take than the falls before them, cycle by cycle.
std::vector<double> rises_over_falls(const Segmentation& segmentation) {
  std::vector<double> ratios;
  for (const DetectedSlip& slip : segmentation.slips) {
    if (slip.rise_s > 0.0 && slip.fall_s > 0.0) ratios.push_back(slip.rise_s / slip.fall_s);
  }
  return ratios;
}

/// Intervals between the falls scatter no more than those of a repetition do.
bool keeps_rhythm(const Segmentation& segmentation) {
  double mean = 0.0, square = 0.0, count = 0.0;
  for (std::size_t i = 1; i < segmentation.slips.size(); ++i) {
    const double interval_s = segmentation.slips[i].middle_s - segmentation.slips[i - 1].middle_s;
    count += 1.0;
    const double step = interval_s - mean;
    mean += step / count;
    square += step * (interval_s - mean);
  }
  return count > 1.0 && std::sqrt(square / (count - 1.0)) < kRhythm * mean;
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

/// All falls lie close together near the end, and the force does not rise again: the release and its ring-down.
bool is_release(const Recording& recording, const Segmentation& segmentation) {
  const DetectedSlip& last = segmentation.slips.back();
  const auto after = recording.force().subspan(last.trough);
  if (*std::max_element(after.begin(), after.end()) > last.trough_force + 0.5 * last.drop()) return false;
  const double first_s = segmentation.slips.front().middle_s - recording.time_s().front();
  const double last_s = segmentation.slips.back().middle_s - recording.time_s().front();
  return first_s > kSpanShare * recording.duration_s() && last_s - first_s < 0.3 * recording.duration_s();
}

std::optional<Judgement> judge_counts(const Recording& recording, const Segmentation& segmentation,
                                      const SpectralFrequency& spectral) {
  const std::size_t count = segmentation.slips.size();
  if (count == 0) return Judgement{Verdict::SteadySliding, "the force has no falls beyond its noise"};
  if (is_faint(segmentation) && no_repetition(spectral)) {
    return Judgement{Verdict::SteadySliding, "the force moves no more than its noise, without repetition"};
  }
  if (!slips_are_sudden(segmentation) && is_release(recording, segmentation)) {
    return Judgement{Verdict::SteadySliding, "no falls but those of the release at the end"};
  }
  if (count < 4 && ends_flat(recording, segmentation)) {
    return Judgement{Verdict::SteadySliding, fmt::format("{} fall(s) at the start, then no more", count)};
  }
  if (count < 3) {
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

/// The spectrum shows the rhythm of the falls, whatever they scatter by.
bool spectrum_agrees(const Segmentation& segmentation, const SpectralFrequency& spectral) {
  constexpr double kAlike = 0.1;
  if (!spectral.value_Hz || segmentation.slips.size() < kFewestSudden) return false;
  std::vector<double> intervals_s;  // their median: falls that were missed do not count
  for (std::size_t i = 2; i < segmentation.slips.size(); ++i) {
    intervals_s.push_back(segmentation.slips[i].middle_s - segmentation.slips[i - 1].middle_s);
  }
  return std::abs(*spectral.value_Hz * signal::median(std::move(intervals_s)) - 1.0) < kAlike;
}

std::optional<Judgement> judge_ripple(const Recording& recording, const Segmentation& segmentation) {
  const double share = median_drop(segmentation) / std::abs(mean_of(recording.force()));
  if (share > kRipple || slips_are_sudden(segmentation)) return std::nullopt;
  return Judgement{Verdict::SteadySliding,
                   fmt::format("swings of {:.1f} % of the force, no sudden falls: pick-up or ripple on steady sliding",
                               100.0 * share)};
}

/// What the trace shows by itself where no slip of the model is close to it.
Judgement judge_without_model(const Recording& recording, const Segmentation& segmentation,
                              const SpectralFrequency& spectral) {
  const double ratio = signal::median(rises_over_falls(segmentation));
  if (slips_are_sudden(segmentation)) {
    return {Verdict::StickSlip,
            fmt::format("{} sudden falls after rises that take {:.1f} times as long; no slip of the model is close to "
                        "them, so that its parameters stay unknown",
                        segmentation.slips.size(), ratio)};
  }
  if (auto ripple = judge_ripple(recording, segmentation)) return *ripple;
  if (spectrum_agrees(segmentation, spectral)) {
    return {Verdict::OscillatorySlip,
            fmt::format("swings without straight sticks: the force rises in {:.1f} times the time that it falls in",
                        ratio)};
  }
  if (!keeps_rhythm(segmentation)) {
    return {Verdict::SteadySliding,
            "the force wanders: its falls are no more sudden than its rises and keep no rhythm"};
  }
  return {Verdict::Undetermined,
          fmt::format("the swings are no stick-slip cycles: the force rises in {:.1f} times the time that it falls in",
                      ratio)};
}

/// Swings without sticks that can be told; empty where slips come to rest.
std::optional<Judgement> judge_round_swings(const Recording& recording, const Segmentation& segmentation,
                                            const Evidence& e) {
  const bool sine_like = is_sine_like(segmentation);
  if (e.restick_share < kSineRestickShare) {
    if (auto ripple = judge_ripple(recording, segmentation)) return ripple;
  }
  if (!sine_like && signal::median(rises_over_falls(segmentation)) < kSquare) {
    return Judgement{Verdict::Undetermined, "the force rises as suddenly as it falls: no sticks"};
  }
  if ((sine_like || e.restick_share < kRestickShare) && is_faint(segmentation)) {
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

bool slips_are_sudden(const Segmentation& segmentation) {
  const std::vector<double> ratios = rises_over_falls(segmentation);
  if (ratios.size() + 1 < kFewestSudden || signal::median(ratios) < kSudden) return false;
  const auto sudden = std::count_if(ratios.begin(), ratios.end(), [](double ratio) { return ratio > 0.5 * kSudden; });
  return static_cast<double>(sudden) >= kSuddenShare * static_cast<double>(ratios.size());
}

bool slips_stand_out(const Segmentation& segmentation) {
  return !is_faint(segmentation) && !is_sine_like(segmentation);
}

Judgement judge_fit(const Recording& recording, const Segmentation& segmentation, const SpectralFrequency& spectral,
                    const FitResult* fit) {
  if (auto early = judge_counts(recording, segmentation, spectral)) return *early;
  if (fit == nullptr) return judge_without_model(recording, segmentation, spectral);
  const Evidence& e = fit->evidence;
  std::size_t used = 0;
  for (const Cycle& cycle : fit->cycles) used += cycle.used ? 1 : 0;
  const bool sudden = slips_are_sudden(segmentation);
  if (used < 5 && !sudden && (e.onset_force_spread > 0.2 || e.relative_residual > 0.04)) {
    return {Verdict::Undetermined, fmt::format("only {} usable cycles, and they do not agree", used)};
  }
  // Hum as large as the drop is what the detector sees, and the fit that follows it finds wrong slips good.
  if (is_sine_like(segmentation) && e.hum_share > kMuchHum) {
    return {Verdict::Undetermined, "the swings are as round as the mains hum in them: it hides what else there is"};
  }
  const bool close = e.relative_residual < kCloseFit && e.onset_force_spread < kWideSpread;
  const bool loose = e.relative_residual < kLooseFit && e.onset_force_spread < kModestSpread;
  const bool died = !sudden && keeps_rhythm(segmentation) && (e.decay > kDecay || e.span_share < kSpanShare);
  if (died && (close || loose || e.restick_share < kRestickShare)) {
    return {Verdict::OscillatorySlip, "the swings die out: a ring-down to steady sliding"};
  }
  const bool rests = e.restick_share >= kRestickShare;
  if ((!close && !loose) || (sudden && !rests)) return judge_without_model(recording, segmentation, spectral);
  if (is_sine_like(segmentation) && std::abs(mains_share(segmentation) - 1.0) < kMainsRhythm) {
    return {Verdict::Undetermined, "nearly sinusoidal swings at the rhythm of the mains: they may be its hum"};
  }
  if (auto round = judge_round_swings(recording, segmentation, e)) return *round;
  if (!close && !sudden) return judge_without_model(recording, segmentation, spectral);
  return {Verdict::StickSlip,
          fmt::format("{} cycles of straight sticks and quick slips, residual {:.1f} % of the friction drop", used,
                      100.0 * e.relative_residual),
          true};
}

Judgement judge_shape(const Recording& recording, const Segmentation& segmentation, const SpectralFrequency& spectral) {
  if (auto early = judge_counts(recording, segmentation, spectral)) return *early;
  if (slips_are_sudden(segmentation)) {
    return {Verdict::StickSlip, "the force falls much faster than it rises (no model fitted)"};
  }
  if (is_faint(segmentation)) {
    return {Verdict::Undetermined, "the falls are not much larger than the noise: only a fit can tell"};
  }
  if (!is_sine_like(segmentation) && signal::median(rises_over_falls(segmentation)) > kSquare) {
    return {Verdict::StickSlip, "the force falls much faster than it rises (no model fitted)"};
  }
  return {Verdict::Undetermined, "the force falls about as slowly as it rises: only a fit can tell"};
}

}  // namespace slipfit
