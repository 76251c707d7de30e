#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "fit/selection/fit_input.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// The search for the variance sigma^2 of an instrument's kernel on some of the cycles and, of these, some of the
/// samples around their slips, from the features of the slips. A moving average over W has sigma^2 = W^2 / 12, a lag T
/// of first order T^2.
class KernelSearch {
 public:
  /// `plain`: the fit of all cycles without a kernel. `count`: of cycles. `half_width_s`: around the middle of a slip,
  /// what the kernel may change. Empty where too few cycles are that wide.
  static std::optional<KernelSearch> create(const FitInput& input, const DampedFit& plain, double half_width_s,
                                            std::size_t count);

  /// A sum of squares, in units of the noise, and where it is.
  struct Least {
    double sum = std::numeric_limits<double>::infinity();
    double variance_s2 = 0.0;
    Parameters parameters{};
    double resting = 0.0;  ///< share of the slips that come to rest
    double gain = 0.0;     ///< of `minima`: share of the sum without an average by which it is smaller
  };
  /// Where the sum of squares of a moving average is least, the smallest first. There are two where the time of the
  /// fall may be either W's or the slip's own (docs/model.md section 7). Those of at least this gain.
  [[nodiscard]] std::vector<Least> minima(double least_gain) const;

  /// The least near one of another search, the average as a parameter: infinity without a solution.
  [[nodiscard]] Least refined(const Least& near) const;
  /// The same of a sensor of first order near a lag of this variance, from one of this search.
  [[nodiscard]] Least least_lag(const Least& near, double variance_s2) const;

  /// In the sum of squares.
  [[nodiscard]] double residuals() const;

 private:
  KernelSearch(const FitInput& input, const BlockFit& plain, CycleSet cycles);

  [[nodiscard]] double seen_variance_s2() const;
  /// From the solution at another variance, or where the line through two leads if that is nearer.
  [[nodiscard]] Least at(double variance_s2, const Least& near, const Least* other) const;
  [[nodiscard]] Parameters extrapolated(double variance_s2, const Least& near, const Least& other) const;
  [[nodiscard]] Least solved(const BlockFit& start, FreeTime time) const;
  [[nodiscard]] BlockFit with_kernel(const BlockFit& fit, FreeTime kernel, double variance_s2) const;
  [[nodiscard]] BlockFit started() const;
  [[nodiscard]] double log_frequency_gain(double variance_s2) const;
  [[nodiscard]] std::optional<Held> solve_with_damping(BlockFit& fit) const;

  const Segmentation& segmentation_;
  Held held_;
  const BlockFit& plain_;
  std::shared_ptr<const CycleSet> cycles_;
};

}  // namespace slipfit::fit
