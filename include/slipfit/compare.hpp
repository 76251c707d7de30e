#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/report/quantities.hpp"

namespace slipfit {

/// Returns all compared quantities: parameters, frequency, spacing and coefficients of friction.
std::span<const Quantity> compared_quantities();

/// A quantity as a fit determines it. If the value is empty, the note states the reason.
struct ComparedValue {
  Estimate estimate;
  std::string status;      ///< of a parameter: "identified", ...; else empty
  bool is_absent = false;  ///< not in the document at all
};

/// The fit of a recording, or of several together, as input of a comparison.
struct ComparedFit {
  std::string id;
  std::string file;    ///< empty: of several recordings
  std::string source;  ///< digest of its bytes and the stretch that slides: equal where a recording counts twice
  std::string group;   ///< of the manifest
  std::string motion;  ///< "stick_slip", ...
  std::optional<double> speed_m_per_s, normal_force_N;
  std::string speed_unit;              ///< that the speed was given in; empty: m/s
  std::optional<double> zero_force_N;  ///< the reading without force, where it is stated
  std::vector<ComparedValue> values;   ///< in the order of compared_quantities()
};

/// Reads a document of the schema slipfit.fit/1, as `to_json` and `slipfit fit --json` write it. Messages call it
/// `name`. Errors: those of check_fit_document.
Result<ComparedFit> compared_fit(const std::string& document, const std::string& name = "fit document");

/// One side of a comparison: one fit, or one for each repeat of a test.
struct ComparisonSide {
  std::string name;
  std::vector<ComparedFit> fits;
};

/// Pointer to a member of ComparedFit that describes a condition; the value is empty if no fit states it.
using ComparedCondition = std::optional<double> ComparedFit::*;
std::optional<Interval> range_of(const ComparisonSide& side, ComparedCondition condition);
/// Returns "50 mm/min" or "10 to 50 mm/min", the speed in the unit that it was given in; empty if no fit states the
/// condition.
std::string condition_text(const ComparisonSide& side, ComparedCondition condition);

/// The origin of the interval of a difference (docs/validation.md gives the coverage of each).
enum class ComparisonMethod {
  StandardErrors,  ///< of one fit on each side: how repeats scatter is not known
  Welch,           ///< scatter of the repeats on both sides
  ScatterOfA,      ///< B is one recording, and taken to scatter as those of A do
  ScatterOfB
};

/// The estimate of a quantity on one side: its own value, or the mean over its recordings.
struct SideEstimate {
  Estimate estimate;
  std::size_t recordings = 0;  ///< with this quantity
  std::string status;          ///< of a parameter: the least sure one among them
};

struct QuantityComparison {
  Quantity quantity;
  SideEstimate a, b;
  std::optional<ComparisonMethod> method;  ///< empty: not compared, the note of the difference says why
  Estimate difference;                     ///< B - A
  Estimate ratio;                          ///< B / A; its interval holds 1 where that of the difference holds 0
  std::optional<double> p_value;           ///< that A and B do not differ and chance alone shows as much
  std::optional<double> p_adjusted;        ///< the same for all quantities together (Holm)

  /// Returns true if the sides differ at the 5 % level, for all quantities together.
  [[nodiscard]] bool differs() const { return p_adjusted && *p_adjusted < 0.05; }
};

struct Comparison {
  ComparisonSide a, b;
  std::vector<QuantityComparison> quantities;  ///< that either side has
  Warnings warnings;
};

/// Compares two sides. A recording counts once, however many cycles it has. Each side needs at least one fit.
Comparison compare(const ComparisonSide& a, const ComparisonSide& b);

}  // namespace slipfit
