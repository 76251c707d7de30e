// A slip under friction that depends on the speed, as a sensor of first order shows it.
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

SpeedDependentCycle cycle(const Coordinates& values, const SensorInTau& instrument, double onset = kLaggedOnset) {
  Scales scales;
  scales.speed_m_per_s = 0.01;
  scales.law = FrictionLaw::Exponential;
  scales.view = instrument.view;
  scales.sensor_lag_s = instrument.lag_tau / 9.0;
  scales.sensor_average_s = instrument.average_tau / 9.0;
  Population population;
  population.slip_speed_m_per_s = 0.12;
  scales.population = population;
  return SpeedDependentCycle::solve(onset, values, {scales.sensor_lag_s, scales.sensor_average_s}, scales).value();
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

TEST_CASE("derivatives of a lagging sensor's view of friction that depends on the speed agree with differences") {
  const SensorInTau instrument = any_sensor();
  const std::array<double, 3> law{0.1, 0.05, -1.5};
  const SpeedDependentCycle lagged = cycle(values_of(law[0], law[1], law[2]), instrument);
  for (const double tau : {-0.01, 0.2, 1.7, 3.1, 9.0}) {
    CAPTURE(instrument.lag_tau, instrument.average_tau, tau);
    const ShownPoint shown = lagged.at(tau);
    constexpr double kStep = 1e-3;
    const std::array<double, 3> by_law = lagged.by_law(shown);
    for (std::size_t i = 0; i < law.size(); ++i) {
      const auto moved = [&](double step) {
        std::array<double, 3> other = law;
        other[i] += step;
        return cycle(values_of(other[0], other[1], other[2]), instrument).at(tau).z;
      };
      CHECK(by_law[i] == Approx((moved(kStep) - moved(-kStep)) / (2.0 * kStep)).margin(1e-3).epsilon(1e-3));
    }
    const auto started = [&](double step) {
      return cycle(values_of(law[0], law[1], law[2]), instrument, kLaggedOnset + step).at(tau).z;
    };
    CHECK(shown.d_z0 == Approx((started(kStep) - started(-kStep)) / (2.0 * kStep)).margin(1e-3));
    const auto scaled = [&](double step) {  // the instrument's times are fixed in seconds
      const double ratio = std::exp(step);
      return cycle(values_of(law[0], law[1], law[2]),
                   {ratio * instrument.lag_tau, ratio * instrument.average_tau, instrument.view})
          .at(tau)
          .z;
    };
    CHECK(shown.d_log_omega == Approx((scaled(kStep) - scaled(-kStep)) / (2.0 * kStep)).margin(1e-3));
  }
}
