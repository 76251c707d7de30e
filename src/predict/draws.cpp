#include "predict/draws.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>

#include "core/student.hpp"
#include "predict/delta.hpp"

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

/// False outside of the ranges, or where a value is larger than a double can be.
bool is_model(const ModelEstimate& model) {
  const auto is_in_range = [&model](ParameterId id) {
    const double* const value = model.find(id);
    if (value == nullptr) return true;
    const bool is_positive = enters_as_logarithm(id) || id == ParameterId::Ageing || id == ParameterId::ReloadForce;
    const Range& range = info(id).range;
    return std::isfinite(*value) && *value >= range.low && *value <= range.high && (!is_positive || *value > 0.0);
  };
  return model.damping_ratio < 1.0 && std::ranges::all_of(kModelParameters, is_in_range);
}

/// Returns the moved model; empty where it is no model.
std::optional<ModelEstimate> moved_model(const ModelEstimate& model, const VectorXd& step) {
  ModelEstimate other = model;
  for (std::size_t i = 0; i < kModelValues; ++i) {
    double* const value = other.find(kModelParameters[i]);
    if (value == nullptr) continue;
    *value = moved(kModelParameters[i], *value, step(static_cast<Index>(i)));
  }
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
    if (const std::optional<ModelEstimate> draw = moved_model(model, steps.col(i))) draws.push_back(*draw);
  }
  return draws;
}

}  // namespace slipfit::predict
