#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>

#include "memory.hpp"
#include "output.hpp"
#include "program.hpp"

namespace {

/// A file that the program opens would take the number of a closed standard stream, and messages would run into it.
/// Standard output is opened so that writing fails: a result that nobody can read is an error.
void open_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    (void)::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);  // the lowest free number
  }
}

/// Takes the stack that an analysis needs while there is memory: where it has to grow and cannot, the system ends the
/// program.
[[gnu::noinline]] void take_stack() {
  constexpr std::size_t kPage = 4096;
  std::array<volatile char, 256 * kPage> stack;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (std::size_t i = 0; i < stack.size(); i += kPage) stack[i] = 0;
}

}  // namespace

int main(int argc, char** argv) {
  (void)std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is an error like a full disk
  take_stack();
  open_standard_streams();
  keep_freed_memory();
  const std::vector<std::string> words(argv, argv + argc);
  const Outcome outcome = run_program(words, shell_line(words));
  if (!outcome.message.empty()) say(outcome.message);
  return static_cast<int>(outcome.exit);
}
