#include "fit/problem/solve.hpp"

#include <ceres/ceres.h>
#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/problem/normals.hpp"
#include "fit/problem/solver_log.hpp"

namespace slipfit::fit {

namespace {

using Eigen::Index;

/// The sum of squares of a problem as a function of the parameters that its cycles have in common: each cycle's own
/// follow them (variable projection, one Gauss-Newton step at a time).
class Bundle {
 public:
  /// Both must outlive this.
  Bundle(const Problem& problem, const SolveOptions& options);

  struct Values {
    Eigen::VectorXd common;  ///< in the order of CommonColumns
    std::vector<Local> cycles;
  };
  struct Point : Values {
    double sum = 0.0;  ///< of squares; cycles far worse than the others count linearly (huber_weight)
    Elimination normal;
  };
  /// Returns the point at the parameters of the recordings; it is empty outside the model. `damping` applies to the
  /// steps of the cycles' own parameters from there (Elimination).
  [[nodiscard]] std::optional<Point> start(double damping) const;
  /// Does the same as `start` at other values.
  [[nodiscard]] std::optional<Point> at(Values values, double damping) const;
  /// Returns the values after a step of the common parameters. The cycles' own follow, and they take `share` of the
  /// step by which they can still gain where the common ones are fixed.
  [[nodiscard]] Values moved(const Point& from, const Eigen::VectorXd& step, double share) const;
  /// Returns whether the slips of all cycles have solutions there. Where slips are integrated this is not checked, and
  /// so false: it would take as long as the sum of squares.
  [[nodiscard]] bool is_inside(const Values& values) const;
  /// Writes values to the recordings, which have the problem's order.
  void put(const Values& values, std::span<BlockFit> recordings) const;

  [[nodiscard]] Eigen::Index common() const { return columns_.size(); }
  /// Rows of residuals.
  [[nodiscard]] std::size_t residuals() const { return residuals_; }

 private:
  [[nodiscard]] bool add(std::size_t recording, std::size_t first_cycle, Point& point) const;
  /// Writes [J r]' [J r] of a cycle with [J r] = `lines`, as Elimination takes it, and returns the cycle's part of the
  /// sum.
  [[nodiscard]] static double put_products(const Eigen::MatrixXd& lines, Eigen::Ref<RowMajor> normal);
  void add_steady(Point& point) const;

  const Problem& problem_;
  const SolveOptions& options_;
  CommonColumns columns_;
  std::size_t residuals_ = 0;
};

/// The parameters of a recording, taken from those that all have in common.
class Gathered {
 public:
  Gathered(const CommonColumns& columns, std::size_t recording, const BlockFit& fit, const Eigen::VectorXd& common)
      : parameters_{fit.parameters.values, fit.parameters.level, {}}, columns_(fit.columns()) {
    columns.visit(recording, fit, parameters_, [&](Index column, double& value) { value = common(column); });
  }

  [[nodiscard]] CycleValues with(const Local& local) const { return values_of(parameters_, columns_, local); }
  [[nodiscard]] const Coordinates& values() const { return parameters_.values; }

