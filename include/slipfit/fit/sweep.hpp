#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/options.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit {

/// Results of the fit of a sweep for one of its recordings; forces are those that the sensor measures.
struct SweepPoint {
  std::size_t cycles_used = 0;
  std::optional<double> rms;     ///< residual, N
  Estimate kinetic_friction_N;   ///< F_k at the driving speed by the friction law
  Estimate mean_steady_force_N;  ///< steady sliding: as measured
  Estimate spacing_m;            ///< periodic displacement by the model at this speed
  Estimate spacing_left_out_m;   ///< the same from a fit without this recording: what proves the model
  /// The stiffness by a fit without this recording; empty if there is no such fit.
  std::optional<double> stiffness_left_out_N_per_m;
  std::optional<double> friction_difference_left_out_N;
};

/// The parameters shared by a sweep. `result` contains tier (Damped or Velocity), candidates, parameters and
/// correlation; it has no cycles and no curve.
struct SweepFit {
  FitResult result;
  std::vector<SweepPoint> points;  ///< in the order of the recordings
  bool level_shared = false;       ///< one F_k(0+) for all recordings: the data agree with it
  bool difference_shared = false;  ///< one F_s for all speeds: the data agree with it
  bool ring_down_used = false;     ///< as data of w_n and zeta: it is the motion of the slips
};

/// Fits k, w_n, zeta, F_s, f0, f1 and alpha to all recordings together; each cycle has its own onset and static
/// friction. The result is empty if fewer than two recordings have cycles that can be fitted.
std::optional<SweepFit> fit_sweep(std::span<const SweepRecording> recordings, const FitOptions& options = {});

}  // namespace slipfit
