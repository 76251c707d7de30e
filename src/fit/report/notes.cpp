#include "fit/report/notes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/fit_thresholds.hpp"

namespace slipfit::fit {

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
