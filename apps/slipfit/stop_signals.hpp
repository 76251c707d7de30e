#pragma once

#include <optional>

#include "failure.hpp"

/// While it exists, Ctrl-C and SIGTERM are recorded instead of ending the program; a second one ends it at once, as do
/// two seconds in which the program has not ended. Ctrl-Z is recorded, too.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  StopSignals(StopSignals&&) = delete;
  StopSignals& operator=(StopSignals&&) = delete;

  /// Returns the exit code that the shell expects: 128 + signal.
  [[nodiscard]] static std::optional<ExitCode> received();
  /// Returns true if Ctrl-Z (SIGTSTP) was received since the last call.
  [[nodiscard]] static bool take_suspension();
};
