#include "batch/ledger.hpp"

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "batch/csv_line.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

constexpr const char* kResults = "results.jsonl";
constexpr const char* kFailures = "failures.csv";

struct FoundLines {
  std::vector<std::pair<std::size_t, std::uint64_t>> places;  ///< slot, offset
  std::uint64_t size = 0;                                     ///< up to the end of the last whole line
};

std::optional<std::string> id_of(const std::string& document) {
  const auto json = nlohmann::json::parse(document, nullptr, false);
  if (!json.is_object() || !json.contains("id") || !json["id"].is_string()) return std::nullopt;
  return json["id"].get<std::string>();
}

/// A line that is no document (a crash of the machine may leave one) is passed over, and its recording done again.
FoundLines find_lines(const std::filesystem::path& file, const IdIndex& slot_of_id) {
  FoundLines found;
  std::ifstream stream(file, std::ios::binary);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    const std::uint64_t offset = std::exchange(found.size, found.size + line.size() + 1);
    const auto id = id_of(line);
    const auto slot = id ? slot_of_id.find(*id) : std::nullopt;
    if (slot) found.places.emplace_back(*slot, offset);
  }
  return found;
}

}  // namespace

Ledger::Ledger(LineFile results, LineFile failures, std::size_t slots)
    : results_(std::move(results)), failures_(std::move(failures)), offsets_(slots, 0), kinds_(slots, Kind::Nothing) {}

Result<std::unique_ptr<Ledger>> Ledger::open(const std::filesystem::path& folder, std::size_t slots,
                                             std::uint64_t kept) {
  auto results = LineFile::open(folder / kResults, kept);
  if (!results) return results.error();
  auto failures = LineFile::open(folder / kFailures, 0);
  if (!failures) return failures.error();
  auto ledger = std::make_unique<Ledger>(std::move(results).value(), std::move(failures).value(), slots);
  const auto names = ledger->failures_.append(failure_names());
  if (!names) return names.error();
  return ledger;
}

Result<std::unique_ptr<Ledger>> Ledger::begin(const std::filesystem::path& folder, std::size_t slots) {
  return open(folder, slots, 0);
}

Result<std::unique_ptr<Ledger>> Ledger::go_on(const std::filesystem::path& folder, std::size_t slots,
                                              const IdIndex& slot_of_id) {
  const FoundLines found = find_lines(folder / kResults, slot_of_id);
  auto ledger = open(folder, slots, found.size);
  if (!ledger) return ledger;
  std::unique_ptr<Ledger> result = std::move(ledger).value();
  for (const auto& [slot, offset] : found.places) {
    result->offsets_[slot] = offset;
    result->kinds_[slot] = Kind::Result;
  }
  return result;
}

std::optional<Error> Ledger::add_result(std::size_t slot, std::string_view document) {
  const std::lock_guard lock(mutex_);
  const auto offset = results_.append(document);
  if (!offset) return offset.error();
  offsets_[slot] = offset.value();
  kinds_[slot] = Kind::Result;
  return std::nullopt;
}

std::optional<Error> Ledger::add_failure(std::size_t slot, const std::string& id, const Error& failure) {
  const std::lock_guard lock(mutex_);
  const auto offset = failures_.append(csv_line({text_cell(id), failure.code, text_cell(one_line(failure.message))}));
  if (!offset) return offset.error();
  offsets_[slot] = offset.value();
  kinds_[slot] = Kind::Failure;
  return std::nullopt;
}

std::optional<Error> Ledger::sync() {
  if (auto error = results_.sync()) return error;
  return failures_.sync();
}

Result<std::string> Ledger::line_of(std::size_t slot) const {
  return (kinds_[slot] == Kind::Failure ? failures_ : results_).line_at(offsets_[slot]);
}

std::string failure_names() {
  return csv_line({"id", "code", "message"});
}

bool has_results(const std::filesystem::path& folder) {
  std::ifstream stream(folder / kResults, std::ios::binary);
  std::string line;
  return std::getline(stream, line) && !stream.eof();
}

}  // namespace slipfit::batch
