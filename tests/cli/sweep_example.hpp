#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_program.hpp"

namespace test {

/// A manifest with three recordings of the model of fit_example.hpp, group "pad": slow, middle, fast; and the group
/// "contact" of the same files seen by another sensor.
struct SweepExample {
  TemporaryFolder folder;
  std::string manifest = folder.path("manifest.csv");
  std::string out = folder.path("joint.json");

  SweepExample();
  /// slipfit fit --joint with these options; its document, which stands in `out`.
  [[nodiscard]] nlohmann::json fit(const std::vector<std::string>& options) const;
};

}  // namespace test
