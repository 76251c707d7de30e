#include "batch/folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <vector>

#include "batch/result_log.hpp"
#include "core/parallel.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit::batch {

namespace {

namespace fs = std::filesystem;

/// The lock file begins with these words: a file of that name without them was written by another program.
constexpr std::string_view kMark = "slipfit batch, ";

std::string text_of(int descriptor) {
  std::array<char, 256> text{};
  const ssize_t count = ::pread(descriptor, text.data(), text.size(), 0);
  return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count))};
}

/// A full disk may refuse the name: the lock holds without it.
void write_owner(int descriptor) {
  std::array<char, 128> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  const std::string owner = fmt::format("{}process {} on {}", kMark, ::getpid(), host.data());
  [[maybe_unused]] const bool is_named =
      ::ftruncate(descriptor, 0) == 0 && ::pwrite(descriptor, owner.data(), owner.size(), 0) > 0;
}

/// A lock of the process, not of the descriptor: children do not share it, and only who may write the file can hold it.
struct flock whole_file() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

ThrownError in_use(const fs::path& file, int descriptor) {
  struct flock lock = whole_file();
  const bool knows_process = ::fcntl(descriptor, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  struct stat status {};
  (void)::fstat(descriptor, &status);
  return file_error(
      "folder_in_use", file,
      fmt::format("in use by process {} ('{}', file of user {}); wait for it, or choose another folder; if that "
                  "process is not slipfit, remove the file",
                  knows_process ? std::to_string(lock.l_pid) : "?", printable(text_of(descriptor)), status.st_uid));
}

ThrownError not_opened(const fs::path& file, int reason) {
  struct stat status {};
  if (reason != EACCES || ::lstat(file.c_str(), &status) != 0) return cannot_write(file, reason);
  return file_error("folder_in_use", file,
                    fmt::format("user {} started a batch in this folder, and the file cannot be opened; if that batch "
                                "has ended, remove the file",
                                status.st_uid));
}

/// The process that held the lock before may have removed the file that has just been locked.
bool is_still(const fs::path& file, int descriptor) {
  struct stat ours {};
  struct stat there {};
  return ::fstat(descriptor, &ours) == 0 && ::lstat(file.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
         ours.st_dev == there.st_dev;
}

}  // namespace

FolderLock FolderLock::take(const fs::path& folder) {
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) {
    throw file_error("cannot_write", folder,
                     fmt::format("the folder cannot be written ({}); choose another one with --out", error.message()));
  }
  const fs::path file = folder / kLock;
  for (;;) {
    FileHandle handle(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!handle) throw not_opened(file, errno);
    struct flock lock = whole_file();
    if (::fcntl(handle.get(), F_SETLK, &lock) != 0) {
      throw errno == EACCES || errno == EAGAIN ? in_use(file, handle.get()) : cannot_write(file, errno);
    }
    if (!is_still(file, handle.get())) continue;
    const std::string before = text_of(handle.get());
    if (!before.empty() && !before.starts_with(kMark)) {
      throw file_error("folder_of_another_batch", file, "was not written by slipfit batch; choose another folder");
    }
    write_owner(handle.get());
    return {file, std::move(handle)};
  }
}

FolderLock::~FolderLock() {
  if (handle_) (void)::unlink(file_.c_str());
}

bool has_results(const fs::path& folder, const RunRecord& record) {
  if (!record.finished) return journal_has_results(folder);
  std::ifstream stream(folder / kResults, std::ios::binary);
  std::string line;
  return std::getline(stream, line) && !stream.eof();
}

std::optional<RunRecord> check_folder(const fs::path& folder, const RunRecord& now) {
  std::error_code ignored;
  for (const std::string_view name : kFolderFiles) {
    if (!fs::is_symlink(folder / name, ignored)) continue;
    throw file_error("cannot_write", folder / name,
                     "is a symbolic link, which is not followed; remove it, or choose another folder");
  }
  std::optional<RunRecord> before = read_record(folder);
  for (const std::string_view name : kFolderFiles) {
    if (before || !fs::exists(folder / name, ignored)) continue;
    throw file_error("folder_of_another_batch", folder,
                     fmt::format("contains '{}' without the run.json of its batch; choose another folder", name));
  }
  const auto differs = before ? difference(*before, now) : std::nullopt;
  if (!differs) return before;
  if (!has_results(folder, *before)) return std::nullopt;
  throw file_error(
      "folder_of_another_batch", folder,
      fmt::format(
          "contains results of another batch: {}; restore that and use --resume, or choose another folder with --out",
          *differs));
}

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
