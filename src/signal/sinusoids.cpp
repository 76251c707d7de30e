#include "signal/sinusoids.hpp"

#include <Eigen/Dense>
#include <numbers>

namespace slipfit::signal {

/// The higher harmonics by multiplication: a cosine costs more than all else that a sample takes here.
Eigen::MatrixXd line_and_harmonics(const Eigen::VectorXd& time_s, const Oscillation& oscillation) {
  const auto waves = static_cast<Eigen::Index>(oscillation.harmonics);
  Eigen::MatrixXd columns(time_s.size(), 2 + 2 * waves);
  columns.col(0).setOnes();
  columns.col(1) = time_s;
  const Eigen::ArrayXd angle = 2.0 * std::numbers::pi * oscillation.frequency_Hz * time_s.array();
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
  if (oscillation.decay_per_s != 0.0) {
    columns.rightCols(2 * waves).array().colwise() *= (-oscillation.decay_per_s * time_s.array()).exp();
  }
  return columns;
}

HarmonicFit::HarmonicFit(const Samples& samples, const Oscillation& oscillation)
    : samples_(samples),
      columns_(line_and_harmonics(samples.time_s, oscillation)),
      weighted_(samples.weight.asDiagonal() * columns_),
      normal_(weighted_.transpose() * columns_),
      coefficients_(solve(samples.force)) {}

Eigen::VectorXd HarmonicFit::solve(const Eigen::VectorXd& values) const {
  return normal_.solve(weighted_.transpose() * values);
}

Eigen::VectorXd HarmonicFit::by_frequency() const {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(samples_.time_s.size());
  for (Eigen::Index c = 2; c + 1 < columns_.cols(); c += 2) {
    const double turn = std::numbers::pi * static_cast<double>(c);
    slope.array() += turn * samples_.time_s.array() *
                     (coefficients_[c + 1] * columns_.col(c) - coefficients_[c] * columns_.col(c + 1)).array();
  }
  return slope;
}

Eigen::VectorXd HarmonicFit::by_decay() const {
  const Eigen::Index waves = columns_.cols() - 2;
  return -samples_.time_s.cwiseProduct(columns_.rightCols(waves) * coefficients_.tail(waves));
}

Eigen::VectorXd HarmonicFit::without_columns(const Eigen::VectorXd& values) const {
  return values - columns_ * solve(values);
}

HarmonicStep harmonic_step(const Samples& samples, double frequency_Hz, std::size_t harmonics) {
  const HarmonicFit fit(samples, {frequency_Hz, harmonics});
  // What the linear columns can explain holds no information about the frequency.
  const Eigen::VectorXd slope = fit.without_columns(fit.by_frequency());
  const Eigen::VectorXd pull = samples.weight.cwiseProduct(slope);
  HarmonicStep step;
  step.residual = fit.residual();
  step.information = pull.dot(slope);
  step.influence =
      step.information > 0.0 ? Eigen::VectorXd(pull / step.information) : Eigen::VectorXd::Zero(slope.size());
  step.change_Hz = step.influence.dot(step.residual);
  return step;
}

}  // namespace slipfit::signal
