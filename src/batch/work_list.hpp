#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch/id_index.hpp"
#include "slipfit/batch/batch.hpp"
#include "slipfit/core/digest.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::batch {

/// A group of the manifest; its result stands behind that of the last of its recordings.
struct Group {
  std::string name;
  std::size_t first_row = 0;
  std::size_t last_row = 0;
};

/// What a batch has to do. The entries are not kept but read again when they are needed. Rows count from 1. A slot is
/// where the result of a row or a group is kept: rows first, then groups in the order of their last rows.
struct WorkList {
  Digest manifest_digest;
  std::size_t rows = 0;
  std::vector<bool> is_mine;  ///< of each slot: it is this shard's
  std::vector<Group> groups;  ///< fitted together; empty where groups are not fitted
  IdIndex slots;              ///< by id

  [[nodiscard]] std::size_t slot_of_group(std::size_t group) const { return rows + group; }
};

/// Reads the whole manifest once and checks every row. Errors: those of ManifestReader, duplicate_id, empty_manifest.
Result<WorkList> list_work(const BatchOptions& options);

/// Calls `use` with every entry of a manifest until it returns an error. Errors: also those of ManifestReader.
std::optional<Error> for_each_entry(const std::filesystem::path& manifest,
                                    const std::function<std::optional<Error>(const ManifestEntry&)>& use);

/// The same in the order of the results: each group behind the last of its recordings, by its place in the work list.
std::optional<Error> for_each_result(const std::filesystem::path& manifest, const WorkList& list,
                                     const std::function<std::optional<Error>(const ManifestEntry&)>& use_entry,
                                     const std::function<std::optional<Error>(std::size_t group)>& use_group);

/// "group:NAME", the id of a group's result.
std::string id_of_group(const std::string& name);

/// Error: not_readable, also of a pipe.
Result<Digest> manifest_digest(const std::filesystem::path& manifest);

}  // namespace slipfit::batch
