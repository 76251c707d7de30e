#include "fit/cycle/cycle_model.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/thresholds.hpp"
#include "fit/cycle/start.hpp"
#include "fit/problem/block_fit.hpp"
#include "fit/problem/normals.hpp"

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

/// The low-pass filter of the sensor.
struct Filter {
  double lag_s = 0.0;
  std::size_t order = 1;
};

Scales example_scales(ForceView view, const Filter& filter = {}) {
  Scales scales;
  scales.speed_m_per_s = 0.01;
  scales.force = 1.3;
  scales.level = 0.2;
  scales.noise = 0.05;
  scales.time_begin_s = -1.0;
  scales.time_end_s = 1.5;
  scales.view = view;
  scales.half_period_s = 0.3;
  scales.sensor_lag_s = filter.lag_s;
  scales.sensor_order = filter.order;
  scales.sensor_time_unit_s = 0.02;
  return scales;
}

/// The parameters in a vector that has the order of the Jacobian's columns.
struct Unpacked {
  Unpacked(const Columns& columns, const std::vector<double>& x) : x_(x) {
    for (std::size_t i = 0; i < columns.coordinates().size(); ++i) shared_(columns.coordinates()[i]) = x[i];
    const double* const rest = x_.data() + columns.coordinates().size();
    values = {&shared_, rest, x_.data() + columns.first_drift(), x_.data() + columns.common()};
  }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  CycleValues values;

 private:
  std::vector<double> x_;
  Coordinates shared_ = Coordinates::Zero();
};

/// As many such cycles as a fit needs.
CycleSet set_of(const CycleData& cycle, double reference_s, const LevelModel& level, const Scales& scales) {
  constexpr std::size_t kCount = thresholds::kFewestSlips;
  return CycleSet::create(std::vector(kCount, cycle), std::vector(kCount, reference_s), level, scales).value();
}

/// A point at which derivatives are compared.
std::vector<double> example_point(const Columns& columns, FrictionLaw law, int trial, std::mt19937_64& random) {
  std::uniform_real_distribution<double> near(-0.05, 0.05);
  Coordinates here = oscillator(std::log(60.0), std::log(9.0), 0.1);
  here(kSlipDistance) = 0.4;
  here(kFrictionSlope) = 0.05;
  here(kFrictionRate) = trial % 2 == 0 || law != FrictionLaw::Exponential ? -1.5 : 0.4;
  here(kStiffnessExponent) = 0.07;
  here(kSensorTime) = 0.6;
  here(kDifference) = 0.9;
  here(kRelaxation) = 0.35;
  here(kRelaxationTime) = std::log(0.4);
  here(kReloadForce) = 0.3;
  here(kReloadLength) = std::log(2e-3);
  std::vector<double> x;
  for (const Coordinate coordinate : columns.coordinates()) x.push_back(here(coordinate));
  x.resize(columns.size(), 0.1);
  x[columns.common()] = 0.0;
  x[columns.common() + 1] = 0.8;
  for (double& value : x) value += near(random);
  return x;
}

/// How well derivatives agree with differences.
struct Agreement {
  double step = 2e-3;         ///< the longest of the differences
  double tolerance = 1e-9;    ///< relative to the largest derivative of the column
  double smooth_share = 0.9;  ///< least share of the derivatives that are compared
};

