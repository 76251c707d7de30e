#include "slipfit/compare.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "compare/statistics.hpp"
#include "core/unknown.hpp"
#include "report/document/json_node.hpp"
#include "report/format.hpp"
#include "report/quantity_rows.hpp"

namespace slipfit {

namespace {

using Fits = std::vector<ComparedFit>;

/// The values of one quantity by the fits of a side.
struct SideValues {
  std::vector<Estimate> known;
  std::string status;
  std::string why_not;  ///< of the first fit without it
  bool is_absent = true;
};

/// Returns the rank of a status, from the most to the least reliable.
std::size_t doubt_of(const std::string& status) {
  constexpr std::array<const char*, 3> kOrder{"identified", "conditional", "weak"};
  return static_cast<std::size_t>(std::ranges::find(kOrder, status) - kOrder.begin());
}

SideValues values_of(const Fits& fits, std::size_t quantity) {
  SideValues side;
  for (const ComparedFit& fit : fits) {
    const ComparedValue& value = fit.values[quantity];
    side.is_absent = side.is_absent && value.is_absent;
    if (!value.estimate.value) {
      if (side.why_not.empty()) side.why_not = value.estimate.note;
      continue;
    }
    if (side.known.empty() || doubt_of(value.status) > doubt_of(side.status)) side.status = value.status;
    side.known.push_back(value.estimate);
  }
  return side;
}

SideEstimate side_estimate(const SideValues& side) {
  if (side.known.empty()) return {unknown(side.why_not), 0, {}};
  return {comparing::mean_of(side.known), side.known.size(), side.status};
}

ComparisonMethod method_of(std::size_t recordings_a, std::size_t recordings_b) {
  if (recordings_a > 1 && recordings_b > 1) return ComparisonMethod::Welch;
  if (recordings_a > 1) return ComparisonMethod::ScatterOfA;
  return recordings_b > 1 ? ComparisonMethod::ScatterOfB : ComparisonMethod::StandardErrors;
}

std::string why_not_compared(const SideValues& a, const SideValues& b) {
  if (a.known.empty() && b.known.empty()) return "not known in A and B: " + a.why_not;
  if (a.known.empty()) return "not known in A: " + a.why_not;
  return b.known.empty() ? "not known in B: " + b.why_not : "without a standard error";
}

QuantityComparison compare_quantity(const Quantity& quantity, const SideValues& a, const SideValues& b) {
  QuantityComparison result;
  result.quantity = quantity;
  result.a = side_estimate(a);
  result.b = side_estimate(b);
  result.difference = result.ratio = unknown(why_not_compared(a, b));
  if (a.known.empty() || b.known.empty()) return result;
  const bool are_single = a.known.size() == 1 && b.known.size() == 1;
  const auto pair = are_single ? comparing::by_standard_errors(a.known.front(), b.known.front())
                               : comparing::by_scatter(a.known, b.known);
  if (!pair) return result;
  result.method = method_of(a.known.size(), b.known.size());
  result.difference = comparing::difference_of(*pair);
  result.ratio = comparing::ratio_of(*pair);
  result.p_value = comparing::p_value_of(*pair);
  return result;
}

void adjust(std::vector<QuantityComparison>& quantities) {
  std::vector<double> p_values;
  for (const QuantityComparison& quantity : quantities) {
    if (quantity.p_value) p_values.push_back(*quantity.p_value);
  }
  const std::vector<double> adjusted = comparing::holm(p_values);
  auto next = adjusted.begin();
  for (QuantityComparison& quantity : quantities) {
    if (quantity.p_value) quantity.p_adjusted = *next++;
  }
}

/// Returns true if a condition differs by more than one percent, the rounding of typed values.
bool differ(const Comparison& comparison, ComparedCondition condition) {
  constexpr double kRoundedRatio = 1.01;
  const auto range_a = range_of(comparison.a, condition);
  const auto range_b = range_of(comparison.b, condition);
  if (!range_a || !range_b) return false;
  return std::max(range_a->high, range_b->high) > kRoundedRatio * std::min(range_a->low, range_b->low);
}

void warn_of_conditions(Comparison& comparison) {
  const Fits& a = comparison.a.fits;
  const Fits& b = comparison.b.fits;
  if (differ(comparison, &ComparedFit::speed_m_per_s)) {
    comparison.warnings.push_back(
        {"speeds_differ", fmt::format("driving speed of A: {}, of B: {}: quantities that depend on speed (frequency, "
                                      "spacing, friction) may differ for this reason alone",
                                      condition_text(comparison.a, &ComparedFit::speed_m_per_s),
                                      condition_text(comparison.b, &ComparedFit::speed_m_per_s))});
  }
  if (differ(comparison, &ComparedFit::normal_force_N)) {
    comparison.warnings.push_back(
        {"loads_differ", fmt::format("normal force of A: {}, of B: {}: friction forces, frequency and spacing differ "
                                     "for this reason; coefficients of friction account for it",
                                     condition_text(comparison.a, &ComparedFit::normal_force_N),
                                     condition_text(comparison.b, &ComparedFit::normal_force_N))});
  }
  const auto any_differs = [&a, &b](auto property) {
    const auto differs = [&](const ComparedFit& fit) { return property(fit) != property(a.front()); };
    return std::ranges::any_of(a, differs) || std::ranges::any_of(b, differs);
  };
  if (any_differs([](const ComparedFit& fit) { return fit.zero_force_N.has_value(); })) {
    comparison.warnings.push_back(
        {"zeros_differ",
         "the sensor's reading without force is stated for some recordings only: forces and coefficients of friction "
         "may differ for this reason alone; state --zero for all of them"});
  }
  if (any_differs([](const ComparedFit& fit) { return fit.motion; })) {
    comparison.warnings.push_back(
        {"motions_differ",
         "the recordings show different kinds of motion: only quantities that both sides have are compared"});
  }
}

void warn_of_same_recording(Comparison& comparison) {
  std::set<std::string> sources;
  for (const Fits* const fits : {&comparison.a.fits, &comparison.b.fits}) {
    for (const ComparedFit& fit : *fits) {
      if (fit.source.empty() || sources.insert(fit.source).second) continue;
      comparison.warnings.push_back(
          {"recording_repeated", fmt::format("'{}' is identical to another recording in the comparison: it is not a "
                                             "repeat, and counting it twice makes intervals too short",
                                             fit.id)});
      return;
    }
  }
}

void warn_of_repeats(Comparison& comparison) {
  const bool one_a = comparison.a.fits.size() == 1;
  const bool one_b = comparison.b.fits.size() == 1;
  if (one_a && one_b) {
    comparison.warnings.push_back(
        {"scatter_unknown",
         "one recording on each side: the intervals come from the standard errors of the fits, and the scatter of "
         "repeated tests is unknown; a difference between two recordings is not a difference between two materials "
         "(give repeats: several files or a group)"});
  } else if (one_a || one_b) {
    comparison.warnings.push_back(
        {"scatter_of_one_side", fmt::format("{} is one recording: it is assumed to scatter like the repeats of {}",
                                            one_a ? 'A' : 'B', one_a ? 'B' : 'A')});
  }
}

}  // namespace

std::string condition_text(const ComparisonSide& side, ComparedCondition condition) {
  const std::optional<Interval> range = range_of(side, condition);
  if (!range) return {};
  const DisplayUnit unit = condition == &ComparedFit::speed_m_per_s
                               ? speed_unit(side.fits.front().speed_unit, range->high)
                               : display_unit("N", range->high);
  const std::string from = range->low < range->high ? fmt::format("{:.4g} to ", range->low * unit.per_SI) : "";
  return fmt::format("{}{:.4g} {}", from, range->high * unit.per_SI, unit.unit);
}

std::optional<Interval> range_of(const ComparisonSide& side, ComparedCondition condition) {
  std::optional<Interval> range;
  for (const ComparedFit& fit : side.fits) {
    const std::optional<double>& value = fit.*condition;
    if (!value) continue;
    range = range ? Interval{std::min(range->low, *value), std::max(range->high, *value)} : Interval{*value, *value};
  }
  return range;
}

Comparison compare(const ComparisonSide& a, const ComparisonSide& b) {
  Comparison comparison{a, b, {}, {}};
  const auto quantities = compared_quantities();
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const SideValues values_a = values_of(a.fits, i);
    const SideValues values_b = values_of(b.fits, i);
    if (values_a.is_absent && values_b.is_absent) continue;
    comparison.quantities.push_back(compare_quantity(quantities[i], values_a, values_b));
  }
  adjust(comparison.quantities);
  warn_of_repeats(comparison);
  warn_of_same_recording(comparison);
  warn_of_conditions(comparison);
  return comparison;
}

