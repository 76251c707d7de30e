#pragma once

#include <chrono>
#include <string>

#include "slipfit/batch/batch.hpp"

/// Shows on standard error how far long work is: on a terminal a line that changes; elsewhere, of a batch alone, a line
/// every ten seconds.
class ProgressLine {
 public:
  ProgressLine();
  /// Takes the bar off the terminal, for the line that comes next.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  void show(const slipfit::BatchProgress& progress);
  /// Shows the text if standard error is a terminal.
  void show(const std::string& text);

 private:
  bool on_terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point last_line_;
};
