#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/container/byte_stream.hpp"
#include "slipfit/core/result.hpp"

// What each kind of container takes to become text. Without the library that a kind needs the error is not_built_in and
// names Debian's package.

namespace slipfit::reading {

/// A container that is read here and there.
struct ContainerFile {
  std::filesystem::path path;
  std::string name;  ///< as messages show it
  std::uintmax_t size = 0;
};

/// While it is read. Error: not_built_in.
Result<TextStream> unpack_gzip(TextStream packed, const std::string& name);

/// A zip archive with one text file, or a workbook. Errors: not_built_in, damaged_container, container_too_large,
/// unknown_sheet.
Result<TextStream> open_zip(const ContainerFile& file, const ContainerChoice& choice);

/// Errors: damaged_container, container_too_large, unknown_variable, daqmx_channels.
Result<TextStream> open_tdms(const ContainerFile& file, const ContainerChoice& choice);

/// HDF5 and MATLAB 7.3; MATLAB 5 to 7. Errors: not_built_in, damaged_container, container_too_large, unknown_variable.
Result<TextStream> open_hdf5(const ContainerFile& file, const ContainerChoice& choice);
Result<TextStream> open_mat(const ContainerFile& file, const ContainerChoice& choice);

/// The binary format of before 2007. Error: old_workbook.
Result<TextStream> open_old_workbook(const ContainerFile& file, const ContainerChoice& choice);

/// A program beside this one that reads what needs large libraries: its name, and what it takes to be built.
struct Helper {
  std::string program;
  std::vector<std::string> arguments;
  std::string kind;     ///< of file, for messages
  std::string package;  ///< of Debian
};

struct HelperOutput {
  std::string first;  ///< line, behind its "="
  std::unique_ptr<ByteStream> bytes;
};

/// Errors: not_built_in, damaged_container, that of its first line ("!CODE MESSAGE").
Result<HelperOutput> run_helper(const Helper& helper, const std::string& name);

Error damaged(const std::string& name, const std::string& what);
Error too_large(const std::string& name);
Error not_built_in(const std::string& name, const std::string& kind, const std::string& package);

}  // namespace slipfit::reading
