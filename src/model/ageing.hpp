#pragma once

#include <cmath>
#include <functional>
#include <optional>

namespace slipfit::model {

/// F_s - F_k(0+) = difference_N + rate_N ln((stick + cutoff_s) / (reference_s + cutoff_s)). docs/model.md (18)
/// Numbers, or jets of them.
template <class Number>
struct AgeingLawOf {
  Number difference_N;
  Number rate_N;  ///< below 0: static friction falls with the stick time
  double reference_s;
  Number cutoff_s;  ///< >= 0

  [[nodiscard]] Number after(const Number& stick_s) const {
    using std::log;
    return difference_N + rate_N * log((stick_s + cutoff_s) / (reference_s + cutoff_s));
  }
};
using AgeingLaw = AgeingLawOf<double>;

/// Stick time of the limit cycle whose slips start from F_s - F_k(0+), and its derivative.
struct StickTime {
  double seconds = 0.0;
  double by_difference_s_per_N = 0.0;
};
using StickTimeOf = std::function<std::optional<StickTime>(double difference_N)>;

/// F_s - F_k(0+) of the limit cycle, whose stick is just long enough for it. Of two such cycles the one with the longer
/// stick: the other is unstable. Empty where there is none: after every slip the next is smaller. `sharp`: relative
/// error of the solution.
inline constexpr double kSharpDifference = 1e-10;
std::optional<double> aged_difference_N(const AgeingLaw& law, const StickTimeOf& stick_time,
                                        double sharp = kSharpDifference);

/// Returns the same difference with derivatives (Jet as in Ceres), by one Newton step from the solution. `stick_s` is
/// evaluated with F_s - F_k held there.
template <class Jet>
Jet aged_difference_N(double solution_N, const AgeingLawOf<Jet>& law, const Jet& stick_s,
                      double stick_by_difference_s_per_N) {
  const double gain = law.rate_N.a / (stick_s.a + law.cutoff_s.a) * stick_by_difference_s_per_N;
  return solution_N + (law.after(stick_s) - solution_N) / (1.0 - gain);
}

}  // namespace slipfit::model
