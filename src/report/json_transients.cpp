#include "report/json_sections.hpp"

namespace slipfit {

Json transients_json(const Transients& transients, ForceQuantity quantity) {
  const bool newtons = quantity == ForceQuantity::Force_N;
  Json json{{"loading_stiffness_N_per_m", newtons ? estimate(transients.loading_stiffness_N_per_m) : Json()},
            {"breakaway_force_N", newtons ? estimate(transients.breakaway_force) : Json()},
            {"ringdown_frequency_Hz", estimate(transients.ring_down_frequency_Hz)},
            {"ringdown_damping_ratio", estimate(transients.ring_down_damping_ratio)}};
  if (!newtons) json["breakaway_coefficient"] = estimate(transients.breakaway_force);
  return json;
}

}  // namespace slipfit