 private:
  Parameters parameters_;
  const Columns& columns_;
};

Bundle::Bundle(const Problem& problem, const SolveOptions& options)
    : problem_(problem), options_(options), columns_(problem) {
  for (const BlockFit& recording : problem.recordings) residuals_ += recording.residuals();
}

std::optional<Bundle::Point> Bundle::start(double damping) const {
  Values values{Eigen::VectorXd(columns_.size()), {}};
  for (std::size_t r = problem_.recordings.size(); r-- > 0;) {  // what is shared is the first one's
    columns_.visit(r, problem_.recordings[r], problem_.recordings[r].parameters,
                   [&](Index column, double value) { values.common(column) = value; });
  }
  for (const BlockFit& recording : problem_.recordings) {
    const std::vector<Local>& cycles = recording.parameters.cycles;
    values.cycles.insert(values.cycles.end(), cycles.begin(), cycles.end());
  }
  return at(std::move(values), damping);
}

Bundle::Values Bundle::moved(const Point& from, const Eigen::VectorXd& step, double share) const {
  Values values{from.common + step, from.cycles};
  const RowMajor steps = from.normal.own_steps(step, share);
  const double* next = steps.data();
  auto cycle = values.cycles.begin();
  for (const BlockFit& recording : problem_.recordings) {
    const std::size_t own = recording.columns().own();
    for (std::size_t i = 0; i < recording.size(); ++i, ++cycle) {
      for (std::size_t j = 0; j < own; ++j) (*cycle)[j] += *next++;
    }
  }
  return values;
}

bool Bundle::is_inside(const Values& values) const {
  const Local* cycle = values.cycles.data();
  for (std::size_t r = 0; r < problem_.recordings.size(); ++r) {
    const BlockFit& fit = problem_.recordings[r];
    if (fit.model(0).is_integrated()) return false;
    const Gathered common(columns_, r, fit, values.common);
    for (std::size_t i = 0; i < fit.size(); ++i, ++cycle) {
      if (!fit.model(i).is_inside(common.with(*cycle))) return false;
    }
  }
  return true;
}

void Bundle::put(const Values& values, std::span<BlockFit> recordings) const {
  auto next = values.cycles.begin();
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    Parameters& parameters = recordings[r].parameters;
    columns_.visit(r, recordings[r], parameters, [&](Index column, double& value) { value = values.common(column); });
    for (Local& cycle : parameters.cycles) cycle = *next++;
  }
}

std::optional<Bundle::Point> Bundle::at(Values values, double damping) const {
  Point point{std::move(values), 0.0, Elimination(columns_.size(), damping)};
  std::size_t first = 0;
  for (std::size_t r = 0; r < problem_.recordings.size(); ++r) {
    if (!add(r, first, point)) return std::nullopt;
    first += problem_.recordings[r].size();
  }
  add_steady(point);
  return std::isfinite(point.sum) ? std::optional(std::move(point)) : std::nullopt;
}

bool Bundle::add(std::size_t recording, std::size_t first_cycle, Point& point) const {
  const BlockFit& fit = problem_.recordings[recording];
  const std::vector<Index>& columns = columns_.of(recording);
  const Gathered common(columns_, recording, fit, point.common);
  const Local* const cycles = point.cycles.data() + first_cycle;
  const auto size = static_cast<Index>(fit.columns().size() + 1);
  RowMajor normals(size * static_cast<Index>(fit.size()), size);  // one below the other
  std::vector<double> sums(fit.size());
  std::atomic<bool> is_outside = false;
  for_cycles(fit.size(), fit.residuals(), [&](std::size_t begin, std::size_t end) {
    Eigen::MatrixXd lines;  // it stays in the cache from one cycle to the next
    for (std::size_t i = begin; i < end && !is_outside; ++i) {
      auto normal = normals.middleRows(static_cast<Index>(i) * size, size);
      if (!evaluate_lines(fit.model(i), common.with(cycles[i]), lines)) {
        is_outside = true;
        return;
      }
      sums[i] = put_products(lines, normal);
    }
  });
  if (is_outside) return false;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    std::optional<RampResidual> ramp;
    if (options_.continuous && i + 1 < fit.size() && fit.data(i).continuous_with_next) {
      ramp = ramp_residual(fit, i, common.values(), cycles[i].data(), cycles[i + 1].data());
      point.sum += ramp->value * ramp->value;
    }
    point.sum += sums[i];
    point.normal.add_cycle(normals.middleRows(static_cast<Index>(i) * size, size), columns, ramp ? &*ramp : nullptr);
  }
  return true;
}

double Bundle::put_products(const Eigen::MatrixXd& lines, Eigen::Ref<RowMajor> normal) {
  products_of(lines, normal);
  const auto residuals = lines.rightCols<1>();
  const HuberWeight weight = huber_weight(residuals.norm(), static_cast<std::size_t>(lines.rows()));
  normal.triangularView<Eigen::Upper>() = weight.factor * normal;
  return weight.sum;
}

