// slipfit fit --joint: what is refused, and what text and document of a sweep say.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recordings.hpp"
#include "refusal.hpp"
#include "run_program.hpp"
#include "sweep_example.hpp"

using nlohmann::json;
using test::check_refused;
using test::run_slipfit;

TEST_CASE("a joint fit of a Coulomb sweep states its law in text, document and prediction") {
  const test::SweepExample example;
  const test::ProgramResult text = run_slipfit({"fit", "--joint", example.manifest, "--group", "pad", "--details"});
  CHECK(text.exit_code == 0);
  for (const char* const part :
       {"pad: 3 recordings fitted together", "tangential stiffness k", "identified", "slow", "fast",
        "predicted from the others", "Coulomb friction explains the recordings", "critical speed: 4"}) {
    CHECK_THAT(text.out, Catch::Contains(part));
  }
  const json document = example.fit({"--group", "pad"});
  CHECK(document["id"] == "pad");
  CHECK(document["status"] == "stick_slip");
  CHECK_FALSE(document.contains("recording"));
  REQUIRE(document["recordings"].size() == 3);
  for (const json& member : document["recordings"]) {
    CHECK(member["role"] == "cycles");
    CHECK(member["status"] == "stick_slip");
    CHECK(member["joint"]["cycles_used"].get<int>() > 5);
    CHECK(member["joint"]["spacing_left_out_m"]["ci95"].is_array());
  }
  CHECK(document["model"]["tier"] == "damped");
  CHECK(document["model"]["residual"]["rms_N"].get<double>() > 0.0);
  CHECK(document["parameters"]["stiffness_N_per_m"]["value"].get<double>() == Approx(1000.0).epsilon(0.005));
  CHECK(document["parameters"]["alpha_s_per_m"]["value"].is_null());
  CHECK(document["parameters"]["alpha_s_per_m"]["status"] == "unidentified");
  CHECK(document["derived"]["lambda"]["value"].is_null());
  const json& critical = document["derived"]["critical_speed_m_per_s"];
  CHECK(critical["value"].get<double>() == Approx(0.4392).epsilon(0.05));  // 200 * 2 / (1000 * 0.910670)
  const test::ProgramResult predicted = run_slipfit({"predict", example.out, "--speeds", "0.02,0.1", "--json"});
  REQUIRE(predicted.exit_code == 0);
  CHECK(json::parse(predicted.out)["critical_speed_m_per_s"]["ci95"] == critical["ci95"]);
}

