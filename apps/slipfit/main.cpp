#include <fcntl.h>
#include <unistd.h>

#include <csignal>

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

}  // namespace

int main(int argc, char** argv) {
  (void)std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is an error like a full disk
  open_standard_streams();
  keep_freed_memory();
  const std::vector<std::string> words(argv, argv + argc);
  const Outcome outcome = run_program(words, shell_line(words));
  if (!outcome.message.empty()) say(outcome.message);
  return static_cast<int>(outcome.exit);
}
