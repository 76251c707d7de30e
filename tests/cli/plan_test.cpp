// slipfit plan: text, document, and what it refuses.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fit_example.hpp"
#include "json_of.hpp"
#include "refusal.hpp"
#include "sweep_example.hpp"

using nlohmann::json;
using test::check_refused;
using test::run_slipfit;

TEST_CASE("plan starts from the worst known parameter and names what limits each") {
  const test::FitExample example;
  const json plan = test::json_of({"plan", example.fit, "--json"});
  const json parameters = example.document()["parameters"];
  CHECK(plan["schema"] == "slipfit.plan/1");
  CHECK(plan["source"] == example.fit);
  CHECK(plan["target"]["name"] == "damping_ratio");
  CHECK(plan["target"]["value"] == parameters["damping_ratio"]["value"]);
  CHECK(plan["limits"].size() == 6);
  for (const json& limit : plan["limits"]) {
    const std::string by = limit["limited_by"];
    CHECK((by == "noise" || by == "scatter" || by == "sampling" || by == "cycles" || by == "misfit"));
    CHECK(limit["se"].get<double>() > 0.0);
  }
  REQUIRE(plan["options"].size() >= 3);
  CHECK(plan["options"][0]["se"].get<double>() < plan["target"]["se"].get<double>());
  CHECK(plan["halving_s"].get<double>() > 0.0);
  const test::ProgramResult text = run_slipfit({"plan", example.fit, "--for", "stiffness_N_per_m"});
  CHECK(text.exit_code == 0);
  for (const char* const part :
       {"To improve the tangential stiffness k, known", "Coulomb friction", "best first", "Limits of each"}) {
    CHECK_THAT(text.out, Catch::Contains(part));
  }
}

TEST_CASE("plan reads joint fits, and narrows a predicted spacing") {
  const test::SweepExample example;
  static_cast<void>(example.fit({"--group", "pad"}));
  const json plan =
      test::json_of({"plan", example.out, "--for", "periodic_displacement_m", "--at", "100mm/s", "--json"});
  CHECK(plan["target"]["name"] == "periodic_displacement_m");
  CHECK(plan["target"]["speed_m_per_s"] == 0.1);
  CHECK(plan["options"].size() >= 3);
  const std::string file = example.folder.path("plan.txt");
  CHECK(run_slipfit({"plan", example.out, "--at", "0.1", "--out", file, "--quiet"}).out.empty());
  CHECK_THAT(test::content_of(file), Catch::Contains("To improve the periodic displacement at 100"));
}

TEST_CASE("plan refuses what it cannot plan for") {
  const test::FitExample example;
  check_refused({"plan"}, "FIT.json");
  check_refused({"plan", example.recording}, "JSON");
  check_refused({"plan", example.fit, "--for", "colour"}, "unknown target 'colour'");
  check_refused({"plan", example.fit, "--for", "alpha_s_per_m"}, "unknown target");
  check_refused({"plan", example.fit, "--for", "periodic_displacement_m"}, "--at");
  check_refused({"plan", example.fit, "--for", "mass_kg", "--at", "0.1"}, "--at");
  check_refused({"plan", example.fit, "--at", "5"}, "no stick-slip");
  check_refused({"plan", example.fit, "--out", example.fit}, "--out");
  json document = example.document();
  document["correlation"] = nullptr;
  check_refused({"plan", example.folder.file("bare.json", document.dump())}, "no covariance");
  document = example.document();
  document["model"]["residual"]["rms_N"] = nullptr;
  check_refused({"plan", example.folder.file("noiseless.json", document.dump())}, "rms_N");
}
