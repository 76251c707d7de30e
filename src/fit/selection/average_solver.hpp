#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "fit/inference/smoothing.hpp"
#include "fit/selection/damped_fit.hpp"

namespace slipfit::fit {

/// The recording, as if it stated that its samples are averaged over this time.
Recording with_average(const Recording& recording, double average_s);

/// The slips that are left behind the average are those of the model as far as so few cycles tell, and longer than a
/// step of the clock.
bool follows_slips(const DampedFit& fit, double sample_interval_s);

/// A fit of all cycles with an average in it, and what is left to smooth.
struct AveragedFit {
  DampedFit fit;
  Smoothing beyond;
  double variance_s2 = 0.0;

  /// In standard errors.
  [[nodiscard]] double off() const { return std::abs(beyond.variance_s2) / beyond.standard_error_s2; }
};

/// Fits of all cycles with an average of about the given variance.
class AverageSolver {
 public:
  /// `plain`: without an average. All must outlive this.
  AverageSolver(const FitInput& input, const DampedFit& plain) : input_(input), plain_(plain) {}

  /// Newton's steps in sigma^2, the nearest of them. `other`: a fit with another average, whose cycles and samples will
  /// do.
  [[nodiscard]] std::optional<AveragedFit> fit(double variance_s2, const Globals& near, const DampedFit* other) const;

 private:
  /// Of the fit without an average, as one of this time shows it.
  [[nodiscard]] std::shared_ptr<const RiseAfterSlip> reloading(double average_s) const;
  [[nodiscard]] std::optional<DampedFit> drafted(double variance_s2, const Globals& near) const;
  /// A fit of some cycles whose slips do not come to rest or are not shaped like the model's (follows_slips), or that
  /// explains them less well than the fit without average.
  [[nodiscard]] bool is_hopeless(const BlockFit& some) const;
  /// The same cycles and samples with another average, and the rise after the slips that it shows. From the other's
  /// solution on, or from `start`.
  [[nodiscard]] std::optional<DampedFit> beside(const DampedFit& other, double variance_s2, const Globals* start) const;

  const FitInput& input_;
  const DampedFit& plain_;
};

}  // namespace slipfit::fit
