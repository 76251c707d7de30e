#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "model/slip.hpp"
#include "reference_table.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/paper.hpp"

namespace {

using slipfit::damped_motion;

/// Unit slider: w_n = 1, k = 1, V = 1, so times are tau and forces are in k V / w_n.
slipfit::Motion unit_motion(double lambda, double zeta) {
  return damped_motion(slipfit::Slider::create(1.0, 1.0, zeta).value(), slipfit::Friction::create(lambda, 0.0).value(),
                       1.0);
}

}  // namespace

TEST_CASE("undamped cycle agrees with the independent table") {
  for (auto& row : test::reference_rows("undamped.csv")) {
    if (row["lambda"] == 0.0) continue;
    const auto motion = unit_motion(row["lambda"], 0.0);
    INFO("lambda " << row["lambda"]);
    REQUIRE(motion.cycle);
    CHECK(motion.cycle->slip_s == Approx(row["slip_time"]).epsilon(1e-13));
    CHECK(motion.cycle->stick_s == Approx(row["stick_time"]).epsilon(1e-13));
    CHECK(motion.cycle->period_s == Approx(row["period"]).epsilon(1e-11));
  }
}

TEST_CASE("damped cycle agrees with the independent table, existence included") {
  for (auto& row : test::reference_rows("damped_exact.csv")) {
    const auto motion = unit_motion(row["lambda"], row["zeta"]);
    INFO("lambda " << row["lambda"] << " zeta " << row["zeta"]);
    REQUIRE(motion.cycle.has_value() == (row["sticks"] == 1.0));
    if (!motion.cycle) continue;
    CHECK(motion.cycle->slip_s == Approx(row["slip_time"]).epsilon(1e-13));
    CHECK(motion.cycle->stick_s == Approx(row["stick_time"]).epsilon(1e-13));
    CHECK(motion.cycle->sticking_degree == Approx(row["sticking_degree"]).epsilon(1e-13));
    CHECK(motion.cycle->end_force_N == Approx(row["z_end"]).epsilon(1e-13));
  }
}

TEST_CASE("critical lambda agrees with the independent table") {
  for (auto& row : test::reference_rows("stick_slip_boundary.csv")) {
    INFO("zeta " << row["zeta"]);
    CHECK(slipfit::critical_lambda(row["zeta"]) == Approx(row["lambda_c"]).epsilon(1e-13));
  }
  CHECK(slipfit::critical_lambda(0.015) == Approx(0.453482).epsilon(2e-6));
  CHECK(slipfit::critical_lambda(0.0) == 0.0);
}

TEST_CASE("damped cycles obey the laws of motion for random parameters over the whole range") {
  std::mt19937_64 random(99);
  std::uniform_real_distribution<double> exponent(-6.0, 8.0);
  std::uniform_real_distribution<double> log_zeta(-7.0, std::log10(0.999));
  for (int i = 0; i < 20000; ++i) {
    const double lambda = std::pow(10.0, exponent(random));
    const double zeta = i % 7 == 0 ? 0.0 : std::pow(10.0, log_zeta(random));
    const auto motion = unit_motion(lambda, zeta);
    INFO("lambda " << lambda << " zeta " << zeta);
    REQUIRE(std::isfinite(motion.lambda));
    if (!motion.cycle) {
      CHECK(lambda < slipfit::critical_lambda(zeta) * (1.0 + 1e-12));
      continue;
    }
    const slipfit::LimitCycle& c = *motion.cycle;
    const double scale = 1.0 + lambda;
    // Energy: the drive's work V * mean force * T is what kinetic friction (0 here) and the damper take, so the mean
    // force is the damper's work over the path: checked through the slip solution at its end instead of the closed
    // form.
    const auto end = slipfit::model::slip_point(lambda - 2.0 * zeta, zeta, c.slip_s);
    CHECK(end.z == Approx(c.end_force_N).margin(1e-11 * scale));
    CHECK(end.dz == Approx(1.0).margin(1e-11 * scale));
    CHECK(c.periodic_displacement_m == Approx(c.period_s).epsilon(1e-15));
    // Radii of the spiral are exponentials of h, up to 18 here: its rounding (18 * 2e-16) is their relative error, a
    // few of them added up.
    CHECK(c.force_trough_N <= c.end_force_N + 4e-14 * scale);
    CHECK(c.force_peak_N >= c.onset_force_N - 4e-14 * scale);
    if (zeta == 0.0) CHECK(c.mean_force_N == Approx(0.0).margin(1e-13 * scale));
  }
}

TEST_CASE("overdamped bodies slip continuously, without overflow") {
  for (const double zeta : {1.0, 1.0 + 1e-12, 1.5, 50.0}) {
    const auto motion = unit_motion(20.0, zeta);
    CHECK(motion.regime == slipfit::Regime::ContinuousSlip);
    CHECK_FALSE(motion.cycle);
    const double h = 1e-4;
    for (const double tau : {0.01, 1.0, 7.0}) {
      const auto z = [&](double t) { return slipfit::model::slip_point(20.0 - 2.0 * zeta, zeta, t).z; };
      const auto at = slipfit::model::slip_point(20.0 - 2.0 * zeta, zeta, tau);
      CHECK(at.ddz == Approx((z(tau + h) - 2.0 * z(tau) + z(tau - h)) / (h * h)).epsilon(1e-4).margin(1e-5));
    }
    CHECK(slipfit::model::slip_point(20.0, zeta, 1e6).z == Approx(0.0).margin(1e-3));
  }
  CHECK(slipfit::critical_speed_m_per_s(slipfit::Slider::create(1.0, 1.0, 1.5).value(),
                                        slipfit::Friction::create(1.0, 0.0).value()) == 0.0);
}

