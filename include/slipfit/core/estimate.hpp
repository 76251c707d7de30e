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
enum class ParameterStatus { Identified, Weak, Bounded, Unidentified, Fixed };

/// One named model parameter in SI units; `name` is the JSON key (`stiffness_N_per_m`).
struct Parameter {
  std::string name;
  Estimate estimate;
  ParameterStatus status = ParameterStatus::Unidentified;
};

/// Something that the user should know before trusting the numbers. `code` is snake_case and listed in docs/formats.md.
struct Warning {
  std::string code;
  std::string message;
};

using Warnings = std::vector<Warning>;

}  // namespace slipfit
