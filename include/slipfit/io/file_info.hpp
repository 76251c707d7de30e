#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit {

/// A column of a file as its header and its first rows show it.
struct ColumnInfo {
  std::size_t index = 1;  ///< 1-based
  std::string name;       ///< without the unit; empty where the file has none
  std::string unit;
  std::string quantity;  ///< "time", "force", ...; empty if it is unknown
};

/// One of several consecutive recordings in a file.
struct StepInfo {
  std::size_t step = 1;              ///< what `ReadOptions::step` takes
  RowRange rows;                     ///< what `ReadOptions::rows` takes
  std::optional<TimeWindow> time_s;  ///< empty without a clock
  std::optional<double> speed_m_per_s;
  std::optional<double> normal_force_N;
};

/// The columns that `read_recording` would read, by the names that `ReadOptions` accepts.
struct TakenColumns {
  std::optional<std::string> time_column, force_column, normal_force_column;
  std::optional<double> speed_m_per_s;
};

/// The contents of a file.
struct FileInfo {
  std::vector<std::string> sheets;     ///< all that `ReadOptions::sheet` can name: of a workbook, files of an archive
  std::vector<std::string> variables;  ///< all that `ReadOptions::variable` can name, of which a recording may be made
  std::vector<ColumnInfo> columns;
  std::size_t rows = 0;
  std::optional<double> sample_rate_Hz;  ///< by the median time step of the part that would be read
  std::vector<StepInfo> steps;
  bool is_one_recording = true;  ///< the steps are read together: one clock, one speed, one load
  std::size_t strokes = 1;       ///< of the part that would be read; the force of several turns its sign
  TakenColumns taken;
  std::vector<std::string> assumed;
  std::optional<Error> refusal;        ///< why `read_recording` would refuse the file as it is
  std::optional<Recording> recording;  ///< what it reads else, with a speed of 1 m/s if no column contains it
};

/// Inspects a file even if `read_recording` would refuse it. Errors: those of a file without rows of numbers, and of
/// options that select something missing.
Result<FileInfo> inspect_recording(const std::filesystem::path& file, const ReadOptions& options = {});

/// One of the tables in a file.
struct TableInfo {
  std::string name;     ///< of the sheet or variable; empty where the file is one table
  ReadOptions options;  ///< that read it
  Result<FileInfo> info;
};

/// Inspects each table of a file (sheets of a workbook, files of an archive, groups of HDF5 or TDMS, structures of
/// MATLAB), which is opened and read once; a sheet or variable in `options` selects one. `FileInfo::recording` is
/// empty. Errors: those of files that cannot be opened.
Result<std::vector<TableInfo>> inspect_tables(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace slipfit
