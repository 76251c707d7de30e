#include "model/weakening.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "fit/law/slip_weakening.hpp"
#include "model/slip.hpp"
#include "reference_table.hpp"

using namespace slipfit;
using fit::ShownPoint;
using model::WeakeningSlip;

namespace {

struct Drawn {
  double lambda, zeta, distance;

  [[nodiscard]] double z0() const { return lambda - 2.0 * zeta; }
  [[nodiscard]] WeakeningSlip slip(ForceView view = ForceView::Spring) const { return {z0(), zeta, distance, view}; }
};

Drawn drawn(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double lambda = std::exp(uniform(std::log(1.0), std::log(100.0)));
  return {lambda, uniform(-0.1, 0.3), lambda * uniform(0.02, 0.8)};
}

/// Fourth-order central difference of the shown force by one of z0, zeta, distance.
template <class Shown>
double difference(const Drawn& at, const Shown& shown, int parameter) {
  constexpr double kStep = 1e-3;
  const auto moved = [&](double steps) {
    double values[] = {at.z0(), at.zeta, at.distance};
    values[parameter] += steps * kStep;
    return shown(WeakeningSlip(values[0], values[1], values[2], ForceView::Transmitted));
  };
  return (8.0 * (moved(1.0) - moved(-1.0)) - (moved(2.0) - moved(-2.0))) / (12.0 * kStep);
}

/// What a sensor shows at tau that averages over so much of it.
ShownPoint averaged(const WeakeningSlip& slip, double tau, double average) {
  return fit::ShownMotion(fit::WeakeningMotion(slip), {0.0, average, 1}).at(tau);
}

/// Integral of f by Simpson's rule.
template <class F>
double integral(const F& f, double begin, double end) {
  constexpr int kSteps = 4000;
  const double h = (end - begin) / kSteps;
  double sum = f(begin) + f(end);
  for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(begin + i * h);
  return sum * h / 3.0;
}

}  // namespace

TEST_CASE("a slip that weakens over a distance is that of the reference") {
  for (const auto& row : test::reference_rows("slip_weakening.csv")) {
    const Drawn at{row.at("lambda"), row.at("zeta"), row.at("Delta")};
    const WeakeningSlip slip = at.slip();
    CAPTURE(at.lambda, at.zeta, at.distance);
    CHECK(slip.weakened_tau() == Approx(row.at("tau_1")).epsilon(1e-12));
    CHECK(slip.weakened_speed() == Approx(row.at("v_1")).epsilon(1e-12));
    REQUIRE(slip.resticks() == (row.at("t_slip") > 0.0));  // empty: it does not
    if (!slip.resticks()) continue;
    CHECK(slip.tau_end() == Approx(row.at("t_slip")).epsilon(1e-12));
    const double end = slip.at(slip.tau_end()).z + 2.0 * at.zeta;
    CHECK(end == Approx(row.at("s_end")).epsilon(1e-12).margin(1e-12));
    CHECK(at.lambda - end == Approx(row.at("t_stick")).epsilon(1e-12));
  }
}

TEST_CASE("derivatives of a weakening slip agree with differences, its mean too") {
  std::mt19937_64 random(23);
  for (int trial = 0; trial < 60; ++trial) {
    const Drawn at = drawn(random);
    const WeakeningSlip slip = at.slip(ForceView::Transmitted);
    CAPTURE(trial, at.lambda, at.zeta, at.distance, slip.resticks());
    for (const double tau :
         {-0.3, 0.4 * slip.weakened_tau(), 0.5 * (slip.weakened_tau() + slip.tau_end()), slip.tau_end() + 0.2}) {
      // Every derivative is compared where the differences cross no joint, at which the next derivatives jump.
      const auto instant = [tau](const WeakeningSlip& moved) { return moved.at(tau).z; };
      const model::WeakeningPoint p = slip.at(tau);
      const double size = 1e-7 * (1.0 + at.lambda);
      CHECK(p.d_z0 == Approx(difference(at, instant, 0)).epsilon(1e-7).margin(size));
      CHECK(p.d_zeta == Approx(difference(at, instant, 1)).epsilon(1e-7).margin(size));
      CHECK(p.d_distance == Approx(difference(at, instant, 2)).epsilon(1e-7).margin(size));
      const double h = 1e-4;
      CHECK(p.d_tau == Approx((slip.at(tau + h).z - slip.at(tau - h).z) / (2.0 * h)).epsilon(1e-6).margin(10.0 * size));
      const double window = 0.7;
      const auto value = [&](double time) { return slip.at(time).z; };
      const ShownPoint mean = averaged(slip, tau, window);
      CHECK(mean.z ==
            Approx(integral(value, tau - 0.5 * window, tau + 0.5 * window) / window).margin(1e-4 * at.lambda));
      const auto smooth = [&](const WeakeningSlip& moved) { return averaged(moved, tau, window).z; };
      CHECK(mean.d_zeta == Approx(difference(at, smooth, 1)).epsilon(1e-6).margin(10.0 * size));
      const double wider = averaged(slip, tau, window * 1.001).z - averaged(slip, tau, window * 0.999).z;
      CHECK(mean.d_log_omega == Approx(wider / 0.002).epsilon(1e-5).margin(1e-5 * at.lambda));
    }
  }
}

