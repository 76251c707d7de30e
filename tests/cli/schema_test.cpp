// Every kind of document against its schema in docs/, and docs/formats.md against the schemas.

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "fit_example.hpp"
#include "json_of.hpp"
#include "recordings.hpp"
#include "run_program.hpp"
#include "sweep_example.hpp"

using nlohmann::json;

namespace {

std::filesystem::path project_folder() {
  return std::filesystem::path(SLIPFIT_TESTDATA_DIR).parent_path();
}

/// Names of all keys that the schema describes, those of the objects "coefficient" aside: they are the others without
/// unit.
void collect_keys(const json& node, std::set<std::string>& keys) {
  if (!node.is_structured()) return;
  for (const auto& [name, child] : node.items()) {
    if (name == "properties") {
      for (const auto& [key, value] : child.items()) keys.insert(key);
    }
    if (name != "coefficient") collect_keys(child, keys);
  }
}

std::string schema_file(const std::string& name) {
  return (project_folder() / "docs" / (name + ".schema.json")).string();
}

/// Documents by the name of their schema.
struct Documents {
  test::TemporaryFolder folder;
  std::map<std::string, std::vector<std::string>> files = {};

  void keep(const std::string& schema, const json& document) {
    std::vector<std::string>& of_schema = files[schema];
    of_schema.push_back(folder.file(schema + std::to_string(of_schema.size()) + ".json", document.dump()));
  }

  /// Runs the command, and returns what it writes.
  json add(const std::string& schema, const std::vector<std::string>& command) {
    json document = test::json_of(command, {"--json", "--quiet"});
    keep(schema, document);
    return document;
  }

  /// Exit code 77 where no Python at hand has the module jsonschema: then there is nothing to test with.
  [[nodiscard]] test::ProgramResult validate(const std::string& schema) const {
    std::vector<std::string> arguments{(project_folder() / "tests/cli/validate_schema.py").string(),
                                       schema_file(schema)};
    arguments.insert(arguments.end(), files.at(schema).begin(), files.at(schema).end());
    const test::ProgramResult result = test::run_program("python3", arguments);
    if (result.exit_code != 77 || !std::filesystem::exists("/usr/bin/python3")) return result;
    return test::run_program("/usr/bin/python3", arguments);  // Debian's own has the module; the first may be another
  }
};

}  // namespace

TEST_CASE("every kind of document obeys its schema in docs, with no key that the schema does not name") {
  const test::TemporaryFolder folder;
  const test::FitExample example;
  const std::string& run = example.recording;
  const std::string steady = folder.file(
      "steady.csv", test::recording_csv(500, 1000.0, [](double t) { return 2.0 + 1e-3 * std::sin(1e6 * t); }));
  const std::string coefficient = folder.file("coefficient.csv", [] {
    std::string csv = test::recording_csv(4000, 1000.0, [](double t) { return 0.02 * test::sawtooth_N(t, 0.2); });
    return "time_s,COF\n" + csv.substr(csv.find('\n') + 1);
  }());
  const std::vector<std::string> speed{"--speed", "20mm/s"};
  Documents documents;
  const auto fit = [&](std::vector<std::string> command) {
    command.insert(command.end(), speed.begin(), speed.end());
    documents.add("fit", command);
  };
  fit({"fit", run});
  fit({"fit", run, "--timing", "--normal-force", "10", "--speed-uncertainty", "1%", "--zero", "0"});
  fit({"fit", run, "--tier", "sawtooth"});
  fit({"fit", run, "--tier", "undamped"});
  fit({"fit", run, "--fix", "damping_ratio=0.05"});
  fit({"analyze", run});
  fit({"fit", steady});
  fit({"fit", coefficient});
  fit({"fit", coefficient, "--normal-force", "10"});
  const test::SweepExample sweep;
  documents.keep("fit", sweep.fit({"--group", "pad", "--tier", "auto"}));
  documents.keep("fit", sweep.fit({"--group", "pad", "--tier", "velocity"}));
  documents.keep("fit", sweep.fit({"--only", "slow"}));

  documents.add("predict", {"predict", example.fit, "--speeds", "1mm/s:1m/s:20"});
  const test::FitExample without_zero(std::vector<std::string>{});
  documents.add("predict", {"predict", without_zero.fit, "--speeds", "20mm/s,0.42"});
  std::vector<std::string> model{"predict", "--speeds", "20mm/s,0.5"};
  for (const std::string& word : test::model_options()) model.push_back(word);
  documents.add("predict", model);
  documents.add("predict", {"predict", "--stiffness", "1e3", "--mass", "1", "--static-friction", "6",
                            "--kinetic-friction", "4", "--speeds", "1e-300,1e-9,1,1e9,1e300"});

  std::string steps = "Step,time [s],Fx [N],Fz [N],speed [mm/s]\n";
  for (int i = 0; i < 90; ++i) {
    steps += std::to_string(1 + i / 30) + "," + std::to_string(i % 30) + "," + std::to_string(i % 4) + ",2," +
             std::to_string(1 + i / 30) + "\n";
  }
  documents.add("info", {"info", folder.file("steps.csv", steps)});
  documents.add("info", {"info", run});
  const json refused = documents.add("info", {"info", folder.file("three.csv", "a,b,c\n1,2,x\n2,1,y\n1,3,z\n")});
  CHECK(refused["refusal"].is_string());

  for (const std::string& other : {run, steady}) {
    documents.add("compare", {"compare", run, other, "--speed", "20mm/s", "--normal-force", "5"});
  }

  std::string ridges = "x [um],z [um]\n";
  std::string rough = ridges;
  unsigned state = 1;
  for (int i = 0; i < 900; ++i) {
    state = 1664525U * state + 1013904223U;
    const double noise = static_cast<double>(state >> 8U) / (1U << 24U);
    ridges += std::to_string(i) + "," + std::to_string(i % 30 / 15.0 + 0.1 * noise) + "\n";
    rough += std::to_string(i) + "," + std::to_string(noise) + "\n";
  }
  CHECK(documents.add("surface", {"surface", folder.file("ridges.csv", ridges)})["status"] == "periodic");
  CHECK(documents.add("surface", {"surface", folder.file("rough.csv", rough)})["status"] == "none");

  for (const char* const schema : {"fit", "predict", "info", "compare", "surface"}) {
    const test::ProgramResult result = documents.validate(schema);
    CAPTURE(schema, result.out, result.err);
    if (result.exit_code == 77) {
      WARN("skipped: python3-jsonschema is not installed");
      return;
    }
    CHECK(result.exit_code == 0);
  }
  Documents wrong;
  wrong.keep("fit", json{{"schema", "slipfit.fit/1"}});
  CHECK(wrong.validate("fit").exit_code != 0);
}

TEST_CASE("docs/formats.md names every key of the schemas") {
  std::set<std::string> keys;
  for (const char* const schema : {"fit", "predict", "info", "compare"}) {
    collect_keys(json::parse(test::content_of(schema_file(schema))), keys);
  }
  const std::string formats = test::content_of((project_folder() / "docs/formats.md").string());
  CHECK(keys.size() > 90);
  for (const std::string& key : keys) CHECK_THAT(formats, Catch::Contains(key));
}
