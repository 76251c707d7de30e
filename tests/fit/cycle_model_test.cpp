#include "fit/cycle/cycle_model.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "fit/cycle/start.hpp"
#include "fit/level/level_order.hpp"
#include "fit/problem/block_fit.hpp"

using namespace slipfit;
using namespace slipfit::fit;

namespace {

/// A made-up cycle: a slip near t = 0, ramps on both sides.
CycleData example_cycle() {
  CycleData cycle;
  for (int i = -10; i < 40; ++i) {
    cycle.time_s.push_back(0.011 * i);
    cycle.force.push_back(1.0 - 0.03 * i);
  }
  cycle.bins_before = {{20.0, -0.6, 0.9, 0.5, 1.3, 0.0, {}}, {20.0, -0.3, 1.0, 0.6, 1.1, 0.0, {}}};
  cycle.bins_after = {{20.0, 1.0, -0.5, 0.5, 1.2, 0.0, {}}};
  return cycle;
}

Scales example_scales(ForceView view, double sensor_lag_s = 0.0) {
  Scales scales;
  scales.speed_m_per_s = 0.01;
  scales.force = 1.3;
  scales.level = 0.2;
  scales.noise = 0.05;
  scales.time_begin_s = -1.0;
  scales.time_end_s = 1.5;
  scales.view = view;
  scales.half_period_s = 0.3;
  scales.sensor_lag_s = sensor_lag_s;
  return scales;
}

}  // namespace

TEST_CASE("residual derivatives agree with central differences in both views and level models") {
  const double sensor_lag_s = GENERATE(0.0, 0.02);
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> near(-0.1, 0.1);
  const CycleData data = example_cycle();
  for (const ForceView view : {ForceView::Spring, ForceView::Transmitted}) {
    for (const LevelModel& level : {LevelModel{false, 3, {}}, LevelModel{true, 0, {}}}) {
      const CycleModel model(data, example_scales(view, sensor_lag_s), 0.05, level);
      const std::size_t rows = model.residuals();
      for (int trial = 0; trial < 20; ++trial) {
        // ln k, ln w_n, zeta, level (3), own (onset, onset force, level)
        std::vector<double> x{std::log(60.0) + near(random),
                              std::log(9.0) + near(random),
                              0.08 + near(random),
                              0.1 + near(random),
                              near(random),
                              near(random),
                              near(random),
                              0.8 + near(random),
                              near(random)};
        const auto evaluate = [&](const std::vector<double>& p, double* jacobian) {
          std::vector<double> residuals(rows);
          REQUIRE(model.evaluate(p.data(), p.data() + 3, p.data() + 6, residuals.data(), jacobian));
          return residuals;
        };
        std::vector<double> jacobian(rows * model.columns());
        evaluate(x, jacobian.data());
        for (std::size_t column = 0; column < model.columns(); ++column) {
          const std::size_t at = column < 3 + level.terms ? column : column - level.terms + 3;
          const double h = 1e-6;
          auto above = x;
          auto below = x;
          above[at] += h;
          below[at] -= h;
          const auto high = evaluate(above, nullptr);
          const auto low = evaluate(below, nullptr);
          for (std::size_t row = 0; row < rows; ++row) {
            const double exact = jacobian[column * rows + row];
            INFO("column " << column << " row " << row << " trial " << trial);
            // h^2 times third derivatives (up to 1e4 here) and round-off / h; a sample that an event crosses within h
            // keeps its first derivative, its second one jumps: h times that jump.
            CHECK(exact == Approx((high[row] - low[row]) / (2.0 * h)).epsilon(1e-6).margin(2e-3));
          }
        }
      }
    }
  }
}

