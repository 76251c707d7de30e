#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "fit_example.hpp"
#include "json_of.hpp"
#include "refusal.hpp"
#include "run_program.hpp"
#include "support/velocity_motion.hpp"

using nlohmann::json;
using test::run_slipfit;

namespace {

json predicted(std::vector<std::string> source, const std::string& speeds) {
  source.insert(source.begin(), "predict");
  return test::json_of(source, {"--speeds", speeds, "--json"});
}

void check_same(const json& quantity, const json& estimate) {
  // Only the rounding of standard error times correlation lies between the two.
  CHECK(quantity["value"].get<double>() == Approx(estimate["value"].get<double>()).epsilon(1e-12));
  for (const std::size_t end : {0U, 1U}) {
    CHECK(quantity["ci95"][end].get<double>() == Approx(estimate["ci95"][end].get<double>()).epsilon(1e-9));
  }
}

}  // namespace

TEST_CASE("predict at the recording's own speed gives what the fit derived: values and intervals") {
  const test::FitExample example;
  const json derived = example.document()["derived"];
  const json prediction = predicted({example.fit}, "20mm/s");
  CHECK(prediction["schema"] == "slipfit.predict/1");
  CHECK(prediction["source"] == example.fit);
  check_same(prediction["critical_speed_m_per_s"], derived["critical_speed_m_per_s"]);
  check_same(prediction["lambda_critical"], derived["lambda_critical"]);
  const json row = prediction["rows"][0];
  CHECK(prediction["rows"].size() == 1);
  for (const char* const key : {"lambda", "periodic_displacement_m", "micro_vibration_spacing_m"}) {
    CAPTURE(key);
    check_same(row[key], derived[key]);
  }
  CHECK(row["regime"] == derived["regime"]);
  CHECK(row["force_peak_N"]["value"].get<double>() == Approx(6.0).epsilon(0.02));
}

