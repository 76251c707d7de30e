// Where solves end, and what they say of it.

#include "fit/problem/solve.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "fit/selection/damped_fit.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/signal/quality.hpp"

using namespace slipfit;

namespace {

/// Some 60 cycles whose static friction scatters by 5 %.
Recording scattering() {
  const Slider slider = Slider::create(500.0, 120.0, 0.05).value();
  const Friction friction = Friction::create(2.0, 1.4).value();
  SimulationOptions options{.duration_s = 6.0, .sample_rate_Hz = 2000.0, .static_friction_sd_N = 0.1};
  options.noise_rms_N = 0.01;
  options.seed = 11;
  SimulatedTrace trace = simulate(slider, friction, 0.02, options);
  Conditions conditions;
  conditions.speed_m_per_s = 0.02;
  return Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions).value();
}

fit::BlockFit solver_fit(const Recording& recording) {
  const Quality quality = assess_quality(recording);
  const Segmentation slips = find_slips(recording, quality);
  const HeldParameters held;
  auto draft = fit::draft_damped({recording, quality, slips, held});
  REQUIRE(draft);
  return draft->blocks;
}

/// Away from the minimum, the cycles' own parameters each by another amount.
fit::BlockFit moved(fit::BlockFit fit) {
  fit.parameters.values(fit::kLogStiffness) += 0.01;
  fit.parameters.values(fit::kLogFrequency) -= 0.02;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    fit.parameters.cycles[i][0] += 0.02 * std::sin(1.7 * static_cast<double>(i));
    fit.parameters.cycles[i][1] += 0.02 * std::cos(2.3 * static_cast<double>(i));
  }
  return fit;
}

}  // namespace

TEST_CASE("a rough solve ends where a fine one has hardly anything to gain") {
  const Recording recording = scattering();
  fit::BlockFit fit = moved(solver_fit(recording));
  REQUIRE(fit.size() > 40);
  const double before = fit::sum_of_squares(fit);
  const double rough = fit::solve(fit, {{}, false, 60, 0.1});
  const double end = fit::sum_of_squares(fit);
  CHECK(before > 2.0 * end);
  // It says what the sum is up to the gain that ends it, 0.1 of a mean square.
  const double mean_square = end / static_cast<double>(fit.residuals());
  CHECK(std::abs(rough - end) < 0.1 * mean_square);
  // A gain of x moves a parameter by no more than sqrt(x) of its standard error.
  fit::solve(fit, {{}, false, 60, 1e-9});
  CHECK(end - fit::sum_of_squares(fit) < 1e-3 * mean_square);
}

TEST_CASE("a solve that starts at the minimum stays there") {
  const Recording recording = scattering();
  fit::BlockFit fit = solver_fit(recording);
  fit::solve(fit, {{}, false, 60, 1e-9});
  const fit::Coordinates there = fit.parameters.values;
  const double end = fit::sum_of_squares(fit);
  fit::solve(fit, {{}, false, 60, 0.1});
  CHECK(std::abs(fit::sum_of_squares(fit) - end) < 1e-6 * end);
  for (Eigen::Index i = 0; i < 3; ++i) CHECK(fit.parameters.values(i) == Approx(there(i)).margin(1e-5));
}
