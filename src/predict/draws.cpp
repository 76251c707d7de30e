#include "predict/draws.hpp"

#include <Eigen/Dense>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <optional>
#include <random>

#include "core/student.hpp"

namespace slipfit::predict {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kDraws = 400;

/// S with S S' = the covariance, as wide as the intervals are.
MatrixXd root_of(const ModelEstimate& model) {
  constexpr auto kSize = static_cast<Index>(kModelValues);
  MatrixXd covariance(kSize, kSize);
  for (Index i = 0; i < kSize; ++i) {
    for (Index j = 0; j < kSize; ++j) {
      covariance(i, j) = model.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  // In units of the standard errors, so that rounding spares the small ones.
  const VectorXd errors = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const VectorXd scale = errors.unaryExpr([](double error) { return error > 0.0 ? 1.0 / error : 0.0; });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scale.asDiagonal() * covariance * scale.asDiagonal());
  const double width = t_quantile(model.degrees_of_freedom) / kNormalQuantile;
  const VectorXd roots = width * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return errors.asDiagonal() * solver.eigenvectors() * roots.asDiagonal();
}

/// Empty where it is none that could be.
std::optional<ModelEstimate> moved(const ModelEstimate& model, const VectorXd& step) {
  const auto move = [&](ParameterId id) { return step(static_cast<Index>(place_in_model(id))); };
  ModelEstimate other = model;
  other.stiffness_N_per_m *= std::exp(move(ParameterId::Stiffness));
  other.natural_frequency_rad_per_s *= std::exp(move(ParameterId::NaturalFrequency));
  other.damping_ratio += move(ParameterId::DampingRatio);
  other.friction_difference_N *= std::exp(move(ParameterId::FrictionDifference));
  if (!(other.damping_ratio >= 0.0 && other.damping_ratio < 1.0)) return std::nullopt;
  if (other.speed_dependence) {
    other.speed_dependence->slope_N_s_per_m += move(ParameterId::FrictionSlope);
    other.speed_dependence->alpha_s_per_m += move(ParameterId::Alpha);
  }
  if (other.ageing) {
    other.ageing->rate_N += move(ParameterId::Ageing);
    other.ageing->cutoff_s += move(ParameterId::AgeingTime);
    if (!(other.ageing->rate_N > 0.0 && other.ageing->cutoff_s >= 0.0)) return std::nullopt;
  }
  if (other.reloading) {
    other.reloading->force_N += move(ParameterId::ReloadForce);
    other.reloading->length_m *= std::exp(move(ParameterId::ReloadLength));
    if (!(other.reloading->force_N > 0.0)) return std::nullopt;
  }
  if (other.stiffness_trend) other.stiffness_trend->exponent += move(ParameterId::StiffnessExponent);
  return other;
}

}  // namespace

std::vector<ModelEstimate> draws_of(const ModelEstimate& model) {
  const MatrixXd root = root_of(model);
  std::mt19937_64 generator(1);
  boost::random::normal_distribution<double> normal;
  std::vector<ModelEstimate> draws;
  VectorXd numbers(root.cols());
  for (int i = 0; i < kDraws; ++i) {
    // Each number once with either sign: their mean is the estimate.
    if (i % 2 == 0) {
      for (double& number : numbers) number = normal(generator);
    } else {
      numbers = -numbers;
    }
    if (std::optional<ModelEstimate> draw = moved(model, root * numbers)) draws.push_back(*std::move(draw));
  }
  return draws;
}

}  // namespace slipfit::predict