/// Every column against differences over three steps, each half of the one before, extrapolated to none (Richardson),
/// at 6 random points. Samples that an event of the slip crosses within a step are left out: there the differences over
/// two steps do not agree. Round-off of the residuals adds its share.
void check_derivatives(const Scales& scales, const LevelModel& level, const Agreement& agreement = {}) {
  constexpr double kRoundOff = 128.0 * std::numeric_limits<double>::epsilon();
  std::mt19937_64 random(11);
  const CycleSet set = set_of(example_cycle(), 0.05, level, scales);
  const Columns columns(scales, level);
  const CycleModel model(set, 0, scales, columns);
  const auto rows = static_cast<Eigen::Index>(model.residuals());
  double smooth = 0.0;
  double all = 0.0;
  for (int trial = 0; trial < 6; ++trial) {
    const std::vector<double> x = example_point(columns, scales.law, trial, random);
    Eigen::VectorXd residuals(rows);
    Eigen::MatrixXd jacobian(rows, static_cast<Eigen::Index>(columns.size()));
    REQUIRE(model.evaluate(Unpacked(columns, x).values, residuals.data(), jacobian.data()));
    for (std::size_t column = 0; column < columns.size(); ++column) {
      const auto difference = [&](double step) -> Eigen::VectorXd {
        const auto at = [&](double move) {
          std::vector<double> moved = x;
          moved[column] += move;
          Eigen::VectorXd there(rows);
          REQUIRE(model.evaluate(Unpacked(columns, moved).values, there.data(), nullptr));
          return there;
        };
        return (at(step) - at(-step)) / (2.0 * step);
      };
      const Eigen::VectorXd whole = difference(agreement.step);
      const Eigen::VectorXd half = difference(0.5 * agreement.step);
      const Eigen::VectorXd quarter = difference(0.25 * agreement.step);
      const Eigen::VectorXd coarse = (4.0 * half - whole) / 3.0;
      const Eigen::VectorXd fine = (4.0 * quarter - half) / 3.0;
      const Eigen::VectorXd extrapolated = (16.0 * fine - coarse) / 15.0;
      const Eigen::VectorXd exact = jacobian.col(static_cast<Eigen::Index>(column));
      const double round_off = kRoundOff * residuals.cwiseAbs().maxCoeff() / (0.25 * agreement.step);
      const double margin = agreement.tolerance * exact.cwiseAbs().maxCoeff() + round_off;
      const auto is_smooth = (fine - coarse).array().abs() < 0.5 * margin;
      const Eigen::ArrayXd errors = is_smooth.select((exact - extrapolated).array().abs(), 0.0);
      all += static_cast<double>(rows);
      smooth += static_cast<double>(is_smooth.count());
      Eigen::Index row = 0;
      const double largest = errors.maxCoeff(&row);
      INFO("column " << column << " row " << row << " trial " << trial << " derivative " << exact(row));
      CHECK(largest < margin);
    }
  }
  CHECK(smooth > agreement.smooth_share * all);
}

/// An average of the sensor: none, one that is stated, one that is a parameter; or one beside a lag that is a
/// parameter.
enum class Average { None, Stated, Free, BesideFreeLag };

Scales averaged_by(Average average, Scales scales) {
  scales.sensor_average_s = average == Average::None ? 0.0 : 0.015;
  if (average == Average::Free) scales.free_time = FreeTime::Average;
  if (average == Average::BesideFreeLag && scales.sensor_lag_s > 0.0) scales.free_time = FreeTime::Lag;
  return scales;
}

Population example_population() {
  Population population;
  population.load = 1.4;
  population.force = 1.4 * 1.1;
  population.onset_sd = 0.1;
  population.level_sd = 0.2;
  population.slip_speed_m_per_s = 0.12;
  return population;
}

const LevelModel kPolynomial{false, 3, {}};
const LevelModel kPerCycle{true, 0, {}};
const LevelModel kConstant{false, 1, {}};

/// A level above which the force rises after slips.
LevelModel rising() {
  RiseAfterSlip rise{2e-3, 1.0, true, 0.01, {-0.02}, {0.24}};
  return {false, 2, {}, std::make_shared<const RiseAfterSlip>(std::move(rise))};
}

}  // namespace

TEST_CASE("residual derivatives agree with differences for every law, view, sensor and level model") {
  struct Law {
    FrictionLaw friction = FrictionLaw::Coulomb;
    bool relaxes = false;  ///< the spring
  };
  const Law law = GENERATE(Law{}, Law{FrictionLaw::Coulomb, true}, Law{FrictionLaw::Exponential},
                           Law{FrictionLaw::Hyperbolic}, Law{FrictionLaw::Logarithmic}, Law{FrictionLaw::Weakening});
  const ForceView view = GENERATE(ForceView::Spring, ForceView::Transmitted);
  const Filter filter = GENERATE(Filter{}, Filter{0.02, 1}, Filter{0.02, 4});
  const Average average = GENERATE(Average::None, Average::Stated, Average::Free, Average::BesideFreeLag);
  Scales scales = averaged_by(average, example_scales(view, filter));
  scales.law = law.friction;
  scales.slip_distance_m = scales.force / 60.0;
  if (law.relaxes) scales.relaxing = RelaxingCycles{3.3, 12.0, 10.0};
  for (const LevelModel& level : {kPolynomial, kPerCycle, rising()}) {
    if (depends_on_speed(law.friction)) {
      scales.population = example_population();
      // Slips are integrated to 1e-9 of the motion, and their steps change with the parameters.
      check_derivatives(scales, level, {1e-3, 1e-4, 0.9});
      continue;
    }
    check_derivatives(scales, level);
    if (law.friction == FrictionLaw::Weakening) continue;
    Scales in_sweep = scales;
    in_sweep.population = example_population();
    check_derivatives(in_sweep, level);
    in_sweep.population->log_speed = 0.7;
    check_derivatives(in_sweep, level);
  }
}

