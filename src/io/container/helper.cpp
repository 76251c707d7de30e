#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/file_handle.hpp"
#include "io/container/formats.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

/// What a program writes to its standard output; the program ends with it.
class ProgramStream final : public ByteStream {
 public:
  ProgramStream(::pid_t process, FileHandle pipe, std::string name)
      : process_(process), pipe_(std::move(pipe)), name_(std::move(name)) {}
  ~ProgramStream() override {
    pipe_ = {};  // the program notices, and ends
    if (!ended_) (void)wait();
  }
  ProgramStream(const ProgramStream&) = delete;
  ProgramStream& operator=(const ProgramStream&) = delete;

  std::size_t read(char* buffer, std::size_t size) override {
    std::size_t count = 0;
    while (count < size && !ended_) {
      const ::ssize_t got = ::read(pipe_.get(), buffer + count, size - count);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw std::system_error(errno, std::generic_category(), "reading failed");
      count += static_cast<std::size_t>(got);
      if (got > 0) continue;
      ended_ = true;
      if (wait() != 0) throw damaged(name_, "the file is damaged, or asks for too much memory or time");
    }
    return count;
  }

  /// Up to the first line end.
  std::string line() {
    std::string text;
    char c = '\0';
    while (read(&c, 1) == 1 && c != '\n') text += c;
    return text;
  }

 private:
  [[nodiscard]] int wait() const {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
  }

  ::pid_t process_;
  FileHandle pipe_;
  std::string name_;
  bool ended_ = false;
};

/// Of the program or the shared library that this code is part of: a program of another language may have loaded it.
std::filesystem::path folder_of_this_code() {
  static constexpr char kHere = '\0';
  Dl_info place{};
  if (::dladdr(&kHere, &place) == 0) return {};
  return std::filesystem::path(place.dli_fname).parent_path();
}

/// Beside this program or library, where it is installed, or empty.
std::string find_helper(const std::string& name) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto library = folder_of_this_code();
  for (const std::filesystem::path& folder :
       {self.parent_path(), self.parent_path() / "../libexec/slipfit", self.parent_path() / "../apps", library,
        library / "../../../../libexec/slipfit", std::filesystem::path(SLIPFIT_LIBEXEC_DIR)}) {
    if (folder.empty()) continue;
    const auto program = folder / name;
    if (::access(program.c_str(), X_OK) == 0) return program.string();
  }
  return {};
}

/// The libraries want a file in which they can go to and fro: one in memory, so that the bytes are read once, and may
/// come through a pipe. Whether all went in.
bool copy(TextStream& packed, int descriptor) {
  std::vector<char> piece(std::size_t{256} * 1024);
  while (const std::size_t got = packed.bytes->read(piece.data(), piece.size())) {
    for (std::size_t written = 0; written < got;) {
      const ::ssize_t count = ::write(descriptor, piece.data() + written, got - written);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      written += static_cast<std::size_t>(count);
    }
  }
  return true;
}

constexpr int kDescriptorOfHelper = 3;  // kFileOfHelper

std::unique_ptr<ProgramStream> start(const std::string& program, const Helper& helper, const std::string& name) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw ThrownError({"not_readable", name + ": no pipe can be made; close programs"});
  FileHandle read_end(ends[0]);
  const FileHandle write_end(ends[1]);
  std::vector<std::string> texts{program};
  texts.insert(texts.end(), helper.arguments.begin(), helper.arguments.end());
  std::vector<char*> words;
  words.reserve(texts.size() + 1);
  for (std::string& word : texts) words.push_back(word.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, write_end.get(), STDOUT_FILENO);
  if (helper.file >= 0) ::posix_spawn_file_actions_adddup2(&actions, helper.file, kDescriptorOfHelper);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  ::pid_t process = 0;
  const int failed = ::posix_spawn(&process, program.c_str(), &actions, nullptr, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (failed == 0) return std::make_unique<ProgramStream>(process, std::move(read_end), name);
  throw ThrownError({"not_readable", name + ": " + helper.program + " cannot be started; check its permissions"});
}

TextStream open_with_reader(const char* kind, TextStream packed, const std::string& name,
                            const ContainerChoice& choice) {
  const FileHandle file(::memfd_create("slipfit", MFD_CLOEXEC));
  if (!file || !copy(packed, file.get())) throw too_large(name);
  Helper helper{"slipfit-hdf5", {kind, kFileOfHelper}, "a MATLAB or HDF5 file", "libhdf5-dev", file.get()};
  if (choice.variable) helper.arguments.push_back(*choice.variable);
  HelperOutput read = run_helper(helper, name);
  TextStream text;
  text.bytes = std::move(read.bytes);
  text.assumed.push_back("Of the file '" + printable(read.first) + "' was read.");
  return text;
}

}  // namespace

HelperOutput run_helper(const Helper& helper, const std::string& name) {
  const std::string program = find_helper(helper.program);
  if (program.empty()) throw not_built_in(name, helper.kind, helper.package);
  std::unique_ptr<ProgramStream> bytes = start(program, helper, name);
  const std::string first = bytes->line();
  if (first.starts_with('=')) return {first.substr(1), std::move(bytes)};
  const std::size_t blank = std::min(first.find(' '), first.size());
  if (!first.starts_with('!') || blank == first.size()) throw damaged(name, "the file is damaged");
  throw ThrownError({first.substr(1, blank - 1), name + ": " + printable(first.substr(blank + 1))});
}

TextStream open_hdf5(TextStream packed, const std::string& name, const ContainerChoice& choice) {
  return open_with_reader("hdf5", std::move(packed), name, choice);
}

TextStream open_mat(TextStream packed, const std::string& name, const ContainerChoice& choice) {
  return open_with_reader("mat", std::move(packed), name, choice);
}

}  // namespace slipfit::reading
