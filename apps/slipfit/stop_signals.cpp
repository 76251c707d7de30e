#include "stop_signals.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace {

// A signal handler can reach nothing else. NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
volatile std::sig_atomic_t received_signal = 0;

constexpr unsigned kLongest_s = 2;

extern "C" void keep_signal(int signal) {
  received_signal = signal;
  ::alarm(kLongest_s);
}

/// A pipe or a disk blocks. The files are complete enough for --resume.
extern "C" void end_now(int /*signal*/) {
  constexpr std::string_view kMessage = "slipfit: stopped; --resume goes on\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  ::_exit(128 + static_cast<int>(received_signal));
}

}  // namespace

StopSignals::StopSignals() {
  received_signal = 0;
  struct sigaction action {};
  action.sa_handler = keep_signal;
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);  // a job in the background ignores Ctrl-C
  }
  (void)std::signal(SIGALRM, end_now);
}

StopSignals::~StopSignals() {
  ::alarm(0);
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction now {};
    ::sigaction(signal, nullptr, &now);
    if (now.sa_handler == keep_signal) (void)std::signal(signal, SIG_DFL);
  }
}

std::optional<ExitCode> StopSignals::received() {
  if (received_signal == SIGINT) return ExitCode::Interrupted;
  if (received_signal == SIGTERM) return ExitCode::Terminated;
  return std::nullopt;
}
