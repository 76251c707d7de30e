#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chart/chart.hpp"
#include "core/sample_range.hpp"
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
  std::size_t trace_columns = 400;     ///< of the trace: on a page one for 1.5 pixels
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
Figure residuals_figure(const Source& source);
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

/// Cycles of all sets, about as many of each, and the fit of a typical cycle if the source of the only recording is
/// given. At least one of the sets has cycles.
chart::Chart overlay_of(const std::string& title, const std::vector<OverlaidSet>& sets, const Source* fitted = nullptr);

/// The unit that suits the largest force of the recording; no unit for friction coefficients.
DisplayUnit force_unit_of(const Recording& recording);
/// "friction force", or "friction coefficient"
std::string force_name_of(const Recording& recording);
/// "force [mN]"; "[-]" for a pure number.
std::string label_with_unit(const std::string& name, const std::string& unit);

/// "407.1 ± 2.2 µm" that a line does not end in; "-" where it is not known.
std::string quantity_of(const Estimate& estimate, const std::string& SI_unit);
/// Returns a quantity with non-breaking spaces.
std::string unbroken(const std::string& quantity);

/// A line of this width around an area of a page.
constexpr double kEdge_px = 0.8;

/// A dashed line through a panel, whose axes are complete, from the bottom to the top.
chart::Line line_up(const chart::Panel& panel, const std::string& name, double x, chart::Colour colour);

/// A plain rectangle between two corners, with an edge.
chart::Area rectangle(std::string name, chart::Colour colour, chart::Point low, chart::Point high);

/// Lowest and highest number seen so far.
class Span {
 public:
  void add(double value);
  void add(const std::vector<chart::Point>& points, double chart::Point::*coordinate = &chart::Point::y);
  [[nodiscard]] bool empty() const { return !(low_ <= high_); }
  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }
  /// Returns the difference of the largest and the smallest value; 0 if they differ only in digits that no sensor or
  /// clock has.
  [[nodiscard]] double range() const;
  /// Returns a linear axis with a margin of a twentieth of the range on both sides; its length is never zero.
  [[nodiscard]] chart::Axis linear_axis(const std::string& label) const;
  /// Returns a logarithmic axis from the smallest to the largest value with a small margin; the values are positive.
  [[nodiscard]] chart::Axis logarithmic_axis(const std::string& label) const;

 private:
  double low_ = 1.0;
  double high_ = 0.0;
};

/// Start and end of a slip, by the fit where it has it, else by the turning points.
inline double slip_begin_s(const Cycle& cycle) {
  return cycle.onset_s.value_or(cycle.peak_s);
}
inline double slip_end_s(const Cycle& cycle) {
  return cycle.end_s.value_or(cycle.trough_s);
}

SampleRange samples_between(const Recording& recording, double begin_s, double end_s);

/// At most 2 * `columns` points: the lowest and the highest of each column, in order of time; all where they are fewer.
/// Not finite values are passed over.
std::vector<chart::Point> envelope(std::span<const double> x, std::span<const double> y, std::size_t columns);

/// The items themselves, or as many as `most` of them at even distances.
template <class Item>
std::vector<Item> evenly_chosen(const std::vector<Item>& items, std::size_t most) {
  if (items.size() <= most) return items;
  std::vector<Item> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(items[i * items.size() / most]);
  return chosen;
}

}  // namespace slipfit::html
