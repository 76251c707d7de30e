#include "fit_example.hpp"

#include <catch2/catch.hpp>

namespace test {

FitExample::FitExample(const std::vector<std::string>& options) {
  std::vector<std::string> arguments{"fit", recording, "--speed", "20mm/s", "--json", "--out", fit, "--quiet"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const ProgramResult result = slipfit(arguments);
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
}

std::vector<std::string> model_options() {
  return {"--stiffness",       "1000", "--natural-frequency", "200", "--damping-ratio", "0.05",
          "--static-friction", "6",    "--kinetic-friction",  "4"};
}

void check_one_line_refusal(const std::vector<std::string>& arguments, const std::string& part) {
  const test::ProgramResult result = slipfit(arguments);
  CAPTURE(arguments, result.err);
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK(result.err.rfind("slipfit: ", 0) == 0);
  CHECK(test::lines_in(result.err) == 1);
  CHECK_THAT(result.err, Catch::Contains(part));
}

}  // namespace test
