#include "fit/problem/elimination.hpp"

#include <cmath>

namespace slipfit::fit {

using Eigen::Index;

bool factorise(RowMajor& normal, const Eigen::VectorXd& whole) {
  constexpr double kRounding = 1e-13;  // of sums of products over all cycles
  const Index size = normal.cols();
  bool is_definite = true;
  for (Index k = 0; k < whole.size(); ++k) {
    auto row = normal.row(k).tail(size - k);
    if (!(normal(k, k) > kRounding * whole(k))) {
      row.setZero();
      is_definite = false;
      continue;
    }
    row /= std::sqrt(normal(k, k));
    for (Index i = k + 1; i < size; ++i) normal.row(i).tail(size - i) -= normal(k, i) * normal.row(k).tail(size - i);
  }
  return is_definite;
}

/// Columns ascend but for the level and the difference: what lands below the diagonal is mirrored.
void add_scattered(const Eigen::Ref<const RowMajor>& part, const std::vector<Index>& columns, RowMajor& sum) {
  const auto common = static_cast<Index>(columns.size());
  const Index before_sides = sum.cols() - part.cols();
  const auto column_of = [&](Index i) { return i < common ? columns[static_cast<std::size_t>(i)] : before_sides + i; };
  for (Index i = 0; i < part.cols(); ++i) {
    for (Index j = i; j < part.cols(); ++j) {
      const Index a = column_of(i);
      const Index b = column_of(j);
      sum(std::min(a, b), std::max(a, b)) += part(i, j);
    }
  }
}

Elimination::Elimination(Index common, double damping, Index sides)
    : damping_(damping),
      sides_(sides),
      common_(RowMajor::Zero(common + sides, common + sides)),
      common_squares_(Eigen::VectorXd::Zero(common)) {}

void Elimination::add_cycle(const Eigen::Ref<const RowMajor>& normal, const std::vector<Index>& columns,
                            const RampResidual* ramp) {
  const auto common = static_cast<Index>(columns.size());
  const Index own = normal.cols() - common - sides_;
  const Index next = ramp != nullptr ? own : 0;
  const Index first = own + next;
  const Index side = first + common;
  work_.setZero(side + sides_, side + sides_);
  work_.topLeftCorner(own, own) = normal.block(common, common, own, own);
  work_.block(0, first, own, common) = normal.block(0, common, common, own).transpose();
  work_.block(0, side, own, sides_) = normal.block(common, common + own, own, sides_);
  work_.block(first, first, common, common) = normal.topLeftCorner(common, common);
  work_.block(first, side, common, sides_) = normal.block(0, common + own, common, sides_);
  work_.bottomRightCorner(sides_, sides_) = normal.bottomRightCorner(sides_, sides_);
  if (pending_.size() > 0) {
    work_.topLeftCorner(own, own) += pending_.leftCols(own);
    work_.block(0, first, own, common + sides_) += pending_.rightCols(common + sides_);
  }
  if (ramp != nullptr) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(work_.cols());
    for (Index i = 0; i < 2; ++i) {
      row(i) = ramp->d_first[static_cast<std::size_t>(i)];
      row(own + i) = ramp->d_second[static_cast<std::size_t>(i)];
    }
    for (Index i = 0; i < static_cast<Index>(ramp->d_values.size()); ++i) {
      row(first + i) = ramp->d_values[static_cast<std::size_t>(i)];
    }
    row(side) = ramp->value;
    work_ += row.transpose() * row;
  }
  add_squares(first, columns);
  work_.diagonal().head(own) *= 1.0 + damping_;
  is_singular_ |= !factorise(work_, work_.diagonal().head(own));
  keep(own, next, columns);
  pending_ = work_.block(own, own, next, next + common + sides_);
  add_scattered(latest_part(), columns, common_);
}

void Elimination::add_squares(Index first, const std::vector<Index>& columns) {
  for (const Index column : columns) {
    common_squares_(column) += work_(first, first);
    ++first;
  }
}

void Elimination::keep(Index own, Index next, const std::vector<Index>& columns) {
  cycles_.push_back({rows_.size(), own, next, &columns});
  rows_.insert(rows_.end(), work_.data(), work_.data() + own * work_.cols());
  own_gain_ += work_.col(work_.cols() - sides_).head(own).squaredNorm();
}

RowMajor Elimination::own_steps(const Eigen::MatrixXd& common_steps, double share) const {
  Index size = 0;
  for (const Rows& rows : cycles_) size += rows.own;
  RowMajor steps(size, sides_);
  Index first = size;
  for (std::size_t cycle = cycles_.size(); cycle-- > 0;) {
    const Rows& rows = cycles_[cycle];
    const Index known = rows.own + rows.next;
    const auto common = static_cast<Index>(rows.columns->size());
    const Index width = known + common + sides_;
    first -= rows.own;  // those of the next cycle follow
    for (Index i = rows.own; i-- > 0;) {
      const double* const row = rows_.data() + rows.begin + static_cast<std::size_t>(i * width);
      for (Index side = 0; side < sides_; ++side) {
        double rest = share * row[known + common + side];
        for (Index j = 0; j < common; ++j)
          rest += row[known + j] * common_steps((*rows.columns)[static_cast<std::size_t>(j)], side);
        for (Index j = i + 1; j < known; ++j) rest += row[j] * steps(first + j, side);
        steps(first + i, side) = row[i] > 0.0 ? -rest / row[i] : 0.0;
      }
    }
  }
  return steps;
}

}  // namespace slipfit::fit
