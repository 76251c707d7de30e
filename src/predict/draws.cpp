#include "predict/draws.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"

namespace slipfit::predict {

namespace {

constexpr std::array<double, 2> kShare{1.0, 0.5};  // that ln k and ln w_n have in exponent times ln V

constexpr std::size_t kDifferencePlace = place_in_model(ParameterId::FrictionDifference);

/// `half_width`: of the 95 % interval of ln k; w_n is that of the same mass.
void add_stiffness_error(ModelEstimate& model, double half_width) {
  const double variance = std::pow(half_width / t_quantile(model.degrees_of_freedom), 2);
  for (std::size_t i = 0; i < kShare.size(); ++i) {
    for (std::size_t j = 0; j < kShare.size(); ++j) model.covariance[i][j] += kShare[i] * kShare[j] * variance;
  }
}

/// docs/model.md section 13
ModelEstimate beyond_single(const ModelEstimate& model, double speed_m_per_s) {
  const double distance = model.single_speed->distance_to(speed_m_per_s);
  ModelEstimate wider = model;
  // At the speed itself the recording shows the cycle, however the parameters share it out.
  const double share = std::min(1.0, distance / std::log(thresholds::kUntrendedRatio));
  for (std::size_t i = 0; i < model.single_speed->least_errors.size(); ++i) {
    const double least = share * model.single_speed->least_errors[i];
    wider.covariance[i][i] = std::max(wider.covariance[i][i], least * least);
  }
  const double friction_error = thresholds::kFrictionTrend * distance / t_quantile(model.degrees_of_freedom);
  wider.covariance[kDifferencePlace][kDifferencePlace] += friction_error * friction_error;
  add_stiffness_error(wider, thresholds::kStiffnessTrend * distance);
  return wider;
}

}  // namespace

Propagation::Propagation(const ModelEstimate& model)
    : model_(model), quantile_(t_quantile(model_.degrees_of_freedom)) {}

double Propagation::standard_error(const Jet& y) const {
  double variance = 0.0;
  for (std::size_t i = 0; i < kModelValues; ++i) {
    for (std::size_t j = 0; j < kModelValues; ++j) {
      variance += y.v[static_cast<Eigen::Index>(i)] * model_.covariance[i][j] * y.v[static_cast<Eigen::Index>(j)];
    }
  }
  return std::sqrt(std::max(0.0, variance));  // rounding may leave a small negative number
}

Estimate Propagation::positive(const Jet& y) const {
  const double relative = standard_error(y) / y.a;
  const double factor = std::exp(quantile_ * relative);
  return {y.a, relative * y.a, Interval{y.a / factor, y.a * factor}, {}};
}

bool Propagation::law_is_open_at(double speed_m_per_s) const {
  return quantile_ * standard_error(parameter_of<Jet>(model_, ParameterId::Alpha)) * speed_m_per_s >
         thresholds::kStraightLaw;
}

std::optional<ModelEstimate> beyond(const ModelEstimate& model, double speed_m_per_s) {
  if (model.single_speed) return beyond_single(model, speed_m_per_s);
  if (!model.reach) return model;
  const bool is_far = !(model.reach->distance_to(speed_m_per_s) < std::log(thresholds::kUntrendedRatio));
  if (!model.reach->trend && is_far) return std::nullopt;
  ModelEstimate wider = model;
  wider.covariance[kDifferencePlace][kDifferencePlace] +=
      std::pow(model.reach->half_width_at(speed_m_per_s) / t_quantile(model.degrees_of_freedom), 2);
  if (model.stiffness_trend) {
    // It may end there, or double.
    add_stiffness_error(wider, model.stiffness_trend->exponent * model.reach->distance_beyond(speed_m_per_s));
  }
  return wider;
}

Jet micro_vibration_spacing_m(const model::SlidingBody<Jet>& body) {
  const Jet damped_omega = body.omega_rad_per_s * sqrt(1.0 - body.zeta * body.zeta);
  return 2.0 * std::numbers::pi * body.speed_m_per_s / damped_omega;
}

ModelMotion motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp) {
  model::SlidingBody<Jet> body = body_at<Jet>(model, speed_m_per_s);
  // Where each slip is smaller than the one before, nothing sticks in the end: as for F_s = F_k.
  body.difference_N = body.aged_difference_N(sharp).value_or(Jet(0.0));
  ModelMotion motion;
  motion.cycle = body.cycle();
  motion.lambda = motion.cycle ? body.lambda() : body_at<Jet>(model, speed_m_per_s).lambda();
  motion.total_damping_ratio = body.total_damping_ratio();
  motion.regime = body.regime(motion.cycle.has_value());
  // With ageing the margin is needed, not enough: the cycle ends sooner.
  if (motion.cycle || !body.ageing) motion.restick_margin = body.restick_margin();
  return motion;
}

bool sticks_at(const ModelEstimate& model, double speed_m_per_s, double sharp) {
  return body_at<Plain>(model, speed_m_per_s).sticks(sharp);
}

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
    const bool is_positive = enters_as_logarithm(id) || id == ParameterId::ReloadForce;
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
  // The sign of ageing says whether stick-slip ends or begins with speed: one model has one of these.
  const bool ages_alike = !model.ageing || other.ageing->rate_N * model.ageing->rate_N > 0.0;
  return ages_alike && is_model(other) ? std::optional(other) : std::nullopt;
}

/// Normal numbers, a row for each value of a model: every row has the same ones, evenly spread, in another order.
MatrixXd even_normals(Index count) {
  VectorXd sorted(count);
  for (Index i = 0; i < count; ++i) {
    sorted(i) = normal_quantile((static_cast<double>(i) + 0.5) / static_cast<double>(count));
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

CyclesOfDraws::CyclesOfDraws(const ModelEstimate& model, double speed_m_per_s)
    : quantile_(t_quantile(model.degrees_of_freedom)) {
  constexpr double kRough = 1e-4;  // of static friction: its scatter over the models is what counts
  const std::vector<ModelEstimate> draws = draws_of(model);
  for (const ModelEstimate& draw : draws) {
    const ModelMotion motion = motion_at(draw, speed_m_per_s, kRough);
    if (!motion.cycle) continue;
    const double micro_m = micro_vibration_spacing_m(body_at<Jet>(draw, speed_m_per_s)).a;
    cycles_.push_back({motion.cycle->slip_s.a, motion.cycle->stick_s.a, micro_m});
  }
  if (!draws.empty()) share_ = static_cast<double>(cycles_.size()) / static_cast<double>(draws.size());
}

}  // namespace slipfit::predict
