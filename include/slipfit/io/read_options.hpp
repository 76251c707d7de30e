#pragma once

#include <optional>
#include <string>

namespace slipfit {

/// Part of a recording, in seconds on the recording's own clock (bounds included).
struct TimeWindow {
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// What the user says about the file; everything left empty is found out, and said in `Provenance::assumed`.
struct ReadOptions {
  std::optional<std::string> time_column;   ///< name, or 1-based number as text
  std::optional<std::string> force_column;  ///< name, or 1-based number as text
  std::optional<std::string> time_unit;
  std::optional<std::string> force_unit;
  std::optional<double> sample_rate_Hz;  ///< for recordings without a clock
  std::optional<TimeWindow> window;
};

}  // namespace slipfit