TEST_CASE("predict carries the warnings of the fit, and takes a load where the recordings state theirs") {
  const test::SweepExample example;
  json document = example.fit({"--group", "pad"});
  document["warnings"].push_back({{"code", "recordings_disagree"}, {"message", "they do not agree"}});
  document["model"]["normal_force_N"] = 2.0;
  std::ofstream(example.out) << document.dump();
  const std::vector<std::string> predict{"predict", example.out, "--speeds", "0.02"};
  CHECK_THAT(run_slipfit(predict).out, Catch::Contains("they do not agree [recordings_disagree]"));
  const json same = json::parse(run_slipfit({predict[0], predict[1], predict[2], predict[3], "--json"}).out);
  CHECK(same["warnings"].back()["code"] == "recordings_disagree");
  const json twice =
      json::parse(run_slipfit({predict[0], predict[1], predict[2], predict[3], "--json", "--normal-force", "4N"}).out);
  CHECK(twice["rows"][0]["lambda"]["value"].get<double>() ==
        Approx(2.0 * same["rows"][0]["lambda"]["value"].get<double>()));
  CHECK(twice["rows"][0]["force_peak_N"]["value"].is_null());
  document["model"].erase("normal_force_N");
  std::ofstream(example.out) << document.dump();
  const test::ProgramResult refused =
      run_slipfit({predict[0], predict[1], predict[2], predict[3], "--normal-force", "4N"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Catch::Contains("state no normal force"));
}

TEST_CASE("a velocity fit hands slope and alpha on to predict") {
  const test::SweepExample example;
  json document = example.fit({"--group", "pad", "--tier", "velocity"});
  CHECK(document["model"]["tier"] == "velocity");
  CHECK(document["correlation"]["names"].size() == 6);
  CHECK(document["correlation"]["names"][4] == "friction_slope_N_s_per_m");
  CHECK(document["correlation"]["values"][5].is_number());
  const test::ProgramResult same = run_slipfit({"predict", example.out, "--speeds", "0.02", "--json"});
  REQUIRE(same.exit_code == 0);
  const json row = json::parse(same.out)["rows"][0];
  const json& spacing = document["recordings"][0]["joint"]["spacing_m"];
  CHECK(row["periodic_displacement_m"]["value"].get<double>() == Approx(spacing["value"].get<double>()).epsilon(1e-9));
  // Coulomb friction gives no alpha: at this speed exp(alpha V) may be anything, where the speed is low it is 1.
  CHECK_THAT(row["note"].get<std::string>(), Catch::Contains("alpha is not known"));
  const test::ProgramResult slow = run_slipfit({"predict", example.out, "--speeds", "0.0001", "--json"});
  CHECK(json::parse(slow.out)["rows"][0]["periodic_displacement_m"]["ci95"].is_array());

  document["correlation"]["values"][4] = document["correlation"]["values"][4].get<double>() + 2.0;
  const std::string steeper = example.folder.file("steeper.json", document.dump());
  const test::ProgramResult other = run_slipfit({"predict", steeper, "--speeds", "0.02", "--json"});
  CHECK(json::parse(other.out)["rows"][0]["periodic_displacement_m"]["value"] !=
        row["periodic_displacement_m"]["value"]);

  document["correlation"].erase("values");
  check_refused({"predict", example.folder.file("bare.json", document.dump()), "--speeds", "0.02"}, "values");
  document["correlation"] = nullptr;
  check_refused({"predict", example.folder.file("none.json", document.dump()), "--speeds", "0.02"}, "correlation");
}

TEST_CASE("fit --joint refuses what it cannot do, in one line") {
  const test::SweepExample example;
  const std::string run = example.folder.path("slow.csv");
  check_refused({"fit", run, "--joint", example.manifest}, "REC cannot be combined with --joint");
  check_refused({"fit", "--joint", example.folder.path("none.csv")}, "none.csv");
  check_refused({"fit", "--joint", "--tier", "velocity", example.manifest}, "must be followed by");
  check_refused({"fit", "--joint", example.manifest, "--group", "nobody"}, "nobody");
  check_refused({"fit", "--joint", example.manifest, "--only", "slow,nobody"}, "nobody");
  check_refused({"fit", "--joint", example.manifest, "--speed", "1"}, "--speed cannot be combined with --joint");
  check_refused({"fit", "--joint", example.manifest, "--drive-period", "1"},
                "--drive-period cannot be combined with --joint");
  check_refused({"fit", "--joint", example.manifest, "--tier", "sawtooth"}, "no tier of a joint fit");
  check_refused({"fit", run, "--speed", "20mm/s", "--group", "pad"}, "--group");
  check_refused({"fit", "--joint", example.manifest, "--group", "contact"}, "spring");
  const std::string before = test::content_of(run);
  check_refused({"fit", "--joint", example.manifest, "--group", "pad", "--out", run}, "is the recording itself");
  CHECK(test::content_of(run) == before);
}

TEST_CASE("a sweep's unreadable recording is refused in the words of the manifest") {
  const test::TemporaryFolder folder;
  static_cast<void>(folder.file("two.csv", "time,left force,right force\n0,1,2\n1,2,1\n2,1,2\n3,2,1\n"));
  const std::string manifest = folder.file("sweep.csv", "id,file,speed_m_per_s\nrun,two.csv,0.01\n");
  const test::ProgramResult result = run_slipfit({"fit", "--joint", manifest});
  CAPTURE(result.err);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Catch::Contains("the manifest's force_column") && !Catch::Contains("--force-column"));
}

TEST_CASE("one recording is not a sweep: the answer states that nothing was fitted together, and the reason") {
  const test::SweepExample example;
  const json document = example.fit({"--only", "slow"});
  CHECK(document["status"] == "undetermined");
  CHECK_FALSE(document.contains("parameters"));
  CHECK_THAT(document["status_reason"].get<std::string>(), Catch::Contains("1 with stick-slip cycles"));
  CHECK_FALSE(document["recordings"][0].contains("joint"));
  CHECK(document["derived"]["critical_speed_m_per_s"]["value"].is_null());
  check_refused({"predict", example.out, "--speeds", "0.1"}, "no parameters");
}

