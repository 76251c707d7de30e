#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "chart/chart.hpp"
#include "core/sample_range.hpp"
#include "report/format.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::html {

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

/// A plain rectangle between two corners, with an edge.
chart::Area rectangle(std::string name, chart::Colour colour, chart::Point low, chart::Point high);

/// Lowest and highest number seen so far.
class Span {
 public:
  void add(double value);
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

SampleRange samples_between(const Recording& recording, double begin_s, double end_s);

/// At most 2 * `columns` points: the lowest and the highest of each column, in order of time; all where they are fewer.
/// Not finite values are passed over.
std::vector<chart::Point> envelope(std::span<const double> x, std::span<const double> y, std::size_t columns);

}  // namespace slipfit::html
