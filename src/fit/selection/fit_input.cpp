#include "fit/selection/fit_input.hpp"

namespace slipfit::fit {

Recording with_average(const Recording& recording, double average_s) {
  Conditions conditions = recording.conditions();
  conditions.sensor_average_s = average_s;
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  return Recording::create({time_s.begin(), time_s.end()}, {force.begin(), force.end()}, conditions,
                           recording.provenance())
      .value();
}

}  // namespace slipfit::fit