void Bundle::add_steady(Point& point) const {
  if (!problem_.sweep.sharing.level) return;
  const BlockFit& first = problem_.recordings.front();
  const Gathered common(columns_, 0, first, point.common);
  for (const SteadyRun& run : problem_.sweep.steady) {
    const SteadyResidual steady = steady_residual(run, problem_.sweep.units, first.scales().law, common.values(),
                                                  point.common(columns_.level(0)));
    point.normal.add_cycle(products_of(steady, first.columns()), columns_.of_steady());
    point.sum += steady.value * steady.value;
  }
}

/// A time of the sensor of a hundredth of the slip leaves no trace, and none is not a value that derivatives lead to.
constexpr double kLeastSensorTime = 1e-4;  // (time / Scales::sensor_time_unit_s)^2

constexpr double kMostRelaxation = 0.95;  // of k: a spring that relaxes by all of it is none
constexpr double kShortestRise = 1e-3;    // of the longest: over before the next sample

/// The range of a common parameter.
struct Bound {
  Index column = 0;
  double least = 0.0;
  double most = std::numeric_limits<double>::infinity();
};

/// In ascending order of the columns, each once.
std::vector<Bound> bounds_of(const Problem& problem, const SolveOptions& options) {
  const CommonColumns columns(problem);
  std::vector<Bound> bounds;
  const auto bound = [&](Coordinate coordinate, double least, double most = std::numeric_limits<double>::infinity()) {
    if (options.held[static_cast<std::size_t>(coordinate)]) return;
    for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
      if (const std::optional<Index> column = columns.find(r, coordinate)) bounds.push_back({*column, least, most});
    }
  };
  bound(kFrictionRate, kLeastRate, kMostRate);
  bound(kSensorTime, kLeastSensorTime);
  if (options.damped) bound(kDamping, 0.0);
  bound(kRelaxation, 0.0, kMostRelaxation);
  double longest_m = 0.0;
  double longest_s = 0.0;
  for (const BlockFit& recording : problem.recordings) {
    if (const auto& rise = recording.level().reloading) longest_m = std::max(longest_m, rise->longest_m);
    if (const auto& relaxing = recording.scales().relaxing) longest_s = std::max(longest_s, relaxing->longest_s);
  }
  if (longest_m > 0.0) bound(kReloadLength, std::log(kShortestRise * longest_m), std::log(longest_m));
  if (longest_s > 0.0) bound(kRelaxationTime, std::log(kShortestRise * longest_s), std::log(longest_s));
  std::ranges::sort(bounds, {}, &Bound::column);
  const auto same = [](const Bound& left, const Bound& right) { return left.column == right.column; };
  bounds.erase(std::unique(bounds.begin(), bounds.end(), same), bounds.end());  // what recordings share
  return bounds;
}

/// Returns the columns, in ascending order, of the parameters that are at an end of their range and would leave it to
/// make the sum smaller.
std::vector<Index> pressing(const std::vector<Bound>& bounds, const Bundle::Point& point) {
  constexpr double kAtEnd = 1e-9;
  std::vector<Index> columns;
  for (const Bound& bound : bounds) {
    const double value = point.common(bound.column);
    const double slope = point.normal.common()(bound.column, point.common.size());
    const double near = kAtEnd * std::max(1.0, std::abs(bound.least));
    const bool leaves = slope > 0.0 ? value <= bound.least + near : value >= bound.most - near;
    if (leaves && slope != 0.0) columns.push_back(bound.column);
  }
  return columns;
}

