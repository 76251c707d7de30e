#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace slipfit::signal {

/// The samples to which harmonics are fitted; times relative to the middle decorrelate a line and the frequency.
struct Samples {
  Eigen::VectorXd time_s;
  Eigen::VectorXd force;
  Eigen::VectorXd weight;
};

/// Columns 1, t, then cosine and sine of each harmonic.
Eigen::MatrixXd line_and_harmonics(const Eigen::VectorXd& time_s, double frequency_Hz, std::size_t harmonics);

/// One Gauss-Newton step of a least-squares fit of a line and harmonics, whose frequency is a parameter as well.
struct HarmonicStep {
  double change_Hz = 0.0;
  double information = 0.0;   ///< weighted sum of squares of the derivative by the frequency, without the other columns
  Eigen::VectorXd residual;   ///< at the frequency before the step
  Eigen::VectorXd influence;  ///< change of the frequency for a unit change of each sample
};
HarmonicStep harmonic_step(const Samples& samples, double frequency_Hz, std::size_t harmonics);

}  // namespace slipfit::signal
