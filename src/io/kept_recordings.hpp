#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/container/formats.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/named_recording.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// Opens a file of many tables once for several of them: it stays open until another one is opened, or it has changed.
class KeptFile {
 public:
  /// Opens a file; messages show `name`. Errors: those of open_plain and open_container.
  Container open(const std::filesystem::path& file, const std::string& name, const ReadOptions& options);

 private:
  std::filesystem::path path_;
  std::uintmax_t size_ = 0;
  std::filesystem::file_time_type changed_;
  std::optional<Container> file_;
};

/// Reads pieces like slipfit::read_pieces; consecutive rows that name tables of one file open it once.
Result<std::vector<NamedRecording>> read_pieces(KeptFile& kept, const std::filesystem::path& file,
                                                const Conditions& conditions, const ReadOptions& options);

/// Reads a recording like slipfit::read_recording.
Result<Recording> read_recording(KeptFile& kept, const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options);

}  // namespace slipfit::reading
