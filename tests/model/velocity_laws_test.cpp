// What must hold for velocity-dependent friction whatever the parameters are.

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "model/velocity_law.hpp"
#include "model/velocity_slip.hpp"
#include "slipfit/model/motion.hpp"
#include "support/velocity_motion.hpp"

using namespace slipfit;

namespace {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double sign() { return uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0; }

 private:
  std::mt19937_64 generator_;
};

void check_same_cycle(const Motion& velocity, const Motion& coulomb, double tolerance) {
  REQUIRE(velocity.cycle.has_value() == coulomb.cycle.has_value());
  CHECK(velocity.regime == coulomb.regime);
  if (!coulomb.cycle) return;
  const LimitCycle& a = *velocity.cycle;
  const LimitCycle& b = *coulomb.cycle;
  CHECK(a.slip_s == Approx(b.slip_s).epsilon(tolerance));
  CHECK(a.stick_s == Approx(b.stick_s).epsilon(tolerance));
  CHECK(a.sticking_degree == Approx(b.sticking_degree).epsilon(tolerance));
  const double force_N = tolerance * (b.force_peak_N - b.force_trough_N);
  CHECK(a.onset_force_N == Approx(b.onset_force_N).margin(force_N));
  CHECK(a.end_force_N == Approx(b.end_force_N).margin(force_N));
  CHECK(a.force_peak_N == Approx(b.force_peak_N).margin(force_N));
  CHECK(a.force_trough_N == Approx(b.force_trough_N).margin(force_N));
  CHECK(a.mean_force_N == Approx(b.mean_force_N).margin(force_N));
}

/// So near the end of stick-slip that round-off decides, or the last digits of the stick.
bool grazes(double lambda, double zeta) {
  return zeta < 1.0 && std::abs(lambda / critical_lambda(zeta) - 1.0) < 1e-3;
}

}  // namespace

TEST_CASE("laws of friction begin alike, bend as they say, and know their derivatives") {
  const model::LawShape shape =
      GENERATE(model::LawShape::Exponential, model::LawShape::Hyperbolic, model::LawShape::Logarithmic);
  for (const double rate : {-4.0, -0.3, -1e-5}) {
    for (const double v : {1e-3, 0.4, 3.0}) {
      const model::ScaledLaw law{0.7, rate, shape};
      const model::ExcessFriction g = law.at(v);
      const double bend = shape == model::LawShape::Exponential  ? std::exp(rate * v)
                          : shape == model::LawShape::Hyperbolic ? std::pow(1.0 - 0.5 * rate * v, -2.0)
                                                                 : 1.0 / (1.0 - rate * v);
      CHECK(g.d_speed == Approx(0.7 * bend).epsilon(1e-12).margin(1e-15));  // expm1 + 1 rounds
      const double h = 1e-4 * v;
      CHECK(g.d_speed == Approx((law.at(v + h).value - law.at(v - h).value) / (2.0 * h)).epsilon(1e-6));
      CHECK(g.d_slope == Approx(g.value / 0.7).epsilon(1e-12));
      const double r = 1e-4 * std::abs(rate);
      const double above = model::ScaledLaw{0.7, rate + r, shape}.at(v).value;
      const double below = model::ScaledLaw{0.7, rate - r, shape}.at(v).value;
      // The difference of the two loses digits where friction hardly depends on the rate.
      CHECK(g.d_rate == Approx((above - below) / (2.0 * r)).epsilon(1e-5).margin(1e-15 * g.value / r));
    }
  }
}

TEST_CASE("velocity-dependent friction without strength or without rate is Coulomb friction") {
  Dice dice(41);
  for (int trial = 0; trial < 2000; ++trial) {
    const double lambda = dice.log_uniform(1e-3, 1e8);
    const double zeta = trial % 7 == 0 ? 0.0 : dice.log_uniform(1e-7, 1.5);
    const double f1_N = dice.uniform(0.0, 2.0);
    INFO("lambda " << lambda << " zeta " << zeta);
    if (grazes(lambda, zeta)) continue;
    const Slider slider = Slider::create(1.0, 1.0, zeta).value();
    const Motion coulomb = damped_motion(slider, Friction::create(lambda + 2.0, 2.0).value(), 1.0);
    const auto motion = [&](double f1, double alpha) {
      return velocity_motion(slider, VelocityFriction::create(lambda + 2.0, 2.0 - f1, f1, alpha).value(), 1.0)
          .value()
          .motion;
    };
    const double tolerance = 1e-10 + 1e-13 / (lambda * lambda);  // as the header says
    check_same_cycle(motion(f1_N, 0.0), coulomb, tolerance);
    check_same_cycle(motion(0.0, dice.sign() * dice.log_uniform(1e-3, 100.0)), coulomb, tolerance);
  }
}

