#include "fit/inference/uncertainty.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/problem/normals.hpp"

namespace slipfit::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Correlation of neighbouring residuals inside the slips, where samples are fitted one by one.
void measure_lag1(const BlockFit& fit, const std::vector<Normal>& normals, Uncertainty& result) {
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const auto samples = static_cast<Index>(fit.data(i).time_s.size());
    for (Index j = 0; j < samples; ++j) {
      const double r = normals[i].residuals(j);
      square += r * r;
      if (j > 0) {
        product += r * normals[i].residuals(j - 1);
        result.lag1_pairs += 1.0;
      }
    }
  }
  if (square > 0.0) result.lag1_correlation = product / square;
}

struct ChiSquare {
  double chi2 = 0.0;
  double samples = 0.0;
};

/// `sum_of_squares(i)`: of the residuals of cycle i; what scatters within its stick bins is added.
template <class SumOfSquares>
ChiSquare chi_square(const BlockFit& fit, const SumOfSquares& sum_of_squares) {
  const double noise2 = fit.scales().noise * fit.scales().noise;
  ChiSquare result;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    result.chi2 += sum_of_squares(i);
    result.samples += static_cast<double>(fit.data(i).time_s.size());
    for (const auto* bins : {&fit.data(i).bins_before, &fit.data(i).bins_after}) {
      for (const StickBin& bin : *bins) {
        result.chi2 += bin.scatter / noise2;
        result.samples += bin.count;
      }
    }
  }
  return result;
}

/// Noise in slips and sticks differs: white-noise formulas do not hold. Compares the variances of samples around the
/// slips and inside the stick bins; both carry the same noise in the model.
bool noise_differs(const BlockFit& fit, const std::vector<Normal>& normals) {
  double slip = 0.0, slip_freedom = 0.0, stick = 0.0, stick_freedom = 0.0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const auto samples = static_cast<Index>(fit.data(i).time_s.size());
    slip += normals[i].residuals.head(samples).squaredNorm();
    slip_freedom += static_cast<double>(samples - normals[i].own());
    for (const auto* bins : {&fit.data(i).bins_before, &fit.data(i).bins_after}) {
      for (const StickBin& bin : *bins) {
        stick += bin.scatter / (fit.scales().noise * fit.scales().noise);
        stick_freedom += std::max(0.0, bin.count - 2.0);
      }
    }
  }
  if (!(slip_freedom > 0.0) || !(stick_freedom > 0.0) || !(stick > 0.0)) return false;
  const double ratio = std::log(slip / slip_freedom * stick_freedom / stick);
  return std::abs(ratio) > thresholds::kSureSigmas * std::sqrt(2.0 / slip_freedom + 2.0 / stick_freedom);
}

/// Root mean square over the cycles of the error that noise of variance 1 gives to an onset force.
double error_of_onset_force(const std::vector<Normal>& normals) {
  double square = 0.0;
  for (const Normal& n : normals) {
    const MatrixXd own = n.products.block(n.common(), n.common(), n.own(), n.own()).selfadjointView<Eigen::Upper>();
    square += own.inverse()(1, 1) / static_cast<double>(normals.size());
  }
  return std::sqrt(std::max(0.0, square));
}

double spread_of_onset_force(const BlockFit& fit) {
  std::vector<double> forces;
  for (const Local& local : fit.parameters.cycles) forces.push_back(local[1]);
  return describe(forces).sd;
}

/// u = k V / w_n
double force_scale(const BlockFit& fit) {
  const Coordinates& values = fit.parameters.values;
  return std::exp(values(kLogStiffness) - values(kLogFrequency)) * fit.scales().speed_m_per_s;
}

/// Returns the number of parameters of all cycles.
double parameters_of(const BlockFit& fit) {
  const CycleModel& any = fit.model(0);
  return static_cast<double>(any.columns().common() + any.columns().own() * fit.size());
}

}  // namespace

