#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "study.hpp"

namespace atlas {

/// How a method answers at one point of a plane.
enum class Mark {
  Right,
  Refused,  ///< the method states that it has no answer
  Weak,     ///< the method answers, and marks the answer as weak
  Wrong     ///< the answer is wrong, and the method does not warn
};

/// A plane of two factors over which methods are compared; draw.py holds its title and labels.
struct Plane {
  std::string name;
  std::vector<double> x, y;
};

using Judge = std::function<Mark(double x, double y)>;

/// The first line of the table of failures.
std::string failure_columns();

/// Rows of the table of failures: one for each point of the plane.
std::string judge_plane(const Plane& plane, const std::string& method, const Judge& judge);

/// The same over two factors of recordings.
std::string judge_factors(const Plane& plane, const std::string& method, double Factors::*x, double Factors::*y,
                          const std::function<Mark(const Factors&)>& judge);

/// Rows of the failure maps of forward methods, of frequency methods and of fits.
std::string map_forward_failures(Effort effort);
std::string map_frequency_failures(Effort effort);
std::string map_fit_failures(Effort effort);

}  // namespace atlas
