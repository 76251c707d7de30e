#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "batch/files.hpp"
#include "batch/id_index.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::batch {

/// The results as they come in: results.jsonl and failures.csv, in the order of finishing, and where each slot's line
/// stands. Safe to use from several threads.
class Ledger {
 public:
  /// Begins with empty files, or with the whole lines that results.jsonl holds; failures are tried again.
  static Result<std::unique_ptr<Ledger>> begin(const std::filesystem::path& folder, std::size_t slots);
  static Result<std::unique_ptr<Ledger>> go_on(const std::filesystem::path& folder, std::size_t slots,
                                               const IdIndex& slot_of_id);

  std::optional<Error> add_result(std::size_t slot, std::string_view document);
  std::optional<Error> add_failure(std::size_t slot, const std::string& id, const Error& failure);
  /// Waits until the disk has what was added before.
  std::optional<Error> sync();

  enum class Kind : unsigned char { Nothing, Result, Failure };
  [[nodiscard]] Kind kind_of(std::size_t slot) const { return kinds_[slot]; }
  /// The line of a slot that has one.
  [[nodiscard]] Result<std::string> line_of(std::size_t slot) const;

  Ledger(LineFile results, LineFile failures, std::size_t slots);

 private:
  static Result<std::unique_ptr<Ledger>> open(const std::filesystem::path& folder, std::size_t slots,
                                              std::uint64_t kept);

  std::mutex mutex_;
  LineFile results_;
  LineFile failures_;
  std::vector<std::uint64_t> offsets_;  ///< of each slot's line
  std::vector<Kind> kinds_;
};

/// The line of names of failures.csv, without its end.
std::string failure_names();

/// Whether results.jsonl holds a whole line.
bool has_results(const std::filesystem::path& folder);

}  // namespace slipfit::batch
