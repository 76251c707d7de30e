#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/format.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/surface/surface.hpp"
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
Block models_block(const FitResult& fit, ForceQuantity quantity);
/// Returns the pairs of parameters that the data hardly distinguish, the closest first; empty if there are none.
Block correlations_block(const FitResult& fit);
/// Returns the block of the recordings at one speed.
Block repeats_block(const std::vector<Repeat>& repeats);

/// Returns the block of a worn surface.
Block pattern_block(const Profile& profile, const Surface& surface);

/// The numbers of a recording that are neither parameters nor coefficients of friction, in the order of the reports.
std::vector<Block> number_blocks(const Recording& recording, const Analysis& analysis);

/// Returns a block as text, with a blank line before its heading; empty for a block without content.
std::string text_of(const Block& block);

}  // namespace slipfit
