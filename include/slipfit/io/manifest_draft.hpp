#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit {

/// One recording of a drafted manifest; what was not found is empty.
struct DraftEntry {
  std::string id;
  std::filesystem::path file;
  std::optional<double> speed_m_per_s;
  std::optional<double> normal_force_N;
  std::string group;
  std::optional<std::size_t> step;                 ///< where a file holds several
  std::optional<std::string> sheet{}, variable{};  ///< the same
};

struct ManifestDraft {
  std::vector<DraftEntry> entries;
  std::vector<Error> skipped;  ///< files that hold no recording, and why
};

/// Drafts a manifest of the recordings in files and folders (with subfolders, by the usual file endings), every sheet
/// of a workbook and every group of an HDF5 file, except files that slipfit wrote (tables of a batch, curves,
/// manifests). Speed and load come from columns, otherwise from the file name ("fdm_232g_50mm_min", "V-100mmps"); the
/// rest of the name without a final number is the group. `options` apply to each file.
ManifestDraft draft_manifest(const std::vector<std::filesystem::path>& paths, const ReadOptions& options = {});

/// Returns the draft without recordings whose names a line of a manifest cannot contain; `skipped` lists them. Error:
/// bad_id.
ManifestDraft writable(ManifestDraft draft);

/// A column of a manifest with the same cell in every row.
struct DraftColumn {
  std::string name, cell;
};

/// Writes a writable draft so that `ManifestReader` reads it from a file in `folder`. Ids and groups that a spreadsheet
/// would run as formulas get a leading '.
std::string to_csv(const ManifestDraft& draft, const std::filesystem::path& folder,
                   const std::vector<DraftColumn>& columns = {});

}  // namespace slipfit
