#pragma once

#include <optional>
#include <span>
#include <vector>

#include "report/html/figure.hpp"
#include "slipfit/predict/prediction.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit::html {

/// The data of the page of a sweep.
struct SweepSource {
  std::span<const SweepEntry> entries;
  const SweepAnalysis& sweep;
  const std::optional<Prediction>& prediction;
};

/// The unit in which the manifest gives the speeds; empty: SI.
const std::string& given_speed_unit(const SweepSource& source);

/// Returns the unit of the speeds: that of the manifest, otherwise one that suits the fastest recording.
DisplayUnit speed_unit_of(const SweepSource& source);

/// Places of the recordings, from the slowest to the fastest.
std::vector<std::size_t> by_speed(const SweepSource& source);

/// Measured on the worn track: by a profile of it, else as stated.
Estimate spacing_on_surface(const Conditions& conditions);

Figure sweep_spacing_figure(const SweepSource& source);
Figure sweep_friction_figure(const SweepSource& source);
/// Cycles of each over those of the others.
Figure sweep_cycles_figure(const SweepSource& source);
/// Returns charts of each recording against time, as many in a picture as fit on a printed page.
std::vector<Figure> sweep_traces_figures(const SweepSource& source);

}  // namespace slipfit::html
