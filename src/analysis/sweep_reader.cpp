#include <fmt/format.h>

#include "slipfit/io/manifest.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/surface/comparison.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

Result<std::vector<SweepEntry>> read_sweep(std::span<const ManifestEntry> manifest) {
  std::vector<SweepEntry> entries;
  for (const ManifestEntry& entry : manifest) {
    const auto stated = with_worn_track(entry.conditions, entry.surface);
    if (!stated) return in_words_of_manifest(stated.error());
    auto recording = read_recording(entry.file, stated.value(), entry.options);
    if (!recording) return in_words_of_manifest(recording.error());
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
