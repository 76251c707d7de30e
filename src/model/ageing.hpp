#pragma once

#include <cmath>
#include <functional>
#include <optional>

namespace slipfit::model {

/// F_s - F_k(0+) = difference_N + rate_N ln(stick / reference_s). docs/model.md (18)
struct AgeingLaw {
  double difference_N = 0.0;
  double rate_N = 0.0;  ///< > 0
  double reference_s = 1.0;
};

/// Stick time of the limit cycle whose slips start from F_s - F_k(0+), and its derivative.
struct StickTime {
  double seconds = 0.0;
  double by_difference_s_per_N = 0.0;
};
using StickTimeOf = std::function<std::optional<StickTime>(double difference_N)>;

/// F_s - F_k(0+) of the limit cycle, whose stick is just long enough for it. Of two such cycles the one with the longer
/// stick: the other is unstable. Empty where there is none: after every slip the next is smaller.
std::optional<double> aged_difference_N(const AgeingLaw& law, const StickTimeOf& stick_time);

/// The same with derivatives (Jet as in Ceres), one Newton step from the solution: `stick_s` at F_s - F_k held there.
template <class Jet>
Jet aged_difference_N(double solution_N, const Jet& difference_N, const Jet& rate_N, const Jet& stick_s,
                      double stick_by_difference_s_per_N, double reference_s) {
  using std::log;
  const Jet excess_N = difference_N + rate_N * log(stick_s / reference_s) - solution_N;
  return solution_N + excess_N / (1.0 - rate_N.a / stick_s.a * stick_by_difference_s_per_N);
}

}  // namespace slipfit::model
