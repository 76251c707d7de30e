#include "fit/problem/bundle.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "fit/cycle/side_by_side.hpp"
#include "fit/problem/lines.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;

/// Parameters of a recording in the order of its Jacobian, as the cycle model reads them.
class Gathered {
 public:
  Gathered(const CycleModel& any, const std::vector<Index>& columns, const Eigen::VectorXd& common) {
    for (const Index column : columns) values_.push_back(common(column));
    const double* next = values_.data();
    const auto take = [&](std::size_t count) { return count > 0 ? std::exchange(next, next + count) : nullptr; };
    shared_.globals = take(any.globals());
    shared_.exponent = take(any.has_exponent() ? 1 : 0);
    shared_.sensor_time = take(any.has_sensor_time() ? 1 : 0);
    shared_.difference = take(any.has_difference() ? 1 : 0);
    shared_.constant = take(any.has_constant() ? 1 : 0);
    shared_.drift = take(any.drift_parameters());
  }
  Gathered(const Gathered&) = delete;
  Gathered(Gathered&&) = delete;
  Gathered& operator=(const Gathered&) = delete;
  Gathered& operator=(Gathered&&) = delete;
  ~Gathered() = default;

  [[nodiscard]] CycleValues with(const Local& local) const {
    CycleValues values = shared_;
    values.local = local.data();
    return values;
  }
  [[nodiscard]] const double* globals() const { return shared_.globals; }

 private:
  std::vector<double> values_;
  CycleValues shared_;
};

}  // namespace

Bundle::Bundle(const Problem& problem, const SolveOptions& options)
    : problem_(problem), options_(options), columns_(problem) {
  const BlockFit& first = problem.recordings.front();
  if (problem.sweep.sharing.level) of_steady_ = columns_.of_steady(first.model(0).globals());
  for (const BlockFit& recording : problem.recordings) residuals_ += recording.residuals();
}

std::optional<Bundle::Point> Bundle::start(double damping) const {
  Values values{Eigen::VectorXd(columns_.size()), {}};
  for (std::size_t r = problem_.recordings.size(); r-- > 0;) {  // what is shared is the first one's
    columns_.visit(r, problem_.recordings[r], problem_.recordings[r].parameters,
                   [&](Index column, double value) { values.common(column) = value; });
    if (problem_.recordings[r].model(0).has_sensor_time())
      values.common(*columns_.sensor_time()) = problem_.recordings[r].sensor_time();
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
    const std::size_t own = recording.model(0).local_parameters();
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
    const CycleModel& any = fit.model(0);
    if (any.is_integrated()) return false;
    const Gathered common(any, columns_.of(r), values.common);
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
    if (recordings[r].model(0).has_sensor_time()) recordings[r].set_sensor_time(values.common(*columns_.sensor_time()));
  }
}

std::optional<Bundle::Point> Bundle::at(Values values, double damping) const {
  Point point{std::move(values), 0.0, Elimination(columns_.size(), damping)};
  std::size_t first = 0;
  for (std::size_t r = 0; r < problem_.recordings.size(); ++r) {
    if (!add(r, first, point)) return std::nullopt;
    first += problem_.recordings[r].size();
  }
  if (!add_steady(point)) return std::nullopt;
  return std::isfinite(point.sum) ? std::optional(std::move(point)) : std::nullopt;
}

bool Bundle::add(std::size_t recording, std::size_t first_cycle, Point& point) const {
  const BlockFit& fit = problem_.recordings[recording];
  const std::vector<Index>& columns = columns_.of(recording);
  const Gathered common(fit.model(0), columns, point.common);
  const Local* const cycles = point.cycles.data() + first_cycle;
  const auto size = static_cast<Index>(fit.model(0).columns() + 1);
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
      ramp = ramp_residual(fit, i, common.globals(), cycles[i].data(), cycles[i + 1].data());
      point.sum += ramp->value * ramp->value;
    }
    point.sum += sums[i];
    point.normal.add_cycle(normals.middleRows(static_cast<Index>(i) * size, size), columns, ramp ? &*ramp : nullptr);
  }
  return true;
}

double Bundle::put_products(const Eigen::MatrixXd& lines, Eigen::Ref<RowMajor> normal) const {
  products_of(lines, normal);
  const auto residuals = lines.rightCols<1>();
  if (!options_.robust) return residuals.squaredNorm();
  const HuberWeight weight = huber_weight(residuals.norm(), static_cast<std::size_t>(lines.rows()));
  normal.triangularView<Eigen::Upper>() = weight.factor * normal;
  return weight.sum;
}

bool Bundle::add_steady(Point& point) const {
  if (!problem_.sweep.sharing.level) return true;
  const FrictionLaw law = problem_.recordings.front().scales().law;
  const std::size_t count = of_steady_.size() - 1;
  Globals globals{};
  std::copy_n(point.common.data(), count, globals.begin());
  for (const SteadyRun& run : problem_.sweep.steady) {
    const SteadyResidual steady =
        steady_residual(run, problem_.sweep.units, law, globals, point.common(of_steady_.back()));
    point.normal.add_cycle(products_of(steady, count), of_steady_);
    point.sum += steady.value * steady.value;
  }
  return true;
}

}  // namespace slipfit::fit
