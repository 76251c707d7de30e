#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "recordings.hpp"
#include "run_program.hpp"
#include "sweep_example.hpp"

using test::run_slipfit;

namespace {

std::filesystem::path project_folder() {
  return std::filesystem::path(SLIPFIT_TESTDATA_DIR).parent_path();
}

/// Names of all keys that the schema describes, those of the objects "coefficient" aside: they are the others without
/// unit.
void collect_keys(const nlohmann::json& node, std::set<std::string>& keys) {
  if (!node.is_structured()) return;
  for (const auto& [name, child] : node.items()) {
    if (name == "properties") {
      for (const auto& [key, value] : child.items()) keys.insert(key);
    }
    if (name != "coefficient") collect_keys(child, keys);
  }
}

std::string schema_file(const std::string& name = "fit") {
  return (project_folder() / "docs" / (name + ".schema.json")).string();
}

/// Exit code 77 where no Python at hand has the module jsonschema: then there is nothing to test with.
test::ProgramResult validate(const std::vector<std::string>& documents, const std::string& schema = "fit") {
  std::vector<std::string> arguments{(project_folder() / "tests/cli/validate_schema.py").string(), schema_file(schema)};
  arguments.insert(arguments.end(), documents.begin(), documents.end());
  const test::ProgramResult result = test::run_program("python3", arguments);
  if (result.exit_code != 77 || !std::filesystem::exists("/usr/bin/python3")) return result;
  return test::run_program("/usr/bin/python3", arguments);  // Debian's own has the module; the first may be another one
}

}  // namespace

TEST_CASE("every kind of document obeys docs/fit.schema.json, with no key that the schema does not name") {
  const test::TemporaryFolder folder;
  const std::string run = folder.file("run.csv", test::simulated_csv("5"));
  const std::string steady = folder.file(
      "steady.csv", test::recording_csv(500, 1000.0, [](double t) { return 2.0 + 1e-3 * std::sin(1e6 * t); }));
  const std::string coefficient = folder.file("coefficient.csv", [] {
    std::string csv = test::recording_csv(4000, 1000.0, [](double t) { return 0.02 * test::sawtooth_N(t, 0.2); });
    return "time_s,COF\n" + csv.substr(csv.find('\n') + 1);
  }());
  std::vector<std::string> documents;
  const auto add = [&](const std::vector<std::string>& start) {
    documents.push_back(folder.path(std::to_string(documents.size()) + ".json"));
    std::vector<std::string> arguments = start;
    arguments.insert(arguments.end(), {"--speed", "20mm/s", "--json", "--out", documents.back()});
    const test::ProgramResult result = run_slipfit(arguments);
    CAPTURE(arguments, result.err);
    REQUIRE(result.exit_code == 0);
  };
  add({"fit", run});
  add({"fit", run, "--timing", "--normal-force", "10", "--speed-uncertainty", "1%", "--zero", "0"});
  add({"fit", run, "--tier", "sawtooth"});
  add({"fit", run, "--tier", "undamped"});
  add({"fit", run, "--fix", "damping_ratio=0.05"});
  add({"analyze", run});
  add({"fit", steady});
  add({"fit", coefficient});
  add({"fit", coefficient, "--normal-force", "10"});
  const test::SweepExample sweep;
  for (const char* const tier : {"auto", "velocity"}) {
    const std::string document = sweep.fit({"--group", "pad", "--tier", tier}).dump();
    documents.push_back(folder.file(std::string(tier) + "-joint.json", document));
  }
  documents.push_back(folder.file("no-joint.json", sweep.fit({"--only", "slow"}).dump()));
  const test::ProgramResult result = validate(documents);
  CAPTURE(result.out, result.err);
  if (result.exit_code == 77) WARN("skipped: python3-jsonschema is not installed");
  CHECK((result.exit_code == 0 || result.exit_code == 77));
}

TEST_CASE("the document of info obeys docs/info.schema.json, also for a file that fit would refuse") {
  const test::TemporaryFolder folder;
  std::string steps = "Step,time [s],Fx [N],Fz [N],speed [mm/s]\n";
  for (int i = 0; i < 90; ++i) {
    steps += std::to_string(1 + i / 30) + "," + std::to_string(i % 30) + "," + std::to_string(i % 4) + ",2," +
             std::to_string(1 + i / 30) + "\n";
  }
  std::vector<std::string> documents;
  for (const std::string& text : {steps, test::simulated_csv("5"), std::string("a,b,c\n1,2,x\n2,1,y\n1,3,z\n")}) {
    const std::string index = std::to_string(documents.size());
    documents.push_back(folder.path(index + ".json"));
    const auto result = run_slipfit({"info", folder.file(index + ".csv", text), "--json", "--out", documents.back()});
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
  }
  const auto result = validate(documents, "info");
  CAPTURE(result.out, result.err);
  if (result.exit_code == 77) WARN("skipped: python3-jsonschema is not installed");
  CHECK((result.exit_code == 0 || result.exit_code == 77));
  const auto first = nlohmann::json::parse(test::content_of(documents[0]));
  CHECK(first["steps"].size() == 3);
  CHECK(first["steps"][1]["rows"] == nlohmann::json{31, 60});
  CHECK(first["steps"][2]["speed_m_per_s"] == 0.003);
  CHECK(first["taken"]["force_column"] == "Fx [N]");
  CHECK(nlohmann::json::parse(test::content_of(documents[2]))["refusal"].is_string());
}

