#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recordings.hpp"
#include "run_program.hpp"

namespace test {

/// A fit document of a simulated recording: zeta 0.05, F_s 6 N, F_k 4 N, V_c 0.44 m/s.
struct FitExample {
  TemporaryFolder folder;
  std::string recording = folder.file("run.csv", simulated_csv("7"));
  std::string fit = folder.path("fit.json");

  explicit FitExample(const std::vector<std::string>& options = {"--zero", "0"});
  [[nodiscard]] nlohmann::json document() const { return nlohmann::json::parse(content_of(fit)); }
};

/// The same model as options.
std::vector<std::string> model_options();

}  // namespace test