TEST_CASE("friction linear in the speed is viscous damping") {
  Dice dice(43);
  for (int trial = 0; trial < 500; ++trial) {
    const double lambda = dice.log_uniform(1e-3, 1e4);
    const double total = dice.log_uniform(1e-3, 0.9);
    const double zeta = dice.uniform(0.0, 0.95);
    INFO("lambda " << lambda << " total damping ratio " << total << " zeta " << zeta);
    if (grazes(lambda, total)) continue;
    // f1 (exp(alpha v) - 1) = f1 alpha v to a relative alpha v / 2, v at most 2 + lambda
    const double alpha = 1e-12 / (2.0 + lambda);
    const double f1_N = 2.0 * (total - zeta) / alpha;
    const double onset_N = 1.0;
    const auto friction = VelocityFriction::create(onset_N, 0.0, 0.0, 0.0);
    REQUIRE(friction.ok());
    const double f0_N = onset_N - f1_N;
    const double rounded_onset_N = f0_N + f1_N;  // f1 is large: the sum loses digits
    if (rounded_onset_N < 0.0) continue;
    const auto law = VelocityFriction::create(rounded_onset_N + lambda, f0_N, f1_N, alpha).value();
    const Motion velocity = velocity_motion(Slider::create(1.0, 1.0, zeta).value(), law, 1.0).value().motion;
    const Motion coulomb = damped_motion(Slider::create(1.0, 1.0, total).value(),
                                         Friction::create(rounded_onset_N + lambda, rounded_onset_N).value(), 1.0);
    REQUIRE(velocity.cycle.has_value() == coulomb.cycle.has_value());
    if (!coulomb.cycle) continue;
    CHECK(velocity.cycle->slip_s == Approx(coulomb.cycle->slip_s).epsilon(1e-8));
    CHECK(velocity.cycle->stick_s == Approx(coulomb.cycle->stick_s).epsilon(1e-8));
  }
}

TEST_CASE("energy: what the drive gives, velocity-dependent friction and the damper take") {
  Dice dice(47);
  int cycles = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Slider slider =
        Slider::create(dice.uniform(100.0, 5000.0), dice.uniform(20.0, 800.0), dice.uniform(0.0, 0.3)).value();
    const double f0_N = dice.uniform(0.5, 3.0);
    const double f1_N = dice.uniform(-0.4, 2.0);
    const double difference_N = dice.uniform(0.3, 2.0);
    const double lambda = dice.uniform(0.5, 20.0);
    const double speed_m_per_s =
        slider.natural_frequency_rad_per_s() * difference_N / (slider.stiffness_N_per_m() * lambda);
    // f1 < 0 with alpha > 0 runs away.
    const double alpha_s_per_m = dice.uniform(-2.0, f1_N > 0.0 ? 0.1 : 0.0) / speed_m_per_s;
    const auto friction = VelocityFriction::create(f0_N + f1_N + difference_N, f0_N, f1_N, alpha_s_per_m).value();
    const auto motion = velocity_motion(slider, friction, speed_m_per_s);
    REQUIRE(motion.ok());
    if (!motion.value().motion.cycle) continue;
    ++cycles;
    const LimitCycle& cycle = *motion.value().motion.cycle;
    CHECK(cycle.periodic_displacement_m == Approx(speed_m_per_s * cycle.period_s).epsilon(1e-15));
    CHECK(cycle.period_s == Approx(cycle.slip_s + cycle.stick_s).epsilon(1e-15));
    // Gauss' rule on panels: exact for polynomials of degree 19, and the friction's layer at rest is 20 panels wide.
    using Gauss = boost::math::quadrature::gauss<double, 10>;
    constexpr std::size_t kPanels = 100;
    const double half_panel_s = 0.5 * cycle.slip_s / kPanels;
    std::vector<double> time_s, weight_s;
    for (std::size_t panel = 0; panel < kPanels; ++panel) {
      const double middle_s = (2.0 * static_cast<double>(panel) + 1.0) * half_panel_s;
      for (std::size_t i = 0; i < 10; ++i) {
        const std::size_t from_middle = i < 5 ? 4 - i : i - 5;
        const double x = i < 5 ? -Gauss::abscissa()[from_middle] : Gauss::abscissa()[from_middle];
        time_s.push_back(middle_s + x * half_panel_s);
        weight_s.push_back(Gauss::weights()[from_middle] * half_panel_s);
      }
    }
    const auto waveform = velocity_waveform(slider, friction, speed_m_per_s, time_s).value();
    const double c = slider.damping_N_s_per_m();
    double taken_J = c * speed_m_per_s * speed_m_per_s * cycle.stick_s;
    double path_m = 0.0;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      const double v = waveform.sliding_speed_m_per_s[i];
      const double u = speed_m_per_s - v;
      path_m += weight_s[i] * v;
      taken_J += weight_s[i] * (friction.kinetic_N(v) * v + c * u * u);
    }
    INFO("trial " << trial);
    CHECK(path_m == Approx(cycle.periodic_displacement_m).epsilon(1e-9));
    CHECK(taken_J == Approx(cycle.mean_force_N * cycle.periodic_displacement_m).epsilon(1e-9));
  }
  CHECK(cycles > 100);
}

