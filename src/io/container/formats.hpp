#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "core/platform.hpp"
#include "io/container/byte_stream.hpp"

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

}  // namespace slipfit::reading
