#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::fit {

/// Samples [begin, end) of neighbouring cycles.
struct CycleRun {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] double size() const { return static_cast<double>(end - begin); }
};

/// Residuals at equal steps of time; 0 where there is none.
struct EvenRest {
  std::vector<double> own;  ///< of an uneven clock only
  std::span<const double> values;
  std::vector<CycleRun> runs;
  double step_s = 0.0;
};

/// Holds what a fit leaves of the samples of its cycles. Residuals of 0 count as absent samples.
class Rest {
 public:
  /// `residuals`: one a sample of the recording, which must outlive this.
  Rest(const Recording& recording, const BlockFit& fit, std::vector<double> residuals);

  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  [[nodiscard]] const std::vector<CycleRun>& runs() const { return runs_; }
  /// 1 / duration.
  [[nodiscard]] double resolution_Hz() const { return 1.0 / recording_.duration_s(); }

  /// Amplitude^2 of the sine of this frequency that fits best by least squares, at the true times of the samples.
  [[nodiscard]] double power_at(double frequency_Hz) const;
  /// The frequency of the largest power within half a resolution.
  [[nodiscard]] double refined(double frequency_Hz) const;

  /// Returns the residuals for the Fourier transform. On an uneven clock each sample is moved to the nearest step of an
  /// even one, by half a step at most: exact enough to find a line, not to fit it. The values of an even clock are not
  /// copied.
  [[nodiscard]] EvenRest on_even_clock() const;

  /// Adds the fitted interference back.
  void add_interference(const BlockFit& fit);

 private:
  const Recording& recording_;
  std::vector<double> values_;
  std::vector<CycleRun> runs_;
};

}  // namespace slipfit::fit
