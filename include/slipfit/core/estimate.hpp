#pragma once

#include <optional>
#include <string>
#include <vector>

namespace slipfit {

/// A closed interval [low, high] in the unit of its quantity.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// A number with its standard error and 95 % interval. Unknown members are empty, and `note` states the reason.
struct Estimate {
  std::optional<double> value;
  std::optional<double> standard_error;
  std::optional<Interval> ci95;
  std::string note;
};

/// The result for a model parameter (docs/accuracy.md gives the rule of each status).
enum class ParameterStatus {
  Identified,
  Weak,
  Bounded,
  Unidentified,
  Fixed,
  Conditional  ///< known if something holds that the recording cannot show: the note says what
};

/// A condition that limits the reliability of the results. `code` is snake_case and listed in docs/formats.md.
struct Warning {
  std::string code;
  std::string message;
};

using Warnings = std::vector<Warning>;

}  // namespace slipfit
