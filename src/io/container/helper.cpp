#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <utility>

#include "core/file_handle.hpp"
#include "io/container/formats.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

/// The standard output of a program as a stream; the program ends with the stream.
class ProgramStream final : public ByteStream {
 public:
  ProgramStream(::pid_t process, FileHandle pipe, std::string name, std::chrono::milliseconds longest_wait)
      : process_(process), pipe_(std::move(pipe)), name_(std::move(name)), left_(longest_wait) {}
  ~ProgramStream() override {
    if (!ended_) (void)kill();
  }
  ProgramStream(const ProgramStream&) = delete;
  ProgramStream& operator=(const ProgramStream&) = delete;

  std::size_t read(char* buffer, std::size_t size) override {
    std::size_t count = 0;
    while (count < size && !ended_) {
      const bool has_output = wait_for_output();
      const ::ssize_t got = has_output ? ::read(pipe_.get(), buffer + count, size - count) : 0;
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw std::system_error(errno, std::generic_category(), "reading failed");
      count += static_cast<std::size_t>(got);
      if (got > 0) continue;
      check_end(has_output ? wait() : kill());
    }
    return count;
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// False once the program has used up its time. A step counts as no more than its length: the process may have been
  /// stopped and continued meanwhile.
  bool wait_for_output() {
    constexpr std::chrono::milliseconds kStep{500};
    pollfd output{pipe_.get(), POLLIN, 0};
    while (left_ > Clock::duration::zero()) {
      const auto begin = Clock::now();
      const int ready = ::poll(&output, 1, static_cast<int>(kStep.count()));
      left_ -= std::min<Clock::duration>(Clock::now() - begin, kStep);
      if (ready > 0) return true;
      if (ready < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "reading failed");
    }
    return false;
  }

  int wait() {
    ended_ = true;
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
  }

  int kill() {
    (void)::kill(process_, SIGKILL);
    return wait();
  }

  void check_end(int status) const {
    if (status == 0) return;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (signal == SIGTERM || signal == SIGINT || signal == SIGHUP) {
      throw ThrownError({"not_readable", name_ + ": the program that reads it was stopped by another program (" +
                                             ::strsignal(signal) + "); read it again"});
    }
    throw damaged(name_, "the file is damaged or needs too much memory or time");
  }

  ::pid_t process_;
  FileHandle pipe_;
  std::string name_;
  Clock::duration left_;
  bool ended_ = false;
};

/// Returns the folder of the program or shared library that contains this code; a program in another language may have
/// loaded it.
std::filesystem::path folder_of_this_code() {
  static constexpr char kHere = '\0';
  Dl_info place{};
  if (::dladdr(&kHere, &place) == 0) return {};
  return std::filesystem::path(place.dli_fname).parent_path();
}

/// Folders of the environment variable `name` (separated by colons), those that it names by an absolute path.
std::vector<std::filesystem::path> folders_of_variable(const char* name) {
  const char* const value = std::getenv(name);
  std::istringstream text(value == nullptr ? "" : value);
  std::vector<std::filesystem::path> folders;
  for (std::string folder; std::getline(text, folder, ':');) {
    if (folder.starts_with('/')) folders.emplace_back(folder);
  }
  return folders;
}

/// Returns the folders in which helpers may be: the one stated by the user; near this program or library; where this
/// build is installed; near the programs on the PATH, for a program elsewhere that contains slipfit's library.
std::vector<std::filesystem::path> helper_folders() {
  std::vector<std::filesystem::path> folders = folders_of_variable("SLIPFIT_HELPERS");
  std::error_code error;
  const auto program = platform::program_file().parent_path();
  const auto library = folder_of_this_code();
  const std::filesystem::path installed = "../libexec/slipfit";
  folders.insert(folders.end(), {program, program / installed, program / "../apps", library,
                                 library / "../../.." / installed, SLIPFIT_LIBEXEC_DIR});
  for (const auto& folder : folders_of_variable("PATH")) folders.push_back(folder / installed);
  return folders;
}

std::string find_helper(const Helper& helper, const std::string& name) {
  for (const auto& folder : helper_folders()) {
    const auto program = folder / helper.program;
    if (program.is_absolute() && ::access(program.c_str(), X_OK) == 0) return program.string();
  }
  throw ThrownError(
      {"not_built_in", name + ": " + helper.kind + ", which the program " + helper.program +
                           " reads, but that program was not found; install it (it is built with Debian's " +
                           helper.package + "), set SLIPFIT_HELPERS to its folder, or export the file " + "as text"});
}

constexpr int kDescriptorOfHelper = 3;  // kFileOfHelper

/// Settings with which a program is started: with the standard streams that it needs and without the signals that this
/// one ignores or blocks.
class SpawnSettings {
 public:
  SpawnSettings(int input, int output) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, input, kDescriptorOfHelper);
    ::posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    sigset_t signals{};
    ::posix_spawnattr_init(&attributes_);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    ::sigemptyset(&signals);
    ::posix_spawnattr_setsigmask(&attributes_, &signals);
    ::sigfillset(&signals);
    ::posix_spawnattr_setsigdefault(&attributes_, &signals);
  }
  ~SpawnSettings() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  /// 0 where it cannot be started.
  [[nodiscard]] ::pid_t start(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), program);
    std::vector<char*> words;
    words.reserve(arguments.size() + 1);
    for (std::string& word : arguments) words.push_back(word.data());
    words.push_back(nullptr);
    ::pid_t process = 0;
    const int failed = ::posix_spawn(&process, program.c_str(), &actions_, &attributes_, words.data(), environ);
    return failed == 0 ? process : 0;
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