TEST_CASE("the round trip keeps the intervals also if the damping is at its bound or fixed") {
  const test::TemporaryFolder folder;
  const std::string run =
      folder.file("run.csv", run_slipfit({"simulate", "--stiffness", "1000", "--natural-frequency", "200",
                                          "--static-friction", "6", "--kinetic-friction", "4", "--speed", "20mm/s",
                                          "--duration", "3", "--sample-rate", "1kHz", "--noise", "0.02", "--seed", "3"})
                                 .out);
  for (const std::vector<std::string>& options : {std::vector<std::string>{},
                                                  {"--tier", "undamped"},
                                                  {"--fix", "damping_ratio=0.001"},
                                                  {"--fix", "damping_ratio=0"}}) {
    std::vector<std::string> arguments{"fit", run, "--speed", "20mm/s", "--json", "--out", folder.path("fit.json")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    REQUIRE(run_slipfit(arguments).exit_code == 0);
    CAPTURE(options);
    const json derived = json::parse(test::content_of(folder.path("fit.json")))["derived"];
    const json prediction = predicted({folder.path("fit.json")}, "0.02");
    check_same(prediction["rows"][0]["periodic_displacement_m"], derived["periodic_displacement_m"]);
    CHECK(prediction["critical_speed_m_per_s"]["value"] == derived["critical_speed_m_per_s"]["value"]);
  }
}

TEST_CASE("a damping ratio that may be anything predicts with the one that the others were fitted with") {
  const test::FitExample example;
  json document = example.document();
  document["correlation"]["values"][2] = 0.0;
  REQUIRE(document["correlation"]["names"][2] == "damping_ratio");
  document["parameters"]["damping_ratio"]["ci95"] = {0.0, 1.0};
  const auto predicted_with = [&](const json& value, const char* const status) {
    document["parameters"]["damping_ratio"]["value"] = value;
    document["parameters"]["damping_ratio"]["status"] = status;
    return predicted({example.folder.file(std::string(status) + ".json", document.dump())}, "20mm/s")["rows"];
  };
  CHECK(predicted_with(nullptr, "bounded") == predicted_with(0.0, "weak"));
}

TEST_CASE("model options give the exact motion without intervals, and above the critical speed there is none") {
  const json prediction = predicted(test::model_options(), "20mm/s,0.5");
  CHECK(prediction["source"] == "command line");
  CHECK(prediction["lambda_critical"]["value"].get<double>() == Approx(0.910670).epsilon(1e-5));  // design reference
  CHECK(prediction["critical_speed_m_per_s"]["ci95"].is_null());
  const json& slow = prediction["rows"][0];
  CHECK(slow["regime"] == "stick_slip_bistable");
  CHECK(slow["lambda"]["value"].get<double>() == Approx(20.0));
  CHECK(slow["period_s"]["ci95"].is_null());
  CHECK(slow["periodic_displacement_m"]["value"].get<double>() ==
        Approx(0.02 * slow["period_s"]["value"].get<double>()));
  const json& fast = prediction["rows"][1];
  CHECK(fast["regime"] == "oscillatory_slip");
  CHECK(fast["bistable"] == false);
  for (const char* const key :
       {"period_s", "frequency_Hz", "sticking_degree", "periodic_displacement_m", "force_peak_N"}) {
    CHECK(fast[key]["value"].is_null());
    CHECK(fast[key]["ci95"].is_null());
  }
  CHECK(fast["lambda"]["value"].is_number());
}

TEST_CASE("near the critical speed the row states that the data do not determine the motion") {
  const test::FitExample example;
  const json prediction = predicted({example.fit}, "20mm/s,0.42");
  CHECK_FALSE(prediction["rows"][0].contains("note"));
  const json& row = prediction["rows"][1];
  CHECK_THAT(row["note"].get<std::string>(), Catch::Contains("the data do not determine"));
  CHECK_THAT(row["note"].get<std::string>(), Catch::Contains("intervals hold if there is"));
  CHECK(row["period_s"]["ci95"].is_array());
  CHECK(row["force_peak_N"]["ci95"].is_null());
  CHECK(row["lambda"]["ci95"].is_array());
  const test::ProgramResult text = run_slipfit({"predict", example.fit, "--speeds", "20mm/s,0.42"});
  CHECK_THAT(text.out, Catch::Contains("the data do not determine"));
}

TEST_CASE("the table for people has prefixes and bands, and --out and --csv write the same numbers") {
  const test::FitExample example;
  const std::vector<std::string> arguments{"predict", example.fit, "--speeds", "10mm/s:40mm/s:3"};
  const test::ProgramResult text = run_slipfit(arguments);
  CHECK(text.exit_code == 0);
  for (const char* const part :
       {"critical speed: 4", "[mm/s]", "[Hz]", "[mm]", "bistable:", "95 % interval", "Coulomb friction"}) {
    CHECK_THAT(text.out, Catch::Contains(part));
  }
  CHECK(test::widest_line(run_slipfit({"predict", example.fit, "--speeds", "1um/s:1m/s:13"}).out) <= 100);
  const std::string out = example.folder.path("prediction.json");
  const std::string csv = example.folder.path("prediction.csv");
  std::vector<std::string> writing = arguments;
  writing.insert(writing.end(), {"--json", "--out", out, "--csv", csv});
  const test::ProgramResult written = run_slipfit(writing);
  CHECK(written.exit_code == 0);
  CHECK(written.out.empty());
  CHECK(test::lines_in(written.err) == 2);
  CHECK(json::parse(test::content_of(out)) == predicted({example.fit}, "10mm/s:40mm/s:3"));
  const std::string table = test::content_of(csv);
  CHECK(table.rfind("speed_m_per_s,regime,bistable,lambda,lambda_low,lambda_high,period_s,period_low_s,period_high_s,",
                    0) == 0);
  CHECK(test::lines_in(table) == 4);
  const double period_s = json::parse(test::content_of(out))["rows"][0]["period_s"]["value"];
  CHECK_THAT(table, Catch::Contains(json(period_s).dump()));
}

TEST_CASE("a fit document without correlation, or without F_k, leaves intervals or forces out") {
  const test::FitExample example;
  json document = example.document();
  document["correlation"] = nullptr;
  document["parameters"].erase("kinetic_friction_N");
  const json row = predicted({example.folder.file("bare.json", document.dump())}, "20mm/s")["rows"][0];
  CHECK(row["period_s"]["value"].is_number());
  CHECK(row["period_s"]["ci95"].is_null());
  CHECK(row["force_peak_N"]["value"].is_null());
  document = example.document();
  document["model"].erase("degrees_of_freedom");
  const json normal = predicted({example.folder.file("normal.json", document.dump())}, "20mm/s")["rows"][0];
  const json student = predicted({example.fit}, "20mm/s")["rows"][0];
  CHECK(normal["period_s"]["ci95"][0].get<double>() > student["period_s"]["ci95"][0].get<double>());
}

TEST_CASE("predict from stated friction that depends on the speed gives the exact cycle") {
  const json prediction = predicted({"--stiffness", "900", "--natural-frequency", "150", "--damping-ratio", "0.06",
                                     "--static-friction", "3", "--f0", "1.6", "--f1", "0.4", "--alpha=-8"},
                                    "10mm/s,40mm/s");
  const auto slider = slipfit::Slider::create(900.0, 150.0, 0.06).value();
  const auto friction = slipfit::VelocityFriction::create(3.0, 1.6, 0.4, -8.0).value();
  for (const std::size_t i : {0U, 1U}) {
    const auto exact = slipfit::velocity_motion(slider, friction, i == 0 ? 0.01 : 0.04).value();
    REQUIRE(exact.motion.cycle);
    const json row = prediction["rows"][i];
    // Predictions take the fit's slip, good to 1e-6.
    CHECK(row["period_s"]["value"].get<double>() == Approx(exact.motion.cycle->period_s).epsilon(2e-6));
    CHECK(row["period_s"]["ci95"].is_null());
  }
  CHECK(prediction["critical_speed_m_per_s"]["value"].get<double>() > 0.04);
}
