#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace test {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal where a signal ended it
  std::string out;
  std::string err;
};

/// Runs a program without a shell and waits for it.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments);

/// Runs the slipfit executable of this build.
ProgramResult run_slipfit(const std::vector<std::string>& arguments);

/// A folder of its own, removed at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// Writes the file and returns its path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& content) const;
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  std::filesystem::path folder_;
};

std::string content_of(const std::string& file);
std::size_t lines_in(const std::string& text);
std::size_t widest_line(const std::string& text);  ///< in characters

}  // namespace test
