#pragma once

#include <chrono>

namespace slipfit {

/// Wall-clock seconds since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace slipfit
