#pragma once

#include <string>
#include <vector>

#include "report/format.hpp"
#include "slipfit/analysis.hpp"

namespace slipfit {

/// "run.csv: stick-slip at 24.6 Hz [24.2, 24.9], 47 slips, driven at 10 mm/s"
std::string headline_of(const Recording& recording, const Analysis& analysis);

// One function a section of the report for people; each ends with a line break, or is empty.
std::string parameters_text(const Recording& recording, const Analysis& analysis);
/// Returns the table of parameters; `caution` follows the heading.
std::string parameters_text(const FitResult& fit, ForceQuantity quantity, const std::string& caution);
/// "assumed: Coulomb friction; ..."
std::string conditions_text(const std::vector<std::string>& conditional_on);
/// "  critical speed: 20 mm/s [19, 21], lambda there 0.69 [0.67, 0.71]", or why it is not known.
std::string critical_speed_text(const Estimate& speed_m_per_s, const Estimate& lambda, const std::string& given_unit);
/// "-1.0 %"; "-" where one is not known.
std::string off_by(const Estimate& predicted, const Estimate& measured);
std::string warnings_text(const Warnings& warnings);
/// Returns the assumptions made while reading a file.
std::string assumed_text(const std::vector<std::string>& assumed);

/// The numbers of a parameter as people see them: a bounded one's middle is no estimate, they see the interval alone.
EstimateRow parameter_row(const Parameter& parameter);

struct ShownParameter {
  std::string words;
  EstimateRow numbers;
  ParameterStatus status = ParameterStatus::Unidentified;
  std::string note;
};
std::vector<ShownParameter> shown_parameters(const FitResult& fit);

/// Returns each status that occurs, except `identified`, with its meaning: "weak: an estimate that ...".
std::vector<std::string> status_meanings(const std::vector<Parameter>& parameters);

}  // namespace slipfit
