#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "fit/selection/damped_fit.hpp"

namespace slipfit::fit {

/// The recording, as if it stated that its samples are averaged over this time.
Recording with_average(const Recording& recording, double average_s);

/// The slips that are left behind the average are those of the model as far as so few cycles tell, and longer than a
/// step of the clock.
bool follows_slips(const DampedFit& fit, double sample_interval_s);

/// Fits of all cycles with an average that is a parameter, from one of about the given variance on.
class AverageSolver {
 public:
  /// `plain`: without an average. All must outlive this.
  AverageSolver(const FitInput& input, const DampedFit& plain) : input_(input), plain_(plain) {}

  /// `other`: a fit with another average, whose cycles and samples will do. Empty where there is no solution, or slips
  /// of the average to begin with are not those of the model (follows_slips).
  [[nodiscard]] std::optional<DampedFit> fit(double variance_s2, const Coordinates& near, const DampedFit* other) const;

 private:
  [[nodiscard]] std::optional<DampedFit> drafted(double variance_s2, const Coordinates& near) const;
  /// A fit of some cycles whose slips do not come to rest or are not shaped like the model's (follows_slips), or that
  /// explains them less well than the fit without average.
  [[nodiscard]] bool is_hopeless(const BlockFit& some) const;
  /// The same cycles and samples with another average, and the rise after the slips that it shows, from `start` on.
  [[nodiscard]] std::optional<DampedFit> beside(const DampedFit& other, double variance_s2,
                                                const Coordinates& start) const;
  /// From where the blocks stand. `near`: a fit of the same cycles.
  [[nodiscard]] std::optional<DampedFit> solved(BlockFit blocks, const DampedFit& near) const;

  const FitInput& input_;
  const DampedFit& plain_;
};

}  // namespace slipfit::fit
