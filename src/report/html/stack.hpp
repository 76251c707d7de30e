#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "report/html/figure.hpp"

namespace slipfit::html {

/// The reference point of a cycle: the onset and F_k by the fit, otherwise the turning points.
struct Anchor {
  double time_s = 0.0;
  double force = 0.0;
  double height = 0.0;  ///< of the peak above it, for the typical cycle
};

struct Stack {
  std::vector<Anchor> anchors;  ///< evenly chosen
  Anchor typical;               ///< of median height
  bool on_kinetic_level = false;
};
Stack stack_of(const Analysis& analysis, std::size_t most_cycles);

/// A window around the slip, in s.
struct CycleWindow {
  double before_s = 0.0;
  double after_s = 0.0;
};
/// Whole cycles; where the slip is resolved, the slip close up. Empty where there is no period.
std::vector<CycleWindow> windows_of(const CycleStatistics& cycles, double sample_interval_s);

/// One cycle of `force`, laid on its anchor: seconds, and the force in the source's unit.
std::vector<chart::Point> laid(const Source& source, std::span<const double> force, const Anchor& anchor,
                               CycleWindow window);
/// Returns all cycles of the stack as one line with gaps.
chart::Line laid_cycles(const Source& source, const Stack& stack, CycleWindow window);

}  // namespace slipfit::html
