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

/// What a report of one recording is made of.
struct Source {
  const Recording& recording;
  const Analysis& analysis;
  const Background& background;
  DisplayUnit force_unit;              ///< that suits the largest force; no unit for friction coefficients
  std::vector<double> fitted;          ///< the fit at every sample, not a number where it does not reach
  std::vector<double> force_of_slips;  ///< force_without_interference()
};
Source source_of(const Recording& recording, const Analysis& analysis, const Background& background);

/// False for steady sliding: cycles and fit are then those of noise, and no chart shows them.
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
Figure spectrum_figure(const Source& source);
Figure cycles_figure(const Source& source);
Figure evolution_figure(const Source& source);
Figure pairs_figure(const Source& source);
Figure map_figure(const Source& source);
Figure speed_figure(const Source& source);
Figure pattern_figure(const Source& source);

/// All of them, in the order of the page.
std::vector<Figure> figures_of(const Source& source);

struct OverlaidRecording {
  const Recording& recording;
  const Analysis& analysis;
};

/// What is drawn in one colour, under one name: a recording of a sweep, a side of a comparison.
struct OverlaidSet {
  std::string name;
  std::vector<OverlaidRecording> recordings;
};

/// Any of the recordings has cycles to lay over others.
bool has_cycles(const OverlaidSet& set);

/// How to read what `overlay_of` draws.
inline constexpr std::string_view kOverlayGuide =
    "Every cycle moved so that its slip begins at zero and its kinetic friction lies at zero force. Above: whole "
    "cycles over the path of the drive, where sticks rise by the stiffness at any speed; below, where samples resolve "
    "them: "
    "slips close up over time, whose shape shows natural frequency and damping.";

/// Cycles of all sets, about as many of each. At least one of the sets has cycles.
chart::Chart overlay_of(const std::string& title, const std::vector<OverlaidSet>& sets);

}  // namespace slipfit::html
