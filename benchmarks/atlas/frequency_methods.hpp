#pragma once

#include <functional>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "study.hpp"

namespace atlas {

/// A way to find the repetition frequency of a recording, Hz. No value: it says that it found none. Rivals give no
/// interval.
struct FrequencyMethod {
  std::string name;
  std::function<slipfit::Estimate(const slipfit::Recording&)> find;
};

std::vector<FrequencyMethod> frequency_methods();

}  // namespace atlas
