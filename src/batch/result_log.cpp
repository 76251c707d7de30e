#include "batch/result_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "batch/tables.hpp"
#include "report/document/json_node.hpp"

namespace slipfit::batch {
namespace {

constexpr std::string_view kBegun = "begin";
constexpr std::string_view kFitted = "fit";
constexpr std::string_view kFailed = "error";
constexpr std::string_view kEnded = "end";

std::string journal_line(std::string_view word, std::size_t slot, std::string_view content = {}) {
  const std::string event = fmt::format("{} {}{}{}", word, slot, content.empty() ? "" : " ", content);
  return fmt::format("{} {}", digest_of(event).text(), event);
}

struct Event {
  std::string_view word;
  std::size_t slot = 0;
  std::string_view content;
};

/// Cuts a text at its first blank and returns what precedes it; `text` keeps the rest.
std::string_view next_word(std::string_view& text) {
  const std::size_t end = std::min(text.find(' '), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return word;
}

/// Returns the event of a line; empty if the line is not as it was written.
std::optional<Event> event_in(std::string_view line) {
  const std::string_view digest = next_word(line);
  if (digest != digest_of(line).text()) return std::nullopt;
  Event event;
  event.word = next_word(line);
  const std::string_view slot = next_word(line);
  event.content = line;
  const auto read = std::from_chars(slot.data(), slot.data() + slot.size(), event.slot);
  return read.ec == std::errc() ? std::optional(event) : std::nullopt;
}

/// Calls `use` with each whole line of a file and the place where it begins. Returns the size of these lines.
template <class Use>
std::uint64_t for_each_line(const std::filesystem::path& file, const Use& use) {
  std::uint64_t size = 0;
  std::ifstream stream(file, std::ios::binary);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    use(line, size);
    size += line.size() + 1;
  }
  return size;
}

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

}  // namespace

ResultLog::ResultLog(const std::filesystem::path& folder, std::size_t slots)
    : slots_(slots),
      file_(folder / kJournal,
            for_each_line(folder / kJournal, [&](const std::string& line, auto place) { take(line, place); })) {}

void ResultLog::take(std::string_view line, std::uint64_t place) {
  constexpr unsigned char kMostCounted = 255;
  const std::optional<Event> event = event_in(line);
  if (!event || event->slot >= slots_.size()) {
    ++damaged_;
    return;
  }
  Slot& slot = slots_[event->slot];
  if (event->word == kBegun && slot.tries < kMostCounted) ++slot.tries;
  if (event->word != kBegun) slot.tries = 0;
  if (event->word == kFailed) slot.kind = Kind::Nothing;
  if (event->word == kFitted) {
    slot.kind = Kind::Result;
    slot.place = place + static_cast<std::uint64_t>(event->content.data() - line.data());
  }
}

/// Has the file open for itself: the place of a line is that of the process that appends it.
void ResultLog::begin(std::size_t slot) const {
  LineFile file = file_.opened_again();
  file.append(journal_line(kBegun, slot));
  file.throw_error();
}

void ResultLog::add_result(std::size_t slot, std::string_view document) {
  add(Kind::Result, slot, kFitted, document);
}

void ResultLog::add_failure(std::size_t slot, const std::string& id, const Error& failure) {
  add(Kind::Failure, slot, kFailed, failure_line(id, failure));
}

void ResultLog::add(Kind kind, std::size_t slot, std::string_view word, std::string_view content) {
  const std::string line = journal_line(word, slot, content);
  const std::uint64_t place = file_.append(line);
  slots_[slot].place = place + line.size() - content.size();
  slots_[slot].kind = kind;
}

void ResultLog::add_end(std::size_t slot) {
  (void)file_.append(journal_line(kEnded, slot));
}

bool journal_has_results(const std::filesystem::path& folder) {
  bool has_results = false;
  for_each_line(folder / kJournal, [&](const std::string& line, std::uint64_t) {
    if (has_results) return;
    const std::optional<Event> event = event_in(line);
    has_results = event && event->word == kFitted;
  });
  return has_results;
}

std::size_t begin_journal(const std::filesystem::path& folder, const RunRecord* before, const WorkList& list) {
  Replacement journal(folder / kJournal, folder / kResults);  // the same documents
  std::size_t damaged = 0;
  if (before != nullptr) {
    const auto digest = digest_of_file((folder / kResults).string());
    if (digest && digest->text() == before->digests.results) {
      for_each_line(folder / kResults, [&](const std::string& document, std::uint64_t) {
        const auto id = id_of(document);
        const auto place = id ? list.slots.find(digest_of(*id)) : list.slots.end();
        if (place != list.slots.end()) journal.append(journal_line(kFitted, place->second, document) + "\n");
      });
    } else {
      damaged = before->progress.total;
    }
  }
  journal.finish();
  return damaged;
}

void remove_journal(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(folder / kJournal, ignored);
}

}  // namespace slipfit::batch
