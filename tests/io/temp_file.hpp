#pragma once

#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "slipfit/io/recording_reader.hpp"
#include "support/recordings.hpp"

namespace io_test {

/// A file with the given bytes in a folder of its own; both go with it.
class TempFile {
 public:
  explicit TempFile(std::string_view content, const std::string& name = "run7.csv") {
    static int count = 0;
    folder_ = std::filesystem::temp_directory_path() /
              ("slipfit-io-" + std::to_string(getpid()) + "-" + std::to_string(++count));
    std::filesystem::create_directories(folder_);
    path_ = folder_ / name;
    std::ofstream(path_, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
  }
  ~TempFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path path_;
};

inline slipfit::Conditions at_speed(double speed_m_per_s) {
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  return conditions;
}

inline slipfit::Result<slipfit::Recording> read(std::string_view content, const slipfit::ReadOptions& options = {},
                                                const slipfit::Conditions& conditions = at_speed(1e-3)) {
  const TempFile file(content);
  return slipfit::read_recording(file.path(), conditions, options);
}

inline slipfit::Recording read_ok(std::string_view content, const slipfit::ReadOptions& options = {},
                                  const slipfit::Conditions& conditions = at_speed(1e-3)) {
  auto recording = read(content, options, conditions);
  INFO((recording.ok() ? std::string() : recording.error().message));
  REQUIRE(recording.ok());
  return std::move(recording).value();
}

/// The error, which must be one line that begins with the file and names nothing outside ASCII control-free text.
inline slipfit::Error read_error(std::string_view content, const slipfit::ReadOptions& options = {},
                                 const slipfit::Conditions& conditions = at_speed(1e-3)) {
  const auto recording = read(content, options, conditions);
  REQUIRE_FALSE(recording.ok());
  const std::string& message = recording.error().message;
  CHECK(message.find("run7.csv:") != std::string::npos);
  CHECK(std::none_of(message.begin(), message.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }));
  return recording.error();
}

inline std::vector<double> copy(std::span<const double> values) {
  return {values.begin(), values.end()};
}

inline bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

/// Whether one of the sentences of `assumed` holds all the parts.
inline bool says(const slipfit::Recording& recording, std::initializer_list<std::string_view> parts) {
  const auto& assumed = recording.provenance().assumed;
  return std::any_of(assumed.begin(), assumed.end(), [&](const std::string& sentence) {
    return std::all_of(parts.begin(), parts.end(), [&](std::string_view part) { return contains(sentence, part); });
  });
}

inline bool warns(const slipfit::Recording& recording, std::string_view code) {
  return test::warns(recording.provenance().warnings, code);
}

}  // namespace io_test
