#include "model/relaxing.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "model/slip.hpp"
#include "reference_table.hpp"

using namespace slipfit;
using model::RelaxingSlip;

TEST_CASE("slips that repeat on a spring that relaxes agree with an independent integration to 1e-9") {
  for (const auto& row : test::reference_rows("relaxing_spring.csv")) {
    const double z0 = row.at("z0");
    INFO("z0 " << z0 << " zeta " << row.at("zeta") << " share " << row.at("share") << " time " << row.at("time"));
    const auto cycle = model::relaxing_period(z0, row.at("zeta"), row.at("share"), row.at("time"));
    REQUIRE(cycle.has_value());
    CHECK(cycle->slip[0] == Approx(row.at("t_slip")).epsilon(1e-9));
    CHECK(cycle->period[0] == Approx(row.at("period")).epsilon(1e-9));
    CHECK(cycle->trough[0] == Approx(row.at("trough")).epsilon(1e-9).margin(1e-9 * z0));
    const RelaxingSlip slip(z0, row.at("zeta"), row.at("share"), {row.at("time"), row.at("t_slip"), row.at("period")});
    CHECK(slip.at(0.5 * row.at("t_slip")).z[0] == Approx(row.at("half_slip")).epsilon(1e-9).margin(1e-9 * z0));
    const double middle = 0.5 * (row.at("t_slip") + row.at("period"));
    CHECK(slip.at(middle).z[0] == Approx(row.at("half_stick")).epsilon(1e-9).margin(1e-9 * z0));
    // The stick before the slip is that after it.
    CHECK(slip.at(middle - row.at("period")).z[0] == Approx(row.at("half_stick")).epsilon(1e-9).margin(1e-9 * z0));
  }
}

TEST_CASE("a spring of which nothing relaxes slips as an elastic one") {
  for (const double z0 : {2.0, 10.0, 80.0}) {
    const double zeta = 0.1;
    const RelaxingSlip relaxing(z0, zeta, 0.0, {5.0, 3.3, 3.3 + 2.0 * z0});
    const auto elastic = model::solve_slip(z0, zeta);
    CHECK(relaxing.tau_end() == Approx(elastic.tau_end).epsilon(1e-11));
    for (double tau = 0.1; tau < relaxing.tau_end(); tau += 0.3) {
      const double c = std::exp(-zeta * tau) * std::cos(elastic.b * tau);
      const double s = std::exp(-zeta * tau) * std::sin(elastic.b * tau) / elastic.b;
      CHECK(relaxing.at(tau).z[0] == Approx(model::slip_wave(elastic, tau, c, s).z).margin(1e-11 * z0));
    }
    const auto oscillator = model::relaxed_oscillator(zeta, 0.0, 5.0);
    CHECK(oscillator.omega == Approx(1.0).epsilon(1e-14));
    CHECK(oscillator.zeta == Approx(zeta).epsilon(1e-13));
  }
}

TEST_CASE("a spring that relaxes at once is one of the stiffness that is left") {
  const double share = 0.4;
  const double zeta = 0.05;
  const auto oscillator = model::relaxed_oscillator(zeta, share, 1e-6);
  CHECK(oscillator.omega == Approx(std::sqrt(1.0 - share)).epsilon(1e-5));
  CHECK(oscillator.zeta == Approx(zeta / std::sqrt(1.0 - share)).epsilon(1e-5));
}

TEST_CASE("force, integral and their derivatives on a spring that relaxes agree with differences") {
  std::mt19937_64 random(5);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  constexpr double kStep = 1e-3;
  for (int trial = 0; trial < 40; ++trial) {
    const double at[] = {uniform(4.0, 30.0), uniform(0.0, 0.2), uniform(0.05, 0.6), std::exp(uniform(-0.5, 3.0))};
    const ForceView view = trial % 2 == 0 ? ForceView::Spring : ForceView::Transmitted;
    const auto slip_at = [&](const double* p) {
      return RelaxingSlip(p[0], p[1], p[2], {p[3], 3.3, 3.3 + 2.0 * at[0]}, view);
    };
    const RelaxingSlip slip = slip_at(at);
    const double times[] = {-0.4 * at[0], 0.3 * slip.tau_end(), 0.8 * slip.tau_end(), slip.tau_end() + 0.3 * at[0]};
    for (const double tau : times) {
      const auto difference = [](const auto& f) {
        return (8.0 * (f(1.0) - f(-1.0)) - (f(2.0) - f(-2.0))) / (12.0 * kStep);
      };
      // Steps of 1e-3: their fourth power times fifth derivatives of up to 1e3, and rounding over the step.
      const double margin = 1e-8 * at[0];
      CHECK(slip.at(tau).d_tau ==
            Approx(difference([&](double n) { return slip.at(tau + n * kStep).z[0]; })).margin(margin));
      CHECK(slip.integral_to(tau).d_tau ==
            Approx(difference([&](double n) { return slip.integral_to(tau + n * kStep).z[0]; })).margin(margin));
      for (std::size_t p = 0; p < 4; ++p) {
        const auto moved = [&](double n) {
          double values[] = {at[0], at[1], at[2], at[3]};
          values[p] += n * kStep;
          return slip_at(values);
        };
        INFO("trial " << trial << " tau " << tau << " parameter " << p);
        CHECK(slip.at(tau).z[p + 1] ==
              Approx(difference([&](double n) { return moved(n).at(tau).z[0]; })).epsilon(1e-6).margin(margin));
        CHECK(
            slip.integral_to(tau).z[p + 1] ==
            Approx(difference([&](double n) { return moved(n).integral_to(tau).z[0]; })).epsilon(1e-6).margin(margin));
      }
    }
  }
}
