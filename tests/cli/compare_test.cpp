// slipfit compare: what A and B may be, what it says of them, what is refused.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "json_of.hpp"
#include "recordings.hpp"
#include "refusal.hpp"
#include "run_program.hpp"

using nlohmann::json;
using test::check_refused;
using test::run_slipfit;
using test::simulated_csv;

namespace {

json compared(std::vector<std::string> sides) {
  sides.insert(sides.begin(), "compare");
  return test::json_of(sides, {"--json", "--quiet"});
}

}  // namespace

TEST_CASE("compare takes recordings, several of them, fit documents, manifests and folders of a batch") {
  const test::TemporaryFolder folder;
  std::vector<std::string> runs;
  std::string manifest = "id,file,speed_m_per_s,group\n";
  for (const char* const seed : {"1", "2", "3", "4"}) {
    const std::string name = std::string("run") + seed;
    runs.push_back(folder.file(name + ".csv", simulated_csv(seed)));
    manifest += name + "," + name + ".csv,0.02," + (runs.size() <= 2 ? "dry" : "wet") + "\n";
  }
  const std::string list = folder.file("runs.csv", manifest);
  const json single = compared({runs[0], runs[1], "--speed", "20mm/s"});
  const json& stiffness = single["quantities"]["stiffness_N_per_m"];
  CHECK(stiffness["method"] == "standard_errors");
  CHECK(stiffness["ratio"]["value"].get<double>() == Approx(1.0).epsilon(0.01));
  CHECK(single["warnings"][0]["code"] == "scatter_unknown");

  std::vector<std::string> fits;
  for (const std::string& run : {runs[0], runs[1]}) {
    fits.push_back(run + ".json");
    REQUIRE(run_slipfit({"fit", run, "--speed", "20mm/s", "--json", "--quiet", "--out", fits.back()}).exit_code == 0);
  }
  CHECK(compared({fits[0], fits[1]})["quantities"] == single["quantities"]);

  const json several = compared({"--a", runs[0], runs[1], "--b", runs[2], runs[3], "--speed", "20mm/s"});
  CHECK(several["quantities"]["stiffness_N_per_m"]["method"] == "welch");
  CHECK(several["quantities"]["stiffness_N_per_m"]["a"]["recordings"] == 2);
  CHECK(compared({list, "--group", "dry", "--group", "wet"})["quantities"] == several["quantities"]);

  const std::string results = folder.path("results");
  REQUIRE(run_slipfit({"batch", list, "--out", results, "--joint-groups", "--quiet"}).exit_code == 0);
  const json of_batch = compared({results, "--group", "dry", "--group", "wet"});
  CHECK(of_batch["quantities"] == several["quantities"]);
  CHECK(of_batch["a"]["name"] == "dry");
  check_refused({"compare", results, "--group", "dry", "--group", "icy"}, "icy");
}

TEST_CASE("compare writes text and a page with the cycles of both sides") {
  const test::TemporaryFolder folder;
  const std::string a = folder.file("a_20mmps.csv", simulated_csv("1"));
  const std::string b = folder.file("b_20mmps.csv", simulated_csv("2"));
  const std::string page = folder.path("page.html");
  const test::ProgramResult result = run_slipfit({"compare", a, b, "--report", page});  // speeds by the files' names
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.out, Catch::Contains("A: a_20mmps (one recording, stick-slip, 20 mm/s)") &&
                             Catch::Contains("tangential stiffness k [N/m]") && Catch::Contains("scatter_unknown"));
  CHECK(test::widest_line(result.out) <= 100);
  const std::string content = test::content_of(page);
  CHECK_THAT(content,
             Catch::Contains("id=\"cycles\"") && Catch::Contains("B / A") && Catch::Contains("slipfit compare"));
}

TEST_CASE("compare refuses what it cannot do, in one line") {
  const test::TemporaryFolder folder;
  const std::string run = folder.file("run.csv", simulated_csv("1"));
  check_refused({"compare", run}, "two sides are compared");
  check_refused({"compare", run, run}, "no speed in a column or in the file's name");
  check_refused({"compare", run, run, "--speed", "1", "--speed", "2", "--speed", "3"}, "--speed");
  check_refused({"compare", run, run, "--speed", "20mm/s", "--out", run}, "is the recording itself");
  check_refused({"compare", folder.file("bad.json", "{\"schema\": 1}"), run, "--speed", "20mm/s"},
                "schema is 1, expected a text");
  const test::ProgramResult missing = run_slipfit({"compare", run, folder.path("none.csv"), "--speed", "20mm/s"});
  CHECK(missing.exit_code == 3);
  CHECK_THAT(missing.err, Catch::Contains("none.csv"));
  CHECK(test::lines_in(missing.err) == 1);
}
