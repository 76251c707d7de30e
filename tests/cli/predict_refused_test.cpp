#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>

#include "fit_example.hpp"
#include "refusal.hpp"
#include "run_program.hpp"

using nlohmann::json;
using test::run_slipfit;

TEST_CASE("a fit document that does not determine the motion is refused with the reason") {
  const test::FitExample example;
  const auto refused = [&example](const std::function<void(json&)>& change, const std::string& part) {
    json document = example.document();
    change(document);
    test::check_refused({"predict", example.folder.file("changed.json", document.dump()), "--speeds", "0.1"}, part);
  };
  refused(
      [](json& d) {
        d["parameters"]["friction_difference_N"]["status"] = "bounded";
        d["parameters"]["friction_difference_N"]["note"] = "between half of the drop\nand the drop";
      },
      "friction_difference_N is bounded (between half of the drop\\nand the drop)");
  refused(
      [](json& d) {
        for (const char* const name : {"natural_frequency_rad_per_s", "damping_ratio"}) {
          d["parameters"][name] = {
              {"value", nullptr}, {"se", nullptr}, {"ci95", nullptr}, {"status", "unidentified"}, {"note", "too slow"}};
        }
      },
      "natural_frequency_rad_per_s is unidentified, damping_ratio is unidentified (too slow)");
  refused([](json& d) { d["parameters"].erase("damping_ratio"); }, "damping_ratio is absent");
  refused(
      [](json& d) {
        d["parameters"]["damping_ratio"]["status"] = "bounded";
        d["correlation"]["values"][2] = 1.0;
      },
      "damping_ratio is not in [0, 1)");
  refused([](json& d) { d.erase("parameters"); }, "no parameters");
  refused([](json& d) { d["model"]["tier"] = "velocity"; }, "friction_slope_N_s_per_m");
  const std::string analysed = example.folder.file(
      "analysed.json", run_slipfit({"analyze", example.recording, "--speed", "20mm/s", "--json"}).out);
  test::check_refused({"predict", analysed, "--speeds", "0.1"}, "no parameters");
}

TEST_CASE("numbers that a fit cannot have written are refused with their place") {
  const test::FitExample example;
  const auto refused = [&example](const char* pointer, const json& value, const std::string& part) {
    json document = example.document();
    document[json::json_pointer(pointer)] = value;
    test::check_refused({"predict", example.folder.file("changed.json", document.dump()), "--speeds", "0.1"}, part);
  };
  refused("/schema", "slipfit.predict/1", "schema is \"slipfit.predict/1\", expected slipfit.fit/1");
  refused("/schema", 3, "schema is 3");
  refused("/parameters", json::array(), "parameters is [], expected an object");
  refused("/parameters/stiffness_N_per_m", 1000, "parameters.stiffness_N_per_m is 1000, expected an object");
  refused("/parameters/stiffness_N_per_m/value", "1000", "parameters.stiffness_N_per_m.value is \"1000\"");
  refused("/parameters/stiffness_N_per_m/value", -5, "value is -5, expected a number >= 0");
  refused("/parameters/stiffness_N_per_m/value", 0, "value is 0, expected a number of its interval");
  refused("/parameters/natural_frequency_rad_per_s/value", nullptr, "value is null");
  refused("/parameters/friction_difference_N/value", true, "value is true");
  refused("/parameters/damping_ratio/value", 1.0, "value is 1.0, expected a number of its interval");
  refused("/parameters/damping_ratio/value", -0.1, "expected a number from 0 to 1");
  refused("/parameters/damping_ratio/status", "sure", "parameters.damping_ratio.status is \"sure\"");
  refused("/parameters/damping_ratio/se", -1, "parameters.damping_ratio.se is -1");
  refused("/parameters/damping_ratio/ci95", 3, "parameters.damping_ratio.ci95 is 3");
  refused("/parameters/damping_ratio/ci95", json::array({1}), "parameters.damping_ratio.ci95 is [1]");
  refused("/parameters/kinetic_friction_N/value", "4", "kinetic_friction_N.value");
  refused("/correlation/names/0", "mass_kg", "correlation.names");
  refused("/correlation/names", 3, "correlation.names is 3");
  refused("/correlation/matrix", json::array(), "correlation.matrix");
  refused("/correlation/matrix/1", json::array({1, 2}), "correlation.matrix[1]");
  refused("/correlation/matrix/0/1", 7, "from -1 to 1");
  refused("/correlation/matrix/0/1", 0.99, "symmetric");
  refused("/correlation/scaled_se/2", "x", "correlation.scaled_se[2]");
  refused("/model/degrees_of_freedom", 0, "model.degrees_of_freedom is 0");
  refused("/model/conditional_on", "x", "model.conditional_on");
  refused("/parameters/stiffness_N_per_m/value", std::string(5000, 'x'), "...");
  json missing = example.document();
  missing["parameters"]["stiffness_N_per_m"].erase("value");
  test::check_refused({"predict", example.folder.file("missing.json", missing.dump()), "--speeds", "0.1"},
                      "parameters.stiffness_N_per_m.value is missing");
}

