#include "analysis/damped_sine.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace slipfit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kColumns = 6;  // omega, decay, a, b, level, slope
using Normal = Eigen::Matrix<double, kColumns, kColumns>;
using Vector = Eigen::Matrix<double, kColumns, 1>;

class DampedSineFit {
 public:
  DampedSineFit(std::span<const double> time_s, std::span<const double> force) : time_s_(time_s), force_(force) {}

  [[nodiscard]] std::optional<DampedSine> from(double omega, double decay) const {
    constexpr int kMostSteps = 30;
    constexpr double kEnough = 1e-9;
    constexpr double kFar = 0.3;  // of ln omega: another oscillation
    Vector p = Vector::Zero();
    p.head<2>() << omega, decay;
    for (int step = 0; step < kMostSteps; ++step) {
      const MatrixXd shapes = jacobian(p).rightCols<4>();
      p.tail<4>() = shapes.colPivHouseholderQr().solve(values());
      const MatrixXd full = jacobian(p);
      const Vector move = full.colPivHouseholderQr().solve(values() - at(p));
      p.head<2>() += move.head<2>();
      if (!p.allFinite() || std::abs(std::log(p(0) / omega)) > kFar) return std::nullopt;
      if (move.head<2>().norm() < kEnough * omega) return with_errors(p + move);
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Index size() const { return static_cast<Index>(time_s_.size()); }
  [[nodiscard]] double since(Index i) const { return time_s_[static_cast<std::size_t>(i)] - time_s_.front(); }
  [[nodiscard]] Eigen::Map<const VectorXd> values() const { return {force_.data(), size()}; }

  [[nodiscard]] MatrixXd jacobian(const Vector& p) const {
    MatrixXd columns(size(), kColumns);
    for (Index i = 0; i < size(); ++i) {
      const double t = since(i);
      const double c = std::exp(-p(1) * t) * std::cos(p(0) * t);
      const double s = std::exp(-p(1) * t) * std::sin(p(0) * t);
      columns.row(i) << t * (p(3) * c - p(2) * s), -t * (p(2) * c + p(3) * s), c, s, 1.0, t;
    }
    return columns;
  }

  [[nodiscard]] VectorXd at(const Vector& p) const { return jacobian(p).rightCols<4>() * p.tail<4>(); }

  [[nodiscard]] std::optional<DampedSine> with_errors(const Vector& p) const {
    const MatrixXd columns = jacobian(p);
    const VectorXd residuals = values() - at(p);
    const Normal whole = columns.transpose() * columns;
    std::vector<Normal> parts;
    std::vector<Vector> scores;
    for (Index i = 0; i < size(); ++i) {
      const auto part = static_cast<std::size_t>(since(i) * p(0) / std::numbers::pi);
      parts.resize(std::max(parts.size(), part + 1), Normal::Zero());
      scores.resize(parts.size(), Vector::Zero());
      parts[part] += columns.row(i).transpose() * columns.row(i);
      scores[part] += residuals(i) * columns.row(i).transpose();
    }
    const auto count = static_cast<double>(parts.size());
    MatrixXd moves(static_cast<Index>(parts.size()), Index{2});
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const Vector move = (whole - parts[part]).ldlt().solve(-scores[part]);
      moves.row(static_cast<Index>(part)) = move.head<2>();
    }
    const double freedom = std::max(1.0, static_cast<double>(size() - kColumns));
    const Vector white = residuals.squaredNorm() / freedom * whole.inverse().diagonal();
    const Eigen::RowVector2d scatter =
        (count - 1.0) / count * (moves.rowwise() - moves.colwise().mean()).colwise().squaredNorm();
    const auto error = [&](Index i) { return std::sqrt(std::max(white(i), scatter(i))); };
    if (!std::isfinite(error(0)) || !std::isfinite(error(1))) return std::nullopt;
    return DampedSine{p(0), error(0), p(1), error(1), count};
  }

  std::span<const double> time_s_;
  std::span<const double> force_;
};

}  // namespace

std::optional<DampedSine> fit_damped_sine(std::span<const double> time_s, std::span<const double> force,
                                          double omega_rad_per_s, double decay_per_s) {
  if (time_s.size() < static_cast<std::size_t>(kColumns) + 2) return std::nullopt;
  return DampedSineFit(time_s, force).from(omega_rad_per_s, decay_per_s);
}

}  // namespace slipfit
