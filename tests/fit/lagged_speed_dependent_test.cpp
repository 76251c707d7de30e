// A slip under friction that depends on the speed, as a sensor of first order or an average shows it.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "fit/law/coulomb.hpp"
#include "fit/law/speed_dependent.hpp"

using namespace slipfit;
using namespace slipfit::fit;

namespace {

constexpr double kLaggedOnset = 6.0;

struct SensorInTau {
  double lag_tau = 0.0, average_tau = 0.0;  ///< at w_n = 9 rad/s
  ForceView view = ForceView::Spring;
};

Coordinates values_of(double zeta, double slope, double rate) {
  Coordinates values = oscillator(std::log(60.0), std::log(9.0), zeta);
  values(kFrictionSlope) = slope;
  values(kFrictionRate) = rate;
  return values;
}

SpeedDependentCycle cycle(const Coordinates& values, const SensorInTau& instrument) {
  Scales scales;
  scales.speed_m_per_s = 0.01;
  scales.law = FrictionLaw::Exponential;
  scales.view = instrument.view;
  scales.sensor_lag_s = instrument.lag_tau / 9.0;
  scales.sensor_average_s = instrument.average_tau / 9.0;
  Population population;
  population.slip_speed_m_per_s = 0.12;
  scales.population = population;
  return SpeedDependentCycle::solve(kLaggedOnset, values, {scales.sensor_lag_s, scales.sensor_average_s}, scales)
      .value();
}

SensorInTau any_sensor() {
  const auto view = GENERATE(ForceView::Spring, ForceView::Transmitted);
  const double lag = GENERATE(0.003, 0.1, 0.7, 4.0);
  const double average = GENERATE(0.0, 0.4, 5.0);
  return {lag, average, view};
}

constexpr std::array kLaggedTimes{-2.0, -0.01, 0.0, 0.2, 1.7, 3.1, 4.4, 5.0, 9.0};

}  // namespace

TEST_CASE("without dependence on the speed a lagging sensor shows the closed form of Coulomb friction") {
  const SensorInTau instrument = any_sensor();
  const SpeedDependentCycle integrated = cycle(values_of(0.1, 0.0, 0.0), instrument);
  const CoulombCycle exact(kLaggedOnset, 0.1, {instrument.lag_tau, instrument.average_tau}, instrument.view);
  for (const double tau : kLaggedTimes) {
    CAPTURE(instrument.lag_tau, instrument.average_tau, tau);
    const model::WavePoint expected = exact.at(tau);
    const ShownPoint shown = integrated.at(tau);
    // Slips are followed to 4e-7 of a motion of size 10 in fits, and the mean of the drag's slope to a tenth of that.
    constexpr double kSame = 1e-5;
    CHECK(shown.z == Approx(expected.z).margin(kSame));
    CHECK(shown.d_tau == Approx(expected.d_tau).margin(kSame));
    CHECK(shown.d_z0 == Approx(expected.d_z0).margin(kSame));
    CHECK(shown.d_zeta == Approx(expected.d_zeta).margin(10.0 * kSame));
    CHECK(shown.d_log_omega == Approx(expected.d_log_omega).margin(kSame));
  }
}

TEST_CASE("what a lagging sensor shows of friction that depends on the speed obeys its equation") {
  const SensorInTau instrument = any_sensor();
  const Coordinates values = values_of(0.1, 0.05, -1.5);
  const SpeedDependentCycle before = cycle(values, {0.0, instrument.average_tau, instrument.view});
  const SpeedDependentCycle lagged = cycle(values, instrument);
  for (const double tau : kLaggedTimes) {
    CAPTURE(instrument.lag_tau, instrument.average_tau, tau);
    const ShownPoint shown = lagged.at(tau);
    constexpr double kStep = 1e-4;
    const double slope = (lagged.at(tau + kStep).z - lagged.at(tau - kStep).z) / (2.0 * kStep);
    if (tau != 0.0) CHECK(shown.d_tau == Approx(slope).margin(1e-4));  // the curvature jumps at the onset
    CHECK(shown.z + instrument.lag_tau * shown.d_tau == Approx(before.at(tau).z).margin(1e-5));
  }
}

TEST_CASE("an average shows the mean of the force over windows shorter and longer than the slip") {
  const ForceView view = GENERATE(ForceView::Spring, ForceView::Transmitted);
  const Coordinates values = values_of(0.1, 0.05, -1.5);
  const SpeedDependentCycle instant = cycle(values, {0.0, 0.0, view});
  const auto mean_force = [&](double tau, double average_tau) {  // by the rule of the middle
    constexpr int kPieces = 20'000;
    double sum = 0.0;
    for (int i = 0; i < kPieces; ++i) sum += instant.at(tau + average_tau * ((i + 0.5) / kPieces - 0.5)).z;
    return sum / kPieces;
  };
  for (const double average_tau : {0.03, 0.4, 3.0, 30.0}) {
    const SpeedDependentCycle averaged = cycle(values, {0.0, average_tau, view});
    for (const double tau : {-2.0, -0.01, 0.0, 0.2, 1.7, 3.1, 5.0, 9.0}) {
      CAPTURE(average_tau, tau);
      // A series is good to 1e-7 of the motion, which is of size 10; the rule of the middle to 1e-8 but for the kinks
      // of the transmitted force, a jump of 2 zeta in a piece of the window.
      const double rule = view == ForceView::Transmitted ? 1e-5 : 1e-7;
      CHECK(averaged.at(tau).z == Approx(mean_force(tau, average_tau)).margin(1e-6 + rule));
    }
  }
}
