#include "fit/report/notes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/fit_thresholds.hpp"

namespace slipfit::fit {

Warning averaged_warning(double average_s) {
  return {
      "samples_averaged",
      fmt::format("the slips are seen through averaging over {:.3g} ms, which is fitted together with them: state "
                  "it with --sensor-average where it is known, and the mass with --mass, which averages of the length "
                  "of the slips hide",
                  1e3 * average_s)};
}

std::string averaging_doubt(double change) {
  return fmt::format(
      "averaging over one step of the clock, of which nothing is stated, would change w_n by {:.1f} %; state it with "
      "--sensor-average (0: an instant), or sample faster",
      100.0 * change);
}

std::string unexcluded_average(double average_s, double change) {
  return fmt::format(
      "the slips do not exclude averaging over {:.2g} ms, which would change w_n by {:.1f} %; state it with "
      "--sensor-average (0: an instant)",
      1e3 * average_s, 100.0 * change);
}

Warning ripple_warning(const StickRipple& ripple) {
  if (ripple.speed_share > 1.0) {
    return {"suspicious_line",
            fmt::format("line at {:.4g} Hz in the sticks: pick-up or an oscillation in step with the slips",
                        ripple.frequency_Hz)};
  }
  return {
      "drive_ripple",
      fmt::format("the force in stick swings at {:.4g} Hz, as where the drive's speed swings by {:.2g} %: slips then "
                  "begin at other speeds than the mean",
                  ripple.frequency_Hz, 100.0 * ripple.speed_share)};
}

std::string weak_damping(const Estimate& damping) {
  const double times = std::pow(4.0 * *damping.standard_error / *damping.value, 2);
  const std::string known = fmt::format("its standard error is {:.2g}", *damping.standard_error);
  return times < 100.0 ? fmt::format("{}: it takes {:.2g} times the cycles, or less noise", known, times)
                       : known + ": it cannot be distinguished from 0";
}

Parameter held_cutoff(const AgeingCutoff& cutoff, double stick_s) {
  const std::string why =
      cutoff.ratio > thresholds::kCutoffStickRatio
          ? std::string("static friction that ages without one explains the recordings as well")
          : fmt::format("the longest sticks are {:.2g} times as long as the shortest, it is told from {} times on",
                        cutoff.ratio, thresholds::kCutoffStickRatio);
  const Interval held_s{stick_s * cutoff.held.low, stick_s * cutoff.held.high};
  const std::string note = fmt::format(
      "{}; predictions take {:.3g} s, and their bands hold what the other values change, which the recordings allow "
      "between 0 and the longest stick, {:.3g} s",
      why, stick_s * cutoff.value, stick_s * cutoff.longest);
  return {ParameterId::AgeingTime,
          {0.5 * (held_s.low + held_s.high), std::nullopt, held_s, note},
          ParameterStatus::Bounded};
}

}  // namespace slipfit::fit