/// A bundle as Ceres sees it. Its parameters are the common ones, in units of what moves the residuals by 1 at the
/// start while all others are fixed, and one whose steps are the share that the cycles' own take of the steps that
/// they have to gain by, in units of what moves the residuals by 1 from where it is. Its residuals are one a common
/// parameter, one that no parameter changes, and one for what the own parameters have to gain. In these units Ceres
/// damps steps as Levenberg and Marquardt do in the problem of all parameters.
class BundleCost : public ceres::CostFunction, public ceres::IterationCallback {
 public:
  /// `radius`: of the region in which Ceres trusts the derivatives at `start`. `tolerance`: a gain of this share of the
  /// sum of squares ends the solve. So does a parameter that comes to press against its `bounds`: Ceres cuts steps off
  /// there without looking for the step of the others that belongs to it, and hardly moves on.
  BundleCost(const Bundle& bundle, Bundle::Point start, double radius, double tolerance, std::vector<Bound> bounds)
      : bundle_(bundle),
        bounds_(std::move(bounds)),
        tolerance_(tolerance),
        first_radius_(radius),
        radius_(radius),
        units_(start.normal.common_squares().unaryExpr([](double square) { return unit_of(square); })),
        base_{std::make_shared<const Bundle::Point>(std::move(start)), Eigen::VectorXd::Zero(bundle.common() + 1)} {
    base_.at.head(bundle.common()) = base_.point->common.cwiseQuotient(units_);
    latest_ = base_;
    set_num_residuals(static_cast<int>(bundle.common() + 2));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(bundle.common() + 1));
  }

  /// Returns the units of the common parameters.
  [[nodiscard]] const Eigen::VectorXd& units() const { return units_; }
  /// Parameters at `start`.
  [[nodiscard]] const Eigen::VectorXd& first() const { return base_.at; }

  /// Steps count from the last point whose derivatives were asked for, which is where Ceres is. One that is to gain too
  /// little for another to follow is taken as the derivatives foresee it: its end is not worked out.
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Index common = bundle_.common();
    const Eigen::Map<const Eigen::VectorXd> at(parameters[0], common + 1);
    last_.reset();
    if (at != latest_.at) {
      const Eigen::VectorXd step = at - base_.at;
      const double share = step(common) * unit_of(base_.point->normal.own_gain());
      Bundle::Values moved = bundle_.moved(*base_.point, step.head(common).cwiseProduct(units_), share);
      if (jacobians == nullptr && is_last(step) && bundle_.is_inside(moved)) {
        Eigen::Map<Eigen::VectorXd>(residuals, common + 2) = foreseen(step);
        last_ = std::move(moved);
        return true;
      }
      auto point = bundle_.at(std::move(moved), 1.0 / radius_);
      latest_ = {point ? std::make_shared<const Bundle::Point>(*std::move(point)) : nullptr, at};
    }
    if (!latest_.point) return false;
    put(*latest_.point, residuals, jacobians != nullptr ? jacobians[0] : nullptr);
    if (jacobians != nullptr) {
      base_ = latest_;
      residuals_ = Eigen::Map<const Eigen::VectorXd>(residuals, common + 2);
      jacobian_ = Eigen::Map<const RowMajor>(jacobians[0], common + 2, common + 1);
    }
    return true;
  }

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    radius_ = iteration.trust_region_radius;
    return pressing(bounds_, *base_.point).empty() ? ceres::SOLVER_CONTINUE : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

  /// The better one of the point where Ceres is and the last that it tried: a step whose gain was small enough to end
  /// the solve is not taken by Ceres.
  [[nodiscard]] const Bundle::Values& best() const {
    if (last_) return *last_;
    return is_latest_better() ? *latest_.point : *base_.point;
  }
  /// Sum of squares there, or no more than a negligible gain above it.
  [[nodiscard]] double best_sum() const { return is_latest_better() ? latest_.point->sum : base_.point->sum; }

 private:
  struct Visited {
    std::shared_ptr<const Bundle::Point> point;  ///< null: outside the model
    Eigen::VectorXd at;                          ///< in Ceres' units
  };

  /// Returns the unit of a parameter from the square of what a step of 1 moves the residuals by; it is 1 where that
  /// moves none.
  static double unit_of(double square) { return square > 0.0 ? 1.0 / std::sqrt(square) : 1.0; }

  [[nodiscard]] bool is_latest_better() const { return latest_.point && latest_.point->sum < base_.point->sum; }

  /// Residuals after a step from base_ by its derivatives.
  [[nodiscard]] Eigen::VectorXd foreseen(const Eigen::VectorXd& step) const { return residuals_ + jacobian_ * step; }

  /// Returns whether Ceres will end with a step from base_. It will not after steps that were in vain: where
  /// derivatives mislead, small steps only look as if there were nothing to gain.
  [[nodiscard]] bool is_last(const Eigen::VectorXd& step) const {
    constexpr double kSurely = 0.9;
    if (jacobian_.size() == 0 || radius_ < first_radius_) return false;
    const double gain = base_.point->sum - foreseen(step).squaredNorm();
    return gain >= 0.0 && gain < kSurely * tolerance_ * base_.point->sum;
  }

  void put(const Bundle::Point& point, double* residuals, double* jacobian) const {
    const Index common = bundle_.common();
    RowMajor rows = point.normal.common();
    factorise(rows, point.normal.common_squares());
    Eigen::Map<Eigen::VectorXd> r(residuals, common + 2);
    r.head(common) = rows.col(common).head(common);
    r(common + 1) = std::sqrt(point.normal.own_gain());
    r(common) = std::sqrt(std::max(0.0, point.sum - r.head(common).squaredNorm() - point.normal.own_gain()));
    if (jacobian == nullptr) return;
    Eigen::Map<RowMajor> j(jacobian, common + 2, common + 1);
    j.setZero();
    j.topLeftCorner(common, common).triangularView<Eigen::Upper>() =
        rows.topLeftCorner(common, common) * units_.asDiagonal();
    j(common + 1, common) = -r(common + 1) * unit_of(point.normal.own_gain());
  }

  const Bundle& bundle_;
  std::vector<Bound> bounds_;
  double tolerance_;
  double first_radius_;
  double radius_;
  Eigen::VectorXd units_;
  mutable Visited base_;
  mutable Eigen::VectorXd residuals_;  ///< at base_, as Ceres has them
  mutable RowMajor jacobian_;          ///< empty before Ceres asked for any
  mutable Visited latest_;
  mutable std::optional<Bundle::Values> last_;  ///< whose sum was not worked out
};

