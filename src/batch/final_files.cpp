#include "batch/final_files.hpp"

#include "batch/tables.hpp"

namespace slipfit::batch {

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

Result<FileDigests> FinalFiles::finish() {
  for (const Replacement* const file : {&results_, &failures_, &summary_}) {
    if (file->error()) return *file->error();
  }
  for (Replacement* const file : {&results_, &failures_, &summary_}) {
    if (auto error = file->finish()) return *error;
  }
  return FileDigests{results_.digest().text(), summary_.digest().text(), failures_.digest().text()};
}

Result<FileDigests> write_final_files(const std::filesystem::path& folder, const std::filesystem::path& manifest,
                                      const WorkList& list, const ResultLog& log) {
  FinalFiles files(folder);
  auto failed = for_each_result(manifest, list, log, [&](const LoggedResult& result) -> std::optional<Error> {
    if (result.has_failed) {
      files.add_failure(result.line, summary_of_failure(result.key, failure_from(result.line).code));
      return std::nullopt;
    }
    const auto summary = summary_of_result(result.key, result.line);
    if (!summary) return summary.error();
    files.add_result(result.line, summary.value());
    return std::nullopt;
  });
  if (failed) return *failed;
  return files.finish();
}

}  // namespace slipfit::batch