std::unique_ptr<ProgramStream> start(const Helper& helper, const FileHandle& input, const std::string& name) {
  const std::string program = find_helper(helper, name);
  const std::array<int, 2> ends = platform::open_pipe();
  FileHandle read_end(ends[0]);
  if (!read_end) throw ThrownError({"not_readable", name + ": no pipe can be created; close other programs"});
  const FileHandle write_end(ends[1]);
  const ::pid_t process = SpawnSettings(input.get(), write_end.get()).start(program, helper.arguments);
  if (process != 0) return std::make_unique<ProgramStream>(process, std::move(read_end), name, helper.longest_wait);
  throw ThrownError({"not_readable", name + ": " + helper.program + " cannot be started; check its permissions"});
}

/// Returns what a helper writes up to the next line end. It is read byte by byte: what follows may be binary.
std::string next_line(ByteStream& bytes) {
  std::string text;
  char c = '\0';
  while (bytes.read(&c, 1) == 1 && c != '\n') text += c;
  return text;
}

/// Returns the error that a helper writes as "!CODE MESSAGE".
ThrownError error_of(const std::string& line, const std::string& name) {
  const std::size_t blank = std::min(line.find(' '), line.size());
  if (!line.starts_with('!') || blank == line.size()) return damaged(name, "the file is damaged");
  return ThrownError({line.substr(1, blank - 1), name + ": " + printable_utf8(line.substr(blank + 1))});
}

