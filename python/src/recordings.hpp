#pragma once

#include <memory>
#include <string>
#include <vector>

#include "convert.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::python {

using SharedRecording = std::shared_ptr<Recording>;

}  // namespace slipfit::python
