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

/// The parameters of a recording, taken from those that all have in common.
class Gathered {
 public:
  Gathered(const CommonColumns& columns, std::size_t recording, const BlockFit& fit, const Eigen::VectorXd& common)
      : parameters_{fit.parameters.values, fit.parameters.level, {}}, has_constant_(fit.columns().has_constant()) {
    columns.visit(recording, fit, parameters_, [&](Index column, double& value) { value = common(column); });
  }

  [[nodiscard]] CycleValues with(const Local& local) const {
    const double* const level = parameters_.level.data();
    return {&parameters_.values, level, level + (has_constant_ ? 1 : 0), local.data()};
  }
  [[nodiscard]] const Coordinates& values() const { return parameters_.values; }

 private:
  Parameters parameters_;
  bool has_constant_;
};

}  // namespace

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
  if (!add_steady(point)) return std::nullopt;
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
  const BlockFit& first = problem_.recordings.front();
  const Gathered common(columns_, 0, first, point.common);
  for (const SteadyRun& run : problem_.sweep.steady) {
    const SteadyResidual steady = steady_residual(run, problem_.sweep.units, first.scales().law, common.values(),
                                                  point.common(columns_.level(0)));
    point.normal.add_cycle(products_of(steady, first.columns()), columns_.of_steady());
    point.sum += steady.value * steady.value;
  }
  return true;
}

}  // namespace slipfit::fit
