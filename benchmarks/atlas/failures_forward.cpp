#include <cmath>
#include <map>

#include "failure_plane.hpp"
#include "forward_methods.hpp"
#include "slipfit/model/motion.hpp"

namespace atlas {
namespace {

constexpr double kGross = 0.01;  // relative error of the period that counts as wrong
constexpr WaveTimes kAnyTimes{0.1, 1};

Mark compare(const Answer& answer, const Answer& truth) {
  if (answer.outcome == Outcome::GaveUp) return Mark::Refused;
  if (answer.outcome != truth.outcome) return Mark::Wrong;
  if (truth.outcome == Outcome::NoCycle) return Mark::Right;
  return std::abs(answer.period / truth.period - 1.0) > kGross ? Mark::Wrong : Mark::Right;
}

std::vector<ForwardMethod> chosen(const std::map<std::string, std::vector<std::string>>& settings) {
  std::vector<ForwardMethod> methods;
  for (ForwardMethod& method : forward_methods()) {
    const auto family = settings.find(method.family);
    if (family == settings.end()) continue;
    for (const std::string& setting : family->second) {
      if (setting == method.setting) methods.push_back(method);
    }
  }
  return methods;
}

std::string title_of(const ForwardMethod& method) {
  return method.setting.empty() ? method.family : method.family + ", " + method.setting;
}

std::string lambda_zeta(Effort effort) {
  const std::size_t fineness = effort == Effort::Full ? 2 : 1;
  const Plane plane{"forward", log_spaced(0.03, 300.0, 12 * fineness + 1), log_spaced(0.002, 0.8, 6 * fineness + 1)};
  std::string rows;
  for (const ForwardMethod& method : chosen({{"undamped closed form", {""}},
                                             {"paper's approximation", {""}},
                                             {"RK4, sign switching", {"0.1", "0.01"}},
                                             {"time stepping (Moreau)", {"0.01"}},
                                             {"ODE 5(4), event location", {"0.001", "1e-05"}},
                                             {"switch model (Leine)", {"0.0001"}},
                                             {"tanh-smoothed", {"0.001"}},
                                             {"velocity tier", {""}},
                                             {"exact damped", {""}}})) {
    rows += judge_plane(plane, title_of(method), [&](double lambda, double zeta) {
      const ForwardScene scene{lambda, zeta, 0.0, 0.0};
      return compare(method.run(scene, kAnyTimes), solve_reference(scene, 1).answer);
    });
  }
  return rows;
}

/// Scenes just above and just below the limit of stick-slip, where the body nearly comes to rest; the answer is wrong
/// if either is.
std::string grazing(Effort effort) {
  const std::size_t fineness = effort == Effort::Full ? 2 : 1;
  const Plane plane{"grazing", log_spaced(1e-11, 0.1, 10 * fineness + 1), log_spaced(0.005, 0.8, 5 * fineness + 1)};
  std::string rows;
  for (const ForwardMethod& method : chosen({{"RK4, sign switching", {"0.01", "0.001"}},
                                             {"time stepping (Moreau)", {"0.001"}},
                                             {"ODE 5(4), event location", {"1e-05", "1e-09", "1e-11"}},
                                             {"switch model (Leine)", {"1e-06"}},
                                             {"velocity tier", {""}},
                                             {"exact damped", {""}}})) {
    rows += judge_plane(plane, title_of(method), [&](double distance, double zeta) {
      const double limit = slipfit::critical_lambda(zeta);
      const auto outcome = [&](double lambda) { return method.run({lambda, zeta, 0.0, 0.0}, kAnyTimes).outcome; };
      const Outcome above = outcome(limit * (1.0 + distance));
      const Outcome below = outcome(limit * (1.0 - distance));
      if (above == Outcome::NoCycle || below == Outcome::Cycle) return Mark::Wrong;
      return above == Outcome::GaveUp || below == Outcome::GaveUp ? Mark::Refused : Mark::Right;
    });
  }
  return rows;
}

/// Friction that bends within the speeds of a slip: what tier is needed.
std::string friction_of_speed(Effort effort) {
  const std::size_t fineness = effort == Effort::Full ? 2 : 1;
  const Plane plane{"speed", log_spaced(1e-3, 30.0, 8 * fineness + 1), log_spaced(0.003, 3.0, 5 * fineness + 1)};
  std::string rows;
  for (const double sign : {-1.0, 1.0}) {
    for (const ForwardMethod& method :
         chosen({{"exact damped", {""}}, {"ODE 5(4), event location", {"1e-05"}}, {"velocity tier", {""}}})) {
      const std::string title = title_of(method) + (sign < 0.0 ? ", weakening (α < 0)" : ", strengthening (α > 0)");
      rows += judge_plane(plane, title, [&](double bend, double strength) {
        constexpr double kLambda = 20.0;
        const double rate = sign * bend / kLambda;
        const ForwardScene scene{kLambda, 0.05, strength * kLambda * rate, rate};
        return compare(method.run(scene, kAnyTimes), solve_reference(scene, 1).answer);
      });
    }
  }
  return rows;
}

}  // namespace

std::string map_forward_failures(Effort effort) {
  return lambda_zeta(effort) + grazing(effort) + friction_of_speed(effort);
}

}  // namespace atlas