TEST_CASE("a weakening slip turns the spring's work into friction, and slips as far as the drive moves") {
  std::mt19937_64 random(29);
  for (int trial = 0; trial < 40; ++trial) {
    const Drawn at = drawn(random);
    const WeakeningSlip slip = at.slip();
    if (!slip.resticks()) continue;
    CAPTURE(trial, at.lambda, at.zeta, at.distance);
    // At rest before and after: the work of the spring on the mass is that of damping and friction above F_k.
    const auto speed = [&](double tau) { return 1.0 - slip.at(tau).d_tau; };
    const auto spring = [&](double tau) { return (slip.at(tau).z + 2.0 * at.zeta) * speed(tau); };
    const auto damping = [&](double tau) { return 2.0 * at.zeta * speed(tau) * speed(tau); };
    const double joint = slip.weakened_tau();
    const auto over_slip = [&](const auto& f) { return integral(f, 0.0, joint) + integral(f, joint, slip.tau_end()); };
    const double friction = 0.5 * at.lambda * at.distance;
    CHECK(over_slip(spring) == Approx(over_slip(damping) + friction).epsilon(1e-8).margin(1e-8 * at.lambda));
    // The slip is what the drive moves in it and what the spring gives back.
    CHECK(over_slip(speed) == Approx(slip.tau_end() + at.z0() - slip.at(slip.tau_end()).z).epsilon(1e-9));
    // Over a whole cycle the slider moves by the drive's V T.
    const double stick = at.z0() - slip.at(slip.tau_end()).z;
    CHECK(over_slip(speed) == Approx(slip.tau_end() + stick).epsilon(1e-9));
  }
}

TEST_CASE("friction that weakens at once is Coulomb friction") {
  for (const double zeta : {0.0, 0.05, 0.3}) {
    const double z0 = 8.0 - 2.0 * zeta;
    const model::Slip coulomb = model::solve_slip(z0, zeta);
    double before = INFINITY;
    for (const double distance : {1e-2, 1e-4, 1e-8, 1e-12}) {
      const WeakeningSlip slip(z0, zeta, distance);
      const double off = std::abs(slip.at(2.0).z - model::slip_wave(coulomb, 2.0).z);
      CHECK(off < 0.7 * before);
      before = off;
    }
    CHECK(before < 1e-4);  // the onset is late by sqrt(D_c / lambda) times a logarithm
  }
}

TEST_CASE("friction that weakens slowly has forms of its own, and may stop the slip while it weakens") {
  // x'' = tau undamped where the friction falls as the spring force does: x = tau^3 / 6.
  const WeakeningSlip level(5.0, 0.0, 5.0);
  CHECK(level.weakened_tau() == Approx(std::cbrt(30.0)).epsilon(1e-13));
  CHECK(level.weakened_speed() == Approx(0.5 * std::pow(30.0, 2.0 / 3.0)).epsilon(1e-13));
  // From either side, and with damping, where two roots of the equation of motion meet.
  for (const double zeta : {-0.2, 0.0, 0.2}) {
    const double z0 = 5.0 - 2.0 * zeta;
    const double middle = WeakeningSlip(z0, zeta, 5.0).tau_end();
    CHECK(WeakeningSlip(z0, zeta, 5.0 + 1e-9).tau_end() == Approx(middle).epsilon(1e-8));
    CHECK(WeakeningSlip(z0, zeta, 5.0 - 1e-9).tau_end() == Approx(middle).epsilon(1e-8));
    const double twice = 5.0 / (1.0 - zeta * zeta);
    CHECK(WeakeningSlip(z0, zeta, twice * (1.0 + 1e-9)).at(2.0).z ==
          Approx(WeakeningSlip(z0, zeta, twice).at(2.0).z).epsilon(1e-7));
  }
  // g = lambda / Delta - 1 = -1/2: at rest again after one swing of w = sqrt(1/2), 2 pi / w^3 further.
  const WeakeningSlip stopped(20.0, 0.0, 40.0);
  CHECK(std::isinf(stopped.weakened_tau()));
  CHECK(stopped.resticks());
  CHECK(stopped.tau_end() == Approx(2.0 * 3.14159265358979 * std::sqrt(2.0)).epsilon(1e-12));
  CHECK(stopped.at(stopped.tau_end()).z == Approx(20.0 + stopped.tau_end() * (1.0 - 2.0)).epsilon(1e-12));
  const WeakeningSlip growing(20.1, -0.05, 40.0);
  CHECK(std::isinf(growing.weakened_tau()));
  CHECK(growing.at(growing.tau_end()).d_tau == Approx(1.0).epsilon(1e-9));
  CHECK(growing.tau_end() < stopped.tau_end());
}

TEST_CASE("the track of a weakening slip at even steps is the slip") {
  std::mt19937_64 random(5);
  for (int i = 0; i < 200; ++i) {
    const Drawn at = drawn(random);
    for (const ForceView view : {ForceView::Spring, ForceView::Transmitted}) {
      const WeakeningSlip slip = at.slip(view);
      if (!std::isfinite(slip.tau_end())) continue;
      const double step = slip.tau_end() / 70.0;
      for (const double average : {0.0, 0.3 * slip.tau_end(), 1.5 * slip.tau_end()}) {
        model::WeakeningTrack track(slip, step, average);
        CAPTURE(at.lambda, at.zeta, at.distance, average);
        for (int k = -60; k < 130; ++k) {
          if (k % 11 == 7) continue;
          const double tau = (k + 0.3) * step;
          const model::WeakeningPoint here = track.at(tau);
          const ShownPoint there = averaged(slip, tau, average);
          const double size = at.lambda + std::abs(tau);
          CHECK(here.z == Approx(there.z).margin(1e-11 * size));
          CHECK(here.d_z0 == Approx(there.d_z0).margin(1e-10));
          CHECK(here.d_zeta == Approx(there.d_zeta).margin(1e-10 * size));
          CHECK(here.d_tau == Approx(there.d_tau).margin(1e-11 * size));
          CHECK(here.d_log_omega == Approx(there.d_log_omega).margin(1e-11 * size));
          CHECK(here.d_distance == Approx(there.d_law[0]).margin(1e-10));
        }
      }
    }
  }
}
