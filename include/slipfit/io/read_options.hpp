#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace slipfit {

/// Part of a recording, in seconds on the recording's own clock (bounds included).
struct TimeWindow {
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// Rows of numbers, counted from 1 over the file (bounds included).
struct RowRange {
  std::size_t first = 1;
  std::size_t last = 1;
};

/// The rows with this value, a number or a text, in this column.
struct ColumnValue {
  std::string column;  ///< name, or 1-based number as text
  std::string value;
};

/// The recordings to read from a file. Strokes are those of a reciprocating test, in both directions or with one sign
/// of the force; segments are the sections of constant speed.
enum class Pieces { One, Strokes, PositiveStrokes, NegativeStrokes, Segments };

/// Properties of the file that the user states; everything left empty is detected and listed in `Provenance::assumed`.
struct ReadOptions {
  std::optional<std::string> time_column;          ///< name, or 1-based number as text
  std::optional<std::string> force_column;         ///< name, or 1-based number as text
  std::optional<std::string> normal_force_column;  ///< name, or 1-based number as text
  std::optional<std::string> speed_column;         ///< name, or 1-based number as text
  std::optional<std::string> time_unit;
  std::optional<std::string> force_unit;
  std::optional<std::string> force_scale;  ///< "5 N/V": the force for a unit of what the column holds
  std::optional<double> sample_rate_Hz;    ///< for recordings without a clock
  std::optional<double> radius_m;          ///< of the contact from the axis: for a speed of rotation, or a torque
  // What in a container is the recording:
  std::optional<std::string> sheet;     ///< of a workbook, file of a zip archive: name or 1-based number
  std::optional<std::string> variable;  ///< of a .mat file, dataset or group of HDF5, group of TDMS
  // Parts of the file, in the order in which they are taken:
  std::optional<RowRange> rows;
  std::optional<ColumnValue> where;
  std::optional<std::size_t> step;  ///< as `inspect_recording` counts them
  std::optional<TimeWindow> window;
  Pieces pieces = Pieces::One;  ///< `read_pieces` takes them apart
};

}  // namespace slipfit