TEST_CASE("the paper's approximation agrees with the independent table, unsolvable rows included") {
  for (auto& row : test::reference_rows("damped_paper.csv")) {
    const auto cycle = slipfit::paper_cycle(slipfit::Slider::create(1.0, 1.0, row["zeta"]).value(),
                                            slipfit::Friction::create(row["lambda"], 0.0).value(), 1.0);
    INFO("lambda " << row["lambda"] << " zeta " << row["zeta"]);
    REQUIRE(cycle.ok() == (row["has_solution"] == 1.0));
    if (!cycle) {
      CHECK(cycle.error().code == "no_solution");
      continue;
    }
    const slipfit::PaperCycle& paper = cycle.value();
    for (const auto& [value, name] :
         {std::pair{paper.delta_e, "delta_e"}, std::pair{paper.delta_t, "delta_t"}, std::pair{paper.delta_s, "delta_s"},
          std::pair{paper.slip_s, "slip_time"}, std::pair{paper.stick_s, "stick_time"},
          std::pair{paper.sticking_degree, "sticking_degree"}, std::pair{paper.displacement_printed_m, "xi"}}) {
      INFO(name);
      CHECK(value == Approx(row[name]).epsilon(1e-10));
    }
  }
}

TEST_CASE("the paper's equations have solutions below the exact limit, but far above the limits printed for figure 7") {
  struct Limits {
    double zeta, printed, first_solvable;
  };
  for (const Limits& limits : {Limits{0.015, 0.2, 0.4385}, Limits{0.05, 0.5, 0.8617}, Limits{0.1, 0.9, 1.3770}}) {
    const auto solvable = [&](double lambda) {
      return slipfit::paper_cycle(slipfit::Slider::create(1.0, 1.0, limits.zeta).value(),
                                  slipfit::Friction::create(lambda, 0.0).value(), 1.0)
          .ok();
    };
    double none = limits.printed;
    double some = slipfit::critical_lambda(limits.zeta);
    INFO("zeta " << limits.zeta);
    CHECK_FALSE(solvable(none));
    REQUIRE(solvable(some));
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (none + some);
      (solvable(middle) ? some : none) = middle;
    }
    CHECK(some == Approx(limits.first_solvable).margin(5e-5));
    CHECK(some > 1.5 * limits.printed);
  }
}

TEST_CASE("the sliding body rejects impossible parameters by name") {
  CHECK(slipfit::Slider::create(-1.0, 1.0, 0.1).error().message.find("stiffness") != std::string::npos);
  CHECK(slipfit::Slider::create(1.0, std::nan(""), 0.1).error().message.find("natural frequency") != std::string::npos);
  CHECK(slipfit::Slider::create(1.0, 1.0, -0.1).error().message.find("damping ratio") != std::string::npos);
  CHECK(slipfit::Friction::create(1.0, 2.0).error().message.find("static friction") != std::string::npos);
  CHECK(slipfit::Friction::create(1.0, -2.0).error().message.find("kinetic friction") != std::string::npos);
}

TEST_CASE("wave derivatives are exact on either side of every event") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> log_z0(-0.5, 2.0);
  std::uniform_real_distribution<double> any_zeta(0.0, 0.3);
  const double h = 1e-6;
  for (int i = 0; i < 300; ++i) {
    const double z0 = std::pow(10.0, log_z0(random));
    const double zeta = any_zeta(random);
    const auto slip = slipfit::model::solve_slip(z0, zeta);
    INFO("z0 " << z0 << " zeta " << zeta << " resticks " << slip.resticks);
    for (const double tau : {0.0, 0.3 * slip.tau_end, slip.tau_end}) {
      const auto wave = slipfit::model::slip_wave(slip, tau);
      const auto z = [&](double a, double c, double t) { return slipfit::model::slip_point(a, c, t).z; };
      const double tolerance = 1e-8 * (1.0 + z0);  // h^2 z''' of the difference and round-off / h
      CHECK(wave.z == Approx(z(z0, zeta, tau)).margin(1e-13 * (1.0 + z0)));
      CHECK(wave.d_z0 == Approx((z(z0 + h, zeta, tau) - z(z0 - h, zeta, tau)) / (2 * h)).margin(tolerance));
      CHECK(wave.d_zeta == Approx((z(z0, zeta + h, tau) - z(z0, zeta - h, tau)) / (2 * h)).margin(tolerance));
      CHECK(wave.d_tau == Approx((z(z0, zeta, tau + h) - z(z0, zeta, tau - h)) / (2 * h)).margin(tolerance));
    }
    const auto line = slipfit::model::stick_after(slip);
    const auto intercept = [](double a, double c) {
      return slipfit::model::stick_after(slipfit::model::solve_slip(a, c)).intercept;
    };
    const bool grazes = std::abs(slip.end.dz - 1.0) < 1e-3 && !slip.resticks;
    if (grazes || (slip.resticks && std::abs(slip.end.ddz) < 1e-2)) continue;  // the end jumps within the step h
    CHECK(line.d_z0 == Approx((intercept(z0 + h, zeta) - intercept(z0 - h, zeta)) / (2 * h)).margin(1e-7 * (1 + z0)));
    CHECK(line.d_zeta == Approx((intercept(z0, zeta + h) - intercept(z0, zeta - h)) / (2 * h)).margin(1e-7 * (1 + z0)));
  }
}
