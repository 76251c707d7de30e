#pragma once

#include <cmath>

namespace slipfit::model {

/// Stick over which the force recovers a drop where it rises more steeply after a slip: x of
/// x + rise (1 - exp(-x / length)) = drop, all in metres, rise that of the force over the stiffness. docs/model.md (25)
/// drop > 0, rise >= 0, length > 0. Numbers, or jets of them: one Newton step from the solution gives the derivatives.
template <class Number>
Number reloaded_stick_m(const Number& drop_m, const Number& rise_m, const Number& length_m) {
  using std::exp;
  constexpr int kMostSteps = 60;
  constexpr double kSharp = 1e-15;
  Number x = drop_m / (1.0 + rise_m / length_m);  // below the solution; the sum bends down, so every step stays there
  for (int step = 0; step < kMostSteps; ++step) {
    const Number left = exp(-x / length_m);
    const Number move = (drop_m - x - rise_m * (1.0 - left)) / (1.0 + rise_m / length_m * left);
    x = x + move;
    if (!(move > kSharp * x)) break;
  }
  const Number left = exp(-x / length_m);
  return x + (drop_m - x - rise_m * (1.0 - left)) / (1.0 + rise_m / length_m * left);
}

}  // namespace slipfit::model
