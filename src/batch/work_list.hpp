#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/thrown_error.hpp"
#include "slipfit/batch/options.hpp"
#include "slipfit/core/digest.hpp"
#include "slipfit/io/manifest.hpp"

namespace slipfit::batch {

/// A group of the manifest; its result follows that of the last of its recordings.
struct Group {
  std::string name;
  std::size_t first_row = 0;
  std::size_t last_row = 0;
};

/// The work of a batch. The entries are not kept but read again when they are needed. Rows count from 1. A slot holds
/// the result of a row or a group: rows first, then groups in the order of their last rows.
struct WorkList {
  Digest manifest_digest;
  std::size_t rows = 0;
  std::vector<bool> is_mine;            ///< of each slot: it is this shard's
  std::vector<Group> groups;            ///< fitted together; empty where groups are not fitted
  std::map<Digest, std::size_t> slots;  ///< by the digests of ids, which take less memory than the ids
  std::vector<std::string> ignored_columns;

  [[nodiscard]] std::size_t slot_of_group(std::size_t group) const { return rows + group; }
};

/// A slot and the id of its recording or group.
struct SlotKey {
  std::size_t slot = 0;
  std::string id;
};

/// Reads the whole manifest once and checks every row. Errors: those of ManifestReader, duplicate_id, empty_manifest,
/// output_is_input.
WorkList list_work(const BatchOptions& options);

/// The entries of a manifest, one after the other. Errors: those of ManifestReader.
class Entries {
 public:
  explicit Entries(const std::filesystem::path& manifest) : reader_(value_or_throw(ManifestReader::open(manifest))) {}
  /// Returns the next entry, or nothing after the last one.
  std::optional<ManifestEntry> next() { return value_or_throw(reader_.next()); }
  [[nodiscard]] const std::vector<std::string>& ignored_columns() const { return reader_.ignored_columns(); }

 private:
  ManifestReader reader_;
};

/// "group:NAME", the id of a group's result.
std::string id_of_group(const std::string& name);

/// Returns the digest of the manifest. The error is not_readable, also for a pipe.
Result<Digest> manifest_digest(const std::filesystem::path& manifest);

}  // namespace slipfit::batch
