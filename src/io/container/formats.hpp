#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/file_handle.hpp"
#include "core/platform.hpp"
#include "core/thrown_error.hpp"
#include "slipfit/core/digest.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// Bytes one after another.
class ByteStream {
 public:
  ByteStream() = default;
  virtual ~ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  /// Returns fewer than `size` bytes only at the end. Throws std::system_error if the disk fails, ThrownError if a
  /// container turns out to be damaged, or far larger than a recording.
  virtual std::size_t read(char* buffer, std::size_t size) = 0;
};

/// Returns all bytes, or nothing if there are more than `most`.
std::optional<std::string> read_all(ByteStream& stream, std::size_t most);

/// The text in a file, whatever it is packed in.
struct TextStream {
  std::unique_ptr<ByteStream> bytes;
  std::shared_ptr<const Digester> digester;  ///< of the bytes of the file itself
  std::size_t size = 0;                      ///< of the text; 0 where it is not known
  std::string start;                         ///< first bytes of the file, which are still to be read
  std::vector<std::string> assumed;          ///< sentences about the container
  Warnings warnings;
};

/// The bytes of a file, or for "-" of standard input, as they are. Errors: file_not_found, is_directory, not_readable.
TextStream open_plain(const std::filesystem::path& file);

/// A file and the tables in it.
struct Container {
  /// Unpacks the table of this name, or without a name the one that is most likely a recording; the text of a file that
  /// is one table can be taken once.
  std::function<TextStream(const std::optional<std::string>& table)> open;
  /// Returns the names of the tables; empty if the file is one table.
  std::function<std::vector<std::string>()> tables = [] { return std::vector<std::string>(); };
  std::optional<std::string> ReadOptions::*choice = nullptr;  ///< the option that names a table; null: there is one
  std::string_view kind = {};                                 ///< "a TDMS file"
  std::shared_ptr<const Digester> digester = {};              ///< of the bytes of the file
};

/// Opens a file of which open_plain has read the beginning, as the container that its first bytes announce; messages
/// show `name`. The bytes of a file of several tables are read once. Errors: those of containers and table_in.
Container open_container(TextStream file, const std::string& name, const ReadOptions& options);

/// Returns the text of the table that the options select. Errors: those of containers; no_container if they select a
/// table of another kind of file.
TextStream table_in(const Container& container, const std::string& name, const ReadOptions& options);

// Converters to text, one for each kind of container. Without the library that a kind needs the error is not_built_in
// and names Debian's package.

/// A function that opens a container. `packed` contains the bytes of the whole file, which are read once; messages show
/// `name`.
using OpenFormat = Container(TextStream packed, const std::string& name);

/// Returns a file that is one table.
Container one_table(TextStream text);

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
  std::string first;  ///< line, after its "="
  std::unique_ptr<ByteStream> bytes;
};

/// Starts the program with `input` as kFileOfHelper. Errors: not_built_in, damaged_container, not_readable, that of its
/// first line ("!CODE MESSAGE").
HelperOutput run_helper(const Helper& helper, const FileHandle& input, const std::string& name);

/// Writes all bytes of a stream into a file without a name, as helpers need it: their libraries read in any order, and
/// the bytes may come through a pipe. Error: container_too_large.
FileHandle file_in_memory(ByteStream& stream, const std::string& name);

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
