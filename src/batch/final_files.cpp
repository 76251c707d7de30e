#include "batch/final_files.hpp"

#include <cstddef>

#include "batch/summary.hpp"
#include "io/csv_fields.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

std::optional<Error> append_line(Replacement& file, const std::string& line) {
  return file.append(line + "\n");
}

/// The second cell of a line of failures.csv.
std::string code_of(const std::string& failure) {
  const auto cells = reading::csv_fields(failure, ',');
  return cells && cells->size() > 1 ? (*cells)[1] : std::string();
}

std::optional<Error> add_slot(FinalFiles& files, const ResultLog& log, std::size_t slot, const SummaryKey& key) {
  const ResultLog::Kind kind = log.kind_of(slot);
  if (kind == ResultLog::Kind::Nothing) return std::nullopt;
  const auto line = log.line_of(slot);
  if (!line) return line.error();
  if (kind == ResultLog::Kind::Failure) {
    return files.add_failure(line.value(), summary_of_failure(key, code_of(line.value())));
  }
  const auto summary = summary_of_result(key, line.value());
  if (!summary) return summary.error();
  return files.add_result(line.value(), summary.value());
}

}  // namespace

Result<FinalFiles> FinalFiles::open(const std::filesystem::path& folder) {
  auto results = Replacement::open(folder / "results.jsonl");
  if (!results) return results.error();
  auto summary = Replacement::open(folder / "summary.csv");
  if (!summary) return summary.error();
  auto failures = Replacement::open(folder / "failures.csv");
  if (!failures) return failures.error();
  FinalFiles files(std::move(results).value(), std::move(summary).value(), std::move(failures).value());
  if (auto error = append_line(files.summary_, summary_names())) return *error;
  if (auto error = append_line(files.failures_, failure_names())) return *error;
  return files;
}

std::optional<Error> FinalFiles::add_result(const std::string& document, const std::string& summary) {
  if (auto error = append_line(results_, document)) return error;
  return append_line(summary_, summary);
}

std::optional<Error> FinalFiles::add_failure(const std::string& failure, const std::string& summary) {
  if (auto error = append_line(failures_, failure)) return error;
  return append_line(summary_, summary);
}

Result<FileDigests> FinalFiles::finish() {
  for (Replacement* const file : {&results_, &failures_, &summary_}) {
    if (auto error = file->finish()) return *error;
  }
  return FileDigests{results_.digest().text(), summary_.digest().text(), failures_.digest().text()};
}

Result<FileDigests> write_final_files(const std::filesystem::path& folder, const std::filesystem::path& manifest,
                                      const WorkList& list, const ResultLog& log) {
  auto opened = FinalFiles::open(folder);
  if (!opened) return opened.error();
  FinalFiles files = std::move(opened).value();
  const auto add_entry = [&](const ManifestEntry& entry) {
    return add_slot(files, log, entry.row - 1, {entry.row, entry.id, entry.group, one_line(entry.file.string())});
  };
  const auto add_group = [&](std::size_t group) {
    const Group& found = list.groups[group];
    return add_slot(files, log, list.slot_of_group(group), {found.last_row, id_of_group(found.name), found.name, ""});
  };
  auto failed = for_each_result(manifest, list, add_entry, add_group);
  if (failed) return *failed;
  return files.finish();
}

}  // namespace slipfit::batch
