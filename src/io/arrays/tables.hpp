#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/thrown_error.hpp"
#include "io/container/table_text.hpp"

namespace slipfit::reading {

/// A defect of a file; the message does not contain its name.
class Refusal : public ThrownError {
 public:
  using ThrownError::ThrownError;
};

/// An array of numbers in a file, by its extents: one of them is 1 for a vector.
struct ArrayShape {
  std::string name;   ///< what --variable takes
  std::string group;  ///< what holds it: a group, a structure; empty for the file
  std::uint64_t rows = 1;
  std::uint64_t columns = 1;
  std::vector<std::string> fields;  ///< of a table of named columns

  [[nodiscard]] bool is_vector() const { return fields.empty() && (rows == 1 || columns == 1); }
  [[nodiscard]] std::uint64_t length() const { return fields.empty() && columns > rows ? columns : rows; }
  [[nodiscard]] std::uint64_t width() const {
    return fields.empty() ? (columns > rows ? rows : columns) : fields.size();
  }
};

/// Arrays that are a table together: one array, or the vectors of one length in one group.
struct TableShape {
  std::string name;
  std::vector<ArrayShape> arrays;
};

/// The one that --variable names (an array, or a group), else the one with the most numbers in at least two columns,
/// else the longest vector. Throws Refusal.
TableShape choose_table(const std::vector<ArrayShape>& arrays, const std::optional<std::string>& variable,
                        std::uint64_t file_size);

/// Returns true if --variable WANTED names `name`: "/run/force" is also "run/force" and, as MATLAB writes it,
/// "run.force".
bool is_called(const std::string& name, std::string wanted);

/// The columns of an array that is stored row by row, or column by column; the longer extent is that of the
/// rows.
void add_columns(NumberTable& table, const ArrayShape& shape, const std::vector<double>& values,
                 const std::string& name);

/// Returns the names of the tables that --variable can name, each once, from which a recording can be made: at least
/// two columns and 16 rows; without any, the name of the table that choose_table takes. None is too large.
std::vector<std::string> recordable_tables(const std::vector<ArrayShape>& arrays, std::uint64_t file_size);

/// A table that was read, and its name.
struct ReadTable {
  NumberTable table;
  std::string name;
};

/// A file of arrays that is open. Both functions throw Refusal.
struct ArrayFile {
  std::function<ReadTable(const std::optional<std::string>& variable)> read;
  std::function<std::vector<std::string>()> tables;  ///< returns the names of recordable_tables
};

/// Opens the bytes of a file, which must outlive the result. Throws Refusal.
using OpenArrays = ArrayFile(std::string_view file);

OpenArrays open_mat_arrays;   ///< MATLAB 5 to 7
OpenArrays open_hdf5_arrays;  ///< HDF5, which MATLAB 7.3 writes, too

}  // namespace slipfit::reading