TEST_CASE("a comparison obeys docs/compare.schema.json") {
  const test::TemporaryFolder folder;
  const std::string run = folder.file("run.csv", test::simulated_csv("5"));
  const std::string steady = folder.file(
      "steady.csv", test::recording_csv(500, 1000.0, [](double t) { return 2.0 + 1e-3 * std::sin(1e6 * t); }));
  std::vector<std::string> documents;
  for (const std::string& other : {run, steady}) {
    documents.push_back(folder.path(std::to_string(documents.size()) + ".json"));
    REQUIRE(run_slipfit({"compare", run, other, "--speed", "20mm/s", "--normal-force", "5", "--json", "--out",
                         documents.back()})
                .exit_code == 0);
  }
  const auto result = validate(documents, "compare");
  CAPTURE(result.err);
  if (result.exit_code == 77) {
    WARN("skipped: python3-jsonschema is not installed");
    return;
  }
  CHECK(result.exit_code == 0);
}

TEST_CASE("the schema check fails for a document that is wrong") {
  const test::TemporaryFolder folder;
  const std::string wrong = folder.file("wrong.json", R"({"schema": "slipfit.fit/1"})");
  const int exit_code = validate({wrong}).exit_code;
  CHECK((exit_code == 1 || exit_code == 77));
}

TEST_CASE("docs/formats.md names every key of the schema") {
  std::set<std::string> keys;
  for (const char* const schema : {"fit", "predict", "info", "compare"}) {
    collect_keys(nlohmann::json::parse(test::content_of(schema_file(schema))), keys);
  }
  const std::string formats = test::content_of((project_folder() / "docs/formats.md").string());
  CHECK(keys.size() > 90);
  for (const std::string& key : keys) CHECK_THAT(formats, Catch::Contains(key));
}

TEST_CASE("docs/formats.md lists every warning that a recording full of defects gives") {
  const test::TemporaryFolder folder;
  std::string csv = test::recording_csv(4000, 1000.0, [](double t) {
    const double force_N = test::sawtooth_N(t, 0.2);
    return t > 2.0 && t < 2.0015 ? 100.0 : std::min(14.5, std::round(20.0 * force_N) / 20.0);
  });
  csv += "4.5,nan\n4.6,12\n4.6,12.5\n4.55,12\n";
  const test::ProgramResult result =
      run_slipfit({"fit", folder.file("defects.csv", csv), "--speed", "20mm/s", "--json", "--quiet"});
  REQUIRE(result.exit_code == 0);
  const std::string formats = test::content_of((project_folder() / "docs/formats.md").string());
  const auto warnings = nlohmann::json::parse(result.out)["warnings"];
  CHECK(warnings.size() >= 5);
  for (const auto& warning : warnings) {
    std::string code = warning["code"];
    code.insert(code.begin(), '`');
    code.push_back('`');
    CHECK_THAT(formats, Catch::Contains(code));
  }
}

TEST_CASE("the document of surface obeys docs/surface.schema.json, with a pattern and without") {
  const test::TemporaryFolder folder;
  std::string ridges = "x [um],z [um]\n";
  std::string rough = ridges;
  unsigned state = 1;
  for (int i = 0; i < 900; ++i) {
    state = 1664525U * state + 1013904223U;
    const double noise = static_cast<double>(state >> 8U) / (1U << 24U);
    ridges += std::to_string(i) + "," + std::to_string(i % 30 / 15.0 + 0.1 * noise) + "\n";
    rough += std::to_string(i) + "," + std::to_string(noise) + "\n";
  }
  std::vector<std::string> documents;
  for (const std::string& text : {ridges, rough}) {
    const std::string index = std::to_string(documents.size());
    documents.push_back(folder.path(index + ".json"));
    const auto result =
        run_slipfit({"surface", folder.file(index + ".csv", text), "--json", "--out", documents.back()});
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
  }
  const auto result = validate(documents, "surface");
  CAPTURE(result.out, result.err);
  if (result.exit_code == 77) WARN("skipped: python3-jsonschema is not installed");
  CHECK((result.exit_code == 0 || result.exit_code == 77));
  const auto found = nlohmann::json::parse(test::content_of(documents[0]));
  CHECK(found["status"] == "periodic");
  CHECK(found["spacing_m"]["ci95"][0] <= 30e-6);
  CHECK(found["spacing_m"]["ci95"][1] >= 30e-6);
  CHECK(nlohmann::json::parse(test::content_of(documents[1]))["status"] == "none");
}
