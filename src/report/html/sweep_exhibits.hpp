#pragma once

#include <span>

#include "report/html/exhibit.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit::html {

/// What the page of a sweep is made of.
struct SweepSource {
  std::span<const SweepEntry> entries;
  const SweepAnalysis& sweep;
};

Exhibit sweep_spacing_exhibit(const SweepSource& source);
Exhibit sweep_friction_exhibit(const SweepSource& source);
Exhibit sweep_traces_exhibit(const SweepSource& source);

}  // namespace slipfit::html
