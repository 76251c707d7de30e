#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "scenes.hpp"

using namespace slipfit;

namespace test {
namespace {

const Parameter* find(const Analysis& analysis, const std::string& name) {
  if (!analysis.fit) return nullptr;
  for (const Parameter& parameter : analysis.fit->parameters) {
    if (parameter.name() == name) return &parameter;
  }
  return nullptr;
}

void check_near(double foretold, double found, double standard_error) {
  CAPTURE(foretold, found, standard_error);
  CHECK(std::abs(found - foretold) <= 0.01 * standard_error);
}

void check_estimate(const Estimate& before, const Estimate& after, double factor) {
  REQUIRE(before.value.has_value() == after.value.has_value());
  REQUIRE(before.standard_error.has_value() == after.standard_error.has_value());
  REQUIRE(before.ci95.has_value() == after.ci95.has_value());
  if (!before.value || !before.standard_error) return;
  const double error = factor * *before.standard_error;
  check_near(factor * *before.value, *after.value, error);
  check_near(error, *after.standard_error, error);
  if (!before.ci95) return;
  check_near(factor * before.ci95->low, after.ci95->low, error);
  check_near(factor * before.ci95->high, after.ci95->high, error);
}

/// Whether units are plausible depends on absolute numbers: k, m and c are then conditional.
bool is_implausible(const Analysis& analysis) {
  return std::any_of(analysis.warnings.begin(), analysis.warnings.end(),
                     [](const Warning& warning) { return warning.code == "implausible_units"; });
}

bool depends_on_units(const Parameter& parameter) {
  return parameter.id == ParameterId::Stiffness || parameter.id == ParameterId::Mass ||
         parameter.id == ParameterId::DampingCoefficient;
}

}  // namespace

void check_same(const Analysis& before, const Analysis& after, const Factors& factors) {
  CHECK(after.motion == before.motion);
  CHECK(after.cycles.count == before.cycles.count);
  REQUIRE(before.fit.has_value());
  REQUIRE(after.fit.has_value());
  CHECK(after.fit->tier == before.fit->tier);
  REQUIRE(after.fit->parameters.size() == before.fit->parameters.size());
  for (const Parameter& parameter : before.fit->parameters) {
    CAPTURE(parameter.name());
    const Parameter* const other = find(after, std::string(parameter.name()));
    REQUIRE(other != nullptr);
    const bool is_of_units = depends_on_units(parameter) && is_implausible(before) != is_implausible(after);
    if (!is_of_units) CHECK(other->status == parameter.status);
    const auto factor = factors.find(std::string(parameter.name()));
    check_estimate(parameter.estimate, other->estimate, factor == factors.end() ? 1.0 : factor->second);
  }
}

void check_agree(const Analysis& first, const Analysis& second) {
  CHECK(first.motion == second.motion);
  REQUIRE(first.fit.has_value());
  std::size_t compared = 0;
  for (const Parameter& parameter : first.fit->parameters) {
    const Parameter* const other = find(second, std::string(parameter.name()));
    if (other == nullptr || !parameter.estimate.ci95 || !other->estimate.ci95) continue;
    const Interval a = *parameter.estimate.ci95;
    const Interval b = *other->estimate.ci95;
    CAPTURE(parameter.name(), a.low, a.high, b.low, b.high);
    CHECK(std::max(a.low, b.low) <= std::min(a.high, b.high));
    ++compared;
  }
  CHECK(compared >= 3);
}

}  // namespace test
