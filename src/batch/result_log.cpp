#include "batch/result_log.hpp"

#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <utility>

#include "batch/tables.hpp"
#include "core/parallel.hpp"
#include "report/document/json_node.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit::batch {
namespace {

/// Null where it is no document, or one out of all bounds.
nlohmann::json parsed(const std::string& document) {
  try {
    return documents::parse_document(document, kResults);
  } catch (const ThrownError&) {
    return {};
  }
}

std::optional<std::string> id_of(const std::string& document) {
  const auto json = parsed(document);
  if (!json.is_object() || json.value("schema", nlohmann::json()) != "slipfit.fit/1") return std::nullopt;
  const auto id = json.find("id");
  return id != json.end() && id->is_string() ? std::optional(id->get<std::string>()) : std::nullopt;
}

std::string begin_line(std::size_t slot) {
  return fmt::format("begin {}", slot);
}

std::string done_line(std::size_t slot, const Digest& digest) {
  return fmt::format("done {} {}", slot, digest.text());
}

struct JournalEntry {
  unsigned char tries = 0;
  std::string done;  ///< the last "done" line
};

/// Reads the journal entry of each slot. Incomplete lines are ignored.
std::vector<JournalEntry> read_journal(const std::filesystem::path& folder, std::size_t slots) {
  constexpr unsigned char kMostCounted = 255;
  std::vector<JournalEntry> entries(slots);
  std::ifstream stream(folder / kJournal, std::ios::binary);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    std::istringstream words(line);
    std::string word;
    std::size_t slot = 0;
    if (!(words >> word >> slot) || slot >= slots) continue;
    JournalEntry& entry = entries[slot];
    if (word == "begin" && entry.tries < kMostCounted) ++entry.tries;
    if (word == "done" || word == "end") entry.tries = 0;
    if (word == "done") entry.done = line;
  }
  return entries;
}

/// The whole lines of results.jsonl with a slot. Whether they are as they were written is not checked here.
FoundResults read_results(const std::filesystem::path& folder, const WorkList& list) {
  FoundResults found(list.is_mine.size());
  std::ifstream stream(folder / kResults, std::ios::binary);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    const std::uint64_t offset = std::exchange(found.size, found.size + line.size() + 1);
    const auto id = id_of(line);
    const auto slot = id ? list.slots.find(*id) : std::nullopt;
    if (slot) found.lines.push_back({*slot, offset, digest_of(line)});
  }
  return found;
}

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::file_size(file, ignored);
}

std::string summary_of(const LoggedResult& result) {
  return result.has_failed ? summary_of_failure(result.key, failure_from(result.line).code)
                           : summary_of_result(result.key, result.line);
}

}  // namespace

FoundResults find_results(const std::filesystem::path& folder, const RunRecord& before, const WorkList& list) {
  FoundResults found = read_results(folder, list);
  if (before.finished) {
    const auto digest = digest_of_file((folder / kResults).string());
    if (digest && digest->text() == before.digests.results) return found;
    found.lines.clear();
    found.damaged = before.progress.total;
    return found;
  }
  const std::size_t slots = list.is_mine.size();
  const std::vector<JournalEntry> journal = read_journal(folder, slots);
  std::vector<bool> is_found(slots, false);
  std::erase_if(found.lines, [&](const FoundResults::Line& line) {
    if (journal[line.slot].done != done_line(line.slot, line.digest)) return true;
    is_found[line.slot] = true;
    return false;
  });
  for (std::size_t slot = 0; slot < slots; ++slot) {
    found.tries[slot] = journal[slot].tries;
    if (!journal[slot].done.empty() && !is_found[slot]) ++found.damaged;
  }
  return found;
}

void write_journal(const std::filesystem::path& folder, const FoundResults& found) {
  Replacement journal(folder / kJournal);
  for (std::size_t slot = 0; slot < found.tries.size(); ++slot) {
    for (unsigned tries = 0; tries < found.tries[slot]; ++tries) journal.append(begin_line(slot) + "\n");
  }
  for (const FoundResults::Line& line : found.lines) journal.append(done_line(line.slot, line.digest) + "\n");
  journal.finish();
}

void remove_journal(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(folder / kJournal, ignored);
}

