#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study.hpp"

// Ways to compute one stick-slip cycle, in scaled form: times are w_n t, forces are above F_k(0+) in units of k V /
// w_n.

namespace atlas {

/// z'' + 2 zeta z' + z = slope (exp(rate v) - 1) / rate in slip, v = 1 - z' the sliding speed over V; stick until
/// z + 2 zeta = lambda. rate = alpha V; slope = 0: Coulomb friction.
struct ForwardScene {
  double lambda = 1.0;
  double zeta = 0.0;
  double slope = 0.0;
  double rate = 0.0;
};

/// Friction above F_k(0+) at a sliding speed, any number type.
template <class T>
T friction_above(const ForwardScene& scene, T speed) {
  using std::expm1;
  if (scene.slope == 0.0) return T(0);
  return T(scene.slope) * expm1(T(scene.rate) * speed) / T(scene.rate);
}

/// Even times, counted from the moment when the spring force falls through F_k(0+): every method has one.
struct WaveTimes {
  double step = 0.1;
  std::size_t count = 0;
};

enum class Outcome { Cycle, NoCycle, GaveUp };

struct Answer {
  Outcome outcome = Outcome::GaveUp;
  double period = 0.0;
  std::vector<double> z;  ///< at WaveTimes
};

/// One method with one setting (step, tolerance, width).
struct ForwardMethod {
  std::string family;
  std::string setting;
  std::function<Answer(const ForwardScene&, const WaveTimes&)> run;
};

/// Rivals and slipfit's own tiers.
std::vector<ForwardMethod> forward_methods();

/// Runge-Kutta-Fehlberg 7(8) in long double at short steps, events by bisection of the step: shares nothing with the
/// closed forms. `samples` over the period that it finds.
struct Reference {
  Answer answer;
  WaveTimes times;
};
Reference solve_reference(const ForwardScene& scene, std::size_t samples);

}  // namespace atlas
