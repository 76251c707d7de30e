#pragma once

#include <optional>

#include "failure.hpp"

/// While it lives, Ctrl-C and SIGTERM are remembered instead of ending the program; the second one ends it at once, as
/// do two seconds in which the program has not come to its end. Ctrl-Z is remembered, too.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  StopSignals(StopSignals&&) = delete;
  StopSignals& operator=(StopSignals&&) = delete;

  /// What the shell is to see: 128 + signal.
  [[nodiscard]] static std::optional<ExitCode> received();
  /// Whether there was a Ctrl-Z (SIGTSTP) since the last call.
  [[nodiscard]] static bool take_suspension();
};
