// One step by the normal equations of all recordings against the fit without one of them that it stands for.

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <vector>

#include "fit/sweep/sweep_outcome.hpp"
#include "fit/sweep/sweep_solution.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"
#include "sweep_recordings.hpp"

using namespace slipfit;

namespace {

/// Recordings with what their fit refers to.
struct Prepared {
  std::vector<SweepEntry> entries;
  std::vector<Quality> qualities;
  std::vector<Segmentation> slips;
  fit::SweepData data;

  explicit Prepared(std::vector<SweepEntry> of_entries) : entries(std::move(of_entries)) {
    for (const SweepEntry& entry : entries) qualities.push_back(assess_quality(entry.recording));
    for (std::size_t i = 0; i < entries.size(); ++i) slips.push_back(find_slips(entries[i].recording, qualities[i]));
    std::vector<SweepRecording> recordings;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      recordings.push_back({entries[i].recording, qualities[i], slips[i], SweepRole::Cycles});
    }
    data = fit::prepare_sweep(recordings, {});
  }
};

}  // namespace

TEST_CASE("one step without a recording of many goes as far as a fit without it") {
  test::SweepScene scene;
  scene.scatter_N = 0.02;
  const Prepared prepared(test::record_sweep(scene, {0.004, 0.005, 0.006, 0.008, 0.01, 0.012, 0.015, 0.02}));
  const std::optional<fit::SweepFits> fits = fit::solve_sweep(prepared.data, {});
  REQUIRE(fits);
  for (const fit::SweepSolution* solution : {&fits->velocity, &*fits->coulomb}) {
    const fit::NormalSolution all{*solution, fit::normals_of(solution->problem())};
    for (const std::size_t recording : {std::size_t{0}, std::size_t{4}, std::size_t{7}}) {
      const std::optional<fit::NormalSolution> step = fit::leave_out(all, recording);
      REQUIRE(step);
      fit::SweepSolution others = *solution;
      others.recordings.erase(others.recordings.begin() + static_cast<std::ptrdiff_t>(recording));
      const double chi2 = fit::solve_together(others.recordings, others.sweep, {others.held, false, 50, 1e-4});
      const fit::StaticFriction kind;  // constant
      const fit::Spread spread = fit::spread_of(prepared.data, step->solution, step->normals, kind);
      const fit::Coordinates off = fit::coordinates_of(step->solution, kind) - fit::coordinates_of(others, kind);
      for (const auto i : {fit::kLogStiffness, fit::kLogFrequency, fit::kDamping, fit::kLevel, fit::kDifference}) {
        INFO("recording " << recording << ", coordinate " << i);
        CHECK(std::abs(off(i)) <
              0.05 * std::sqrt(spread.with_scatter()(i, i)));  // as compare_builds.py asks of two builds
      }
      CHECK(step->solution.chi2 == Approx(chi2).epsilon(1e-3));
    }
  }
}
