#include "analysis/warnings.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "analysis/short_tests.hpp"
#include "analysis/slip_intervals.hpp"
#include "core/thresholds.hpp"

namespace slipfit {

Warnings collect_warnings(const Recording& recording, const Segmentation& slips, const Analysis& analysis) {
  Warnings warnings = recording.provenance().warnings;
  const auto warn = [&](const char* code, std::string message) { warnings.push_back({code, std::move(message)}); };
  const Quality& quality = analysis.quality;
  if (quality.gaps > 0) {
    warn("gaps", fmt::format("{} gap(s) in the clock, the longest {:.3g} s", quality.gaps, quality.longest_gap_s));
  }
  if (quality.clock_jitter > thresholds::kUnevenClock) {
    warn("uneven_clock", fmt::format("the time step varies by {:.0f} %", 100.0 * quality.clock_jitter));
  }
  if (quality.clipped_samples > 0) {
    warn("clipped", fmt::format("{} samples at a level where the sensor saturates: left out", quality.clipped_samples));
  }
  if (quality.impulses > 0) {
    warn("impulses", fmt::format("{} isolated impulses: left out", quality.impulses));
  }
  if (quality.quantisation_step) {
    const bool newtons = recording.conditions().quantity == ForceQuantity::Force_N;
    warn("quantised", fmt::format("forces are multiples of {:.3g}{}", *quality.quantisation_step, newtons ? " N" : ""));
  }
  for (const SuspiciousLine& line : analysis.frequency.lines) {
    warn("suspicious_line", fmt::format("line at {:.4g} Hz: {}", line.frequency_Hz, line.reason));
  }
  const auto& bandwidth_Hz = recording.conditions().sensor_bandwidth_Hz;
  if (bandwidth_Hz && analysis.cycles.period_s) {
    const double lags = *analysis.cycles.period_s * 2.0 * std::numbers::pi * *bandwidth_Hz;
    if (lags < thresholds::kForgottenLags) {
      warn("sensor_too_slow", fmt::format("a cycle lasts {:.2g} times the sensor's lag: one slip is hardly forgotten "
                                          "when the next begins, and little of the ramps is left to fit",
                                          lags));
    }
  }
  for (Warning& warning : warn_of(analysis.tests)) warnings.push_back(std::move(warning));
  if (analysis.fit) warnings.insert(warnings.end(), analysis.fit->warnings.begin(), analysis.fit->warnings.end());
  if (analysis.verdict == Verdict::StickSlip) {
    for (Warning& warning : warn_of_changes(recording, slips)) warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace slipfit
