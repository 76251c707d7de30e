#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/sample_range.hpp"
#include "io/cells.hpp"
#include "io/columns.hpp"
#include "io/layout.hpp"
#include "io/text_source.hpp"
#include "slipfit/core/digest.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// The position of a sample in the file; it is valid for later samples up to the next position.
struct RowPlace {
  std::size_t sample = 0;  ///< index into Rows::time_s
  std::size_t row = 1;     ///< 1-based, of the rows of numbers
  unsigned line = 1;
};

/// The chosen columns in SI, in the order of the file, and what was left out; time and force are finite.
struct Rows {
  std::vector<double> time_s;
  std::vector<double> force;
  // Empty where no such column is chosen; NaN where a row does not hold it:
  std::vector<double> displacement_m;
  std::vector<double> normal_force_N;
  std::vector<double> speed_m_per_s;
  std::vector<double> step;
  std::vector<std::size_t> blocks;  ///< samples before which the header line is repeated
  std::vector<RowPlace> places;
  std::size_t count = 0;  ///< rows in the file
  std::size_t without_number = 0;
  std::size_t text_lines = 0;
  unsigned first_text_line = 0;
  std::optional<UnreadCells> unread;  ///< where cells of one shape cost more than a tenth of the rows
  std::optional<TimeWindow> clock;    ///< where a window was asked for: what the clock covers inside and outside it
  std::optional<Digest> digest;       ///< of the whole file; empty: of none
  std::optional<std::uint64_t> bytes;

  /// Row number and line of a sample.
  [[nodiscard]] RowPlace place_of(std::size_t sample) const;
  void cut(const SampleRange& kept);
  /// Keeps the samples in the rows and in the window that have a time and a force; counts those without.
  void keep_wanted(const std::optional<RowRange>& wanted_rows, const std::optional<TimeWindow>& window);
  /// Keeps the samples of these indices, ascending.
  void keep(const std::vector<std::size_t>& samples);
};

/// Reads the chosen columns in one pass: 16 bytes a sample, 8 for each further column. Throws what TextLines throws.
Rows read_rows(std::unique_ptr<TextSource> source, const Layout& layout, const Choice& choice,
               const ReadOptions& options);

}  // namespace slipfit::reading