TEST_CASE("the residual of steady sliding and its derivatives") {
  const Units units{2.0, 0.0, 0.3};
  const SteadyRun run{0.05, 1.5, 4.0, 0.01};
  for (const double rate : {-2.0, 1e-6, 0.7}) {
    Coordinates values = oscillator(std::log(500.0), std::log(90.0), 0.05);
    values(kFrictionSlope) = 0.04;
    values(kFrictionRate) = rate;
    const double level = 0.7;
    const SteadyResidual steady = steady_residual(run, units, FrictionLaw::Exponential, values, level);
    // F_k(V) = load (F_k(0+) + b (exp(alpha V) - 1) / alpha), with the slope b that makes the mean slope up to v_c
    // right
    const double alpha = rate / units.slip_speed_m_per_s;
    const double gain = 2.0 * values(kFrictionSlope) * units.slip_speed_m_per_s * 500.0 / 90.0;
    const double excess = gain * std::expm1(alpha * run.speed_m_per_s) / std::expm1(rate);
    CHECK(steady.value ==
          Approx((run.mean_force - run.load * (units.force * level + excess)) / run.standard_error).epsilon(1e-6));
    for (Eigen::Index i = 0; i < kCoordinates; ++i) {
      const double h = 1e-5;
      Coordinates above = values;
      Coordinates below = values;
      above(i) += h;
      below(i) -= h;
      const double difference = steady_residual(run, units, FrictionLaw::Exponential, above, level).value -
                                steady_residual(run, units, FrictionLaw::Exponential, below, level).value;
      CHECK(steady.by_value(i) == Approx(difference / (2.0 * h)).epsilon(1e-6).margin(1e-6));
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
      const CycleSet set = set_of(data, 0.05, kConstant, example_scales(view));
      const Columns columns(example_scales(view), kConstant);
      const CycleModel model(set, 0, example_scales(view), columns);
      std::vector<double> residuals(model.residuals());
      Eigen::MatrixXd rows(model.residuals(), columns.size() + 1);
      REQUIRE(model.evaluate(Unpacked(columns, x).values, residuals.data(), rows.data()));
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

TEST_CASE("ramp residual derivatives agree with central differences") {
  CycleData first = example_cycle();
  first.continuous_with_next = true;
  const BlockFit fit = BlockFit::create({first, example_cycle(), example_cycle()}, {0.0, 2.0, 4.0},
                                        example_scales(ForceView::Spring), {false, 1, {}})
                           .value();
  const std::vector<double> x{std::log(60.0), std::log(9.0), 0.08, 0.1, 0.8, -0.2, 0.9};
  const auto value = [&](const std::vector<double>& p) {
    return ramp_residual(fit, 0, oscillator(p[0], p[1], p[2]), p.data() + 3, p.data() + 5);
  };
  const RampResidual exact = value(x);
  for (std::size_t column = 0; column < x.size(); ++column) {
    const double h = 1e-6;
    auto above = x;
    auto below = x;
    above[column] += h;
    below[column] -= h;
    const double derivative = column < 3   ? exact.d_values[column]
                              : column < 5 ? exact.d_first[column - 3]
                                           : exact.d_second[column - 5];
    INFO("column " << column);
    CHECK(derivative == Approx((value(above).value - value(below).value) / (2.0 * h)).epsilon(1e-6));
  }
}
