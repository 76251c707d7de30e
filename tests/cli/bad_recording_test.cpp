#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "recordings.hpp"
#include "run_program.hpp"

using test::run_slipfit;

namespace {

/// Unreadable, or nothing usable in it: exit code 3, nothing on standard output, one line that names the file.
void check_unreadable(const std::string& file) {
  for (const std::string command : {"analyze", "fit"}) {
    const test::ProgramResult result = run_slipfit({command, file, "--speed", "10mm/s", "--json"});
    CAPTURE(command, file, result.err);
    CHECK(result.exit_code == 3);
    CHECK(result.out.empty());
    CHECK(result.err.rfind("slipfit: ", 0) == 0);
    CHECK(test::lines_in(result.err) == 1);
    CHECK_THAT(result.err, Catch::Contains(std::filesystem::path(file).filename().string()));
  }
}

/// Readable: exit code 0 and a status that does not claim stick-slip.
nlohmann::json check_answered(const std::string& file) {
  const test::ProgramResult result = run_slipfit({"fit", file, "--speed", "10mm/s", "--json", "--quiet"});
  CAPTURE(file, result.err, result.out);
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.empty());
  return nlohmann::json::parse(result.out);
}

std::string status_of(const nlohmann::json& document) {
  return document["status"].get<std::string>();
}

}  // namespace

TEST_CASE("recordings that cannot be read: exit code 3, one line") {
  const test::TemporaryFolder folder;
  std::string binary;
  for (int i = 0; i < 5000; ++i) binary.push_back(static_cast<char>((i * 7919) % 256));
  check_unreadable(folder.path("missing.csv"));
  check_unreadable(folder.path("."));
  check_unreadable(folder.file("empty.csv", ""));
  check_unreadable(folder.file("blank.csv", "\n\n  \n"));
  check_unreadable(folder.file("binary.csv", binary));
  check_unreadable(folder.file("zeros.csv", std::string(4096, '\0')));
  check_unreadable(folder.file("header-only.csv", "time_s,force_N\n"));
  check_unreadable(folder.file("one-row.csv", "time_s,force_N\n0,1\n"));
  check_unreadable(folder.file("words.csv", "name,colour\nanna,red\nbert,blue\ncarl,green\n"));
  check_unreadable(folder.file("all-nan.csv", "time_s,force_N\n0,nan\n1,nan\n2,nan\n3,nan\n"));
  check_unreadable(folder.file("time-stands.csv", "time_s,force_N\n1,1\n1,2\n1,3\n1,4\n"));
}

TEST_CASE("a name that contains a line break stays on one line") {
  const test::TemporaryFolder folder;
  const test::ProgramResult result = run_slipfit({"fit", folder.path("a\nslipfit: all is well\n.csv"), "--speed", "1"});
  CHECK(result.exit_code == 3);
  CHECK(test::lines_in(result.err) == 1);
}

TEST_CASE("a column that is not there is an error that names it") {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("run.csv", test::simulated_csv("1"));
  const test::ProgramResult result = run_slipfit({"fit", file, "--speed", "20mm/s", "--force-column", "Fz"});
  CHECK(result.exit_code == 3);
  CHECK(test::lines_in(result.err) == 1);
  CHECK_THAT(result.err, Catch::Contains("Fz"));
}

TEST_CASE("a constant force and a few samples are no data: exit code 3, one line with a remedy") {
  const test::TemporaryFolder folder;
  check_unreadable(folder.file("constant.csv", test::recording_csv(2000, 1000.0, [](double) { return 3.0; })));
  check_unreadable(folder.file("two.csv", "time_s,force_N\n0,1\n0.001,2\n"));
}

TEST_CASE("fewer than three cycles are undetermined") {
  const test::TemporaryFolder folder;
  const auto force_N = [](double time_s) { return test::sawtooth_N(time_s, 1.0); };
  const auto document = check_answered(folder.file("short.csv", test::recording_csv(1800, 1000.0, force_N)));
  CHECK(status_of(document) == "undetermined");
}

TEST_CASE("fewer than two samples a cycle never give an identified damping or natural frequency") {
  const test::TemporaryFolder folder;
  const auto force_N = [](double time_s) { return test::sawtooth_N(time_s, 1.0 / 613.0); };
  const auto document = check_answered(folder.file("aliased.csv", test::recording_csv(3000, 1000.0, force_N)));
  for (const std::string name : {"damping_ratio", "natural_frequency_rad_per_s"}) {
    const bool given = document.contains("parameters") && document["parameters"].contains(name);
    CHECK((!given || document["parameters"][name]["status"] != "identified"));
  }
}

TEST_CASE("time that runs backwards is refused, or counted and warned of") {
  const test::TemporaryFolder folder;
  const std::string reversed = folder.file("reversed.csv", "time_s,force_N\n5,1\n4,2\n3,1\n2,2\n1,1\n0,2\n");
  check_unreadable(reversed);

  std::string csv = test::recording_csv(2000, 1000.0, [](double t) { return test::sawtooth_N(t, 0.2); });
  csv += "0.5,3\n0.6,4\n";
  csv += "2.1,3\n2.101,3\n";
  const auto document = check_answered(folder.file("jumps-back.csv", csv));
  CHECK(document["recording"]["quality"]["rows_backward_in_time"] == 2);
  CHECK_FALSE(document["warnings"].empty());
}