TEST_CASE("a joint fit gives the same bytes in every run, at any memory address") {
  const test::SweepExample example;
  const test::ProgramResult first = run_slipfit({"fit", "--joint", example.manifest, "--group", "pad", "--json"});
  REQUIRE(first.exit_code == 0);
  for (int run = 0; run < 4; ++run) {
    CHECK(run_slipfit({"fit", "--joint", example.manifest, "--group", "pad", "--json"}).out == first.out);
  }
}

TEST_CASE("strokes applies to one recording are fitted together, alone and as a row of a batch") {
  const test::TemporaryFolder folder;
  std::string text = "time [s],force [N]\n";
  for (int i = 0; i < 8000; ++i) {
    const int in_stroke = i % 2000;
    const double side = i / 2000 % 2 == 0 ? 1.0 : -1.0;
    const double ramp = i < 2000 ? 1.0 : std::min(1.0, in_stroke / 25.0 - 1.0);
    text +=
        std::to_string(1e-3 * i) + "," + std::to_string(side * ramp * test::sawtooth_N(1e-3 * in_stroke, 0.2)) + "\n";
  }
  const std::string file = folder.file("run.csv", text);
  const auto fit = test::run_slipfit({"fit", file, "--speed", "0.01", "--strokes", "--json"});
  REQUIRE(fit.exit_code == 0);
  const auto document = nlohmann::json::parse(fit.out);
  CHECK(document["recordings"].size() == 4);
  CHECK(document["repeats"]["frequency_Hz"]["value"].get<double>() == Approx(5.0).epsilon(0.02));
  for (const auto& [name, parameter] : document["parameters"].items()) {
    const bool depends_on_speed = name == "friction_difference_N" || name == "damping_ratio";
    if (depends_on_speed) CHECK(parameter["status"] != "identified");
  }
  const auto analysis = test::run_slipfit({"analyze", file, "--speed", "0.01", "--strokes=negative", "--json"});
  REQUIRE(analysis.exit_code == 0);
  CHECK(nlohmann::json::parse(analysis.out)["recordings"].size() == 2);
  test::check_refused({"fit", file, "--speed", "0.01", "--strokes", "--curve", folder.path("c.csv")},
                      "applies to one recording");
  test::check_refused({"fit", file, "--speed", "0.01", "--strokes=up"}, "positive or negative");

  const std::string manifest = folder.file("runs.csv", "id,file,speed_m_per_s,strokes\nr1,run.csv,0.01,both\n");
  const std::vector<std::string> batch{"batch", manifest, "--out", folder.path("out"), "--quiet", "--jobs", "1"};
  REQUIRE(test::run_slipfit(batch).exit_code == 0);
  const std::string results = test::content_of(folder.path("out/results.jsonl"));
  CHECK(nlohmann::json::parse(results)["recordings"].size() == 4);
  std::vector<std::string> again = batch;
  again.emplace_back("--resume");
  REQUIRE(test::run_slipfit(again).exit_code == 0);
  CHECK(nlohmann::json::parse(test::content_of(folder.path("out/run.json")))["before"] == 1);
}

TEST_CASE("segments of one file are a joint fit as a row of a batch, and its page lays their cycles over each other") {
  const test::TemporaryFolder folder;
  static_cast<void>(folder.file("sweep.csv", test::segments_csv()));
  const std::string manifest = folder.file("runs.csv", "id,file,speed_m_per_s,segments\nr1,sweep.csv,,yes\n");
  const test::ProgramResult batch = run_slipfit({"batch", manifest, "--out", folder.path("out"), "--quiet", "--jobs",
                                                 "1", "--report", folder.path("pages/index.html")});
  CAPTURE(batch.err);
  REQUIRE(batch.exit_code == 0);
  const json document = json::parse(test::content_of(folder.path("out/results.jsonl")));
  CHECK(document["id"] == "r1");
  REQUIRE(document["recordings"].size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(document["recordings"][i]["recording"]["speed_m_per_s"].get<double>() == Approx(0.01 * std::exp2(i)));
    CHECK(document["recordings"][i]["frequency"]["value_Hz"].get<double>() == Approx(2.5 * std::exp2(i)).epsilon(0.01));
  }
  const std::string page = test::content_of(folder.path("pages/recordings/00001-r1.html"));
  CHECK_THAT(page, Catch::Contains("overlaid cycles of 3 recordings"));
}
