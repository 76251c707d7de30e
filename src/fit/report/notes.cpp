#include "fit/report/notes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/fit_thresholds.hpp"

namespace slipfit::fit {

Warning averaged_warning(double average_s) {
  return {"samples_averaged",
          fmt::format("sensor averaging over {:.3g} ms was included in the fit: state the averaging time with "
                      "--sensor-average and the mass with --mass if they are known",
                      1e3 * average_s)};
}

Warning ripple_warning(const StickRipple& ripple) {
  if (ripple.speed_share > 1.0) {
    return {"suspicious_line",
            fmt::format("oscillation at {:.4g} Hz during stick: pick-up, or an oscillation synchronous with the slips",
                        ripple.frequency_Hz)};
  }
  return {
      "drive_ripple",
      fmt::format(
          "the force in stick oscillates at {:.4g} Hz, as if the driving speed varied by {:.2g} %: the speed at the "
          "onset of a slip then differs from the mean",
          ripple.frequency_Hz, 100.0 * ripple.speed_share)};
}

std::string weak_damping(const Estimate& damping) {
  const double times = std::pow(4.0 * *damping.standard_error / *damping.value, 2);
  const std::string known = fmt::format("its standard error is {:.2g}", *damping.standard_error);
  return times < 100.0 ? fmt::format("{}; {:.2g} times as many cycles, or less noise, would determine it", known, times)
                       : known + ": it cannot be distinguished from 0";
}

Parameter held_cutoff(const AgeingCutoff& cutoff, double stick_s) {
  const std::string why =
      cutoff.ratio > thresholds::kCutoffStickRatio
          ? std::string("ageing without a cut-off time explains the recordings as well")
          : fmt::format("the longest sticks are {:.2g} times as long as the shortest; a ratio of {} is needed",
                        cutoff.ratio, thresholds::kCutoffStickRatio);
  const Interval held_s{stick_s * cutoff.held.low, stick_s * cutoff.held.high};
  const std::string note = fmt::format(
      "{}; predictions use {:.3g} s, and their bands include the other values that the recordings allow, from 0 to the "
      "longest stick of {:.3g} s",
      why, stick_s * cutoff.value, stick_s * cutoff.longest);
  return {ParameterId::AgeingTime,
          {0.5 * (held_s.low + held_s.high), std::nullopt, held_s, note},
          ParameterStatus::Bounded};
}

}  // namespace slipfit::fit
