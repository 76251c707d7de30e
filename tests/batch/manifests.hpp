#pragma once

#include <string>
#include <vector>

#include "run_program.hpp"

namespace test {

/// A folder with `recordings` simulated recordings r0.csv, r1.csv, ... of different lengths and runs.csv that lists
/// them, in the groups g0, g1 and none in turn.
class BatchScene {
 public:
  explicit BatchScene(std::size_t recordings);

  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path(name); }
  [[nodiscard]] std::string manifest() const { return path("runs.csv"); }
  /// Another manifest in the same folder.
  [[nodiscard]] std::string file(const std::string& name, const std::string& content) const {
    return folder_.file(name, content);
  }

 private:
  TemporaryFolder folder_;
};

/// Runs `slipfit batch MANIFEST --out OUT` and more.
ProgramResult batch(const std::string& manifest, const std::string& out, const std::vector<std::string>& more = {});

/// The three files that must not depend on how the batch went.
struct BatchFiles {
  std::string results, summary, failures;
  friend bool operator==(const BatchFiles&, const BatchFiles&) = default;
};
BatchFiles files_in(const std::string& folder);

std::vector<std::string> lines_of(const std::string& text);

}  // namespace test
