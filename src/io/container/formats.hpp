#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/file_handle.hpp"
#include "core/platform.hpp"
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

// What each kind of container takes to become text. Without the library that a kind needs the error is not_built_in and
// names Debian's package.

namespace slipfit::reading {

/// A function that opens a container. `packed` contains the bytes of the whole file, which are read once; messages show
/// `name`.
using OpenFormat = TextStream(TextStream packed, const std::string& name, const ContainerChoice& choice);

/// Visits all tables of the container.
using VisitFormat = void(TextStream packed, const std::string& name, const TableVisitor& visit);
VisitFormat visit_zip;
VisitFormat visit_tdms;
VisitFormat visit_hdf5;
VisitFormat visit_mat;

/// Unpacked while it is read. Error: not_built_in.
OpenFormat open_gzip;

/// A zip archive with one text file, or a workbook. Errors: not_built_in, damaged_container, container_too_large,
/// unknown_sheet.
OpenFormat open_zip;

/// Opens a TDMS file. Errors: damaged_container, container_too_large, unknown_variable, daqmx_channels.
OpenFormat open_tdms;

/// HDF5 and MATLAB 7.3; MATLAB 5 to 7. Errors: not_built_in, damaged_container, container_too_large, unknown_variable.
OpenFormat open_hdf5;
OpenFormat open_mat;

/// An array of numbers that NumPy saved (.npy). Errors: damaged_container, container_too_large.
OpenFormat open_npy;

/// The binary format of before 2007. Error: old_workbook.
OpenFormat open_old_workbook;

/// Returns all bytes, for formats that are read in no fixed order. Error: container_too_large.
std::string read_all(TextStream& packed, const std::string& name);

/// A program of slipfit that reads what needs large libraries: its name, and what it takes to be built.
struct Helper {
  std::string program;
  std::vector<std::string> arguments;                                ///< the input as kFileOfHelper
  std::string kind;                                                  ///< of file, for messages
  std::string package;                                               ///< of Debian
  std::chrono::milliseconds longest_wait = std::chrono::minutes(4);  ///< for its output, in total; then it is killed
};

inline constexpr const char* kFileOfHelper = platform::kFileOfDescriptor3;

struct HelperOutput {
  std::string first;  ///< line, behind its "="
  std::unique_ptr<ByteStream> bytes;
};

/// The program gets all bytes of `input` as a file in memory. Errors: not_built_in, damaged_container,
/// container_too_large, not_readable, that of its first line ("!CODE MESSAGE").
HelperOutput run_helper(const Helper& helper, TextStream input, const std::string& name);

ThrownError damaged(const std::string& name, const std::string& what);
ThrownError too_large(const std::string& name);
ThrownError not_built_in(const std::string& name, const std::string& kind, const std::string& package);

/// Returns true if `unpacked` bytes are out of proportion to the `packed` bytes from which they come: deflate
/// compresses by a factor of 1000 at most, and recordings by about 10.
constexpr bool is_bomb(std::uintmax_t unpacked, std::uintmax_t packed) {
  constexpr std::uintmax_t kSmall = std::uintmax_t{64} << 20U;
  constexpr std::uintmax_t kHighestRatio = 200;
  return unpacked > kSmall && unpacked / kHighestRatio > packed;
}

/// Counts what a file is unpacked to and compares it with the bytes that the file has. The sizes that an archive states
/// do not enter.
class UnpackingLimit {
 public:
  explicit UnpackingLimit(std::string file, std::uintmax_t packed = 0) : file_(std::move(file)), packed_(packed) {}

  void add_packed(std::uintmax_t bytes) { packed_ += bytes; }
  /// Counts decompressed bytes. Error: container_too_large.
  void add_unpacked(std::uintmax_t bytes) {
    unpacked_ += bytes;
    if (is_bomb(unpacked_, packed_)) throw too_large(file_);
  }

 private:
  std::string file_;
  std::uintmax_t packed_;
  std::uintmax_t unpacked_ = 0;
};

}  // namespace slipfit::reading
