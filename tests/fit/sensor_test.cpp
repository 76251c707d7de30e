#include "fit/cycle/sensor.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "fit/law/coulomb.hpp"
#include "model/reference_table.hpp"
#include "scene.hpp"
#include "support/recordings.hpp"

using namespace slipfit;

namespace {

constexpr double kOversampling = 40.0;

/// Butterworth's response as sections of second order, y'' + 2 c w y' + w^2 y = w^2 x, and one of first order where the
/// order is odd, one behind the other: shares nothing with the sum over poles in the library.
class Cascade {
 public:
  Cascade(int order, double corner_rad_per_s, double at_rest) : order_(order), w_(corner_rad_per_s) {
    for (int k = 0; k < order; ++k) state_.push_back(k % 2 == 0 ? at_rest : 0.0);
  }

  /// The force shown a step later; the force measured is straight in between. Runge-Kutta of fourth order.
  double step(double from, double to, double step_s) {
    const auto moved = [](const std::vector<double>& a, double by, const std::vector<double>& b) {
      std::vector<double> c = a;
      for (std::size_t i = 0; i < a.size(); ++i) c[i] += by * b[i];
      return c;
    };
    const auto k1 = slopes(state_, from);
    const auto k2 = slopes(moved(state_, 0.5 * step_s, k1), 0.5 * (from + to));
    const auto k3 = slopes(moved(state_, 0.5 * step_s, k2), 0.5 * (from + to));
    const auto k4 = slopes(moved(state_, step_s, k3), to);
    for (std::size_t i = 0; i < state_.size(); ++i) {
      state_[i] += step_s / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
    return shown();
  }

 private:
  /// State: force and slope of each section in turn; the section of first order is the last.
  [[nodiscard]] std::vector<double> slopes(const std::vector<double>& y, double x) const {
    std::vector<double> slope(y.size());
    double in = x;
    for (std::size_t i = 0; i + 1 < y.size(); i += 2) {
      const double damping = std::sin(std::numbers::pi * (static_cast<double>(i) + 1.0) / (2.0 * order_));
      slope[i] = y[i + 1];
      slope[i + 1] = w_ * w_ * (in - y[i]) - 2.0 * damping * w_ * y[i + 1];
      in = y[i];
    }
    if (order_ % 2 == 1) slope.back() = w_ * (in - y.back());
    return slope;
  }
  [[nodiscard]] double shown() const { return order_ % 2 == 1 ? state_.back() : state_[state_.size() - 2]; }

  int order_;
  double w_;
  std::vector<double> state_;
};

/// The scene as a sensor shows it with a Butterworth response of this order and corner: simulated 40 times finer,
/// filtered, thinned out, noise added.
Recording through_filter(Scene s, int order, double corner_rad_per_s) {
  const double noise_N = s.noise * (s.static_N - s.kinetic_N);
  s.noise = 0.0;
  s.samples_per_slip *= kOversampling;
  const Recording fine = record(s);
  const auto time_s = fine.time_s();
  const auto force = fine.force();
  std::mt19937_64 random(s.seed);
  std::normal_distribution<double> noise(0.0, noise_N);
  std::vector<double> seen_s;
  std::vector<double> seen;
  Cascade filter(order, corner_rad_per_s, force[0]);
  for (std::size_t i = 1; i < force.size(); ++i) {
    const double shown = filter.step(force[i - 1], force[i], time_s[i] - time_s[i - 1]);
    if (i % static_cast<std::size_t>(kOversampling) != 0) continue;
    seen_s.push_back(time_s[i]);
    seen.push_back(shown + noise(random));
  }
  return Recording::create(std::move(seen_s), std::move(seen), fine.conditions()).value();
}

Recording through_sensor(const Scene& s, double lag_s) {
  return through_filter(s, 1, 1.0 / lag_s);
}

/// The scene as a logger shows it that averages over so many samples: simulated 40 times finer.
Recording averaged(Scene s, double samples) {
  const double noise_N = s.noise * (s.static_N - s.kinetic_N);
  s.noise = 0.0;
  s.samples_per_slip *= kOversampling;
  const Recording fine = record(s);
  const auto force = fine.force();
  const auto reach = static_cast<std::size_t>(0.5 * samples * kOversampling);
  std::mt19937_64 random(s.seed);
  std::normal_distribution<double> noise(0.0, noise_N);
  std::vector<double> sum{0.0};
  for (const double f : force) sum.push_back(sum.back() + f);
  std::vector<double> seen_s;
  std::vector<double> seen;
  for (std::size_t i = reach; i + reach + 1 < sum.size(); i += static_cast<std::size_t>(kOversampling)) {
    seen_s.push_back(fine.time_s()[i]);
    seen.push_back((sum[i + reach + 1] - sum[i - reach]) / static_cast<double>(2 * reach + 1) + noise(random));
  }
  return Recording::create(std::move(seen_s), std::move(seen), fine.conditions()).value();
}

}  // namespace

TEST_CASE("a slip seen through a stated filter gives its parameters back") {
  struct Seen {
    int order;
    double corner;  ///< over w_n
    ForceView view = ForceView::Spring;
    double zeta = 0.06;
  };
  constexpr ForceView kTransmitted = ForceView::Transmitted;
  const Seen seen = GENERATE(
      Seen{1, 10.0}, Seen{1, 2.0}, Seen{1, 1.0 / 1.5}, Seen{1, 10.0, kTransmitted}, Seen{1, 2.0, kTransmitted},
      Seen{1, 1.0 / 1.5, kTransmitted}, Seen{1, 10.0, ForceView::Spring, 0.01}, Seen{1, 2.0, ForceView::Spring, 0.01},
      Seen{1, 1.0 / 1.5, ForceView::Spring, 0.01}, Seen{2, 1.0}, Seen{3, 1.0}, Seen{4, 1.5}, Seen{8, 4.0},
      Seen{2, 1.0, kTransmitted}, Seen{3, 1.0, kTransmitted}, Seen{4, 1.5, kTransmitted}, Seen{8, 4.0, kTransmitted});
  CAPTURE(seen.order, seen.corner, seen.zeta);
  Scene s{.zeta = seen.zeta, .jitter = 0.03, .noise = 0.01, .view = seen.view};
  const double corner = seen.corner * s.omega;
  s.conditions.sensor_bandwidth_Hz = corner / (2.0 * std::numbers::pi);
  s.conditions.sensor_filter_order = static_cast<std::size_t>(seen.order);
  const Analysis analysis = analyze_and_fit(through_filter(s, seen.order, corner));
  REQUIRE(analysis.motion == MotionClass::StickSlip);
  check_truth(analysis, s);
  CHECK_FALSE(has_warning(analysis, "model_misfit"));
}

TEST_CASE("friction that weakens is not sure where a filter that nobody stated explains the slips as well") {
  const Scene s{.jitter = 0.03, .noise = 0.003};
  const Analysis analysis = analyze_and_fit(through_filter(s, 3, 5.0 * s.omega));
  const Parameter& distance = parameter(analysis, "slip_distance_m");
  CHECK(distance.status != ParameterStatus::Identified);
  CHECK(distance.status != ParameterStatus::Conditional);
  const Parameter& difference = parameter(analysis, "friction_difference_N");
  CHECK(difference.status == ParameterStatus::Weak);
  CHECK(difference.estimate.note.find("low-pass filter") != std::string::npos);
  CHECK(difference.estimate.ci95->low < s.static_N - s.kinetic_N);
  CHECK(difference.estimate.ci95->high > s.static_N - s.kinetic_N);
}

TEST_CASE("the response of a filter is that of its sections in a chain") {
  const int order = GENERATE(1, 2, 3, 4, 5, 8);
  const double corner = GENERATE(0.3, 1.0, 5.0, 40.0);  // over w_n
  const double zeta = GENERATE(0.02, 0.3);
  CAPTURE(order, corner, zeta);
  const model::Slip slip = model::solve_slip(8.0, zeta);
  const double delay = 1.0 / (corner * std::sin(std::numbers::pi / (2.0 * order)));
  const fit::CoulombCycle cycle(8.0, zeta, {delay, 0.0, static_cast<std::size_t>(order)}, ForceView::Spring);
  const fit::CoulombCycle plain(8.0, zeta, {}, ForceView::Spring);
  // From a stick so long before that the filter has forgotten its start.
  const double begin = -2.0 - 30.0 * delay;
  const double step = std::min(1e-3, 0.02 / corner);
  Cascade filter(order, corner, plain.at(begin).z);
  double tau = begin;
  double worst = 0.0;
  for (std::size_t i = 0; tau < slip.tau_end + 5.0; ++i) {
    const double next = begin + static_cast<double>(i + 1) * step;
    const double shown = filter.step(plain.at(tau).z, plain.at(next).z, next - tau);
    tau = next;
    if (tau > -2.0) worst = std::max(worst, std::abs(shown - cycle.at(tau).z));
  }
  CHECK(worst < 2.0 * step * step + 1e-6);  // straight between samples: h^2 / 8 of a bend of 8, twice
}

TEST_CASE("a slip that hardly ends, or whose end is no number, does not end the program behind a filter") {
  const std::size_t order = GENERATE(as<std::size_t>(), 1, 2, 4);
  const fit::Sensor sensor{0.5, 0.0, order};
  int without_number = 0;
  for (const double zeta : {0.1, 1.0 - 1e-9, 1.0 - 1e-16, -0.5, -0.99997107734733037}) {
    for (const double z0 : {1e-300, 1.0, 2429.1426878275092, 1e100}) {
      if (!(z0 + 2.0 * zeta > 0.0) || !(zeta < 1.0)) continue;
      CAPTURE(order, zeta, z0);
      const fit::CoulombCycle cycle(z0, zeta, sensor, ForceView::Spring);
      const bool is_slip = cycle.tau_end() < fit::CoulombWave::kLongest;
      if (is_slip) CHECK(std::isfinite(cycle.at(1.0).z));
      if (zeta > 0.9) CHECK_FALSE(is_slip);
      if (std::isnan(cycle.tau_end())) ++without_number;
    }
  }
  CHECK(without_number > 0);
}

TEST_CASE("without the stated bandwidth the same slip gives another natural frequency") {
  const Scene s{.jitter = 0.03, .noise = 0.01};
  const Analysis analysis = analyze_and_fit(through_sensor(s, 0.3 / s.omega));
  const Parameter& frequency = parameter(analysis, "natural_frequency_rad_per_s");
  // What docs/accuracy.md says that it costs: 5 % of w_n at w_n T = 0.3.
  CHECK(*frequency.estimate.value == Approx(0.95 * s.omega).epsilon(0.01));
  // Friction that weakens and an average explain such slips, too: the interval holds what they say.
  CHECK(frequency.status == ParameterStatus::Weak);
  CHECK(frequency.estimate.ci95->high > s.omega);
}

TEST_CASE("a sensor that has not forgotten one slip when the next begins is warned of") {
  Scene s{.speed = 0.03, .noise = 0.01};
  const double lag_s = 2.0 / s.omega;
  s.conditions.sensor_bandwidth_Hz = 1.0 / (2.0 * std::numbers::pi * lag_s);
  const Analysis analysis = analyze_and_fit(through_sensor(s, lag_s));
  CHECK(has_warning(analysis, "sensor_too_slow"));
  // Left over from the slip before, its tail would draw k off by 10 of its standard errors.
  if (analysis.motion == MotionClass::StickSlip) check_truth(analysis, "stiffness_N_per_m", s.stiffness);
}

TEST_CASE("a moving average of the limit cycle is that of numerical integration") {
  for (const auto& row : test::reference_rows("sensor_average.csv")) {
    const double lambda = row.at("lambda");
    const double zeta = row.at("zeta");
    const double tau = row.at("tau");
    // The table is of the periodic motion: only windows that reach into no other slip compare.
    if (tau + 0.5 * row.at("window") > row.at("t_slip") + row.at("t_stick")) continue;
    if (tau - 0.5 * row.at("window") < -row.at("t_stick")) continue;
    const model::Slip slip = model::solve_slip(lambda - 2.0 * zeta, zeta);
    CAPTURE(lambda, zeta, row.at("window"), tau);
    // Differences of integrals of size lambda^2, over the window, keep 1e-16 of them.
    const double expected = row.at("average");
    const fit::CoulombMotion motion(fit::CoulombWave(slip.z0, zeta, ForceView::Spring));
    const fit::ShownMotion<fit::CoulombMotion> shown(motion, {0.0, row.at("window")});
    CHECK(shown.at(tau).z == Approx(expected).margin(1e-12 * (1.0 + lambda)));
    const fit::AveragedSlip averaged(slip, model::stick_after(slip), row.at("window"), false);
    CHECK(averaged.at(tau).z == Approx(expected).margin(1e-12 * (1.0 + lambda)));
  }
}

TEST_CASE("a stated averaging gives the parameters back, and unstated it is seen, and nothing of the slip is sure") {
  const Scene s{.jitter = 0.03, .noise = 0.01};
  constexpr double kSamples = 8.0;  // of 30 in a slip: w_n is 4 % too small without it
  const Recording shown = averaged(s, kSamples);
  SECTION("stated") {
    Conditions conditions = shown.conditions();
    conditions.sensor_average_s = kSamples * shown.sample_interval_s();
    const Analysis analysis = analyze_and_fit(test::with_conditions(shown, conditions));
    check_truth(analysis, s);
    CHECK(parameter(analysis, "natural_frequency_rad_per_s").status == ParameterStatus::Conditional);
    CHECK(parameter(analysis, "sensor_average_s").status == ParameterStatus::Fixed);
    CHECK_FALSE(has_warning(analysis, "samples_averaged"));
  }
  SECTION("unstated") {
    const Analysis analysis = analyze_and_fit(shown);
    CHECK(has_warning(analysis, "samples_averaged"));
    const Parameter& omega = parameter(analysis, "natural_frequency_rad_per_s");
    CHECK(omega.status == ParameterStatus::Weak);
    // One recording: one in twenty lies outside the interval, one in four hundred outside three standard errors.
    CHECK(std::abs(*omega.estimate.value - s.omega) < 3.0 * *omega.estimate.standard_error);
    CHECK(parameter(analysis, "mass_kg").status == ParameterStatus::Weak);
  }
}
