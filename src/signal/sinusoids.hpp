#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>

namespace slipfit::signal {

/// The samples to which harmonics are fitted; times relative to the middle decorrelate a line and the frequency.
struct Samples {
  Eigen::VectorXd time_s;
  Eigen::VectorXd force;
  Eigen::VectorXd weight;
};

/// Holds what a fundamental and its harmonics share: each has a multiple of the frequency and exp(-decay t).
struct Oscillation {
  double frequency_Hz = 0.0;
  std::size_t harmonics = 1;
  double decay_per_s = 0.0;
};

/// Columns 1, t, then cosine and sine of each harmonic.
Eigen::MatrixXd line_and_harmonics(const Eigen::VectorXd& time_s, const Oscillation& oscillation);

/// A weighted least-squares fit of a line and harmonics at a given frequency and decay.
class HarmonicFit {
 public:
  /// `samples` outlive the fit.
  HarmonicFit(const Samples& samples, const Oscillation& oscillation);

  [[nodiscard]] const Eigen::MatrixXd& columns() const { return columns_; }
  [[nodiscard]] Eigen::VectorXd residual() const { return samples_.force - columns_ * coefficients_; }
  /// Returns the derivative of the fitted force by the frequency in Hz.
  [[nodiscard]] Eigen::VectorXd by_frequency() const;
  /// Returns the derivative of the fitted force by the decay.
  [[nodiscard]] Eigen::VectorXd by_decay() const;
  /// Returns what the columns cannot explain of values.
  [[nodiscard]] Eigen::VectorXd without_columns(const Eigen::VectorXd& values) const;

 private:
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& values) const;

  const Samples& samples_;
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd weighted_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
  Eigen::VectorXd coefficients_;
};

/// One Gauss-Newton step of a least-squares fit of a line and harmonics, whose frequency is a parameter as well.
struct HarmonicStep {
  double change_Hz = 0.0;
  double information = 0.0;   ///< weighted sum of squares of the derivative by the frequency, without the other columns
  Eigen::VectorXd residual;   ///< at the frequency before the step
  Eigen::VectorXd influence;  ///< change of the frequency for a unit change of each sample
};
HarmonicStep harmonic_step(const Samples& samples, double frequency_Hz, std::size_t harmonics);

}  // namespace slipfit::signal
