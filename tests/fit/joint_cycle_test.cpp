#include "fit/problem/joint_cycle.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "fit/problem/joint_problem.hpp"

using namespace slipfit;
using namespace slipfit::fit;

namespace {

CycleData example_cycle() {
  CycleData cycle;
  for (int i = -10; i < 40; ++i) {
    cycle.time_s.push_back(0.0113 * i);
    cycle.force.push_back(1.0 - 0.03 * i);
  }
  cycle.bins_before = {{20.0, -0.6, 0.9, 0.5, 1.3, 0.0, {}}};
  cycle.bins_after = {{20.0, 1.0, -0.5, 0.5, 1.2, 0.0, {}}};
  return cycle;
}

JointRun example_run() {
  JointRun run;
  run.scales.speed_m_per_s = 0.01;
  run.scales.force = 1.3;
  run.scales.level = 0.2;
  run.scales.noise = 0.05;
  run.scales.time_begin_s = -1.0;
  run.scales.time_end_s = 1.5;
  run.scales.half_period_s = 0.3;
  run.load = 1.4;
  run.noise = 0.05;
  run.onset_sd = 0.1;
  run.level_sd = 0.2;
  return run;
}

}  // namespace

TEST_CASE(
    "joint: residual derivatives agree with central differences, level common or per cycle, spring or transmitted") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> near(-0.1, 0.1);
  const CycleData data = example_cycle();
  const JointScales scales{1.1, 0.12};
  const LevelModel polynomial{false, 3, {}};
  const LevelModel own_levels{true, 0, {}};
  for (const auto& [level, view] : {std::pair{polynomial, ForceView::Spring}, std::pair{own_levels, ForceView::Spring},
                                    std::pair{polynomial, ForceView::Transmitted}}) {
    JointRun run = example_run();
    run.scales.view = view;
    const CycleModel model(data, run.scales, 0.05, level);
    const JointCycle cycle(model, level, 0.05, run, scales);
    const std::size_t drifts = cycle.drift_parameters();
    const std::size_t own = cycle.own_parameters();
    const std::size_t columns = kJointShared + 2 + drifts + own;
    for (int trial = 0; trial < 20; ++trial) {
      // shared, level, difference, drift, own
      std::vector<double> x{std::log(60.0), std::log(9.0), 0.08, 0.05, trial % 2 == 0 ? -1.5 : 0.4, 0.3, 0.9};
      x.resize(columns, 0.1);
      x[columns - own] = 0.0;
      x[columns - own + 1] = 0.8;
      for (double& value : x) value += 0.5 * near(random);
      const auto values = [&](const std::vector<double>& p) {
        return JointValues{p.data(), p.data() + kJointShared, p.data() + kJointShared + 1, p.data() + kJointShared + 2,
                           p.data() + columns - own};
      };
      const auto evaluate = [&](const std::vector<double>& p, const JointJacobians& jacobians) {
        std::vector<double> residuals(cycle.residuals());
        REQUIRE(cycle.evaluate(values(p), residuals.data(), jacobians));
        return residuals;
      };
      const std::size_t rows = cycle.residuals();
      std::vector<double> d_shared(rows * kJointShared), d_level(rows), d_difference(rows), d_drift(rows * drifts),
          d_own(rows * own);
      evaluate(x, {d_shared.data(), d_level.data(), d_difference.data(), drifts > 0 ? d_drift.data() : nullptr,
                   d_own.data()});
      for (std::size_t column = 0; column < columns; ++column) {
        const double h = 1e-4;  // the slip is integrated to 1e-9: its noise is 1e-5 in the difference
        auto above = x;
        auto below = x;
        above[column] += h;
        below[column] -= h;
        const auto high = evaluate(above, {});
        const auto low = evaluate(below, {});
        for (std::size_t row = 0; row < rows; ++row) {
          const double exact = column < kJointShared        ? d_shared[row * kJointShared + column]
                               : column == kJointShared     ? d_level[row]
                               : column == kJointShared + 1 ? d_difference[row]
                               : column < columns - own     ? d_drift[row * drifts + column - kJointShared - 2]
                                                            : d_own[row * own + column - (columns - own)];
          INFO("column " << column << " row " << row << " trial " << trial);
          // Second derivatives of up to 1e3 jump where the slip's end crosses a sample: h times that.
          CHECK(exact == Approx((high[row] - low[row]) / (2.0 * h)).epsilon(1e-3).margin(0.1));
        }
      }
    }
  }
}

TEST_CASE("joint: the residual of steady sliding and its derivatives") {
  const JointScales scales{2.0, 0.3};
  const JointProblem problem({}, {}, {}, scales, {true, true});
  const SteadyRun run{0.05, 1.5, 4.0, 0.01};
  for (const double rate : {-2.0, 1e-6, 0.7}) {
    const JointShared shared{std::log(500.0), std::log(90.0), 0.05, 0.04, rate};
    const double level = 0.7;
    const auto steady = problem.steady_residual(run, shared.data(), level);
    // F_k(V) = load (F_k(0+) + b (exp(alpha V) - 1) / alpha), with the slope b that makes the mean slope up to v_c
    // right
    const double alpha = rate / scales.slip_speed_m_per_s;
    const double gain = 2.0 * shared[kFrictionSlope] * scales.slip_speed_m_per_s * 500.0 / 90.0;
    const double excess = gain * std::expm1(alpha * run.speed_m_per_s) / std::expm1(rate);
    CHECK(steady.value ==
          Approx((run.mean_force - run.load * (scales.force * level + excess)) / run.standard_error).epsilon(1e-6));
    for (std::size_t i = 0; i < kJointShared; ++i) {
      const double h = 1e-5;
      JointShared above = shared;
      JointShared below = shared;
      above[i] += h;
      below[i] -= h;
      const double difference = problem.steady_residual(run, above.data(), level).value -
                                problem.steady_residual(run, below.data(), level).value;
      CHECK(steady.d_shared[i] == Approx(difference / (2.0 * h)).epsilon(1e-6).margin(1e-6));
    }
  }
}
