#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/file_handle.hpp"
#include "io/container/formats.hpp"

namespace slipfit::reading {

/// Writes all bytes of a stream into a file without a name; messages show `name`. Error: container_too_large.
FileHandle file_in_memory(ByteStream& stream, const std::string& name);

/// Opens a file of many tables once for several of them: its bytes and their digest stay in memory until another file
/// is opened, or the file has changed.
class KeptFile {
 public:
  /// Opens a file like open_plain; it can also fail with container_too_large.
  TextStream open(const std::filesystem::path& file);

 private:
  struct Bytes {
    FileHandle memory;
    std::shared_ptr<const Digester> digester;
    std::string start;
  };
  std::filesystem::path path_;
  std::uintmax_t size_ = 0;
  std::filesystem::file_time_type changed_;
  std::shared_ptr<const Bytes> bytes_;
};

}  // namespace slipfit::reading
