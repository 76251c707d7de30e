#include "analysis/conclusions.hpp"

#include <fmt/format.h>

#include <iterator>
#include <numbers>
#include <utility>

#include "analysis/slip_intervals.hpp"
#include "core/thresholds.hpp"

namespace slipfit {

namespace {

Warnings warn_of_quality(const Detected& detected) {
  const Recording& recording = detected.recording();
  const Quality& quality = detected.whole_quality;
  Warnings warnings;
  const auto warn = [&](const char* code, std::string message) { warnings.push_back({code, std::move(message)}); };
  if (quality.gaps > 0) {
    warn("gaps", fmt::format("{} {} in the clock, the longest {:.3g} s", quality.gaps,
                             quality.gaps == 1 ? "gap" : "gaps", quality.longest_gap_s));
  }
  if (quality.clock_jitter > thresholds::kUnevenClock) {
    warn("uneven_clock", fmt::format("the sample interval varies by {:.0f} %", 100.0 * quality.clock_jitter));
  }
  if (detected.repeats() > 1.0) {
    warn("repeated_values",
         fmt::format(
             "each value is repeated {:.3g} times because the logger is faster than the converter; each was used once, "
             "every {:.3g} s",
             detected.repeats(), recording.sample_interval_s()));
  }
  if (quality.clipped_samples > 0) {
    warn("clipped", fmt::format("the sensor saturates: {} samples were left out", quality.clipped_samples));
  }
  if (quality.impulses > 0) {
    warn("impulses", fmt::format("{} isolated {} left out", quality.impulses,
                                 quality.impulses == 1 ? "impulse was" : "impulses were"));
  }
  if (quality.quantisation_step) {
    const bool newtons = recording.conditions().quantity == ForceQuantity::Force_N;
    warn("quantised",
         fmt::format("the force is quantised in steps of {:.3g}{}", *quality.quantisation_step, newtons ? " N" : ""));
  }
  return warnings;
}

Warnings warn_of_sensor(const Conditions& conditions, const CycleStatistics& cycles) {
  if (!conditions.sensor_bandwidth_Hz || !cycles.period_s) return {};
  const double lags = *cycles.period_s * 2.0 * std::numbers::pi * *conditions.sensor_bandwidth_Hz;
  if (lags > thresholds::kLagsOfCycle) return {};
  return {{"sensor_too_slow",
           fmt::format("a cycle lasts only {:.2g} times the lag of the sensor: its response to one slip has "
                       "not decayed when the next begins",
                       lags)}};
}

Warnings warn_of_clock(const Conditions& conditions, const CycleStatistics& cycles) {
  if (cycles.regularity != Regularity::Clocked) return {};
  return {{"clocked",
           fmt::format(
               "the slips are synchronous with the drive (period {:.4g} ms), which determines frequency and spacing: "
               "they do not apply to other speeds",
               1e3 * *conditions.drive_period_s)}};
}

}  // namespace

Warnings collect_warnings(const Detected& detected, const Segmentation& slips, const Analysis& analysis) {
  const Recording& recording = detected.recording();
  Warnings warnings = recording.provenance().warnings;
  const auto append = [&](Warnings more) {
    warnings.insert(warnings.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  append(warn_of_quality(detected));
  for (const SuspiciousLine& line : analysis.frequency.lines) {
    warnings.push_back({"suspicious_line", fmt::format("line at {:.4g} Hz: {}", line.frequency_Hz, line.reason)});
  }
  append(warn_of_sensor(recording.conditions(), analysis.cycles));
  append(warn_of_clock(recording.conditions(), analysis.cycles));
  append(warn_of(analysis.tests));
  if (analysis.fit && analysis.motion != MotionClass::SteadySliding) append(analysis.fit->warnings);
  if (analysis.motion == MotionClass::StickSlip) append(warn_of_changes(recording, slips));
  return warnings;
}

}  // namespace slipfit
