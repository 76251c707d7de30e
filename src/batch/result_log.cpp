#include "batch/result_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <utility>

#include "batch/csv_line.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

constexpr const char* kResults = "results.jsonl";
constexpr const char* kFailures = "failures.csv";
constexpr const char* kJournal = "journal";
constexpr unsigned char kMostCountedTries = 255;

std::optional<std::string> id_of(const std::string& document) {
  const auto json = nlohmann::json::parse(document, nullptr, false);
  if (!json.is_object() || json.value("schema", nlohmann::json()) != "slipfit.fit/1") return std::nullopt;
  const auto id = json.find("id");
  return id != json.end() && id->is_string() ? std::optional(id->get<std::string>()) : std::nullopt;
}

std::string done_line(std::size_t slot, const Digest& digest) {
  return fmt::format("done {} {}", slot, digest.text());
}

struct JournalEntry {
  unsigned char tries = 0;
  std::string done;  ///< the line that says so
};

/// Of each slot. A torn line is passed over.
std::vector<JournalEntry> read_journal(const std::filesystem::path& folder, std::size_t slots) {
  std::vector<JournalEntry> entries(slots);
  std::ifstream stream(folder / kJournal, std::ios::binary);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    std::istringstream words(line);
    std::string word;
    std::size_t slot = 0;
    if (!(words >> word >> slot) || slot >= slots) continue;
    JournalEntry& entry = entries[slot];
    if (word == "begin") entry.tries = std::min<unsigned char>(entry.tries, kMostCountedTries - 1) + 1;
    if (word == "done" || word == "end") entry.tries = 0;
    if (word == "done") entry.done = line;
  }
  return entries;
}

/// The whole lines of results.jsonl with a slot. Whether they are as they were written is not looked at.
FoundResults read_results(const std::filesystem::path& folder, std::size_t slots, const IdIndex& slot_of_id) {
  FoundResults found = no_results(slots);
  std::ifstream stream(folder / kResults, std::ios::binary);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    const std::uint64_t offset = std::exchange(found.size, found.size + line.size() + 1);
    const auto id = id_of(line);
    const auto slot = id ? slot_of_id.find(*id) : std::nullopt;
    if (slot) found.lines.push_back({*slot, offset, digest_of(line)});
  }
  return found;
}

}  // namespace

FoundResults no_results(std::size_t slots) {
  FoundResults found;
  found.tries.resize(slots, 0);
  return found;
}

FoundResults find_results(const std::filesystem::path& folder, const RunRecord& before, std::size_t slots,
                          const IdIndex& slot_of_id) {
  FoundResults found = read_results(folder, slots, slot_of_id);
  if (before.finished) {
    const auto digest = digest_of_file((folder / kResults).string());
    if (digest && digest->text() == before.digests.results) return found;
    found.lines.clear();
    found.damaged = before.progress.total;
    return found;
  }
  const std::vector<JournalEntry> journal = read_journal(folder, slots);
  for (std::size_t slot = 0; slot < slots; ++slot) found.tries[slot] = journal[slot].tries;
  std::vector<bool> is_found(slots, false);
  std::erase_if(found.lines, [&](const FoundResults::Line& line) {
    if (journal[line.slot].done != done_line(line.slot, line.digest)) return true;
    is_found[line.slot] = true;
    return false;
  });
  for (std::size_t slot = 0; slot < slots; ++slot) {
    if (!journal[slot].done.empty() && !is_found[slot]) ++found.damaged;
  }
  return found;
}

std::optional<Error> write_journal(const std::filesystem::path& folder, const FoundResults& found) {
  auto opened = Replacement::open(folder / kJournal);
  if (!opened) return opened.error();
  Replacement journal = std::move(opened).value();
  for (std::size_t slot = 0; slot < found.tries.size(); ++slot) {
    for (unsigned tries = 0; tries < found.tries[slot]; ++tries) {
      if (auto error = journal.append(fmt::format("begin {}\n", slot))) return error;
    }
  }
  for (const FoundResults::Line& line : found.lines) {
    if (auto error = journal.append(done_line(line.slot, line.digest) + "\n")) return error;
  }
  return journal.finish();
}

void remove_journal(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(folder / kJournal, ignored);
}

ResultLog::ResultLog(LineFile results, LineFile failures, LineFile journal, FoundResults found)
    : results_(std::move(results)),
      failures_(std::move(failures)),
      journal_(std::move(journal)),
      offsets_(found.tries.size(), 0),
      kinds_(found.tries.size(), Kind::Nothing),
      tries_(std::move(found.tries)) {
  for (const FoundResults::Line& line : found.lines) {
    offsets_[line.slot] = line.offset;
    kinds_[line.slot] = Kind::Result;
  }
}

Result<std::unique_ptr<ResultLog>> ResultLog::open(const std::filesystem::path& folder, FoundResults found) {
  auto results = LineFile::open(folder / kResults, found.size);
  if (!results) return results.error();
  auto failures = LineFile::open(folder / kFailures, 0);
  if (!failures) return failures.error();
  std::error_code ignored;
  auto journal = LineFile::open(folder / kJournal, std::filesystem::file_size(folder / kJournal, ignored));
  if (!journal) return journal.error();
  auto log = std::make_unique<ResultLog>(std::move(results).value(), std::move(failures).value(),
                                         std::move(journal).value(), std::move(found));
  const auto names = log->failures_.append(failure_names());
  if (!names) return names.error();
  return log;
}

std::optional<Error> ResultLog::note(const std::string& line) {
  const auto place = journal_.append(line);
  return place ? std::nullopt : std::optional(place.error());
}

std::optional<Error> ResultLog::begin(std::size_t slot) {
  return note(fmt::format("begin {}", slot));
}

std::optional<Error> ResultLog::add_result(std::size_t slot, std::string_view document) {
  const auto offset = results_.append(document);
  if (!offset) return offset.error();
  offsets_[slot] = offset.value();
  kinds_[slot] = Kind::Result;
  return note(done_line(slot, digest_of(document)));
}

std::optional<Error> ResultLog::add_failure(std::size_t slot, const std::string& id, const Error& failure) {
  const auto offset = failures_.append(csv_line({text_cell(id), failure.code, text_cell(one_line(failure.message))}));
  if (!offset) return offset.error();
  offsets_[slot] = offset.value();
  kinds_[slot] = Kind::Failure;
  return note(fmt::format("end {}", slot));
}

std::optional<Error> ResultLog::add_end(std::size_t slot) {
  return note(fmt::format("end {}", slot));
}

std::optional<Error> ResultLog::sync() {
  for (LineFile* const file : {&results_, &failures_, &journal_}) {
    if (auto error = file->sync()) return error;
  }
  return std::nullopt;
}

Result<std::string> ResultLog::line_of(std::size_t slot) const {
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
