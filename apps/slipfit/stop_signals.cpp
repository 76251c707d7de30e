#include "stop_signals.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace {

// A signal handler can reach nothing else. NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
volatile std::sig_atomic_t received_signal = 0;

volatile std::sig_atomic_t suspension = 0;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

constexpr unsigned kLongest_s = 2;

extern "C" void keep_signal(int signal) {
  received_signal = signal;
  ::alarm(kLongest_s);
}

extern "C" void keep_suspension(int /*signal*/) {
  suspension = 1;
}

/// A pipe or a disk blocks. The files are complete enough for --resume.
extern "C" void end_now(int /*signal*/) {
  constexpr std::string_view kMessage = "slipfit: stopped; --resume continues\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  ::_exit(128 + static_cast<int>(received_signal));
}

/// A signal that is ignored stays so: a job in the background ignores Ctrl-C.
void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction before {};
  ::sigaction(signal, nullptr, &before);
  if (before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART | flags;
  sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
  received_signal = 0;
  suspension = 0;
  for (const int signal : {SIGINT, SIGTERM}) handle(signal, keep_signal, static_cast<int>(SA_RESETHAND));
  handle(SIGTSTP, keep_suspension, 0);
  (void)std::signal(SIGALRM, end_now);
}

StopSignals::~StopSignals() {
  ::alarm(0);
  for (const int signal : {SIGINT, SIGTERM, SIGTSTP}) {
    struct sigaction now {};
    ::sigaction(signal, nullptr, &now);
    if (now.sa_handler == keep_signal || now.sa_handler == keep_suspension) (void)std::signal(signal, SIG_DFL);
  }
}

bool StopSignals::take_suspension() {
  const bool is_asked = suspension != 0;
  suspension = 0;
  return is_asked;
}

std::optional<ExitCode> StopSignals::received() {
  if (received_signal == SIGINT) return ExitCode::Interrupted;
  if (received_signal == SIGTERM) return ExitCode::Terminated;
  return std::nullopt;
}