TEST_CASE("samples on an even clock give the same rows as on one with a sample missing") {
  const CycleData whole = example_cycle();
  CycleData holed = whole;
  const std::size_t missing = holed.time_s.size() - 1 - 5;
  holed.time_s.erase(holed.time_s.begin() + static_cast<std::ptrdiff_t>(missing));
  holed.force.erase(holed.force.begin() + static_cast<std::ptrdiff_t>(missing));
  const std::vector<double> x{std::log(60.0), std::log(9.0), 0.08, 0.1, 0.1, 0.8};
  for (const ForceView view : {ForceView::Spring, ForceView::Transmitted}) {
    const auto rows_of = [&](const CycleData& data) {
      const CycleModel model(data, example_scales(view), 0.05, {false, 1, {}});
      std::vector<double> residuals(model.residuals());
      Eigen::MatrixXd rows(model.residuals(), model.columns() + 1);
      REQUIRE(model.evaluate(x.data(), x.data() + 3, x.data() + 4, residuals.data(), rows.data()));
      rows.rightCols<1>() = Eigen::VectorXd::Map(residuals.data(), rows.rows());
      return rows;
    };
    const Eigen::MatrixXd even = rows_of(whole);
    const Eigen::MatrixXd uneven = rows_of(holed);
    const auto before = static_cast<Eigen::Index>(missing);
    const Eigen::Index after = uneven.rows() - before;
    // rows up to 1e2, 45 turns of a few units in the last place each
    CHECK((even.topRows(before) - uneven.topRows(before)).cwiseAbs().maxCoeff() < 1e-11);
    CHECK((even.bottomRows(after) - uneven.bottomRows(after)).cwiseAbs().maxCoeff() < 1e-11);
  }
}

TEST_CASE("a cycle without friction drop is outside the model, not a number") {
  const CycleData data = example_cycle();
  const CycleModel model(data, example_scales(ForceView::Spring), 0.0, {false, 1, {}});
  const double shared[] = {4.0, 2.0, 0.05};
  const double level[] = {0.0};
  const double own[] = {0.0, -0.5};
  std::vector<double> residuals(model.residuals(), 7.0);
  CHECK_FALSE(model.evaluate(shared, level, own, residuals.data(), nullptr));
  CHECK(residuals.front() == 7.0);
}

TEST_CASE("ramp residual derivatives agree with central differences") {
  CycleData first = example_cycle();
  first.continuous_with_next = true;
  BlockFit fit({first, example_cycle()}, {0.0, 2.0}, example_scales(ForceView::Spring), {false, 1, {}});
  const std::vector<double> x{std::log(60.0), std::log(9.0), 0.08, 0.1, 0.8, -0.2, 0.9};
  const auto value = [&](const std::vector<double>& p) {
    return ramp_residual(fit, 0, p.data(), p.data() + 3, p.data() + 5);
  };
  const RampResidual exact = value(x);
  for (std::size_t column = 0; column < x.size(); ++column) {
    const double h = 1e-6;
    auto above = x;
    auto below = x;
    above[column] += h;
    below[column] -= h;
    const double derivative = column < 3   ? exact.d_shared[column]
                              : column < 5 ? exact.d_first[column - 3]
                                           : exact.d_second[column - 5];
    INFO("column " << column);
    CHECK(derivative == Approx((value(above).value - value(below).value) / (2.0 * h)).epsilon(1e-6));
  }
}

TEST_CASE("Legendre values and slopes are those of the books") {
  std::vector<double> values(4);
  std::vector<double> slopes(4);
  legendre(0.3, 4, values.data(), slopes.data());
  CHECK(values[2] == Approx(0.5 * (3.0 * 0.09 - 1.0)));
  CHECK(slopes[2] == Approx(3.0 * 0.3));
  CHECK(slopes[3] == Approx(0.5 * (15.0 * 0.09 - 3.0)));
}

TEST_CASE("a drift polynomial is paid for by drift, not by scatter") {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<double> time_s;
  std::vector<double> flat;
  std::vector<double> drifting;
  for (int i = 0; i < 60; ++i) {
    time_s.push_back(i);
    flat.push_back(noise(random));
    drifting.push_back(noise(random) + 0.01 * (i - 30) * (i - 30));
  }
  CHECK(choose_level_terms(time_s, flat) == 1);
  CHECK(choose_level_terms(time_s, drifting) == 3);
}
