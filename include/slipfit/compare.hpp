#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit {

/// A number that a comparison looks at.
struct ComparedQuantity {
  std::string section;  ///< of the document that holds it: "parameters", "derived", ...
  std::string key;
  std::string words;
  std::string unit;  ///< SI
};

/// All of them: parameters, frequency, spacing and coefficients of friction.
std::span<const ComparedQuantity> compared_quantities();

/// A quantity as a fit tells it. Where the value is empty, the note says why.
struct ComparedValue {
  Estimate estimate;
  std::string status;      ///< of a parameter: "identified", ...; else empty
  bool is_absent = false;  ///< not in the document at all
};

/// One fit, of a recording or of several together, as a comparison sees it.
struct ComparedFit {
  std::string id;
  std::string file;    ///< empty: of several recordings
  std::string source;  ///< digest of its bytes and the stretch that slides: equal where a recording counts twice
  std::string group;   ///< of the manifest
  std::string motion;  ///< "stick_slip", ...
  std::optional<double> speed_m_per_s, normal_force_N;
  std::vector<ComparedValue> values;  ///< in the order of compared_quantities()
};

/// From a document of the schema slipfit.fit/1, as `to_json` and `slipfit fit --json` write it. `name`: what messages
/// call it. Errors: those of check_fit_document.
Result<ComparedFit> compared_fit(const std::string& document, const std::string& name = "fit document");

/// What is compared: one fit, or one for each repeat of a test.
struct ComparisonSide {
  std::string name;
  std::vector<ComparedFit> fits;
};

/// What a condition was at its least and its most; empty where no fit tells it.
using ComparedCondition = std::optional<double> ComparedFit::*;
std::optional<Interval> range_of(const ComparisonSide& side, ComparedCondition condition);

/// Where the interval of a difference comes from (docs/accuracy.md says how each holds).
enum class ComparisonMethod {
  StandardErrors,  ///< of one fit on each side: how repeats scatter is not known
  Welch,           ///< scatter of the repeats on both sides
  ScatterOfA,      ///< B is one recording, and taken to scatter as those of A do
  ScatterOfB
};

/// What one side tells of a quantity: its own value, or the mean over its recordings.
struct SideEstimate {
  Estimate estimate;
  std::size_t recordings = 0;  ///< that tell it
  std::string status;          ///< of a parameter: the least sure one among them
};

struct QuantityComparison {
  ComparedQuantity quantity;
  SideEstimate a, b;
  std::optional<ComparisonMethod> method;  ///< empty: not compared, the note of the difference says why
  Estimate difference;                     ///< B - A
  Estimate ratio;                          ///< B / A; its interval holds 1 where that of the difference holds 0
  std::optional<double> p_value;           ///< that A and B do not differ and chance alone shows as much
  std::optional<double> p_adjusted;        ///< the same for all quantities together (Holm)

  /// At the 5 % level, all quantities together.
  [[nodiscard]] bool differs() const { return p_adjusted && *p_adjusted < 0.05; }
};

struct Comparison {
  ComparisonSide a, b;
  std::vector<QuantityComparison> quantities;  ///< that either side has
  Warnings warnings;
};

/// Do two sides differ? A recording counts once, however many cycles it has. Each side has at least one fit.
Comparison compare(const ComparisonSide& a, const ComparisonSide& b);

}  // namespace slipfit
