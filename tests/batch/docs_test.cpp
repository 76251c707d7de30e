#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "batch/tables.hpp"
#include "io/cells.hpp"
#include "manifests.hpp"

using test::BatchScene;

namespace {

std::string formats() {
  return test::content_of((std::filesystem::path(SLIPFIT_TESTDATA_DIR).parent_path() / "docs/formats.md").string());
}

std::string quoted(const std::string& name) {
  return "`" + name + "`";
}

}  // namespace

TEST_CASE(
    "docs/formats.md names every column of summary.csv but bounds and errors of parameters, and every key of "
    "run.json") {
  const std::string text = formats();
  const auto columns = slipfit::reading::csv_fields(slipfit::batch::summary_names(), ',');
  REQUIRE(columns);
  CHECK(columns->size() > 60);
  for (const std::string& column : *columns) {
    const bool is_bound = column.find("_low") != std::string::npos || column.find("_high") != std::string::npos ||
                          column.find("_se") != std::string::npos || column.find("_status") != std::string::npos;
    if (!is_bound) CHECK_THAT(text, Catch::Contains(quoted(column)));
  }
  const BatchScene scene(1);
  REQUIRE(test::batch(scene.manifest(), scene.path("out")).exit_code == 0);
  const auto record = nlohmann::json::parse(test::content_of(scene.path("out/run.json")));
  for (const auto& [key, value] : record.items()) CHECK_THAT(text, Catch::Contains(quoted(key)));
}

TEST_CASE("a row of summary.csv agrees with its document") {
  const BatchScene scene(3);
  REQUIRE(test::batch(scene.manifest(), scene.path("out")).exit_code == 0);
  const auto document = nlohmann::json::parse(test::lines_of(test::files_in(scene.path("out")).results).at(1));
  const auto lines = test::lines_of(test::files_in(scene.path("out")).summary);
  const auto names = slipfit::reading::csv_fields(lines.at(0), ',').value();
  const auto cells = slipfit::reading::csv_fields(lines.at(2), ',').value();
  const auto cell = [&](const std::string& name) {
    const auto place = std::find(names.begin(), names.end(), name);
    REQUIRE(place != names.end());
    return cells.at(static_cast<std::size_t>(place - names.begin()));
  };
  REQUIRE(names.size() == cells.size());
  const auto& stiffness = document["parameters"]["stiffness_N_per_m"];
  const auto text = [](const nlohmann::json& value) { return value.get<std::string>(); };
  CHECK(cell("row") == "2");
  CHECK(cell("id") == "r1");
  CHECK(cell("group") == "g1");
  CHECK(cell("file") == scene.path("r1.csv"));
  CHECK(cell("status") == text(document["status"]));
  CHECK(std::stod(cell("frequency_Hz")) == document["frequency"]["value_Hz"]);
  CHECK(std::stod(cell("frequency_low_Hz")) == document["frequency"]["ci95_Hz"][0]);
  CHECK(std::stod(cell("stiffness_N_per_m")) == stiffness["value"]);
  CHECK(std::stod(cell("stiffness_high_N_per_m")) == stiffness["ci95"][1]);
  CHECK(cell("stiffness_status") == text(stiffness["status"]));
  CHECK(std::stod(cell("pattern_spacing_low_m")) == document["derived"]["pattern_spacing_m"]["ci95"][0]);
  CHECK(cell("tier") == text(document["model"]["tier"]));
  CHECK(cell("measured_spacing_En").empty());
  CHECK(cell("error").empty());
}
