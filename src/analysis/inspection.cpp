#include "slipfit/inspection.hpp"

#include <utility>

#include "slipfit/pipeline.hpp"

namespace slipfit {

/// The places of slips do not depend on the speed: where the file has none, any value gives the same.
Result<Inspection> inspect(const std::filesystem::path& file, const ReadOptions& options) {
  auto info = inspect_recording(file, options);
  if (!info) return info.error();
  Inspection inspection{std::move(info).value(), std::nullopt};
  if (const auto& recording = inspection.info.recording) inspection.sliding = analyze(*recording).sliding;
  return inspection;
}

}  // namespace slipfit