ResultLog::ResultLog(const std::filesystem::path& folder, FoundResults found)
    : results_(folder / kResults, found.size),
      failures_(folder / kFailures, 0),
      journal_(folder / kJournal, size_of(folder / kJournal)),
      offsets_(found.tries.size(), 0),
      kinds_(found.tries.size(), Kind::Nothing),
      tries_(std::move(found.tries)) {
  for (const FoundResults::Line& line : found.lines) {
    offsets_[line.slot] = line.offset;
    kinds_[line.slot] = Kind::Result;
  }
  failures_.append(failure_names());
}

void ResultLog::begin(std::size_t slot) {
  journal_.append(begin_line(slot));
}

void ResultLog::add_result(std::size_t slot, std::string_view document) {
  offsets_[slot] = results_.append(document);
  kinds_[slot] = Kind::Result;
  if (!results_.has_failed()) journal_.append(done_line(slot, digest_of(document)));
}

void ResultLog::add_failure(std::size_t slot, const std::string& id, const Error& failure) {
  offsets_[slot] = failures_.append(failure_line(id, failure));
  kinds_[slot] = Kind::Failure;
  if (!failures_.has_failed()) add_end(slot);
}

void ResultLog::add_end(std::size_t slot) {
  journal_.append(fmt::format("end {}", slot));
}

void ResultLog::sync() {
  for (LineFile* const file : {&results_, &failures_, &journal_}) file->sync();
}

void ResultLog::throw_error() const {
  for (const LineFile* const file : {&results_, &failures_, &journal_}) file->throw_error();
}

Result<std::string> ResultLog::line_of(std::size_t slot) const {
  return (kinds_[slot] == Kind::Failure ? failures_ : results_).line_at(offsets_[slot]);
}

void for_each_result(const std::filesystem::path& manifest, const WorkList& list, const ResultLog& log,
                     const std::function<void(const LoggedResult&)>& use) {
  const auto use_slot = [&](std::size_t slot, const SummaryKey& key) {
    if (log.kind_of(slot) == ResultLog::Kind::Nothing) return;
    use({slot, key, !log.has_result(slot), value_or_throw(log.line_of(slot))});
  };
  std::size_t group = 0;
  Entries entries(manifest);
  while (const auto entry = entries.next()) {
    use_slot(entry->row - 1, {entry->row, entry->id, entry->group, printable(entry->file.string())});
    for (; group < list.groups.size() && list.groups[group].last_row == entry->row; ++group) {
      const std::string& name = list.groups[group].name;
      use_slot(list.slot_of_group(group), {entry->row, id_of_group(name), name, ""});
    }
  }
}

FinalFiles::FinalFiles(const std::filesystem::path& folder)
    : results_(folder / kResults), summary_(folder / kSummary), failures_(folder / kFailures) {
  summary_.append(summary_names() + "\n");
  failures_.append(failure_names() + "\n");
}

void FinalFiles::add_result(const std::string& document, const std::string& summary) {
  results_.append(document + "\n");
  summary_.append(summary + "\n");
}

void FinalFiles::add_failure(const std::string& failure, const std::string& summary) {
  failures_.append(failure + "\n");
  summary_.append(summary + "\n");
}

FileDigests FinalFiles::finish() {
  for (const Replacement* const file : {&results_, &failures_, &summary_}) file->throw_error();
  for (Replacement* const file : {&results_, &failures_, &summary_}) file->finish();
  return {results_.digest().text(), summary_.digest().text(), failures_.digest().text()};
}

FileDigests write_final_files(const std::filesystem::path& folder, const std::filesystem::path& manifest,
                              const WorkList& list, const ResultLog& log) {
  constexpr std::size_t kSideBySide = 256;  // so many documents are in memory
  FinalFiles files(folder);
  std::vector<LoggedResult> results;
  const auto add_all = [&] {
    const std::vector<std::string> summaries =
        in_parallel(results.size(), [&](std::size_t i) { return summary_of(results[i]); });
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (results[i].has_failed) {
        files.add_failure(results[i].line, summaries[i]);
      } else {
        files.add_result(results[i].line, summaries[i]);
      }
    }
    results.clear();
  };
  for_each_result(manifest, list, log, [&](const LoggedResult& result) {
    results.push_back(result);
    if (results.size() == kSideBySide) add_all();
  });
  add_all();
  return files.finish();
}

}  // namespace slipfit::batch