/// What a fit can explain settles in some five steps from a solution of fewer cycles, however large it is. What it
/// cannot may creep along a valley: not for longer than the rest of the program takes.
int most_iterations(const Problem& problem, const SolveOptions& options, std::size_t residuals) {
  constexpr double kMostEvaluations = 3e5;  // of a sample under Coulomb friction: 10 of 300 cycles of 72 samples
  constexpr double kCycle = 24.0;           // evaluations that a cycle costs besides those of its samples
  constexpr double kTerm = 2.0;             // by which weakening and an average each make an evaluation longer
  constexpr double kFewest = 10.0;
  if (problem.recordings.size() > 1) return options.max_iterations;
  const BlockFit& fit = problem.recordings.front();
  double evaluations = static_cast<double>(residuals) + kCycle * static_cast<double>(fit.size());
  if (fit.scales().law == FrictionLaw::Weakening) evaluations *= kTerm;
  if (fit.sensor().average_s > 0.0) evaluations *= kTerm;
  return static_cast<int>(std::min<double>(options.max_iterations, std::max(kFewest, kMostEvaluations / evaluations)));
}

/// Holds the `fixed` columns, and keeps others within these bounds.
void hold(ceres::Problem& ceres, double* parameters, const std::vector<Index>& fixed, const std::vector<Bound>& bounds,
          const Eigen::VectorXd& units) {
  if (!fixed.empty()) {
    const std::vector<int> constant(fixed.begin(), fixed.end());
    ceres.SetManifold(parameters, new ceres::SubsetManifold(ceres.ParameterBlockSize(parameters), constant));
  }
  for (const Bound& bound : bounds) {
    const auto column = static_cast<int>(bound.column);
    ceres.SetParameterLowerBound(parameters, column, bound.least / units(bound.column));
    if (std::isfinite(bound.most)) ceres.SetParameterUpperBound(parameters, column, bound.most / units(bound.column));
  }
}