TEST_CASE("a slip that falls into a thin layer of friction at rest ends at the same time whatever its steps") {
  // The last terms of a series are blind to an exponential that grows by more than its order: slips would end late.
  // With derivatives the steps are others.
  Dice dice(59);
  for (int trial = 0; trial < 1000; ++trial) {
    const double lambda = dice.log_uniform(100.0, 1e4);
    const double f1_N = dice.sign() * dice.log_uniform(0.05, 20.0);
    const double rate = -dice.log_uniform(3.0, 20.0);
    const Slider slider = Slider::create(1.0, 1.0, dice.uniform(0.0, 0.1)).value();
    const auto friction = VelocityFriction::create(21.0 + lambda, 21.0 - f1_N, f1_N, rate).value();
    INFO("lambda " << lambda << " f1 " << f1_N << " rate " << rate);
    const auto motion = velocity_motion(slider, friction, 1.0);
    const auto derivatives = velocity_derivatives(slider, friction, 1.0);
    if (!motion || !derivatives) continue;
    REQUIRE(motion.value().motion.cycle.has_value() == derivatives.value().has_value());
    if (!motion.value().motion.cycle) continue;
    CHECK(motion.value().motion.cycle->slip_s == Approx(derivatives.value()->slip_s.value).epsilon(1e-11));
  }
}

TEST_CASE("a slip that is overdamped above the driving speed settles without integration") {
  // w = v - 1 obeys w'' + (2 zeta + g'(v)) w' + w = 0, and the factor of w' exceeds 2 where w > 0: w crosses 0 only
  // once.
  const model::ScaledSlip slip{7.5, 0.1, {18.6, 3.4}};
  int steps = 0;
  const auto end = model::follow_slip<true>(slip, model::kForFits, [&](const auto&) { ++steps; });
  CHECK(end.outcome == model::SlipOutcome::Settles);
  CHECK(steps == 0);
  CHECK_FALSE(model::VelocityTrack::solve(slip.lambda - 2.0 * slip.zeta, slip.zeta, slip.law));
}

TEST_CASE("finite valid velocity-dependent parameters never give a number that is not finite") {
  Dice dice(53);
  std::map<std::string, int> outcomes;
  int bad = 0;
  constexpr int kTrials = 5000;
  for (int i = 0; i < kTrials; ++i) {
    const double zeta = i % 10 == 0 ? 0.0 : dice.log_uniform(1e-9, 10.0);
    const Slider slider = Slider::create(dice.log_uniform(1e-6, 1e12), dice.log_uniform(1e-4, 1e8), zeta).value();
    const double speed_m_per_s = dice.log_uniform(1e-12, 1e4);
    const double force_N = slider.stiffness_N_per_m() * speed_m_per_s / slider.natural_frequency_rad_per_s();
    const double onset_N = i % 7 == 0 ? 0.0 : force_N * dice.log_uniform(1e-6, 1e6);
    const double f1_N = dice.sign() * force_N * dice.log_uniform(1e-6, 1e6);
    const double difference_N = i % 11 == 0 ? 0.0 : force_N * dice.log_uniform(1e-6, 1e8);
    const double alpha_s_per_m = dice.sign() * dice.log_uniform(1e-9, 1e3) / speed_m_per_s;
    const double f0_N = onset_N - f1_N;
    const double rounded_onset_N = std::max(0.0, f0_N + f1_N);
    const auto friction =
        VelocityFriction::create(rounded_onset_N + difference_N, rounded_onset_N - f1_N, f1_N, alpha_s_per_m);
    if (!friction) continue;
    const auto result = velocity_motion(slider, friction.value(), speed_m_per_s);
    if (!result) {
      ++outcomes[result.error().code];
      continue;
    }
    const Motion& motion = result.value().motion;
    if (!std::isfinite(motion.lambda) || !std::isfinite(result.value().total_damping_ratio)) ++bad;
    ++outcomes["regime " + std::to_string(static_cast<int>(motion.regime))];
    if (!motion.cycle) continue;
    const LimitCycle& c = *motion.cycle;
    for (const double value : {c.slip_s, c.stick_s, c.period_s, c.sticking_degree, c.periodic_displacement_m,
                               c.force_peak_N, c.force_trough_N, c.onset_force_N, c.end_force_N, c.mean_force_N}) {
      if (!std::isfinite(value)) ++bad;
    }
    if (!(c.slip_s > 0.0 && c.stick_s > 0.0 && c.sticking_degree <= 1.0)) ++bad;
  }
  CHECK(bad == 0);
  for (const auto& [name, count] : outcomes) INFO(name << ": " << count);
  // The rest runs away (alpha > 0, f1 < 0) or is far too stiff.
  CHECK(outcomes["no_convergence"] + outcomes["parameter_out_of_range"] < kTrials / 4);
  CHECK(outcomes["regime 0"] + outcomes["regime 1"] > kTrials / 4);
}
