#pragma once

#include <vector>

#include "fit/inference/uncertainty.hpp"

namespace slipfit::fit {

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

/// The spread of refits to such copies in place of the white-noise covariance, or added to that of the jackknife. Each
/// row of `moves`: what one refit moves the coordinates by.
Uncertainty with_rounding(Uncertainty uncertainty, const Moves& moves);

}  // namespace slipfit::fit
