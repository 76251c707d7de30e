#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "slipfit/core/result.hpp"

/// Exit codes that the shell receives; docs/formats.md lists them.
enum class ExitCode {
  Analysed = 0,
  RecordingsFailed = 1,  ///< a batch finished, and some of its recordings failed
  WrongUsage = 2,
  BadRecording = 3,
  Interrupted = 130,  ///< 128 + SIGINT
  Terminated = 143    ///< 128 + SIGTERM
};

/// Ends a command: main() prints the message as one line and exits with the code. Thrown in apps/ only.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit, const std::string& message) : std::runtime_error(message), exit_(exit) {}
  Failure(ExitCode exit, const slipfit::Error& error)
      : std::runtime_error(error.message), exit_(exit), code_(error.code) {}
  [[nodiscard]] ExitCode exit() const { return exit_; }
  [[nodiscard]] const std::string& code() const { return code_; }  ///< of docs/formats.md

 private:
  ExitCode exit_;
  std::string code_ = "wrong_usage";
};

/// Throws Failure(WrongUsage) with this message.
template <class... Values>
[[noreturn]] void refuse(fmt::format_string<Values...> message, Values&&... values) {
  throw Failure(ExitCode::WrongUsage, fmt::format(message, std::forward<Values>(values)...));
}

/// Returns the value; an error is thrown as a Failure.
template <class Value>
Value value_or_fail(slipfit::Result<Value> result, ExitCode exit = ExitCode::WrongUsage) {
  if (!result) throw Failure(exit, result.error());
  return std::move(result).value();
}
