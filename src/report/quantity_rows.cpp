#include "report/quantity_rows.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "slipfit/fit/parameter.hpp"

namespace slipfit {
namespace {

std::vector<Quantity> make_quantities() {
  std::vector<Quantity> all;
  for (const ParameterInfo& parameter : parameter_table()) {
    all.push_back({"parameters", parameter.key, parameter.words, parameter.unit});
  }
  all.push_back(kFrequency);
  const auto add = [&all](const auto& table) { all.insert(all.end(), table.begin(), table.end()); };
  add(kMeasured);
  add(kPredicted);
  add(kOnSurface);
  add(kCoefficients);
  add(kCoefficientThirds);
  add(kCoefficientSpreads);
  add(kCycleQuantities);
  add(kTransients);
  add(kPattern);
  return all;
}

}  // namespace

std::span<const Quantity> recording_quantities() {
  static const std::vector<Quantity> all = make_quantities();
  return all;
}

const Quantity& quantity_with_key(std::string_view key) {
  const std::span<const Quantity> all = recording_quantities();
  const auto found = std::ranges::find(all, key, &Quantity::key);
  assert(found != all.end());
  return *found;
}

std::string full_words(const Quantity& quantity) {
  return (quantity.section == "coefficients" ? "coefficient of friction, " : "") + std::string(quantity.words);
}

std::string suffix_of(std::string_view unit) {
  std::string suffix = unit.empty() ? "" : "_";
  for (const char c : unit) suffix += c == '/' ? std::string("_per_") : std::string(1, c == ' ' ? '_' : c);
  return suffix;
}

std::string key_of(const Quantity& quantity, std::string_view property) {
  std::string key(quantity.key);
  return key.insert(key.size() - suffix_of(quantity.unit).size(), property);
}

DisplayUnit unit_of(const Quantity& quantity, const Estimate& estimate, const Conditions& conditions) {
  if (quantity.unit == "m/s") return speed_unit(conditions.speed_unit, estimate.value);
  return suitable_unit(estimate, quantity.unit == "N" ? force_unit(conditions.quantity) : std::string(quantity.unit));
}

EstimateRow estimate_row(const Quantity& quantity, const Estimate& estimate, const Conditions& conditions) {
  return estimate_row(estimate, unit_of(quantity, estimate, conditions));
}

std::vector<double> fitted_force(const Recording& recording, const Analysis& analysis) {
  std::vector<double> fitted(recording.size(), std::numeric_limits<double>::quiet_NaN());
  if (!analysis.fit) return fitted;
  for (const CurvePoint& point : analysis.fit->curve) {
    if (point.sample < fitted.size()) fitted[point.sample] = point.force;
  }
  return fitted;
}

std::vector<double> force_without_interference(const Recording& recording, const Analysis& analysis) {
  std::vector<double> force(recording.force().begin(), recording.force().end());
  if (!analysis.fit) return force;
  for (const CurvePoint& point : analysis.fit->curve) {
    if (point.sample < force.size()) force[point.sample] -= point.interference;
  }
  return force;
}

}  // namespace slipfit
