#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/recording.hpp"

namespace slipfit::reading {

/// A column by its 0-based index, and what turns its numbers into SI.
struct Channel {
  std::size_t column = 0;
  double scale = 1.0;
  ForceQuantity quantity = ForceQuantity::Force_N;  ///< of the force channel
  std::string sentence;                             ///< for Provenance::assumed
  bool is_clock = false;                            ///< of the time: counted from midnight of its first day
};

/// Only rows whose cell says this are read.
struct WhereFilter {
  std::size_t column = 0;
  std::string text;
  std::optional<double> number;  ///< where the text is one: 4 is 4.0
};

/// Which columns are read, and how.
struct Choice {
  std::optional<Channel> time;  ///< empty: the sample rate is the clock
  Channel force;
  std::optional<Channel> displacement;
  std::optional<Channel> normal_force;
  std::optional<Channel> speed;
  std::optional<std::size_t> step;  ///< column of numbers of steps
  std::optional<WhereFilter> where;
  std::vector<std::string> assumed;
};

}  // namespace slipfit::reading
