#pragma once

#include <optional>
#include <vector>

#include "fit/coordinates.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// What averaging or filtering of the samples that the model does not know of does to a fit. To second order all that
/// counts is the variance sigma^2 of the filter's impulse response: W^2 / 12 of a moving average over W.
struct Smoothing {
  double variance_s2 = 0.0;  ///< sigma^2 that the rounding of onset and end of the slips shows; may be negative
  double standard_error_s2 = 0.0;
  Coordinates move_per_s2 = Coordinates::Zero();  ///< from the fit's coordinates to those with it in the model

  /// Returns whether the averaging exceeds what one step of the clock explains.
  [[nodiscard]] bool exceeds_step(double sample_interval_s) const;
  /// sigma^2 that what is seen allows for. The move per sigma^2 is that of little averaging: a quarter more of what is
  /// seen allows for the bend.
  [[nodiscard]] double largest_variance_s2() const { return 1.25 * variance_s2 + 2.0 * standard_error_s2; }
};

/// d ln w_n / d (w_n sigma)^2 of damped slips that are averaged.
inline constexpr double kFrequencyByAverage = 0.62;

/// sigma^2 as one parameter more at the solution of the fit: one Gauss-Newton step, errors from the scatter over the
/// cycles. Ramps count as not joined. Empty where the data do not
/// determine it, or where it is a parameter of the fit already.
std::optional<Smoothing> estimate_smoothing(const BlockFit& fit, const Held& held, double sample_interval_s);

/// Recordings as the fitted model would give them, rounded to multiples of `step` with a random offset, noise
/// (what the residuals have beyond the rounding) included: the same noise from another sample on in each of them, which
/// takes a quarter of the time. Rounding repeats its errors from cycle to cycle where these are regular: neither
/// residuals nor the spread over the cycles show it.
class RoundedCopies {
 public:
  /// `model`: fitted force of every sample. Same arguments, same copies.
  RoundedCopies(std::vector<double> model, double step, double residual_rms);
  [[nodiscard]] std::vector<double> draw(unsigned copy) const;

 private:
  std::vector<double> model_;
  double step_;
  std::vector<double> noise_;
};

inline constexpr unsigned kRoundedCopies = 24;

/// Returns the uncertainty with the spread of refits to such copies, which replaces the white-noise covariance or is
/// added to that of the jackknife. A row of `moves` holds the move of the coordinates by one refit.
Uncertainty with_rounding(Uncertainty uncertainty, const Moves& moves);

}  // namespace slipfit::fit
