#include "fit/problem/normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "fit/cycle/cycle_data.hpp"

namespace slipfit::fit {

using Eigen::Index;

namespace {

bool is_shared(Coordinate coordinate, const Sharing& sharing) {
  return !is_of_recording(coordinate) || (coordinate == kDifference && sharing.difference);
}

}  // namespace

CommonColumns::CommonColumns(const Problem& problem)
    : coordinates_(problem.recordings.size()), of_(problem.recordings.size()) {
  const std::size_t count = problem.recordings.size();
  for (Index i = 0; i < kCoordinates; ++i) {
    const auto coordinate = static_cast<Coordinate>(i);
    std::optional<Index> of_all;
    for (std::size_t r = 0; r < count; ++r) {
      if (!problem.recordings[r].solves_for(coordinate)) continue;
      if (!of_all || !is_shared(coordinate, problem.sweep.sharing)) of_all = size_++;
      coordinates_[r][static_cast<std::size_t>(i)] = of_all;
    }
  }
  for (const BlockFit& recording : problem.recordings) {
    const bool is_again = problem.sweep.sharing.level && !levels_.empty();
    levels_.push_back(is_again ? levels_.front() : size_);
    if (!is_again && recording.columns().has_constant()) ++size_;
  }
  for (const BlockFit& recording : problem.recordings) {
    drifts_.push_back(size_);
    size_ += static_cast<Index>(recording.columns().drift());
  }
  for (std::size_t r = 0; r < count; ++r) {
    const Columns& columns = problem.recordings[r].columns();
    for (const Coordinate coordinate : columns.coordinates()) of_[r].push_back(*find(r, coordinate));
    if (r == 0) {
      of_steady_ = of_[0];
      of_steady_.push_back(levels_[0]);
    }
    if (columns.has_constant()) of_[r].push_back(levels_[r]);
    for (Index i = 0; i < static_cast<Index>(columns.drift()); ++i) of_[r].push_back(drifts_[r] + i);
  }
}

std::vector<Index> CommonColumns::held(const Held& held) const {
  std::vector<Index> columns;
  for (const OfCoordinates& of_recording : coordinates_) {
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (held[i] && of_recording[i]) columns.push_back(*of_recording[i]);
    }
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  return columns;
}

RampResidual ramp_residual(const BlockFit& fit, std::size_t first, const Coordinates& values, const double* local_first,
                           const double* local_second) {
  const Scales& scales = fit.scales();
  const std::optional<CycleState> s = fit.model(first).state(values, local_first);
  if (!s) return {std::numeric_limits<double>::quiet_NaN(), {}, {}, {}};
  const model::StickLine& after = std::get<CoulombCycle>(s->motion).wave.after;
  const double weight = 1.0 / (scales.noise * kRampTolerance);
  const double rate = s->stiffness_N_per_m * scales.speed_m_per_s;
  const double second_onset_s = fit.reference_s(first + 1) + scales.half_period_s * local_second[0];
  const double elapsed_s = second_onset_s - s->onset_s;
  const double u = s->force_scale;
  // d(u I) / d ln u at fixed A: I depends on z0 = A / u
  const double scale_part = u * (after.intercept - s->z0() * after.d_z0);
  RampResidual ramp;
  ramp.value = weight * (rate * elapsed_s + u * after.intercept - scales.force * local_second[1]);
  ramp.d_values = {weight * (rate * elapsed_s + scale_part), -weight * scale_part, weight * u * after.d_zeta};
  ramp.d_first = {-weight * rate * scales.half_period_s, weight * scales.force * after.d_z0};
  ramp.d_second = {weight * rate * scales.half_period_s, -weight * scales.force};
  return ramp;
}

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

bool evaluate_lines(const CycleModel& model, const CycleValues& values, Eigen::MatrixXd& lines) {
  const auto columns = static_cast<Index>(model.columns().size());
  lines.resize(static_cast<Index>(model.residuals()), columns + 1);
  return model.evaluate(values, lines.col(columns).data(), lines.data());
}

namespace {

/// Products of A columns, from `a` on, with B columns, from `b` on: as many as the registers hold, so that each value
/// is read once for several products.
template <Index A, Index B>
void put_products_of(const Eigen::Ref<const Eigen::MatrixXd>& lines, Index a, Index b, Eigen::Ref<RowMajor>& products) {
  using Pair = Eigen::Array2d;
  std::array<Pair, static_cast<std::size_t>(A * B)> sums;
  sums.fill(Pair::Zero());
  const Index rows = lines.rows();
  const auto value = [&](Index row, Index column) { return lines.data() + column * lines.outerStride() + row; };
  for (Index row = 0; row + 1 < rows; row += 2) {
    for (Index i = 0; i < A; ++i) {
      const Pair left = Pair::Map(value(row, a + i));
      for (Index j = 0; j < B; ++j) sums[static_cast<std::size_t>(i * B + j)] += left * Pair::Map(value(row, b + j));
    }
  }
  const bool is_odd = rows % 2 != 0;
  for (Index i = 0; i < A; ++i) {
    for (Index j = 0; j < B; ++j) {
      const double last = is_odd ? lines(rows - 1, a + i) * lines(rows - 1, b + j) : 0.0;
      products(a + i, b + j) = sums[static_cast<std::size_t>(i * B + j)].sum() + last;
    }
  }
}

}  // namespace

void products_of(const Eigen::Ref<const Eigen::MatrixXd>& lines, Eigen::Ref<RowMajor> products) {
  const Index columns = lines.cols();
  for (Index a = 0; a < columns; a += 2) {  // quicker than a product of matrices of so few columns
    if (a + 1 == columns) {
      put_products_of<1, 1>(lines, a, a, products);
      return;
    }
    Index b = a;
    for (; b + 4 <= columns; b += 4) put_products_of<2, 4>(lines, a, b, products);
    for (; b + 2 <= columns; b += 2) put_products_of<2, 2>(lines, a, b, products);
    if (b < columns) put_products_of<2, 1>(lines, a, b, products);
  }
}

RowMajor products_of(const Eigen::Ref<const Eigen::MatrixXd>& lines) {
  RowMajor products(lines.cols(), lines.cols());
  products_of(lines, products);
  return products;
}

RowMajor products_of(const SteadyResidual& steady, const Columns& columns) {
  Eigen::RowVectorXd line(static_cast<Index>(columns.coordinates().size()) + 2);
  Index next = 0;
  for (const Coordinate coordinate : columns.coordinates()) line(next++) = steady.by_value(coordinate);
  line.tail<2>() << steady.by_level, steady.value;
  return line.transpose() * line;
}

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<Normal> normals_of(const Problem& problem) {
  const CommonColumns columns(problem);
  std::vector<Normal> normals;
  for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
    const BlockFit& recording = problem.recordings[r];
    const std::size_t first = normals.size();
    normals.resize(first + recording.size());
    for_cycles(recording.size(), recording.residuals(), [&](std::size_t begin, std::size_t end) {
      MatrixXd lines;
      for (std::size_t c = begin; c < end; ++c) {
        evaluate_lines(recording.model(c), recording.values(c), lines);
        normals[first + c] = {columns.of(r), products_of(lines), lines.rightCols<1>()};
      }
    });
  }
  if (!problem.sweep.sharing.level) return normals;
  const BlockFit& any = problem.recordings.front();
  for (const SteadyRun& run : problem.sweep.steady) {
    const SteadyResidual steady = steady_residual(run, problem.sweep.units, any.scales().law, any.parameters.values,
                                                  any.parameters.level.front());
    normals.push_back({columns.of_steady(), products_of(steady, any.columns()), VectorXd()});
  }
  return normals;
}

std::vector<Normal> normals_without(const Problem& all, std::size_t recording, const std::vector<Normal>& normals,
                                    const Problem& others) {
  const CommonColumns columns(others);
  std::vector<Normal> kept;
  auto next = normals.begin();
  for (std::size_t r = 0; r < all.recordings.size(); ++r) {
    for (std::size_t cycle = 0; cycle < all.recordings[r].size(); ++cycle, ++next) {
      if (r == recording) continue;
      kept.push_back(*next);
      kept.back().columns = columns.of(r < recording ? r : r - 1);
    }
  }
  for (; next != normals.end(); ++next) {
    kept.push_back(*next);
    kept.back().columns = columns.of_steady();
  }
  return kept;
}

}  // namespace slipfit::fit
