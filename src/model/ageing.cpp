#include "model/ageing.hpp"

#include <algorithm>

namespace slipfit::model {

// The stick time is nearly proportional to F_s - F_k, so that h(D), the static friction after t(D) less D, is concave:
// Newton from above its larger root comes down to it from one side, and finds h rising before it finds a root where
// there is none.
std::optional<double> aged_difference_N(const AgeingLaw& law, const StickTimeOf& stick_time, double sharp) {
  constexpr int kMaxSteps = 200;
  constexpr int kMaxDoublings = 20;  // the logarithm of a stick time brings few times the rate
  struct Excess {
    double value_N, slope;
  };
  const auto excess_at = [&](double difference_N) -> std::optional<Excess> {
    const std::optional<StickTime> stick = stick_time(difference_N);
    if (!stick || !(stick->seconds > 0.0)) return std::nullopt;
    return Excess{law.after(stick->seconds) - difference_N,
                  law.rate_N * stick->by_difference_s_per_N / (stick->seconds + law.cutoff_s) - 1.0};
  };
  // A slip that does not stick from so much more than the static friction after the reference stick does not stick at
  // this speed at all: longer sticks are those of lower speeds.
  constexpr int kMostWithoutStick = 4;  // doublings
  double difference_N = std::max(law.difference_N, law.rate_N);
  std::optional<Excess> excess = excess_at(difference_N);
  int without_stick = excess ? 0 : 1;
  for (int i = 0; i < kMaxDoublings && !(excess && excess->value_N <= 0.0 && excess->slope < 0.0); ++i) {
    if (without_stick > kMostWithoutStick) return std::nullopt;
    difference_N *= 2.0;
    excess = excess_at(difference_N);
    if (!excess) ++without_stick;
  }
  for (int i = 0; i < kMaxSteps && excess && excess->slope < 0.0; ++i) {
    const double step_N = excess->value_N / excess->slope;
    difference_N -= step_N;
    if (std::abs(step_N) <= sharp * difference_N) return difference_N;
    if (!(difference_N > 0.0)) break;
    excess = excess_at(difference_N);
  }
  return std::nullopt;
}

}  // namespace slipfit::model
