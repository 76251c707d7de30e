#include "fit/problem/block_fit.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/quantile.hpp"
#include "fit/cycle/side_by_side.hpp"

namespace slipfit::fit {

namespace {

std::vector<CycleModel> models_of(const CycleSet& set, const Scales& scales) {
  std::vector<CycleModel> models;
  models.reserve(set.cycles().size());
  for (std::size_t i = 0; i < set.cycles().size(); ++i) models.emplace_back(set, i, scales);
  return models;
}

double& free_time_s(Scales& scales) {
  return scales.free_time == FreeTime::Lag ? scales.sensor_lag_s : scales.sensor_average_s;
}

}  // namespace

BlockFit::BlockFit(std::shared_ptr<const CycleSet> set, const Scales& scales)
    : set_(std::move(set)),
      scales_(scales),
      sensor_time_(std::pow(free_time_s(scales_) / scales.sensor_time_unit_s, 2)),
      models_(models_of(*set_, scales_)) {
  parameters.level.assign((models_[0].has_constant() ? 1 : 0) + models_[0].drift_parameters(), 0.0);
  parameters.cycles.assign(models_.size(), Local{});
}

std::optional<BlockFit> BlockFit::create(std::vector<CycleData> cycles, std::vector<double> reference_s,
                                         const Scales& scales, LevelModel level) {
  std::optional<CycleSet> set = CycleSet::create(std::move(cycles), std::move(reference_s), std::move(level), scales);
  if (!set) return std::nullopt;
  return BlockFit(std::make_shared<const CycleSet>(*std::move(set)), scales);
}

BlockFit BlockFit::with_level(LevelModel level, const Scales& scales) const {
  return {std::make_shared<const CycleSet>(set_->with_level(std::move(level), scales)), scales};
}

BlockFit BlockFit::with_scales(const Scales& scales) const {
  BlockFit other(set_, scales);
  other.parameters = parameters;
  return other;
}

CycleValues BlockFit::values(std::size_t cycle) const {
  CycleValues values;
  values.globals = parameters.globals.data();
  values.exponent = &parameters.exponent;
  values.sensor_time = &sensor_time_;
  values.difference = &parameters.difference;
  values.constant = parameters.level.data();
  values.drift = parameters.level.data() + (models_[cycle].has_constant() ? 1 : 0);
  values.local = parameters.cycles[cycle].data();
  return values;
}

void BlockFit::set_sensor_time(double value) {
  sensor_time_ = value;
  free_time_s(scales_) = scales_.sensor_time_unit_s * std::sqrt(value);
  models_ = models_of(*set_, scales_);
}

CycleState BlockFit::state(std::size_t cycle) const {
  const CycleModel& model = models_[cycle];
  const Globals globals = model.globals_at_speed(parameters.globals.data(), parameters.exponent);
  return model.state(globals.data(), parameters.cycles[cycle].data()).value();
}

double BlockFit::cycle_sum_of_squares(std::size_t cycle) const {
  std::vector<double> residuals(models_[cycle].residuals());
  if (!models_[cycle].evaluate(values(cycle), residuals.data(), nullptr)) {
    return std::numeric_limits<double>::infinity();
  }
  double sum = 0.0;
  for (const double r : residuals) sum += r * r;
  return sum;
}

std::vector<double> BlockFit::sums_of_squares() const {
  std::vector<double> sums(size());
  for_cycles(size(), residuals(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sums[i] = cycle_sum_of_squares(i);
  });
  return sums;
}

std::size_t BlockFit::residuals() const {
  std::size_t rows = 0;
  for (const CycleModel& model : models_) rows += model.residuals();
  return rows;
}

double resting_share(const BlockFit& fit) {
  double resting = 0.0;
  for (std::size_t i = 0; i < fit.size(); ++i) resting += fit.state(i).resticks() ? 1.0 : 0.0;
  return resting / static_cast<double>(fit.size());
}

double median_slip_s(const BlockFit& fit) {
  std::vector<double> slips_s;
  slips_s.reserve(fit.size());
  for (std::size_t i = 0; i < fit.size(); ++i) slips_s.push_back(fit.state(i).slip_s());
  return median(std::move(slips_s));
}

double median_stick_s(const BlockFit& fit) {
  std::vector<double> sticks_s;
  for (std::size_t i = 0; i + 1 < fit.size(); ++i) {
    if (!fit.data(i).continuous_with_next) continue;
    const CycleState state = fit.state(i);
    sticks_s.push_back(fit.state(i + 1).onset_s - state.onset_s - state.slip_s());
  }
  return median(std::move(sticks_s));
}

double median_period_s(const BlockFit& fit) {
  std::vector<double> intervals_s;
  for (std::size_t c = 1; c < fit.size(); ++c) {
    intervals_s.push_back(fit.reference_s(c) - fit.reference_s(c - 1));
  }
  return median(std::move(intervals_s));
}

}  // namespace slipfit::fit
