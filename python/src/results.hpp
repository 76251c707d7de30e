#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "recordings.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit::python {

struct AnalysedRecording {
  SharedRecording recording;
  std::shared_ptr<const Analysis> analysis;
};

struct AnalysedSweep {
  struct Parts {
    std::vector<SweepEntry> entries;
    SweepAnalysis sweep;
  };
  std::shared_ptr<const Parts> parts;
  std::vector<std::pair<std::string, SharedRecording>> recordings;
};

}  // namespace slipfit::python
