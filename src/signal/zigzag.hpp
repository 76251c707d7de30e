#pragma once

#include <cstddef>
#include <vector>

namespace slipfit::signal {

/// A fall between two turning points.
struct Fall {
  std::size_t peak = 0;
  std::size_t trough = 0;
};

/// Falls of at least `hysteresis`, each bounded by rises of at least as much (or by the ends of the trace). Noise
/// smaller than the hysteresis makes no turning point, however often it crosses a level.
template <class Values>
std::vector<Fall> find_falls(const Values& values, double hysteresis) {
  std::vector<Fall> falls;
  if (values.size() < 2) return falls;
  std::size_t high = 0;
  std::size_t low = 0;
  double highest = values[0];
  double lowest = values[0];
  bool falling = false;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double value = values[i];
    if (falling) {
      if (value < lowest) {
        lowest = value;
        low = i;
      } else if (value > lowest + hysteresis) {
        falls.push_back({high, low});
        falling = false;
        highest = value;
        high = i;
      }
    } else if (value > highest) {
      highest = value;
      high = i;
    } else if (value < highest - hysteresis) {
      falling = true;
      lowest = value;
      low = i;
    }
  }
  return falls;
}

}  // namespace slipfit::signal
