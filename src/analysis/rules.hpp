#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/detect.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit {

/// The input of the rules for one recording.
struct Facts {
  const Detected& detected;
  const Segmentation& slips;
  const Analysis& analysis;
};

/// A warning changes what a reader may conclude. A fact needs no action: a defect that was left out, or a term of the
/// model whose uncertainty the intervals include.
enum class RuleKind { Warning, Fact };

/// One code of a warning.
struct Rule {
  std::string_view code;
  RuleKind kind = RuleKind::Warning;
  /// One message for each time that the condition holds. Null: the warning is made where its cause is found, by the
  /// reader, the fit, the sweep or the comparison.
  std::vector<std::string> (*messages)(const Facts&) = nullptr;
  std::span<const ParameterId> limited = {};  ///< parameters that are at most conditional with this warning
};

/// Returns the rules of all warnings of recordings and sweeps, in order of their effect on the results.
std::span<const Rule> rules();

/// Returns true if a warning is a fact; false for a code without a rule.
bool is_fact(const Warning& warning);

/// The warnings of the reader, of the fit and of the rules, those with the largest effect first.
Warnings collect_warnings(const Facts& facts);

/// The warnings in the order of the rules; codes without a rule come last.
Warnings by_effect(Warnings warnings);

/// The fit with the parameters that a warning limits at most conditional.
FitResult limited_by(const Warnings& warnings, FitResult fit);

}  // namespace slipfit
