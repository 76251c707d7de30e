#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/problem/steady_run.hpp"
#include "fit/selection/solution.hpp"
#include "fit/selection/stated_mass.hpp"
#include "slipfit/fit/options.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit::fit {

/// A steady recording is cut into so many for the error of its mean force.
inline constexpr std::size_t kSteadyStretches = 10;

/// The recordings of a sweep, fitted one by one: data, levels and starts of the fit of the sweep. Recordings whose
/// cycles cannot be fitted are empty.
struct SweepData {
  std::vector<std::optional<DampedFit>> single;  ///< in the order of the recordings
  std::optional<FittedAverage> average{};        ///< OwnFits; the fit of the sweep begins with it
  std::optional<double> rounding_s2{};           ///< OwnFits
  std::optional<StatedMass> mass{};              ///< OwnFits
  /// Holds the motion of slips and ring-downs together, at which w_n and zeta are held: what follows has its errors.
  std::optional<FreeMotion> motion{};
  std::vector<SteadyRun> steady;
  std::vector<std::optional<std::size_t>> steady_of;  ///< index into `steady` of each recording
  std::vector<double> onset_sd;                       ///< spread of F_s over the cycles of each recording, N
  std::vector<double> loads;                          ///< normal force over their mean; 1 where not known
  std::optional<double> mean_load_N;                  ///< empty where a recording does not state it
  Units units;
  std::vector<std::size_t> fitted;                      ///< recordings with cycles
  std::function<void(const std::string&)> notify_step;  ///< FitOptions
};

/// `known`: fit_each.
SweepData prepare_sweep(std::span<const SweepRecording> recordings, const FitOptions& options,
                        const std::optional<FittedAverage>& known = {});

/// Returns F_s - cV above F_k of a recording on its own, as a mean over its cycles; `level_of` returns that of the
/// force level F_k(0+).
double mean_onset_force(const DampedFit& fit);
double level_of(const DampedFit& fit);

/// Returns the scales with which a recording enters the fit of the sweep.
Scales scales_in_sweep(const SweepData& data, std::size_t recording, FrictionLaw law);

}  // namespace slipfit::fit
