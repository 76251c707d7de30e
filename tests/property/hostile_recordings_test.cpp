// Recordings that ended the program or kept it busy without end.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "document_rules.hpp"
#include "run_program.hpp"

namespace {

void check_answer(const std::vector<std::string>& arguments) {
  const test::ProgramResult result = test::run_slipfit(arguments);
  CAPTURE(arguments, result.err);
  REQUIRE(result.exit_code == 0);
  const auto document = nlohmann::json::parse(result.out, nullptr, false);
  REQUIRE(document.is_object());
  if (arguments.front() == "fit") CHECK(test::breaches_of(document).empty());
}

std::string recording(const std::string& name) {
  return (std::filesystem::path(SLIPFIT_TESTDATA_DIR).parent_path() / "tests/property/recordings" / name).string();
}

/// Empty where it is not beside the checkout.
std::string shared(const std::string& name) {
  const auto path = std::filesystem::path(SLIPFIT_SHARED_DIR) / "data/hostile" / name;
  if (std::filesystem::exists(path)) return path.string();
  WARN("skipped: no " << name << " beside the checkout");
  return {};
}

}  // namespace

TEST_CASE("outliers of the weakening law that leave no cycle end that law, not the program") {
  check_answer({"fit", recording("outliers_leave_no_cycle.csv"), "--speed", "10mm/s", "--json"});
}

TEST_CASE("the same in a comparison and in a sweep") {
  const std::string first = shared("joint100/0.csv");
  if (first.empty()) return;
  check_answer({"compare", first, shared("joint100/1.csv"), "--speed", "0.02", "--json"});
  check_answer({"fit", "--joint", shared("joint232/m.csv"), "--json"});
}

TEST_CASE("an average that lasts many slips does not keep a sweep busy") {
  const std::string manifest = shared("joint430/m.csv");
  if (manifest.empty()) return;
  check_answer({"fit", "--joint", manifest, "--tier", "velocity", "--json"});
}
