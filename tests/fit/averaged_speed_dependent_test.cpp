// A slip under friction that depends on the speed, as an average over any time shows it.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "fit/law/speed_dependent.hpp"

using namespace slipfit;
using namespace slipfit::fit;

namespace {

Coordinates values() {
  Coordinates values = oscillator(std::log(60.0), std::log(9.0), 0.1);
  values(kFrictionSlope) = 0.05;
  values(kFrictionRate) = -1.5;
  return values;
}
constexpr double kOnset = 6.0;

SpeedDependentCycle cycle(double average_tau, ForceView view) {
  Scales scales;
  scales.speed_m_per_s = 0.01;
  scales.law = FrictionLaw::Exponential;
  scales.view = view;
  scales.sensor_average_s = average_tau / std::exp(values()(kLogFrequency));
  Population population;
  population.slip_speed_m_per_s = 0.12;
  scales.population = population;
  return SpeedDependentCycle::solve(kOnset, values(), {scales.sensor_lag_s, scales.sensor_average_s}, scales).value();
}

/// Mean of the force as it is, by the rule of the middle.
double mean_force(const SpeedDependentCycle& instant, double tau, double average_tau) {
  constexpr int kPieces = 20'000;
  double sum = 0.0;
  for (int i = 0; i < kPieces; ++i) sum += instant.at(tau + average_tau * ((i + 0.5) / kPieces - 0.5)).z;
  return sum / kPieces;
}

}  // namespace

TEST_CASE("an average shows the mean of the force over windows shorter and longer than the slip") {
  const ForceView view = GENERATE(ForceView::Spring, ForceView::Transmitted);
  const SpeedDependentCycle instant = cycle(0.0, view);
  for (const double average_tau : {0.03, 0.4, 3.0, 30.0}) {
    const SpeedDependentCycle averaged = cycle(average_tau, view);
    for (const double tau : {-2.0, -0.01, 0.0, 0.2, 1.7, 3.1, 5.0, 9.0}) {
      CAPTURE(average_tau, tau);
      // A series is good to 1e-7 of the motion, which is of size 10; the rule of the middle to 1e-8 but for the kinks
      // of the transmitted force, a jump of 2 zeta in a piece of the window.
      const double rule = view == ForceView::Transmitted ? 1e-5 : 1e-7;
      CHECK(averaged.at(tau).z == Approx(mean_force(instant, tau, average_tau)).margin(1e-6 + rule));
    }
  }
}

TEST_CASE("an average of a billion slips is as quick as a short one") {
  // Half of the window is stick before the slip, half is stick after it: straight lines of slope 1 whose distance is
  // small beside it.
  const SpeedDependentCycle averaged = cycle(1e9, ForceView::Spring);
  CHECK(averaged.at(0.0).z == Approx(kOnset).margin(20.0));
}
