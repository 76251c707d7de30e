#include <catch2/catch.hpp>

#include "recordings.hpp"
#include "run_program.hpp"

using Catch::Contains;
using test::run_slipfit;

namespace {

struct RunWithPage {
  test::TemporaryFolder folder;
  std::string recording = folder.file("run.csv", test::simulated_csv("7"));
  std::string page = folder.path("run.html");
};

}  // namespace

TEST_CASE("fit --report writes one page in addition to the usual output, the same bytes every time") {
  const RunWithPage example;
  const std::vector<std::string> arguments{"fit", example.recording, "--speed", "20mm/s", "--report", example.page};
  const test::ProgramResult first = run_slipfit(arguments);
  REQUIRE(first.exit_code == 0);
  CHECK_THAT(first.out, Contains("stick-slip"));
  CHECK_THAT(first.err, Contains("wrote '" + example.page + "'"));
  const std::string page = test::content_of(example.page);
  CHECK_THAT(page, Contains("<p class=\"headline\">Stick-slip at ") && Contains("--speed 20mm/s --report"));
  REQUIRE(run_slipfit(arguments).exit_code == 0);
  CHECK(test::content_of(example.page) == page);
}

TEST_CASE("fit --plots writes the charts as SVG into a folder that it makes") {
  const RunWithPage example;
  const std::string plots = example.folder.path("plots");
  REQUIRE(run_slipfit({"fit", example.recording, "--speed", "20mm/s", "--plots", plots, "--quiet"}).exit_code == 0);
  for (const char* name :
       {"trace", "spectrum", "cycles", "residuals", "evolution", "pairs", "map", "speed", "pattern"}) {
    CAPTURE(name);
    const std::string picture = test::content_of(plots + "/" + name + ".svg");
    CHECK(picture.rfind("<svg xmlns=", 0) == 0);
    CHECK_THAT(picture, Catch::EndsWith("</svg>\n") && !Contains("nan"));
  }
}

TEST_CASE("analyze has a report too, without a fit") {
  const RunWithPage example;
  REQUIRE(run_slipfit({"analyze", example.recording, "--speed", "20mm/s", "--report", example.page}).exit_code == 0);
  CHECK_THAT(test::content_of(example.page), Contains("the model was not fitted"));
}

TEST_CASE("charts into a file in place of a folder are refused before any work") {
  const RunWithPage example;
  const test::ProgramResult refused =
      run_slipfit({"fit", example.recording, "--speed", "20mm/s", "--plots", example.recording});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Contains("--plots") && Contains("expected a folder"));
}
