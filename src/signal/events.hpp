#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "signal/turning_points.hpp"

namespace slipfit::signal {

/// Falls of one trace at the time scale that shows them best.
struct Events {
  std::vector<Fall> falls;    ///< samples of `trace`; at least a quarter of the median fall
  std::vector<double> trace;  ///< the force at this scale, one value a sample
  std::size_t width = 1;      ///< samples that it was smoothed over
  std::size_t minor = 0;      ///< smaller falls
  double noise = 0.0;         ///< standard deviation that is left at this scale
  double hysteresis = 0.0;    ///< swing that makes a turning point
  double asymmetry = 1.0;     ///< median time of a rise over that of a fall
};

/// Sudden falls after slow rises, whatever follows them: the trace is smoothed over widths in equal ratios, its turning
/// points are taken with hystereses in equal ratios, falls are joined where the rise between them is as quick as they
/// are (ringing). The scale whose falls exceed its noise most often and are most sudden is chosen, at the finest scale
/// that shows the same falls. `noise`: of the samples. `width`: in samples, where the scale is known.
Events find_events(std::vector<double> force, double noise, std::optional<std::size_t> width = std::nullopt);

}  // namespace slipfit::signal
