#pragma once

#include <string>

#include "slipfit/core/recording.hpp"

namespace slipfit {

/// A recording and its name among others: a row of a manifest, a stroke, a segment.
struct NamedRecording {
  std::string id;
  Recording recording;
};

}  // namespace slipfit
