#include "io/kept_recordings.hpp"
#include "slipfit/io/manifest.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/surface/comparison.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

std::optional<Error> check_joint(const Recording& recording) {
  const std::string& file = recording.provenance().file;
  const Conditions& conditions = recording.conditions();
  if (std::optional<Error> error = missing_data(recording)) return error;
  if (conditions.quantity != ForceQuantity::Force_N) {
    return Error{"not_a_force", file +
                                    ": contains a friction coefficient, but a joint fit needs forces: give the normal "
                                    "force (normal_force_N in a manifest)"};
  }
  if (conditions.force_view == ForceView::Spring) return std::nullopt;
  return Error{
      "view_not_spring",
      file +
          ": force_view is not spring, and a joint fit supports only the spring force: fit this recording separately"};
}

Result<std::vector<SweepEntry>> read_sweep(std::span<const ManifestEntry> manifest) {
  std::vector<SweepEntry> entries;
  reading::KeptFile kept;
  for (const ManifestEntry& entry : manifest) {
    const auto worded = [&entry](const Error& error) { return entry.line > 0 ? in_words_of_manifest(error) : error; };
    const auto stated = with_worn_track(entry.conditions, entry.surface);
    if (!stated) return worded(stated.error());
    auto pieces = reading::read_pieces(kept, entry.file, stated.value(), entry.options);
    if (!pieces) return worded(pieces.error());
    for (NamedRecording& piece : std::move(pieces).value()) {
      if (auto error = check_joint(piece.recording)) return *std::move(error);
      piece.id = piece.id.empty() ? entry.id : entry.id + " " + piece.id;
      entries.push_back(std::move(piece));
    }
  }
  return entries;
}

}  // namespace slipfit
