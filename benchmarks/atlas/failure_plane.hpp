#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study.hpp"

namespace atlas {

/// How a method does at one point of a plane.
enum class Mark {
  Fine,
  Silent,    ///< says that it has no answer
  Doubtful,  ///< answers, but marks the answer as weak
  Wrong,     ///< a number that is off, without a warning
  Multiple,  ///< a multiple, a part, or the mains' frequency instead
  Missed,    ///< says "no stick-slip" where there is
  Invented   ///< gives a cycle where there is none
};

struct PlaneAxis {
  std::string label;
  std::vector<double> values;  ///< logarithmic
};

/// One panel a method, drawn over the same plane.
struct Plane {
  PlaneAxis x, y;
  double height_px = 230.0;
  std::vector<chart::Line> lines;  ///< known limits
};

using Judge = std::function<Mark(double x, double y)>;

chart::Panel draw_plane(const Plane& plane, const std::string& method, const Judge& judge);

/// What the marks mean, for the lines under a chart's title.
std::vector<std::string> explain_marks(const std::vector<Mark>& marks);

std::vector<File> map_forward_failures(Effort effort);
std::vector<File> map_frequency_failures(Effort effort);
std::vector<File> map_fit_failures(Effort effort);

}  // namespace atlas