double reduced_chi2(const BlockFit& fit) {
  const std::vector<double> sums = fit.sums_of_squares();
  const auto [chi2, samples] = chi_square(fit, [&](std::size_t i) { return sums[i]; });
  return chi2 / std::max(1.0, samples - parameters_of(fit));
}

Coordinates coordinates_of(const BlockFit& fit) {
  const Parameters& p = fit.parameters;
  const auto cycles = static_cast<double>(fit.size());
  const double force = fit.scales().force;
  Coordinates coordinates = Coordinates::Zero();
  for (const Coordinate coordinate : fit.columns().coordinates()) coordinates(coordinate) = p.values(coordinate);
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const double level = fit.model(i).level_at(fit.reference_s(i), fit.level_data(), p.cycles[i].data());
    coordinates(kLevel) += (level - fit.scales().level) / force / cycles;
    coordinates(kDifference) += p.cycles[i][1] / cycles;
  }
  coordinates(kDifference) += 2.0 * p.values(kDamping) * force_scale(fit) / force;
  if (fit.level().reloading) coordinates(kReloadLength) = p.values(kReloadLength);
  return coordinates;
}

/// F_s - F_k = A + c V: the spring force at onset is F_s - c V, and c V = 2 zeta k V / w_n. docs/model.md section 4
Selection select(const BlockFit& fit) {
  const CommonColumns columns(Problem{{&fit, 1}});
  const auto local = static_cast<Index>(fit.columns().own());
  Selection selection{MatrixXd::Zero(columns.size(), kCoordinates), MatrixXd::Zero(local, kCoordinates)};
  for (const Coordinate coordinate : fit.columns().coordinates()) {
    selection.common(*columns.find(0, coordinate), coordinate) = 1.0;
  }
  const double drag_unit = 2.0 * force_scale(fit) / fit.scales().force;
  const double drag = drag_unit * fit.parameters.values(kDamping);
  selection.common(kLogStiffness, kDifference) = drag;
  selection.common(kLogFrequency, kDifference) = -drag;
  selection.common(kDamping, kDifference) = drag_unit;
  selection.local(1, kDifference) = 1.0;
  if (fit.level().per_cycle) {
    selection.local(2, kLevel) = 1.0;
    return selection;
  }
  const Scales& scales = fit.scales();
  std::vector<double> values(fit.level().terms);
  for (std::size_t cycle = 0; cycle < fit.size(); ++cycle) {
    legendre(scales.place_at(fit.reference_s(cycle)), fit.level().terms, values.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
      selection.common(columns.level(0) + static_cast<Index>(i), kLevel) += values[i] / static_cast<double>(fit.size());
    }
  }
  return selection;
}

Uncertainty estimate_uncertainty(const BlockFit& fit, const Solved& solved) {
  const Problem problem{{&fit, 1}};
  const std::vector<Normal> normals = normals_of(problem);
  Uncertainty result;
  const ChiSquare sum = chi_square(fit, [&](std::size_t i) { return normals[i].residuals.squaredNorm(); });
  result.chi2 = sum.chi2;
  result.samples = sum.samples;
  measure_lag1(fit, normals, result);
  result.onset_force_sd = spread_of_onset_force(fit);
  const auto cycles = static_cast<double>(fit.size());
  double ramps = 0.0;
  for (std::size_t i = 0; solved.continuous && i + 1 < fit.size(); ++i) {
    ramps += fit.data(i).continuous_with_next ? 1.0 : 0.0;
  }
  const double white_freedom = result.samples - parameters_of(fit) + ramps;
  const double variance = result.chi2 / std::max(1.0, white_freedom);
  result.noise = fit.scales().noise * std::sqrt(variance);
  result.onset_force_error = error_of_onset_force(normals) * std::sqrt(variance);

  // White intervals hold where neighbouring residuals are uncorrelated and slips are as noisy as sticks.
  const double white_bound = thresholds::kSureSigmas / std::sqrt(std::max(1.0, result.lag1_pairs));
  const bool white = std::abs(result.lag1_correlation) <= white_bound && !noise_differs(fit, normals);
  result.from_cycles = !white && !solved.continuous;
  const Selection selection = select(fit);
  if (result.from_cycles) {
    result.covariance = jackknife_covariance(problem, normals, selection, solved.held);
    result.degrees_of_freedom = std::max(1.0, cycles - 1.0);
  } else {
    result.covariance = variance * white_covariance(problem, normals, selection, solved);
    result.degrees_of_freedom = std::max(1.0, white_freedom);
  }
  return result;
}

