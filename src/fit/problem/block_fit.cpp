#include "fit/problem/block_fit.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/law/speed_dependent.hpp"

namespace slipfit::fit {

/// F_k(V) = F_k(0+) + G g(V) / g(v_c), G = 2 v_c sqrt(k m) times kFrictionSlope. docs/model.md section 5
SteadyResidual steady_residual(const SteadyRun& run, const Units& units, FrictionLaw law, const Coordinates& values,
                               double level) {
  const double a = values(kFrictionRate);
  const double speed = run.speed_m_per_s / units.slip_speed_m_per_s;
  const SlopeRatio whole = slope_ratio(law, a);
  const SlopeRatio part = slope_ratio(law, a * speed);
  const double growth = speed * whole.value / part.value;  // g(V) / g(v_c)
  const double d_growth =
      speed * (whole.derivative / part.value - whole.value * part.derivative * speed / (part.value * part.value));
  const double weight = 1.0 / run.standard_error;
  const double impedance = std::exp(values(kLogStiffness) - values(kLogFrequency));  // sqrt(k m)
  const double unit = 2.0 * run.load * units.slip_speed_m_per_s * impedance;
  const double excess = unit * values(kFrictionSlope) * growth;
  SteadyResidual result;
  result.value = weight * (run.mean_force - run.load * units.force * level - excess);
  result.by_level = -weight * run.load * units.force;
  result.by_value(kLogStiffness) = -weight * excess;
  result.by_value(kLogFrequency) = weight * excess;
  result.by_value(kFrictionSlope) = -weight * unit * growth;
  result.by_value(kFrictionRate) = -weight * unit * values(kFrictionSlope) * d_growth;
  return result;
}

namespace {

std::vector<CycleModel> models_of(const CycleSet& set, const Scales& scales, const Columns& columns) {
  std::vector<CycleModel> models;
  models.reserve(set.cycles().size());
  for (std::size_t i = 0; i < set.cycles().size(); ++i) models.emplace_back(set, i, scales, columns);
  return models;
}

double first_sensor_time(const Scales& scales) {
  const double time_s = scales.free_time == FreeTime::Lag ? scales.sensor_lag_s : scales.sensor_average_s;
  return std::pow(time_s / scales.sensor_time_unit_s, 2);
}

}  // namespace

BlockFit::BlockFit(std::shared_ptr<const CycleSet> set, const Scales& scales)
    : set_(std::move(set)),
      scales_(scales),
      columns_(std::make_shared<const Columns>(scales_, set_->level())),
      models_(models_of(*set_, scales_, *columns_)) {
  parameters.values(kSensorTime) = first_sensor_time(scales_);
  if (const auto& reloading = set_->level().reloading) parameters.values(kReloadLength) = std::log(reloading->length_m);
  parameters.level.assign((columns_->has_constant() ? 1 : 0) + columns_->drift(), 0.0);
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
  const double anew = other.parameters.values(kSensorTime);
  other.parameters = parameters;
  const bool is_same = scales.free_time == scales_.free_time && anew == first_sensor_time(scales_);
  if (!is_same) other.parameters.values(kSensorTime) = anew;
  return other;
}

BlockFit BlockFit::with_fewer_cycles(std::size_t most) const {
  if (size() <= most) return *this;
  std::vector<CycleData> cycles;
  std::vector<double> references_s;
  std::vector<Local> locals;
  for (const std::size_t i : spread_indices(size(), most)) {
    cycles.push_back(data(i));
    references_s.push_back(reference_s(i));
    locals.push_back(parameters.cycles[i]);
  }
  BlockFit fewer = create(std::move(cycles), std::move(references_s), scales_, level()).value();
  fewer.parameters = {parameters.values, parameters.level, std::move(locals)};
  return fewer;
}

void BlockFit::start_at(const Coordinates& start) {
  parameters.values.head<kOfSlip>() = start.head<kOfSlip>();
  parameters.values.segment<2>(kRelaxation) = start.segment<2>(kRelaxation);
  parameters.values(kStiffnessDrift) = start(kStiffnessDrift);
  if (start(kReloadForce) != 0.0) parameters.values.segment<2>(kReloadForce) = start.segment<2>(kReloadForce);
}

CycleState BlockFit::state(std::size_t cycle) const {
  return models_[cycle].state(parameters.values, parameters.cycles[cycle].data()).value();
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

double sum_of_squares(const BlockFit& fit) {
  double sum = 0.0;
  for (const double of_cycle : fit.sums_of_squares()) sum += of_cycle;
  return sum;
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
