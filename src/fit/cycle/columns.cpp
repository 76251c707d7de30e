#include "fit/cycle/columns.hpp"

namespace slipfit::fit {

Columns::Columns(const Scales& scales, const LevelModel& level)
    : has_constant_(level.terms > 0 || scales.population.has_value()),
      drift_(level.columns_behind_constant()),
      own_(level.per_cycle ? 3 : 2) {
  const auto add = [&](Coordinate coordinate) {
    column_[index(coordinate)] = coordinates_.size();
    coordinates_.push_back(coordinate);
  };
  for (const Coordinate always : {kLogStiffness, kLogFrequency, kDamping}) add(always);
  if (depends_on_speed(scales.law)) {
    add(kFrictionSlope);
    add(kFrictionRate);
  }
  if (scales.law == FrictionLaw::Weakening) add(kSlipDistance);
  if (scales.relaxing) {
    add(kRelaxation);
    add(kRelaxationTime);
  }
  if (level.reloading) add(kReloadForce);
  if (level.reloading && level.reloading->is_free) add(kReloadLength);
  if (scales.population && scales.population->log_speed) add(kStiffnessExponent);
  if (scales.free_time != FreeTime::None) add(kSensorTime);
  if (scales.population) add(kDifference);
}

}  // namespace slipfit::fit