namespace {

constexpr double kMargin = 0.15;  // of the slip, on either side

struct Stack {
  double count = 0.0, mean = 0.0, square = 0.0;

  void add(double value) {
    count += 1.0;
    const double step = value - mean;
    mean += step / count;
    square += step * (value - mean);
  }
  [[nodiscard]] double standard_error() const { return std::sqrt(square / (count - 1.0) / count); }
};

using Means = std::array<std::optional<double>, kSegments>;

/// Mean residual of one cycle in every stretch of a slip, unit of force.
Means means_of(const BlockFit& fit, std::size_t cycle, const CycleState& slip) {
  const CycleModel& model = fit.model(cycle);
  std::vector<double> residuals(model.residuals());
  model.evaluate(fit.values(cycle), residuals.data(), nullptr);
  std::array<Stack, kSegments> stacks;
  const CycleData& data = fit.data(cycle);
  for (std::size_t j = 0; j < data.time_s.size(); ++j) {
    const std::optional<std::size_t> segment = segment_of(slip, data.time_s[j]);
    const double weight = data.weight.empty() ? 1.0 : data.weight[j];
    if (segment && weight > 0.0) stacks[*segment].add(residuals[j] * fit.scales().noise / weight);
  }
  Means means;
  for (std::size_t p = 0; p < kSegments; ++p) {
    if (stacks[p].count > 0.0) means[p] = stacks[p].mean;
  }
  return means;
}

/// The means of all cycles, and the mean onset force of their slips.
struct StackedCycles {
  std::array<Stack, kSegments> stacks;
  double onset_force = 0.0;
};

/// Over the slips of `phases`, a fit of the same recording.
StackedCycles stacked(const BlockFit& fit, const BlockFit& phases) {
  std::vector<std::optional<std::size_t>> same(fit.size());
  for (std::size_t i = 0, next = 0; i < fit.size(); ++i) {
    while (next < phases.size() && phases.data(next).slip < fit.data(i).slip) ++next;
    if (next < phases.size() && phases.data(next).slip == fit.data(i).slip) same[i] = next;
  }
  std::vector<Means> means(fit.size());
  std::vector<double> onset_forces(fit.size());
  for_cycles(fit.size(), fit.residuals(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!same[i]) continue;
      const CycleState slip = phases.state(*same[i]);
      onset_forces[i] = slip.onset_force;
      means[i] = means_of(fit, i, slip);
    }
  });
  StackedCycles result;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    if (same[i]) result.onset_force += onset_forces[i] / static_cast<double>(fit.size());
    for (std::size_t p = 0; p < kSegments; ++p) {
      if (means[i][p]) result.stacks[p].add(*means[i][p]);
    }
  }
  return result;
}

}  // namespace

StackedResidual stacked_residual(const BlockFit& fit, const BlockFit& phases) {
  const auto [stacks, onset_force] = stacked(fit, phases);
  double square = 0.0;
  double variance = 0.0;
  for (const Stack& stack : stacks) {
    square += stack.mean * stack.mean / kSegments;
    if (stack.count > 1.0) variance += std::pow(stack.standard_error(), 2) / kSegments;
  }
  return {std::sqrt(square) / std::abs(onset_force), std::sqrt(variance) / std::abs(onset_force)};
}

std::optional<std::size_t> segment_of(const CycleState& state, double time_s) {
  const double share = (time_s - state.onset_s) / state.slip_s();
  const double place = (share + kMargin) / (1.0 + 2.0 * kMargin) * kSegments;
  return place >= 0.0 && place < kSegments ? std::optional(static_cast<std::size_t>(place)) : std::nullopt;
}

