#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "io/container/formats.hpp"
#include "io/message.hpp"

extern char** environ;

namespace slipfit::reading {
namespace {

/// What a program writes to its standard output; the program ends with it.
class ProgramStream final : public ByteStream {
 public:
  ProgramStream(::pid_t process, int pipe, std::string name) : process_(process), pipe_(pipe), name_(std::move(name)) {}
  ~ProgramStream() override {
    ::close(pipe_);
    if (!ended_) (void)wait();
  }

  std::size_t read(char* buffer, std::size_t size) override {
    std::size_t count = 0;
    while (count < size && !ended_) {
      const ::ssize_t got = ::read(pipe_, buffer + count, size - count);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw std::system_error(errno, std::generic_category(), "reading failed");
      count += static_cast<std::size_t>(got);
      if (got > 0) continue;
      ended_ = true;
      if (wait() != 0) throw ContainerError(damaged(name_, "the file is damaged, or asks for too much memory or time"));
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
  int pipe_;
  std::string name_;
  bool ended_ = false;
};

/// Beside this program, where it is installed, or empty.
std::string find_helper(const std::string& name) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  for (const std::filesystem::path& folder :
       {self.parent_path(), self.parent_path() / "../libexec/slipfit", self.parent_path() / "../apps",
        std::filesystem::path(SLIPFIT_LIBEXEC_DIR)}) {
    const auto program = folder / name;
    if (::access(program.c_str(), X_OK) == 0) return program.string();
  }
  return {};
}

Result<std::unique_ptr<ProgramStream>> start(const std::string& program, const std::vector<std::string>& arguments,
                                             const std::string& name) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return Error{"not_readable", name + ": no pipe can be made; close programs"};
  std::vector<char*> words;
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  ::pid_t process = 0;
  const int failed = ::posix_spawn(&process, program.c_str(), &actions, nullptr, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (failed == 0) return std::make_unique<ProgramStream>(process, ends[0], name);
  ::close(ends[0]);
  return Error{"not_readable", name + ": " + program + " cannot be started; check its permissions"};
}

Result<TextStream> open_with_reader(const char* kind, const ContainerFile& file, const ContainerChoice& choice) {
  std::vector<std::string> arguments{kind, file.path.string()};
  if (choice.variable) arguments.push_back(*choice.variable);
  auto output =
      run_helper({"slipfit-hdf5", arguments, "a MATLAB or HDF5 file", "libhdf5-dev and libmatio-dev"}, file.name);
  if (!output) return output.error();
  TextStream text;
  HelperOutput read = std::move(output).value();
  text.bytes = std::move(read.bytes);
  text.assumed.push_back("Of the file '" + printable(read.first) + "' was read.");
  return text;
}

}  // namespace

Result<HelperOutput> run_helper(const Helper& helper, const std::string& name) {
  const std::string program = find_helper(helper.program);
  if (program.empty()) return not_built_in(name, helper.kind, helper.package);
  std::vector<std::string> words{program};
  words.insert(words.end(), helper.arguments.begin(), helper.arguments.end());
  auto started = start(program, words, name);
  if (!started) return started.error();
  std::unique_ptr<ProgramStream> bytes = std::move(started).value();
  const std::string first = bytes->line();
  if (first.starts_with('=')) return HelperOutput{first.substr(1), std::move(bytes)};
  const std::size_t blank = std::min(first.find(' '), first.size());
  if (!first.starts_with('!') || blank == first.size()) return damaged(name, "the file is damaged");
  return Error{first.substr(1, blank - 1), name + ": " + printable(first.substr(blank + 1))};
}

Result<TextStream> open_hdf5(const ContainerFile& file, const ContainerChoice& choice) {
  return open_with_reader("hdf5", file, choice);
}

Result<TextStream> open_mat(const ContainerFile& file, const ContainerChoice& choice) {
  return open_with_reader("mat", file, choice);
}

}  // namespace slipfit::reading
