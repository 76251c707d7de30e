#pragma once

#include <optional>
#include <string>
#include <vector>

namespace slipfit {

/// Closed interval [low, high] in the unit of the quantity it belongs to.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// A number with its standard error and 95 % interval. What is not known is empty, and `note` says why.
struct Estimate {
  std::optional<double> value;
  std::optional<double> standard_error;
  std::optional<Interval> ci95;
  std::string note;
};

/// What the data say about a model parameter (docs/accuracy.md gives the rule for each).
enum class ParameterStatus {
  Identified,
  Weak,
  Bounded,
  Unidentified,
  Fixed,
  Conditional  ///< known if something holds that the recording cannot show: the note says what
};

/// Something that the user should know before trusting the numbers. `code` is snake_case and listed in docs/formats.md.
struct Warning {
  std::string code;
  std::string message;
};

using Warnings = std::vector<Warning>;

}  // namespace slipfit
