#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fit/coordinates.hpp"
#include "fit/inference/free_motion.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/level/hum.hpp"
#include "fit/problem/block_fit.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// A recording as its fits see it. What it refers to outlives them.
struct FitInput {
  const Recording& recording;
  const Quality& quality;
  const Segmentation& segmentation;
  const HeldParameters& held;  ///< by the user, or by what is known besides the slips
};

/// The recording, as if it stated that its samples are averaged over this time.
Recording with_average(const Recording& recording, double average_s);

/// Time over which the instrument averages its samples, as a fit found it.
struct FittedAverage {
  double seconds = 0.0;
  double standard_error_s = 0.0;
};

/// The block fit of a recording and what it was reached with.
struct DampedFit {
  BlockFit blocks;
  bool continuous = false;  ///< ramps shared by neighbouring cycles: the data agree with it
  Held held;
  /// Free damping ratio where it came out clearly negative: the slip is not shaped like the model's, zeta is held at 0.
  std::optional<double> refused_damping{};
  double half_width_s = 0.0;            ///< around the middle of a slip, as the cycles were cut with
  std::vector<std::size_t> excluded{};  ///< samples in ascending order: impulses, clipped, outliers
  Uncertainty uncertainty{};
  std::optional<SegmentMisfit> misfit{};   ///< slips are not shaped like the model's; the covariances allow for it
  std::optional<Smoothing> rounding{};     ///< of the slips, more than the sensor's stated one; empty: not determined
  std::optional<FittedAverage> average{};  ///< in the model and its covariance; empty: stated, or none
  /// Holds the values of fits with more terms that the data do not rule out. Intervals include them, too.
  std::vector<Coordinates> rivals{};
  std::string average_caveat{};       ///< why it is unknown whether there is one; empty: it is known, or there is none
  std::string fall_caveat{};          ///< why w_n and zeta cannot be read from the slips; empty: they can
  bool mass_gives_frequency = false;  ///< w_n is held at sqrt(k / m) of a stated m; the covariance holds its error
  /// Holds the motion of slips and ring-down together, at which w_n and zeta are held; the covariance includes its
  /// errors.
  std::optional<FreeMotion> motion{};
  std::string law_caveat{};  ///< why the friction law was not the data's choice; empty: it was
};

/// Returns the move of the coordinates per unit of one that is held; empty where the fit has no solution there.
std::optional<Coordinates> moves_by(const DampedFit& fit, Coordinate coordinate);

/// The covariance with an error for the unknown shape of the instrument's impulse response: it moves the fitted time of
/// the sensor, and every coordinate that correlates with it.
CoordinateMatrix with_unknown_shape(const CoordinateMatrix& covariance, const BlockFit& fit);

/// The average that is a parameter of the fit; empty where it is none.
std::optional<FittedAverage> average_of(const BlockFit& fit, const CoordinateMatrix& covariance);

/// Returns the fit with the average that is a parameter of it, if it is one, and with what its unknown shape adds to
/// the covariance.
DampedFit with_average_error(DampedFit fit);

}  // namespace slipfit::fit
