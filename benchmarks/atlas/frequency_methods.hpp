#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "study.hpp"

namespace atlas {

/// A way to find the repetition frequency of a recording. Empty: it says that it found none.
struct FrequencyMethod {
  Look look;
  std::function<std::optional<double>(const slipfit::Recording&)> find_Hz;
};

std::vector<FrequencyMethod> frequency_methods();

}  // namespace atlas
