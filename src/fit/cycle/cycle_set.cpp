#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "fit/cycle/cycle_model.hpp"
#include "fit/cycle/side_by_side.hpp"

namespace slipfit::fit {

void legendre(double x, std::size_t terms, double* values, double* derivatives) {
  for (std::size_t n = 0; n < terms; ++n) {
    const auto order = static_cast<double>(n);
    values[n] = n == 0   ? 1.0
                : n == 1 ? x
                         : ((2.0 * order - 1.0) * x * values[n - 1] - (order - 1.0) * values[n - 2]) / order;
    // P'_n = P'_(n-2) + (2n - 1) P_(n-1)
    derivatives[n] = n == 0 ? 0.0 : (2.0 * order - 1.0) * values[n - 1] + (n >= 2 ? derivatives[n - 2] : 0.0);
  }
}

namespace {

constexpr double kLeastTolerance = 1e-9;  // of a step: what is left of binary fractions

/// The step of times that are even to `tolerance_s`, some of which may be left out; 0 of others: an uneven clock.
double even_step_of(const std::vector<double>& time_s, double tolerance_s) {
  if (time_s.size() < 2) return 0.0;
  const double span_s = time_s.back() - time_s.front();
  double smallest_s = span_s;
  for (std::size_t i = 1; i < time_s.size(); ++i) smallest_s = std::min(smallest_s, time_s[i] - time_s[i - 1]);
  if (!(smallest_s > 0.0)) return 0.0;
  // From neighbour to neighbour: over the whole span what times are rounded by may add up to a step.
  std::vector<double> steps{0.0};
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    steps.push_back(steps.back() + std::round((time_s[i] - time_s[i - 1]) / smallest_s));
  }
  const double step_s = span_s / steps.back();
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double off_s = time_s[i] - time_s.front() - step_s * steps[i];
    if (std::abs(off_s) > std::max(kLeastTolerance * step_s, tolerance_s)) return 0.0;
  }
  return step_s;
}

/// Returns the rounding of written times, in s, that changes the force on the steepest part of a slip by kOfNoise of
/// the noise.
double tolerated_rounding_s(const Scales& scales) {
  constexpr double kOfNoise = 0.01;
  return kOfNoise * scales.noise / scales.force * scales.half_period_s / std::numbers::pi;
}

/// The level's functions but for the constant: at a time, or mean and slope over a bin.
class LevelRow {
 public:
  LevelRow(const LevelModel& level, const Scales& scales)
      : level_(level), scales_(scales), values_(level.terms), slopes_(level.terms) {}

  /// `out`: a row of CycleRows::level.
  template <class Row>
  void at(double time_s, Row out) {
    Eigen::Index column = put_polynomial(time_s, out);
    for (const double line_Hz : level_.lines_Hz) {
      const double phase = 2.0 * std::numbers::pi * line_Hz * (time_s - scales_.time_begin_s);
      out(column++) = std::cos(phase);
      out(column++) = std::sin(phase);
    }
  }

  /// `mean`, `slope`: rows.
  template <class Row>
  void over(const StickBin& bin, Row mean, Row slope) {
    Eigen::Index column = put_polynomial(bin.time_s, mean);
    for (std::size_t i = 1; i < level_.terms; ++i)
      slope(static_cast<Eigen::Index>(i) - 1) = 2.0 / span_s() * slopes_[i];
    for (const LineInBin& line : bin.lines) {
      for (std::size_t i = 0; i < 2; ++i, ++column) {
        mean(column) = line.mean[i];
        slope(column) = line.slope[i];
      }
    }
  }

 private:
  [[nodiscard]] double span_s() const { return scales_.time_end_s - scales_.time_begin_s; }

  template <class Row>
  Eigen::Index put_polynomial(double time_s, Row& out) {
    legendre(2.0 * (time_s - scales_.time_begin_s) / span_s() - 1.0, level_.terms, values_.data(), slopes_.data());
    for (std::size_t i = 1; i < level_.terms; ++i) out(static_cast<Eigen::Index>(i) - 1) = values_[i];
    return static_cast<Eigen::Index>(level_.terms > 0 ? level_.terms - 1 : 0);
  }

  const LevelModel& level_;
  const Scales& scales_;
  std::vector<double> values_;
  std::vector<double> slopes_;
};

/// Returns the level's functions but for the constant, at every residual row of a cycle.
Eigen::ArrayXXd level_of(const CycleData& data, const LevelModel& level, const Scales& scales) {
  Eigen::ArrayXXd rows(static_cast<Eigen::Index>(data.residuals()),
                       static_cast<Eigen::Index>(level.columns_behind_constant()));
  if (rows.cols() == 0) return rows;  // an empty array has no rows to point to
  LevelRow functions(level, scales);
  Eigen::Index row = 0;
  for (const double time_s : data.time_s) functions.at(time_s, rows.row(row++));
  for (const auto* bins : {&data.bins_before, &data.bins_after}) {
    for (const StickBin& bin : *bins) {
      functions.over(bin, rows.row(row), rows.row(row + 1));
      row += 2;
    }
  }
  return rows;
}

}  // namespace

CycleRows rows_of(const CycleData& cycle) {
  const auto size = static_cast<Eigen::Index>(cycle.residuals());
  CycleRows rows{Eigen::ArrayXd(size), Eigen::ArrayXd(size), Eigen::ArrayXd(size), {}};
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < cycle.time_s.size(); ++i, ++row) {
    rows.force(row) = cycle.force[i];
    rows.weight(row) = cycle.weight.empty() ? 1.0 : cycle.weight[i];
  }
  rows.level_weight = rows.weight;
  for (const auto* bins : {&cycle.bins_before, &cycle.bins_after}) {
    for (const StickBin& bin : *bins) {
      rows.force.segment<2>(row) << bin.force, bin.slope;
      rows.weight.segment<2>(row) << std::sqrt(bin.count), std::sqrt(bin.time_spread);
      rows.level_weight.segment<2>(row) << std::sqrt(bin.count), 0.0;
      row += 2;
    }
  }
  return rows;
}

std::optional<CycleSet> CycleSet::create(std::vector<CycleData> cycles, std::vector<double> reference_s,
                                         LevelModel level, const Scales& scales) {
  if (cycles.size() < thresholds::kFewestSlips) return std::nullopt;
  return CycleSet(std::move(cycles), std::move(reference_s), std::move(level), scales);
}

CycleSet::CycleSet(std::vector<CycleData> cycles, std::vector<double> reference_s, LevelModel level,
                   const Scales& scales)
    : cycles_(std::move(cycles)),
      reference_s_(std::move(reference_s)),
      level_(std::move(level)),
      rows_(cycles_.size()),
      even_step_s_(cycles_.size()) {
  std::size_t samples = 0;
  for (const CycleData& cycle : cycles_) samples += cycle.time_s.size();
  for_cycles(cycles_.size(), samples, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      rows_[i] = rows_of(cycles_[i]);
      rows_[i].level = level_of(cycles_[i], level_, scales);
      even_step_s_[i] = even_step_of(cycles_[i].time_s, tolerated_rounding_s(scales));
    }
  });
}

CycleSet CycleSet::with_level(LevelModel level, const Scales& scales) const {
  return {cycles_, reference_s_, std::move(level), scales};
}

}  // namespace slipfit::fit
