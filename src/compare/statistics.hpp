#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slipfit/core/estimate.hpp"

namespace slipfit::comparing {

/// A number with how far below and above it its 95 % interval reaches.
struct Reach {
  double value = 0.0;
  double down = 0.0;
  double up = 0.0;
  double standard_error = 0.0;
};

/// Two independent numbers, and the degrees of freedom of Student's t behind their intervals.
struct Pair {
  Reach a, b;
  double degrees_of_freedom = 0.0;
};

/// Compares one fit on each side; empty if a standard error is unknown.
std::optional<Pair> by_standard_errors(const Estimate& a, const Estimate& b);

/// Compares the values of recordings, at least two on one side and one on the other.
std::optional<Pair> by_scatter(std::span<const Estimate> a, std::span<const Estimate> b);

/// Returns the mean of at least one estimate; several have the interval of their scatter.
Estimate mean_of(std::span<const Estimate> estimates);

Estimate difference_of(const Pair& pair);
Estimate ratio_of(const Pair& pair);
/// Two-sided, of the difference; below 0.05 exactly where the 95 % interval leaves 0 out.
std::optional<double> p_value_of(const Pair& pair);

/// Returns each p value adjusted for the whole family (Holm 1979), in the given order.
std::vector<double> holm(const std::vector<double>& p_values);

}  // namespace slipfit::comparing
