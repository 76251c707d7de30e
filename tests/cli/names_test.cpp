// Names of files and columns are bytes that others chose: no terminal may be moved, recoloured or misled by them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "recordings.hpp"
#include "run_program.hpp"
#include "slipfit/core/printable.hpp"

namespace {

/// Line break, ESC, C1, overriding direction, line separator, zero width, and a byte that is not UTF-8.
constexpr const char* kName = "a\n\x1b[2J\xc2\x9b\xe2\x80\xae\xe2\x80\xa8\xe2\x80\x8b\xff.csv";
constexpr const char* kShown = "a\\n\\u001b[2J\\u009b\\u202e\\u2028\\u200b\\xff.csv";

std::string recording_with(const std::string& force_name) {
  std::string csv = test::simulated_csv("7");
  const std::size_t at = csv.find("force_N");
  return csv.replace(at, 7, force_name);
}

/// Runs slipfit and returns all that it wrote.
std::string written(const std::vector<std::string>& arguments, int exit_code) {
  const test::ProgramResult result = test::run_slipfit(arguments);
  CAPTURE(arguments, result.err);
  CHECK(result.exit_code == exit_code);
  return result.out + result.err;
}

}  // namespace

TEST_CASE("names of files and columns reach terminal and page without control and format characters") {
  const test::TemporaryFolder folder;
  const std::string recording = folder.file(kName, recording_with("F\x1b[31m\xe2\x80\xae_N"));
  const std::string none = folder.path(std::string("none") + kName);
  const std::string fit = folder.path(std::string(kName) + ".json");
  const std::string page = folder.path("page.html");
  const auto check = [](const std::vector<std::string>& arguments, int exit_code = 0) {
    const std::string text = written(arguments, exit_code);
    CAPTURE(arguments, text);
    CHECK(slipfit::printable_lines(text) == text);
    const bool is_json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    if (is_json) return;  // escaped as JSON demands
    CHECK_THAT(text, Catch::Contains("a\\n\\u001b[2J\\u009b\\u202e\\u2028\\u200b\\xff"));
  };
  check({"info", recording});
  check({"info", recording, "--json"});
  check({"analyze", recording, "--speed", "20mm/s"});
  check({"fit", recording, "--speed", "20mm/s", "--zero", "0", "--report", page});
  check({"fit", recording, "--speed", "20mm/s", "--json"});
  check({"fit", recording, "--speed", "20mm/s", "--zero", "0", "--json", "--out", fit});
  check({"predict", fit, "--speeds", "0.1"});
  check({"predict", fit, "--speeds", "0.1", "--json"});
  check({"plan", fit});
  check({"compare", fit, fit});
  check({"fit", none, "--speed", "20mm/s"}, 3);
  check({"surface", none}, 3);
  check({"predict", none, "--speeds", "1"}, 2);
  check({"batch", none, "--out", folder.path("out")}, 2);
  check({"merge", none, "--out", folder.path("out")}, 2);
  check({"fit", recording, "--speed", "20mm/s", "--out", folder.path("missing/" + std::string(kName))}, 2);
  check({"fit", recording, "--speed", "20mm/s", "--force-column", kName}, 3);
  const auto document = nlohmann::json::parse(test::content_of(fit));
  CHECK_THAT(document["recording"]["file"].get<std::string>(), Catch::EndsWith(kShown));
  const std::string html = test::content_of(page);
  CHECK_THAT(html, Catch::Contains("\\u202e\\u2028\\u200b\\xff.csv"));
  for (const char* const bytes : {"\xff", "\xe2\x80\xae", "\xc2\x9b"}) CHECK_THAT(html, !Catch::Contains(bytes));
}
