#include "fit/problem/elimination.hpp"

#include <cmath>

namespace slipfit::fit {

using Eigen::Index;

void factorise(RowMajor& normal, const Eigen::VectorXd& whole) {
  constexpr double kRounding = 1e-13;  // of sums of products over all cycles
  const Index size = normal.cols();
  for (Index k = 0; k < whole.size(); ++k) {
    auto row = normal.row(k).tail(size - k);
    if (!(normal(k, k) > kRounding * whole(k))) {
      row.setZero();
      continue;
    }
    row /= std::sqrt(normal(k, k));
    for (Index i = k + 1; i < size; ++i) normal.row(i).tail(size - i) -= normal(k, i) * normal.row(k).tail(size - i);
  }
}

Elimination::Elimination(Index common, double damping)
    : damping_(damping),
      common_(RowMajor::Zero(common + 1, common + 1)),
      common_squares_(Eigen::VectorXd::Zero(common)) {}

void Elimination::add_cycle(const RowMajor& normal, const std::vector<Index>& columns, const RampResidual* ramp) {
  const auto common = static_cast<Index>(columns.size());
  const Index own = normal.cols() - common - 1;
  const Index next = ramp != nullptr ? own : 0;
  const Index first = own + next;
  work_.setZero(first + common + 1, first + common + 1);
  work_.topLeftCorner(own, own) = normal.block(common, common, own, own);
  work_.block(0, first, own, common) = normal.block(0, common, common, own).transpose();
  work_.block(0, first + common, own, 1) = normal.block(common, common + own, own, 1);
  work_.block(first, first, common, common) = normal.topLeftCorner(common, common);
  work_.block(first, first + common, common, 1) = normal.block(0, common + own, common, 1);
  work_(first + common, first + common) = normal(common + own, common + own);
  if (pending_.size() > 0) {
    work_.topLeftCorner(own, own) += pending_.leftCols(own);
    work_.block(0, first, own, common + 1) += pending_.rightCols(common + 1);
  }
  if (ramp != nullptr) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(work_.cols());
    for (Index i = 0; i < 2; ++i) {
      row(i) = ramp->d_first[static_cast<std::size_t>(i)];
      row(own + i) = ramp->d_second[static_cast<std::size_t>(i)];
    }
    for (Index i = 0; i < static_cast<Index>(ramp->d_globals.size()); ++i) {
      row(first + i) = ramp->d_globals[static_cast<std::size_t>(i)];
    }
    row(first + common) = ramp->value;
    work_ += row.transpose() * row;
  }
  add_squares(work_, first, columns);
  work_.diagonal().head(own) *= 1.0 + damping_;
  factorise(work_, work_.diagonal().head(own));
  keep(own, next, columns);
  pending_ = work_.block(own, own, next, next + common + 1);
  add_scattered(work_, first, columns);
}

void Elimination::add_common(const RowMajor& normal, const std::vector<Index>& columns) {
  add_squares(normal, 0, columns);
  add_scattered(normal, 0, columns);
}

void Elimination::add_squares(const RowMajor& normal, Index first, const std::vector<Index>& columns) {
  for (const Index column : columns) {
    common_squares_(column) += normal(first, first);
    ++first;
  }
}

void Elimination::keep(Index own, Index next, const std::vector<Index>& columns) {
  cycles_.push_back({rows_.size(), own, next, &columns});
  rows_.insert(rows_.end(), work_.data(), work_.data() + own * work_.cols());
  own_gain_ += work_.col(work_.cols() - 1).head(own).squaredNorm();
}

/// Columns ascend but for the level and the difference: what lands below the diagonal is mirrored.
void Elimination::add_scattered(const RowMajor& normal, Index first, const std::vector<Index>& columns) {
  const auto column_of = [&](Index i) {
    return i < static_cast<Index>(columns.size()) ? columns[static_cast<std::size_t>(i)] : common_.cols() - 1;
  };
  for (Index i = 0; i <= static_cast<Index>(columns.size()); ++i) {
    for (Index j = i; j <= static_cast<Index>(columns.size()); ++j) {
      const Index a = column_of(i);
      const Index b = column_of(j);
      common_(std::min(a, b), std::max(a, b)) += normal(first + i, first + j);
    }
  }
}

std::vector<double> Elimination::own_steps(const Eigen::VectorXd& common_step, double share) const {
  std::size_t size = 0;
  for (const Rows& rows : cycles_) size += static_cast<std::size_t>(rows.own);
  std::vector<double> steps(size);
  double* step = steps.data() + size;
  for (std::size_t cycle = cycles_.size(); cycle-- > 0;) {
    const Rows& rows = cycles_[cycle];
    const auto own = static_cast<std::size_t>(rows.own);
    const std::size_t known = own + static_cast<std::size_t>(rows.next);
    const std::size_t width = known + rows.columns->size() + 1;
    step -= own;  // those of the next cycle follow
    for (std::size_t i = own; i-- > 0;) {
      const double* const row = rows_.data() + rows.begin + i * width;
      double rest = share * row[width - 1];
      for (std::size_t j = 0; j < rows.columns->size(); ++j) rest += row[known + j] * common_step((*rows.columns)[j]);
      for (std::size_t j = i + 1; j < known; ++j) rest += row[j] * step[j];
      step[i] = row[i] > 0.0 ? -rest / row[i] : 0.0;
    }
  }
  return steps;
}

}  // namespace slipfit::fit
