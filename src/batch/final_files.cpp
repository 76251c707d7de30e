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

FileDigests FinalFiles::finish() {
  for (const Replacement* const file : {&results_, &failures_, &summary_}) file->throw_error();
  for (Replacement* const file : {&results_, &failures_, &summary_}) file->finish();
  return {results_.digest().text(), summary_.digest().text(), failures_.digest().text()};
}

FileDigests write_final_files(const std::filesystem::path& folder, const std::filesystem::path& manifest,
                              const WorkList& list, const ResultLog& log) {
  FinalFiles files(folder);
  for_each_result(manifest, list, log, [&](const LoggedResult& result) {
    if (result.has_failed) {
      files.add_failure(result.line, summary_of_failure(result.key, failure_from(result.line).code));
    } else {
      files.add_result(result.line, summary_of_result(result.key, result.line));
    }
  });
  return files.finish();
}

}  // namespace slipfit::batch
