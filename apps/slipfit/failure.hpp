#pragma once

#include <stdexcept>
#include <string>

/// What the shell sees; docs/formats.md lists them.
enum class ExitCode { Analysed = 0, WrongUsage = 2, BadRecording = 3 };

/// Ends a command: main() prints the message as one line and exits with the code. Thrown in apps/ only.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit, const std::string& message) : std::runtime_error(message), exit_(exit) {}
  [[nodiscard]] ExitCode exit() const { return exit_; }

 private:
  ExitCode exit_;
};