std::optional<SegmentMisfit> find_misfit(const BlockFit& fit, double tolerated) {
  const auto [stacks, onset_force] = stacked(fit, fit);
  std::optional<SegmentMisfit> worst;
  for (std::size_t p = 0; p < kSegments; ++p) {
    const Stack& stack = stacks[p];
    if (stack.count < thresholds::kFewestCycles) continue;
    const double size = std::abs(stack.mean);
    if (size < thresholds::kOfManySigmas * stack.standard_error() ||
        size < thresholds::kNegligible * std::abs(onset_force) + tolerated)
      continue;
    if (worst && size <= std::abs(worst->size * onset_force)) continue;
    const double position = (static_cast<double>(p) + 0.5) / kSegments * (1.0 + 2.0 * kMargin) - kMargin;
    const double chance = kSegments * t_chance(size / stack.standard_error(), stack.count - 1.0);
    worst = SegmentMisfit{position, stack.mean / onset_force, chance};
  }
  return worst;
}

Uncertainty with_misfit(Uncertainty uncertainty, const Moves& moves) {
  const auto count = static_cast<double>(moves.rows());
  if (count < 2.0) return uncertainty;  // nothing can be left out
  uncertainty.from_refits = true;
  uncertainty.covariance += (count - 1.0) / count * moves.transpose() * moves;
  return uncertainty;
}

namespace {

using Eigen::VectorXd;

struct Rows {
  Index begin = 0;
  Index count = 0;
};

/// The samples of a stretch are neighbours.
std::array<Rows, kSegments> stretches_of(const BlockFit& fit, std::size_t cycle) {
  std::array<Rows, kSegments> stretches;
  const CycleState state = fit.state(cycle);
  const std::vector<double>& time_s = fit.data(cycle).time_s;
  for (std::size_t j = 0; j < time_s.size(); ++j) {
    const std::optional<std::size_t> segment = segment_of(state, time_s[j]);
    if (!segment) continue;
    Rows& rows = stretches[*segment];
    if (rows.count++ == 0) rows.begin = static_cast<Index>(j);
  }
  return stretches;
}

/// The normal equations without one stretch of each cycle, for every stretch.
class SegmentInfluence {
 public:
  explicit SegmentInfluence(const BlockFit& fit)
      : fit_(fit), columns_(Problem{{&fit, 1}}), without_(kSegments, Elimination(columns_.size())) {
    for (std::size_t i = 0; i < fit.size(); ++i) add(i);
  }

  [[nodiscard]] Moves moves(const Held& held) const {
    const Selection selection = select(fit_);
    Moves moves(kSegments, kCoordinates);
    Index known = 0;
    for (const Elimination& without : without_) {
      const VectorXd step = common_steps(without.common(), 1, columns_.held(held));
      if (!step.allFinite() || without.is_singular()) continue;
      moves.row(known++) = move_of(selection, without, step).transpose();
    }
    return moves.topRows(known);
  }

 private:
  void add(std::size_t cycle) {
    evaluate_lines(fit_.model(cycle), fit_.values(cycle), lines_);
    const auto residuals = lines_.rightCols<1>();
    const double weight = huber_weight(residuals.norm(), static_cast<std::size_t>(residuals.size())).factor;
    const RowMajor all = products_of(lines_);
    const std::array<Rows, kSegments> stretches = stretches_of(fit_, cycle);
    for (std::size_t p = 0; p < kSegments; ++p) {
      const RowMajor left = products_of(lines_.middleRows(stretches[p].begin, stretches[p].count));
      RowMajor kept = weight * (all - left);
      kept.rightCols<1>() = -weight * left.rightCols<1>();  // with all samples nothing pulls
      without_[p].add_cycle(kept, columns_.of(0));
    }
  }

  const BlockFit& fit_;
  CommonColumns columns_;
  std::vector<Elimination> without_;
  MatrixXd lines_;
};

}  // namespace

Moves influence_of_segments(const BlockFit& fit, const Held& held) {
  return SegmentInfluence(fit).moves(held);
}

}  // namespace slipfit::fit