namespace {

using documents::JsonNode;

std::vector<Quantity> make_quantities() {
  std::vector<Quantity> quantities;
  for (const Quantity& quantity : recording_quantities()) {
    if (quantity.section == "parameters" && quantity.key != info(ParameterId::SensorAverage).key)
      quantities.push_back(quantity);
  }
  quantities.push_back(kFrequency);
  quantities.push_back(kMeasured.front());  // the others are its inverse and its spread
  quantities.insert(quantities.end(), kCoefficients.begin(), kCoefficients.end());
  return quantities;
}

/// Returns a value for the comparison; values that are only bounded or were not measured have none.
ComparedValue value_in(const JsonNode& document, const Quantity& quantity) {
  const auto found = documents::quantity_in(document, quantity);
  if (!found) return {unknown("its result does not contain it"), {}, true};
  ComparedValue value{found->estimate, found->status, false};
  Estimate& estimate = value.estimate;
  if (value.status == "bounded") {
    estimate = {{}, {}, estimate.ci95, "only its interval is known (status bounded)"};
  } else if (value.status == "fixed") {
    estimate = unknown("fixed at a stated value (status fixed)");
  } else if (!estimate.value) {
    estimate = unknown(estimate.note.empty() ? "not known" : estimate.note);
  }
  return value;
}

ComparedFit fit_from(const JsonNode& document) {
  ComparedFit fit;
  fit.id = document.text_at("id");
  fit.motion = document.text_at("status");
  if (const auto recording = document.known("recording")) {
    fit.file = recording->text_at("file");
    fit.source = recording->text_at("input_digest");
    const auto slides = recording->known("sliding_s");
    if (!fit.source.empty()) fit.source += slides ? slides->json_text() : "null";
    fit.group = recording->text_at("group");
    fit.speed_m_per_s = recording->number_at("speed_m_per_s");
    fit.speed_unit = recording->text_at("speed_unit");
    fit.normal_force_N = recording->number_at("normal_force_N");
    fit.zero_force_N = recording->number_at("zero_force_N");
  }
  for (const Quantity& quantity : compared_quantities()) fit.values.push_back(value_in(document, quantity));
  return fit;
}

}  // namespace

std::span<const Quantity> compared_quantities() {
  static const std::vector<Quantity> quantities = make_quantities();
  return quantities;
}

Result<ComparedFit> compared_fit(const std::string& document, const std::string& name) {
  return documents::with_document<ComparedFit>(document, name, fit_from);
}

}  // namespace slipfit
