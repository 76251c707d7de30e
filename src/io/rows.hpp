#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/columns.hpp"
#include "io/displacement.hpp"
#include "io/layout.hpp"
#include "io/text_source.hpp"

namespace slipfit::reading {

/// What to read from each line.
struct RowPlan {
  const Layout& layout;
  const Choice& choice;
  std::optional<double> sample_rate_Hz;  ///< the clock where no time column is chosen
  std::optional<TimeWindow> window;
  std::size_t expected_rows = 0;
};

/// The two chosen columns in SI, time never decreasing, all finite; and what was left out.
struct Rows {
  std::vector<double> time_s;
  std::vector<double> force;
  DisplacementTrack displacement;
  std::size_t in_window = 0;  ///< rows with numbers inside the window, whatever their order
  std::size_t without_number = 0;
  std::size_t backward = 0;
  std::size_t repeating = 0;
  std::size_t text_lines = 0;
  unsigned first_backward_line = 0;
  unsigned first_text_line = 0;
  std::optional<TimeWindow> clock;  ///< where a window was asked for: what the clock covers inside and outside it
  Digest digest;                    ///< of the whole file
  std::uint64_t bytes = 0;
};

/// One pass, 16 bytes a sample and the reader's own buffer. Throws what LineReader and its source throw; `file` is the
/// name that it says.
Rows read_rows(const std::string& file, std::unique_ptr<TextSource> source, const RowPlan& plan);

}  // namespace slipfit::reading
