#include "slipfit/report/json.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "examples.hpp"

using nlohmann::json;
using slipfit::to_json;

namespace {

json document_of(const slipfit::Recording& recording, const slipfit::Analysis& analysis,
                 const slipfit::JsonOptions& options = {}) {
  return json::parse(to_json(recording, analysis, options));
}

}  // namespace

TEST_CASE("numbers in the document are read back with every bit") {
  auto analysis = test::full_analysis();
  const double awkward = 0.1 + 0.2;
  analysis.fit->parameters[0].estimate.value = awkward;
  const json document = document_of(test::small_recording(), analysis);
  CHECK(document["parameters"]["stiffness_N_per_m"]["value"].get<double>() == awkward);
  CHECK(document["parameters"]["stiffness_N_per_m"]["ci95"] == json::array({999.93, 1004.76}));
  CHECK(document["frequency"]["value_Hz"] == 5.4321);
  CHECK(document["frequency"]["harmonics"] == json::array({5.43, 10.86}));
  CHECK(document["frequency"]["suspicious_lines"][0]["frequency_Hz"] == 50.0);
  CHECK(document["cycles"]["peak_force_N"] == 6.25);
  CHECK(document["derived"]["pattern_spacing_m"]["value"] == 0.0018409);
  CHECK(document["derived"]["bistable"] == true);
  CHECK(document["model"]["tier"] == "damped");
  CHECK(document["model"]["candidates"][1]["aicc"] == -250.25);
  CHECK(document["correlation"]["matrix"][1][0] == 0.25);
  CHECK(document["recording"]["quality"]["rows_without_number"] == 2);
}

TEST_CASE("a number that is not finite is null") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  auto analysis = test::full_analysis();
  analysis.fit->parameters[0].estimate = {nan, infinity, slipfit::Interval{-infinity, 3.0}, ""};
  analysis.fit->residual.rms = nan;
  analysis.fit->correlation->matrix[0][1] = nan;
  analysis.frequency.spectral.harmonics_Hz = {nan};
  analysis.quality.noise_rms = infinity;
  const std::string text = to_json(test::small_recording(), analysis);
  const json document = json::parse(text);
  CHECK(document["parameters"]["stiffness_N_per_m"]["value"].is_null());
  CHECK(document["parameters"]["stiffness_N_per_m"]["se"].is_null());
  CHECK(document["parameters"]["stiffness_N_per_m"]["ci95"].is_null());
  CHECK(document["model"]["residual"]["rms_N"].is_null());
  CHECK(document["correlation"]["matrix"][0][1].is_null());
  CHECK(document["frequency"]["harmonics"][0].is_null());
  CHECK(document["recording"]["quality"]["noise_rms_N"].is_null());
}

TEST_CASE("a friction coefficient is never given as a force") {
  const auto recording = test::small_recording(slipfit::ForceQuantity::FrictionCoefficient);
  const json document = document_of(recording, test::full_analysis());
  CHECK(document["recording"]["force_quantity"] == "friction_coefficient");
  CHECK(document["cycles"]["peak_force_N"].is_null());
  CHECK(document["cycles"]["coefficient"]["peak_force"] == 6.25);
  CHECK(document["model"]["residual"]["rms_N"].is_null());
  CHECK(document["model"]["residual"]["coefficient"]["rms"] == 0.02);
  CHECK(document["recording"]["quality"]["coefficient"]["noise_rms"] == 0.0125);
  CHECK_FALSE(document_of(test::small_recording(), test::full_analysis())["cycles"].contains("coefficient"));
}

TEST_CASE("the reader's warnings are among those of the analysis") {
  const auto warnings = slipfit::analyze(test::small_recording()).warnings;
  REQUIRE_FALSE(warnings.empty());
  CHECK(std::ranges::count(warnings, "rows_left_out", &slipfit::Warning::code) == 1);
}

TEST_CASE("strings from outside cannot break the document") {
  const std::string hostile = "a\"b\\c\n\x01\xff\xc3</script>";
  auto analysis = test::full_analysis();
  analysis.warnings.push_back({"hostile", hostile});
  const auto recording = test::small_recording(slipfit::ForceQuantity::Force_N, "x/" + hostile + ".csv");
  const json document = document_of(recording, analysis);
  CHECK(document["warnings"].back()["message"].get<std::string>().rfind("a\"b\\c\n\x01", 0) == 0);
}

TEST_CASE("the keys are in the order of the interface") {
  const auto document = nlohmann::ordered_json::parse(to_json(test::small_recording(), test::full_analysis()));
  std::vector<std::string> keys;
  for (const auto& [key, value] : document.items()) keys.push_back(key);
  CHECK(keys == std::vector<std::string>{"schema",    "$schema", "version",       "commit",       "id",
                                         "recording", "status",  "status_reason", "warnings",     "frequency",
                                         "cycles",    "model",   "parameters",    "correlation",  "level_trend",
                                         "audit",     "derived", "transients",    "coefficients", "tests"});
}
