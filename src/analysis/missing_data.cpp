#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/thresholds.hpp"
#include "slipfit/pipeline.hpp"

namespace slipfit {

std::optional<Error> missing_data(const Recording& recording) {
  const std::span<const double> force = recording.force();
  const std::string& file = recording.provenance().file;
  const std::string place = file.empty() ? "the recording" : file;
  if (force.size() < thresholds::kFewestSamples) {
    return Error{"too_few_samples", fmt::format("{}: {} samples show no motion, at least {} are needed; record longer",
                                                place, force.size(), thresholds::kFewestSamples)};
  }
  if (std::ranges::adjacent_find(force, std::not_equal_to<>()) != force.end()) return std::nullopt;
  return Error{"force_constant",
               fmt::format("{}: the force is {:.6g} in all {} samples: no data; choose another column with "
                           "--force-column, or check the sensor",
                           place, force.front(), force.size())};
}

Result<Recording> with_data(Result<Recording> recording) {
  if (!recording) return recording;
  if (std::optional<Error> error = missing_data(recording.value())) return *std::move(error);
  return recording;
}

}  // namespace slipfit
