#pragma once

#include <chrono>

#include "slipfit/batch/batch.hpp"

/// Shows on standard error how far a batch is: a bar that moves on a terminal, a line every ten seconds elsewhere.
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

 private:
  bool on_terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point last_line_;
};