/// All tables of a file, which slipfit-hdf5 writes one after another. They are opened in their order.
class TablesInOrder : public std::enable_shared_from_this<TablesInOrder> {
 public:
  TablesInOrder(HelperOutput all, std::string name) : bytes_(std::move(all.bytes)), name_(std::move(name)) {
    std::istringstream list(all.first);
    for (std::string table; std::getline(list, table, '\t');) names_.push_back(table);
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// Null where the table is not one of those that follow.
  std::unique_ptr<ByteStream> open(const std::string& table) {
    if (std::find(names_.begin() + next_, names_.end(), table) == names_.end()) return nullptr;
    for (bool is_found = false; !is_found;) {
      for (std::array<char, 4096> unread{}; left_ > 0;) (void)read(unread.data(), unread.size());
      is_found = names_[static_cast<std::size_t>(next_++)] == table;
      const std::string head = next_line(*bytes_);
      if (!head.starts_with('=') && is_found) throw error_of(head, name_);
      if (head.starts_with('=')) left_ = std::strtoull(head.c_str() + 1, nullptr, 10);
    }
    return std::make_unique<Part>(shared_from_this());
  }

 private:
  class Part final : public ByteStream {
   public:
    explicit Part(std::shared_ptr<TablesInOrder> tables) : tables_(std::move(tables)) {}
    std::size_t read(char* buffer, std::size_t size) override { return tables_->read(buffer, size); }

   private:
    std::shared_ptr<TablesInOrder> tables_;
  };

  std::size_t read(char* buffer, std::size_t size) {
    const std::size_t wanted = std::min(size, left_);
    if (bytes_->read(buffer, wanted) < wanted) throw damaged(name_, "the file is damaged");
    left_ -= wanted;
    return wanted;
  }

  std::unique_ptr<ByteStream> bytes_;
  std::string name_;
  std::vector<std::string> names_;
  std::ptrdiff_t next_ = 0;  ///< table
  std::size_t left_ = 0;     ///< of the table that was opened last
};

/// The tables in a .mat or HDF5 file. The program slipfit-hdf5 reads one, or lists them and reads them in their order.
Container arrays_in(const std::string& kind, TextStream packed, const std::string& name) {
  const auto file = std::make_shared<const FileHandle>(file_in_memory(*packed.bytes, name));
  const auto run = [file, name](std::vector<std::string> arguments) {
    return run_helper({"slipfit-hdf5", std::move(arguments), "a MATLAB or HDF5 file", "libhdf5-dev"}, *file, name);
  };
  const auto in_order = std::make_shared<std::shared_ptr<TablesInOrder>>();
  const auto open = [=](const std::optional<std::string>& variable) {
    TextStream text;
    if (*in_order && variable) text.bytes = (*in_order)->open(*variable);
    std::string read = variable.value_or("");
    if (text.bytes == nullptr) {
      std::vector<std::string> arguments{kind, kFileOfHelper};
      if (variable) arguments.push_back(*variable);
      HelperOutput one = run(arguments);
      read = std::move(one.first);
      text.bytes = std::move(one.bytes);
    }
    text.assumed.push_back(table_was_read(read));
    return text;
  };
  return {open, [=] {
            *in_order = std::make_shared<TablesInOrder>(run({kind + "-all", kFileOfHelper}), name);
            return (*in_order)->names();
          }};
}

}  // namespace

HelperOutput run_helper(const Helper& helper, const FileHandle& input, const std::string& name) {
  std::unique_ptr<ByteStream> bytes = start(helper, input, name);
  const std::string first = next_line(*bytes);
  if (first.starts_with('=')) return {first.substr(1), std::move(bytes)};
  throw error_of(first, name);
}

FileHandle file_in_memory(ByteStream& stream, const std::string& name) {
  constexpr std::size_t kMostBytes = std::size_t{2} << 30U;
  FileHandle file(platform::open_nameless_file());
  if (!file) throw too_large(name);
  std::vector<char> piece(std::size_t{256} * 1024);
  std::size_t size = 0;
  while (const std::size_t got = stream.read(piece.data(), piece.size())) {
    size += got;
    if (size > kMostBytes) throw too_large(name);
    for (std::size_t written = 0; written < got;) {
      const ::ssize_t count = ::write(file.get(), piece.data() + written, got - written);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) throw too_large(name);
      written += static_cast<std::size_t>(count);
    }
  }
  (void)::lseek(file.get(), 0, SEEK_SET);  // a program may inherit the place
  return file;
}

Container open_hdf5(TextStream packed, const std::string& name) {
  return arrays_in("hdf5", std::move(packed), name);
}

Container open_mat(TextStream packed, const std::string& name) {
  return arrays_in("mat", std::move(packed), name);
}

}  // namespace slipfit::reading
