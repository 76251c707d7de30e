#include "signal/sinusoids.hpp"

#include <Eigen/Dense>
#include <numbers>

namespace slipfit::signal {

/// The higher harmonics by multiplication: a cosine costs more than all else that a sample takes here.
Eigen::MatrixXd line_and_harmonics(const Eigen::VectorXd& time_s, double frequency_Hz, std::size_t harmonics) {
  const auto waves = static_cast<Eigen::Index>(harmonics);
  Eigen::MatrixXd columns(time_s.size(), 2 + 2 * waves);
  columns.col(0).setOnes();
  columns.col(1) = time_s;
  const Eigen::ArrayXd angle = 2.0 * std::numbers::pi * frequency_Hz * time_s.array();
  columns.col(2) = angle.cos();
  columns.col(3) = angle.sin();
  const auto turn_c = columns.col(2).array();
  const auto turn_s = columns.col(3).array();
  for (Eigen::Index h = 1; h < waves; ++h) {
    const auto c = columns.col(2 * h).array();
    const auto s = columns.col(2 * h + 1).array();
    columns.col(2 * h + 2) = c * turn_c - s * turn_s;
    columns.col(2 * h + 3) = c * turn_s + s * turn_c;
  }
  return columns;
}

HarmonicStep harmonic_step(const Samples& samples, double frequency_Hz, std::size_t harmonics) {
  const auto waves = static_cast<Eigen::Index>(harmonics);
  const Eigen::MatrixXd columns = line_and_harmonics(samples.time_s, frequency_Hz, harmonics);
  const Eigen::MatrixXd weighted = samples.weight.asDiagonal() * columns;
  const Eigen::LDLT<Eigen::MatrixXd> solver(weighted.transpose() * columns);
  const Eigen::VectorXd fitted = solver.solve(weighted.transpose() * samples.force);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(samples.time_s.size());
  for (Eigen::Index h = 0; h < waves; ++h) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(h + 1);
    slope.array() += turn * samples.time_s.array() *
                     (fitted[3 + 2 * h] * columns.col(2 + 2 * h) - fitted[2 + 2 * h] * columns.col(3 + 2 * h)).array();
  }
  // What the linear columns can explain holds no information about the frequency.
  slope -= columns * solver.solve(weighted.transpose() * slope);
  const Eigen::VectorXd pull = samples.weight.cwiseProduct(slope);
  HarmonicStep step;
  step.residual = samples.force - columns * fitted;
  step.information = pull.dot(slope);
  step.influence =
      step.information > 0.0 ? Eigen::VectorXd(pull / step.information) : Eigen::VectorXd::Zero(slope.size());
  step.change_Hz = step.influence.dot(step.residual);
  return step;
}

}  // namespace slipfit::signal
