#include "fit_example.hpp"

#include <catch2/catch.hpp>

namespace test {

FitExample::FitExample(const std::vector<std::string>& options) {
  std::vector<std::string> arguments{"fit", recording, "--speed", "20mm/s", "--json", "--out", fit, "--quiet"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const ProgramResult result = run_slipfit(arguments);
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
}

std::vector<std::string> model_options() {
  return {"--stiffness",       "1000", "--natural-frequency", "200", "--damping-ratio", "0.05",
          "--static-friction", "6",    "--kinetic-friction",  "4"};
}

}  // namespace test
