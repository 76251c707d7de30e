#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/rounding.hpp"
#include "slipfit/pipeline.hpp"

namespace slipfit {

// One function a section of the report for people; each ends with a line break, or is empty.
std::string parameters_text(const Recording& recording, const Analysis& analysis);
/// `caution` follows the heading.
std::string parameters_text(const FitResult& fit, ForceQuantity quantity, const std::string& caution);
/// "assumed: Coulomb friction; ..."
std::string conditions_text(const std::vector<std::string>& conditional_on);
std::string warnings_text(const Warnings& warnings);
std::string frequency_text(const FrequencyReport& frequency);
std::string cycles_text(const CycleStatistics& cycles, ForceQuantity quantity);
std::string spacing_text(const Recording& recording, const Derived& derived);
std::string predicted_text(const Recording& recording, const Derived& derived);
std::string recording_text(const Recording& recording, const Analysis& analysis);

/// "key   value ± error unit   [low, high]" for a table of estimates; SI_unit gets a prefix where that reads better.
struct EstimateRow {
  std::string value;
  std::string interval;
  std::string unit;
};
EstimateRow estimate_row(const Estimate& estimate, const std::string& SI_unit);
EstimateRow estimate_row(const Estimate& estimate, const DisplayUnit& unit);

/// A parameter as people see it: a bounded one's middle is no estimate, they see the interval alone.
struct ShownParameter {
  std::string words;
  EstimateRow numbers;
  ParameterStatus status = ParameterStatus::Unidentified;
  std::string note;
};
std::vector<ShownParameter> shown_parameters(const FitResult& fit);

/// "1.234 mm": a number without an error.
std::string quantity_text(std::optional<double> value, const std::string& SI_unit);
std::string quantity_text(double value, const DisplayUnit& unit);

/// "10 mm/s": a number that somebody stated, with the digits that it needs.
std::string stated_text(double value, const std::string& SI_unit);
std::string stated_text(double value, const DisplayUnit& unit);

/// The driving speed, in the unit that it was given in.
std::string speed_text(const Conditions& conditions);

/// A status, role or regime of the document in words: "stick-slip", "steady sliding".
std::string plain_words(std::string_view name);

/// What a status means to who has not read the documentation.
std::string_view words_for_status(ParameterStatus status);

/// The unit of the force column: N, or 1 (empty text) for a friction coefficient.
std::string force_unit(ForceQuantity quantity);

}  // namespace slipfit
