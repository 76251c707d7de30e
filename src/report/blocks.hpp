#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/format.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

/// A quantity for readers, as plain text; what is not known of it is empty.
struct Row {
  std::string label;
  std::string value;
  std::string unit = {};
  std::string interval = {};  ///< of 95 %
  std::string note = {};
};

/// A part of a report: a table under a heading, then sentences. `text_of` prints it, and `block_part` of a page shows
/// it, so that a quantity is a row in one place.
struct Block {
  std::string id;  ///< of its section on a page
  std::string title;
  std::vector<Row> rows = {};
  std::vector<std::string> sentences = {};

  /// Adds a row for an estimate in the unit that suits it, or in the given one; none where nothing is known, not even
  /// why.
  void add(std::string_view label, const Estimate& estimate, const std::string& SI_unit);
  void add(std::string_view label, const Estimate& estimate, const DisplayUnit& unit);
  [[nodiscard]] bool empty() const { return rows.empty() && sentences.empty(); }
};

Block coefficients_block(const std::optional<Coefficients>& coefficients);
Block quality_block(const Recording& recording, const Analysis& analysis);
/// The models that were compared, what the chosen one leaves over, and what it assumes.
Block models_block(const FitResult& fit, ForceQuantity quantity, FitKind kind);
/// What the residuals of a fit are compared with: a joint fit with the fits of its recordings one by one.
const char* reference_of_residuals(FitKind kind);
/// Returns the pairs of parameters that the data hardly distinguish, the closest first; empty if there are none.
Block correlations_block(const FitResult& fit);
/// Returns the block of the recordings at one speed.
Block repeats_block(const std::vector<Repeat>& repeats);

/// The numbers of a recording that are neither parameters nor coefficients of friction, in the order of the reports.
std::vector<Block> number_blocks(const Recording& recording, const Analysis& analysis);

/// Returns a block as text, with a blank line before its heading; empty for a block without content.
std::string text_of(const Block& block);

/// "run.csv: stick-slip at 24.6 Hz [24.2, 24.9], 47 slips, driven at 10 mm/s"
std::string headline_of(const Recording& recording, const Analysis& analysis);

// One function a section of the report for people; each ends with a line break, or is empty.
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