/// Joined ramps start at the solution for the cycles by themselves: nearly whole steps. Damped ones move a long chain
/// of cycles, or a level against the damping, only a part of the way.
double first_radius(const SolveOptions& options) {
  return options.continuous ? 1e10 : 1e4;
}

/// Share of the sum of squares.
double tolerance_of(const SolveOptions& options, std::size_t residuals) {
  return options.tolerance / static_cast<double>(residuals);
}

ceres::Solver::Options solver_options(const Problem& problem, const SolveOptions& options, std::size_t residuals) {
  ceres::Solver::Options solver;
  solver.max_num_iterations = most_iterations(problem, options, residuals);
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.function_tolerance = tolerance_of(options, residuals);
  solver.gradient_tolerance = 1e-14;
  solver.initial_trust_region_radius = first_radius(options);
  solver.jacobi_scaling = false;  // BundleCost::units
  solver.min_lm_diagonal = solver.max_lm_diagonal = 1.0;
  solver.parameter_tolerance = 1e-11;
  // Steps that bounds cut short are tried as they are: every point whose derivatives are asked for is taken.
  solver.max_num_line_search_step_size_iterations = 0;
  // A step into friction that runs away: shorten it.
  if (problem.recordings.front().scales().law != FrictionLaw::Coulomb) solver.max_num_consecutive_invalid_steps = 20;
  solver.logging_type = ceres::SILENT;
  solver.num_threads = 1;
  return solver;
}

}  // namespace

double solve_together(std::span<BlockFit> recordings, const SweepTerms& sweep, const SolveOptions& options) {
  constexpr int kMostRuns = 4;
  silence_solver_log();
  const Problem problem{recordings, sweep};
  const Bundle bundle(problem, options);
  const std::vector<Bound> bounds = bounds_of(problem, options);
  const std::vector<Index> held = CommonColumns(problem).held(options.held);
  ceres::Solver::Options solver = solver_options(problem, options, bundle.residuals());
  double sum = std::numeric_limits<double>::infinity();
  std::vector<Index> at_ends;
  bool is_settled = false;
  for (int run = 0; run < kMostRuns && solver.max_num_iterations > 0; ++run) {
    std::optional<Bundle::Point> start = bundle.start(1.0 / first_radius(options));
    if (!start) break;
    std::vector<Index> pressed = pressing(bounds, *start);
    if (is_settled && pressed == at_ends) break;
    at_ends = std::move(pressed);
    std::vector<Index> fixed;
    std::merge(held.begin(), held.end(), at_ends.begin(), at_ends.end(), std::back_inserter(fixed));
    std::vector<Bound> free = bounds;
    std::erase_if(free,
                  [&](const Bound& bound) { return std::binary_search(at_ends.begin(), at_ends.end(), bound.column); });
    ceres::Problem ceres;
    auto* cost = new BundleCost(bundle, *std::move(start), first_radius(options),
                                tolerance_of(options, bundle.residuals()), free);
    Eigen::VectorXd parameters = cost->first();
    ceres.AddResidualBlock(cost, nullptr, parameters.data());
    hold(ceres, parameters.data(), fixed, free, cost->units());
    solver.callbacks = {cost};
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &ceres, &summary);
    bundle.put(cost->best(), recordings);
    if (!summary.IsSolutionUsable()) break;
    sum = cost->best_sum();
    is_settled = summary.termination_type != ceres::USER_SUCCESS;
    if (is_settled && at_ends.empty()) break;
    solver.max_num_iterations -= static_cast<int>(summary.iterations.size());
  }
  return sum;
}

double solve(BlockFit& fit, const SolveOptions& options) {
  return solve_together({&fit, 1}, {}, options);
}

}  // namespace slipfit::fit
