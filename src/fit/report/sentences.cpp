#include "fit/report/sentences.hpp"

#include <fmt/format.h>

namespace slipfit::fit {

Warning averaged_warning(double average_s) {
  return {"samples_averaged",
          fmt::format("the slips are seen through averaging over {:.3g} ms, which is fitted together with them: state "
                      "it with --sensor-average where it is known",
                      1e3 * average_s)};
}

std::string averaging_doubt(double change) {
  return fmt::format(
      "averaging over one step of the clock, of which nothing is stated, would change w_n by {:.1f} %; state it with "
      "--sensor-average (0: an instant), or sample faster",
      100.0 * change);
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

}  // namespace slipfit::fit
