#include "predict/draws.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>

#include "core/student.hpp"
#include "slipfit/model/motion.hpp"

namespace slipfit::predict {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kDraws = 800;

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
  // The symmetric root: it hardly moves with rounding, as single eigenvectors may.
  return errors.asDiagonal() * solver.eigenvectors() * roots.asDiagonal() * solver.eigenvectors().transpose();
}

bool is_model(const ModelEstimate& model) {
  const auto slider = Slider::create(model.stiffness_N_per_m, model.natural_frequency_rad_per_s, model.damping_ratio);
  if (!slider || !Friction::create(model.friction_difference_N, 0.0) || !(model.damping_ratio < 1.0)) return false;
  const std::array<double, kModelValues> values = values_of(model);
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// Returns the moved model; empty where it is no model: outside of the ranges, or larger than a double can be.
std::optional<ModelEstimate> moved(const ModelEstimate& model, const VectorXd& step) {
  const auto move = [&](ParameterId id) { return step(static_cast<Index>(place_in_model(id))); };
  ModelEstimate other = model;
  other.stiffness_N_per_m *= std::exp(move(ParameterId::Stiffness));
  other.natural_frequency_rad_per_s *= std::exp(move(ParameterId::NaturalFrequency));
  other.damping_ratio += move(ParameterId::DampingRatio);
  other.friction_difference_N *= std::exp(move(ParameterId::FrictionDifference));
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
  if (other.relaxing) {
    other.relaxing->share += move(ParameterId::Relaxation);
    other.relaxing->time_s *= std::exp(move(ParameterId::RelaxationTime));
    if (!(other.relaxing->share >= 0.0 && other.relaxing->share < 1.0)) return std::nullopt;
  }
  if (other.stiffness_trend) other.stiffness_trend->exponent += move(ParameterId::StiffnessExponent);
  return is_model(other) ? std::optional(other) : std::nullopt;
}

/// Normal numbers, a row for each value of a model: every row has the same ones, evenly spread, in another order.
MatrixXd even_normals(Index count) {
  const boost::math::normal_distribution<double> normal;
  VectorXd sorted(count);
  for (Index i = 0; i < count; ++i) {
    sorted(i) = boost::math::quantile(normal, (static_cast<double>(i) + 0.5) / static_cast<double>(count));
  }
  std::mt19937_64 generator(1);
  MatrixXd numbers(static_cast<Index>(kModelValues), count);
  for (Index row = 0; row < numbers.rows(); ++row) {
    for (Index i = 0; i < count; ++i) {
      numbers(row, i) = sorted(i);
      const auto other = static_cast<Index>(generator() % static_cast<std::uint64_t>(i + 1));
      std::swap(numbers(row, i), numbers(row, other));
    }
  }
  return numbers;
}

}  // namespace

std::vector<ModelEstimate> draws_of(const ModelEstimate& model) {
  static const MatrixXd normals = even_normals(kDraws);  // a prediction at many speeds asks for them at each
  const MatrixXd steps = root_of(model) * normals;
  std::vector<ModelEstimate> draws;
  for (Index i = 0; i < steps.cols(); ++i) {
    if (const std::optional<ModelEstimate> draw = moved(model, steps.col(i))) draws.push_back(*draw);
  }
  return draws;
}

}  // namespace slipfit::predict