TEST_CASE("files that are no fit document are refused") {
  const test::TemporaryFolder folder;
  const auto refused = [&folder](const std::string& content, const std::string& part) {
    test::check_refused({"predict", folder.file("bad.json", content), "--speeds", "0.1"}, part);
  };
  refused("", "bad.json:1': is not one JSON document");
  refused("{\n\"schema\": \"slipfit.fit/1\",\n", "bad.json:3'");
  refused("{\"schema\": NaN}", "is not one JSON document");
  refused("{\"schema\": 1e999}", "too large");
  refused("{} {}", "is not one JSON document");
  refused("time_s,force_N\n0,1\n", "is not one JSON document");
  refused("[1, 2]", "the document is [1,2], expected an object");
  refused("null", "expected an object");
  refused("{}", "schema is missing");
  refused(std::string(100'000, '['), "is nested too deeply");
  refused(std::string("\xff\xfe{", 3), "is not one JSON document");
  test::check_refused({"predict", folder.path("none.json"), "--speeds", "0.1"}, "No such file");
  test::check_refused({"predict", folder.path(""), "--speeds", "0.1"}, "directory");
  test::check_refused({"predict", "/dev/zero", "--speeds", "0.1"}, "too large");
}

TEST_CASE("every reader of fit documents refuses numbers that contradict each other") {
  const test::FitExample example;
  const auto refused = [&example](const char* pointer, const json& value, const std::string& part) {
    json document = example.document();
    document[json::json_pointer(pointer)] = value;
    const std::string changed = example.folder.file("changed.json", document.dump());
    test::check_refused({"predict", changed, "--speeds", "0.1"}, part);
    test::check_refused({"plan", changed}, part);
    test::check_refused({"compare", example.fit, changed}, part);
    test::check_refused({"compare", changed, example.fit}, part);
  };
  refused("/parameters/stiffness_N_per_m/se", -1e300, "parameters.stiffness_N_per_m.se is -1e+300");
  refused("/parameters/stiffness_N_per_m/ci95", {9, 1}, "parameters.stiffness_N_per_m.ci95 is [9,1]");
  refused("/parameters/stiffness_N_per_m/ci95", {1, 9}, "expected a number of its interval, 1 to 9");
  refused("/parameters/mass_kg/status", "certain",
          "parameters.mass_kg.status is \"certain\", expected one of identified");
  refused("/frequency/se_Hz", -1, "frequency.se_Hz is -1");
  refused("/frequency/ci95_Hz/1", 0.0, "frequency.ci95_Hz");
  refused("/derived/pattern_spacing_m/value", 17, "derived.pattern_spacing_m.value is 17");
  refused("/cycles/force_drop_sd_N", 1e200, "cycles.force_drop_sd_N is 1e+200, expected a number of at most 1e+100");
  refused("/status", "stuck", "status is \"stuck\", expected one of stick_slip");
}

TEST_CASE("documents out of all bounds are refused before they fill the memory") {
  const test::TemporaryFolder folder;
  const auto refused = [&folder](const std::string& content, const std::string& part) {
    const std::string file = folder.file("large.json", content);
    test::check_refused({"predict", file, "--speeds", "0.1"}, part);
    test::check_refused({"plan", file}, part);
    if (content.front() == '{') test::check_refused({"compare", file, file}, part);
  };
  const std::size_t kMega = 1'000'000;
  refused(std::string(60 * kMega, '['), "is nested too deeply for a fit document");
  std::string nested;
  for (int i = 0; i < 100; ++i) nested += "{\"a\":";
  refused(nested, "is nested too deeply");
  std::string many = "{\"a\":[";
  for (std::size_t i = 0; i < 3 * kMega; ++i) many += "0,";
  refused(many + "0]}", "contains too many values");
}

TEST_CASE("a plan of more samples than any recording has is refused, one of very many is quick") {
  const test::FitExample example;
  json document = example.document();
  document["recording"]["sample_rate_Hz"] = 1e12;
  test::check_refused({"plan", example.folder.file("changed.json", document.dump())},
                      "recording.sample_rate_Hz is 1000000000000.0, expected at most 1e+09 samples");
  const double duration_s = document["recording"]["duration_s"];
  document["recording"]["sample_rate_Hz"] = 0.9e9 / duration_s;
  CHECK(run_slipfit({"plan", example.folder.file("changed.json", document.dump())}).exit_code == 0);
}

TEST_CASE("standard errors that leave a parameter open by a factor of e^20 are refused by predictions") {
  const test::FitExample example;
  json document = example.document();
  document["correlation"]["scaled_se"][3] = 300;
  const std::string changed = example.folder.file("changed.json", document.dump());
  test::check_refused({"predict", changed, "--speeds", "0.1"}, "correlation.scaled_se[3] is 300");
  test::check_refused({"plan", changed}, "correlation.scaled_se[3] is 300");
}

TEST_CASE("speeds that make no sense are refused") {
  const std::vector<std::string> model = test::model_options();
  const auto refused = [&model](const std::string& speeds, const std::string& part) {
    std::vector<std::string> arguments{"predict"};
    arguments.insert(arguments.end(), model.begin(), model.end());
    arguments.insert(arguments.end(), {"--speeds", speeds});
    test::check_refused(arguments, "--speeds");
    test::check_refused(arguments, part);
  };
  refused("", "--speeds");
  refused("0", "not above zero");
  refused("-1", "not above zero");
  refused("1,,2", "--speeds");
  refused("1,", "--speeds");
  refused("fast", "fast");
  refused("nan", "nan");
  refused("1,inf", "inf");
  refused("3 kg", "kg");
  refused("60rpm", "rpm");
  refused("1:2", "expected A:B:N");
  refused("1:2:3:4", "expected A:B:N");
  refused("2:1:5", "A < B");
  refused("1:1:5", "A < B");
  refused("0:1:5", "not above zero");
  refused("1:2:1", "bad number of speeds '1'");
  refused("1:2:0", "bad number of speeds");
  refused("1:2:-3", "bad number of speeds");
  refused("1:2:2.5", "bad number of speeds");
  refused("1:2:", "bad number of speeds");
  refused("1:2:100001", "bad number of speeds");
  refused("1:2:99999999999999999999", "bad number of speeds");
  test::check_refused({"predict", "--stiffness", "1"}, "--speeds is missing");
}

TEST_CASE("an output that would destroy the fit document is refused") {
  const test::FitExample example;
  const std::string before = test::content_of(example.fit);
  for (const std::string option : {"--out", "--csv"}) {
    test::check_refused({"predict", example.fit, "--speeds", "1", option, example.fit}, "the fit document itself");
    test::check_refused({"predict", example.fit, "--speeds", "1", option, example.folder.path("none/x")},
                        "does not exist");
  }
  test::check_refused(
      {"predict", example.fit, "--speeds", "1", "--out", example.folder.path("a"), "--csv", example.folder.path("a")},
      "same file");
  CHECK(test::content_of(example.fit) == before);
}
