#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/file_handle.hpp"
#include "core/thrown_error.hpp"
#include "slipfit/core/digest.hpp"
#include "slipfit/core/estimate.hpp"

namespace slipfit::reading {

/// Bytes one after another.
class ByteStream {
 public:
  ByteStream() = default;
  virtual ~ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  /// Fewer than `size` at the end only. Throws std::system_error where the disk fails, ThrownError
  /// where a container turns out to be damaged, or far larger than a recording.
  virtual std::size_t read(char* buffer, std::size_t size) = 0;
};

/// Returns all bytes, or nothing if there are more than `most`.
std::optional<std::string> read_all(ByteStream& stream, std::size_t most);

/// The part of a container that is the recording.
struct ContainerChoice {
  std::optional<std::string> sheet;     ///< of a workbook, or the file of a zip archive: name or 1-based number
  std::optional<std::string> variable;  ///< of a .mat file, dataset of HDF5, group of TDMS
};

/// The option that selects a table of a file: a sheet, a variable, or none because there is only one table.
enum class TableKind { One, Sheet, Variable };

/// The text in a file, whatever it is packed in.
struct TextStream {
  std::unique_ptr<ByteStream> bytes;
  std::shared_ptr<const Digester> digester;  ///< of the bytes of the file itself
  std::size_t size = 0;                      ///< of the text; 0 where it is not known
  std::string start;                         ///< first bytes of the file, which are still to be read
  std::shared_ptr<const FileHandle> memory;  ///< all bytes as a file without a name, where they are kept so
  std::vector<std::string> assumed;          ///< sentences about the container
  std::vector<std::string> tables;           ///< that a choice can name
  TableKind table_kind = TableKind::One;
  Warnings warnings;
};

/// The bytes of a file, or for "-" of standard input, as they are. Errors: file_not_found, is_directory, not_readable.
TextStream open_plain(const std::filesystem::path& file);

/// A file that open_plain opened, unpacked where the first bytes say that it is a container; `name`: as messages show
/// it. Errors: those of containers, no_container.
TextStream unpacked(TextStream file, const std::string& name, const ContainerChoice& choice);

/// A table of a container, as a choice names it. `open` unpacks it; its errors are those of containers.
struct PackedTable {
  std::string name;
  std::function<TextStream()> open;
};

/// Called with the tables of a container one after another; the text of one is not read after the call.
using TableVisitor = std::function<void(const PackedTable& table)>;

/// Returns the kind of tables in a file that open_plain opened.
TableKind table_kind_of(const TextStream& file);

/// Visits the tables of a container, whose bytes are read once. Errors: those of containers.
void visit_tables(TextStream file, const std::string& name, const TableVisitor& visit);

}  // namespace slipfit::reading
