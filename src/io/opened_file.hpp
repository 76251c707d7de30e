#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "io/columns.hpp"
#include "io/layout.hpp"
#include "io/rows.hpp"
#include "io/text_source.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/read_options.hpp"
#include "slipfit/io/samples.hpp"

// In this folder errors are thrown (ThrownError); the functions that users call return them.

namespace slipfit::reading {

/// A file, what was asked for, and what is known of it so far.
struct OpenedFile {
  std::string name;  ///< as messages show it
  ReadOptions options;
  std::unique_ptr<TextSource> source;  ///< until the rows are read
  Warnings warnings;                   ///< of what the text was packed in
  Layout layout;
  Choice choice;
  Rows rows;
};

/// Unpacks the table that the options select and finds its layout; messages show `name`. Errors: those of table_in and
/// TextSource, no_numeric_column, line_too_long, empty_file.
OpenedFile open_file(const Container& container, const std::string& name, const ReadOptions& options);

/// Reads the rows of the chosen columns. With a window of the options that comes before the steps, what lies outside is
/// not even kept.
void load_rows(OpenedFile& file);

/// The samples as a file of two columns whose rows are read. Errors: length_mismatch, no_time_column, those of
/// choose_columns and check_options.
OpenedFile load_samples(Samples samples, const ReadOptions& options);

/// The rows of --rows and --window that cannot be. Errors: bad_window, bad_rows, bad_sample_rate.
void check_options(const ReadOptions& options, const std::string& file);

/// The exception in flight as an error. Errors: line_too_long, out_of_memory, not_readable.
Error error_of_reading(const std::string& file);

/// Returns the value of `read()`; an exception (ThrownError), the disk, the memory or an endless line becomes an error.
template <class Read>
auto with_errors_of_reading(const std::string& file, const Read& read) -> Result<decltype(read())> {
  try {
    return read();
  } catch (...) {
    return error_of_reading(file);
  }
}

}  // namespace slipfit::reading
