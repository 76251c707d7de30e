#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "fit/selection/solution.hpp"
#include "fit/sweep/own_fits.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/options.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit::fit {

/// A steady recording is cut into so many for the error of its mean force.
inline constexpr std::size_t kSteadyStretches = 10;

/// The recordings of a sweep, fitted one by one: data, levels and starts of the fit of the sweep. Recordings whose
/// cycles cannot be fitted are empty.
struct SweepData : OwnFits {
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

/// Returns whether the springs of the recordings relax.
bool relaxes(const SweepData& data);

/// Returns F_s - cV above F_k of a recording on its own, as a mean over its cycles; `level_of` returns that of the
/// force level F_k(0+).
double mean_onset_force(const DampedFit& fit);
/// Returns the standard deviation of the onset force over the cycles, over the size of its mean.
double spread_of_onsets(const DampedFit& fit);
double level_of(const DampedFit& fit);

/// Returns the scales with which a recording enters the fit of the sweep.
Scales scales_in_sweep(const SweepData& data, std::size_t recording, FrictionLaw law);

/// Variance of a sample of `count` values, above 0.
struct SampleVariance {
  double variance = 0.0;
  std::size_t count = 0;
};

/// Returns each variance drawn towards the one that the samples have in common. It is drawn the more the smaller its
/// sample is and the less the samples differ by more than chance explains: the empirical Bayes estimate of Smyth
/// (2004), Stat. Appl. Genet. Mol. Biol. 3(1), 3, section 6.2. As a weight the variance of three values misleads: where
/// these are alike by chance they outweigh all others.
std::vector<double> moderated_variances(const std::vector<SampleVariance>& samples);

/// A normal force that follows the tangential force, as that of a holder which bends at fixed depth does.
/// docs/model.md (31)
struct LoadResponse {
  double share = 0.0;           ///< mu dF_n/dF: by this share of its change the force is less apart from friction
  double standard_error = 0.0;  ///< above 0
  double slope = 0.0;           ///< dF_n/dF
};

/// Returns the response of the measured normal force over the recording. `kinetic_force`: about which the slips swing,
/// in N. The result is empty where it was not measured, or where it does not follow the force by more than its error
/// and 1 %.
std::optional<LoadResponse> load_response(const Recording& recording, double kinetic_force, std::size_t cycles);

/// Returns the mean of at least one response, weighted by their errors.
LoadResponse mean_response(const std::vector<LoadResponse>& responses);

}  // namespace slipfit::fit
