#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/thrown_error.hpp"
#include "slipfit/batch/options.hpp"
#include "slipfit/core/digest.hpp"
#include "slipfit/io/manifest.hpp"

namespace slipfit::batch {

/// Finds the slot that belongs to an id, in 24 bytes an id: digests in place of the ids.
class IdIndex {
 public:
  void add(std::string_view id, std::size_t slot) { entries_.emplace_back(digest_of(id), slot); }
  /// Sorts the list; to be called after the last `add` and before any query.
  void sort();
  [[nodiscard]] std::optional<std::size_t> find(std::string_view id) const;
  /// Digests of the ids that were added more than once.
  [[nodiscard]] std::vector<Digest> repeated() const;

 private:
  std::vector<std::pair<Digest, std::size_t>> entries_;
};

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
  std::vector<bool> is_mine;  ///< of each slot: it is this shard's
  std::vector<Group> groups;  ///< fitted together; empty where groups are not fitted
  IdIndex slots;              ///< by id
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
