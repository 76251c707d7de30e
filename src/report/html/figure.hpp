#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chart/chart.hpp"
#include "report/format.hpp"
#include "slipfit/background.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/pipeline.hpp"

namespace slipfit::html {

/// The data of a report of one recording.
struct Source {
  const Recording& recording;
  const Analysis& analysis;
  const Background& background;
  DisplayUnit force_unit;              ///< that suits the largest force; no unit for friction coefficients
  std::vector<double> fitted;          ///< the fit at every sample, not a number where it does not reach
  std::vector<double> force_of_slips;  ///< force_without_interference()
};
Source source_of(const Recording& recording, const Analysis& analysis, const Background& background);

/// Returns false for steady sliding, whose cycles and fit are those of noise, so that no chart shows them.
bool shows_cycles(const Analysis& analysis);

/// There is a fitted force to draw on the trace.
bool has_fitted_curve(const Analysis& analysis);

/// One chart with its words, or the reason why there is none.
struct Figure {
  std::string id;          ///< letters, digits and '-': on the page, and the file's name
  std::string title;       ///< a few words
  std::string guide = {};  ///< how to read it, plain text
  std::string label = {};  ///< what there is to see, in words, for readers who cannot see it
  std::optional<chart::Chart> chart = {};
  std::string absent = {};  ///< a sentence, where there is no chart

  [[nodiscard]] Figure without_chart(std::string why) const {
    Figure figure = *this;
    figure.absent = std::move(why);
    return figure;
  }
};

Figure trace_figure(const Source& source);
/// Returns the trace, called `name`, with its fit and the residual below it, for pages of several recordings.
std::vector<chart::Panel> small_trace(const Source& source, const std::string& name);
Figure spectrum_figure(const Source& source);
Figure cycles_figure(const Source& source);
Figure evolution_figure(const Source& source);
Figure pairs_figure(const Source& source);
Figure map_figure(const Source& source);
Figure speed_figure(const Source& source);
Figure pattern_figure(const Source& source);

/// Returns all figures in the order of the page.
std::vector<Figure> figures_of(const Source& source);

struct OverlaidRecording {
  const Recording& recording;
  const Analysis& analysis;
};

/// Cycles that are drawn in one colour with one name: a recording of a sweep, or a side of a comparison.
struct OverlaidSet {
  std::string name;
  std::vector<OverlaidRecording> recordings;
};

/// Returns true if any of the recordings has cycles to overlay.
bool has_cycles(const OverlaidSet& set);

/// Explanation of the figure that `overlay_of` draws.
inline constexpr std::string_view kOverlayGuide =
    "All cycles, shifted so that the slip starts at zero and the kinetic friction is at zero force. Top: whole cycles "
    "against drive displacement, where the slope of the sticks is the stiffness at any speed; bottom, if the samples "
    "resolve them: slips against time, whose shape determines natural frequency and damping.";

inline constexpr std::size_t kMostCyclesOfASet = 24;

/// Cycles of all sets, about as many of each, and the fit of a typical cycle if the source of the only recording is
/// given. At least one of the sets has cycles.
chart::Chart overlay_of(const std::string& title, const std::vector<OverlaidSet>& sets, const Source* fitted = nullptr);

}  // namespace slipfit::html
