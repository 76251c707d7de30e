#include <fmt/format.h>

#include "slipfit/io/manifest.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

Result<std::vector<SweepEntry>> read_sweep(std::span<const ManifestEntry> manifest) {
  std::vector<SweepEntry> entries;
  for (const ManifestEntry& entry : manifest) {
    auto recording = read_recording(entry.file, entry.conditions, entry.options);
    if (!recording) return entry.line > 0 ? in_words_of_manifest(recording.error()) : recording.error();
    const Conditions& conditions = recording.value().conditions();
    if (conditions.quantity != ForceQuantity::Force_N) {
      return Error{"not_a_force", fmt::format("{}: holds a friction coefficient, and a joint fit needs forces: give "
                                              "normal_force_N in the manifest",
                                              entry.file.string())};
    }
    if (conditions.force_view != ForceView::Spring) {
      return Error{"view_not_spring",
                   fmt::format("{}: force_view is not spring, and a joint fit knows the spring force only: fit this "
                               "recording on its own",
                               entry.file.string())};
    }
    entries.push_back({entry.id, std::move(recording).value()});
  }
  return entries;
}

}  // namespace slipfit
