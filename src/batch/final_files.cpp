#include "batch/final_files.hpp"

#include <vector>

#include "core/parallel.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit::batch {
namespace {

std::string summary_of(const LoggedResult& result) {
  return result.has_failed ? summary_of_failure(result.key, failure_from(result.line).code)
                           : summary_of_result(result.key, result.line);
}

}  // namespace

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
