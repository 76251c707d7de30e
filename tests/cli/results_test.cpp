#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "json_of.hpp"
#include "recordings.hpp"
#include "run_program.hpp"

using test::run_slipfit;

namespace {

struct SimulatedRun {
  test::TemporaryFolder folder;
  std::string file = folder.file("run.csv", test::simulated_csv("7"));
};

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

TEST_CASE("analyze needs no speed, and gives nothing that depends on it without one") {
  const SimulatedRun example;
  const nlohmann::json without = test::json_of({"analyze", example.file, "--json"});
  const nlohmann::json with = test::json_of({"analyze", example.file, "--speed", "20mm/s", "--json"});
  CHECK(without["status"] == "stick_slip");
  CHECK(without["frequency"] == with["frequency"]);
  CHECK(without["cycles"]["period_s"] == with["cycles"]["period_s"]);
  CHECK(without["recording"]["speed_m_per_s"].is_null());
  for (const char* name : {"pattern_spacing_m", "impulse_rate_per_m"}) {
    INFO(name);
    CHECK(with["derived"][name]["value"].is_number());
    CHECK(without["derived"][name]["value"].is_null());
    CHECK_THAT(without["derived"][name]["note"].get<std::string>(), Catch::Contains("--speed"));
  }
  CHECK(run_slipfit({"fit", example.file}).exit_code == 2);
}

TEST_CASE("help and version go to standard output with exit code 0") {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"--version"},
                                                    {"fit", "--help"},
                                                    {"analyze", "--help"},
                                                    {"simulate", "-h"}}) {
    const test::ProgramResult result = run_slipfit(arguments);
    CHECK(result.exit_code == 0);
    CHECK_FALSE(result.out.empty());
    CHECK(result.err.empty());
  }
  CHECK_THAT(run_slipfit({"--version"}).out, Catch::Matches("slipfit [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_CASE("the units of the command line are converted") {
  const SimulatedRun example;
  const auto speed = [&example](const std::vector<std::string>& words) {
    std::vector<std::string> arguments{"analyze", example.file, "--json"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    return test::json_of(arguments)["recording"];
  };
  CHECK(speed({"--speed", "1200 mm/min"})["speed_m_per_s"].get<double>() == Approx(0.02));
  CHECK(speed({"--speed", "60rpm", "--radius", "10mm"})["speed_m_per_s"].get<double>() == Approx(0.0628318531));
  CHECK(speed({"--speed", "0.02", "--speed-uncertainty", "1%"})["speed_se_m_per_s"].get<double>() == Approx(2e-4));
  CHECK(speed({"--speed", "0.02", "--speed-uncertainty", "1mm/s"})["speed_se_m_per_s"].get<double>() == Approx(1e-3));
  CHECK(speed({"--speed", "0.02", "--normal-force", "41 gf"})["normal_force_N"].get<double>() == Approx(0.40207265));
  CHECK(speed({"--speed", "0.02", "--force-view", "contact"})["force_view"] == "contact");
  CHECK(speed({"--speed", "0.02", "--window", "1:2"})["duration_s"].get<double>() == Approx(1.0).margin(0.002));
  CHECK(speed({"--speed", "0.02", "--zero", "-0.5"})["zero_force_N"].get<double>() == Approx(-0.5));
}

TEST_CASE("with --timing the document has the seconds of the stages") {
  const SimulatedRun example;
  const auto timing = test::json_of({"fit", example.file, "--speed", "20mm/s", "--json", "--timing"})["timing"];
  CHECK(timing["total_s"].get<double>() >= timing["read_s"].get<double>());
  CHECK(timing["read_s"].get<double>() > 0.0);
}

TEST_CASE("the file of --out equals standard output, and its rename leaves no temporary file") {
  const SimulatedRun example;
  const std::string out = example.folder.file("result.json", "old");
  const test::ProgramResult shown = run_slipfit({"fit", example.file, "--speed", "20mm/s", "--json"});
  const test::ProgramResult written = run_slipfit({"fit", example.file, "--speed", "20mm/s", "--json", "--out", out});
  CHECK(written.exit_code == 0);
  CHECK(written.out.empty());
  CHECK_THAT(written.err, Catch::Contains("wrote"));
  CHECK(test::content_of(out) == shown.out);
  CHECK(example.folder.names() == std::vector<std::string>{"result.json", "run.csv"});
  CHECK(run_slipfit({"fit", example.file, "--speed", "20mm/s", "--quiet", "--out", out}).err.empty());
}

TEST_CASE("option --out keeps a link a link and writes directly to special files") {
  const SimulatedRun example;
  const std::string target = example.folder.file("target.json", "old");
  const std::string link = example.folder.path("link.json");
  std::filesystem::create_symlink(target, link);
  CHECK(run_slipfit({"analyze", example.file, "--speed", "20mm/s", "--json", "--out", link}).exit_code == 0);
  CHECK(std::filesystem::is_symlink(link));
  CHECK(test::content_of(target).rfind('{', 0) == 0);
  CHECK(run_slipfit({"analyze", example.file, "--speed", "20mm/s", "--json", "--out", "/dev/null"}).exit_code == 0);
  CHECK(std::filesystem::is_character_file("/dev/null"));
  const test::ProgramResult full = run_slipfit({"analyze", example.file, "--speed", "20mm/s", "--out", "/dev/full"});
  CHECK(full.exit_code == 2);
  CHECK(test::lines_in(full.err) == 1);
}

TEST_CASE("files of --cycles and --curve are tables that agree with the document") {
  const SimulatedRun example;
  const std::string cycles = example.folder.path("cycles.csv");
  const std::string curve = example.folder.path("curve.csv");
  const auto document = test::json_of(
      {"fit", example.file, "--speed", "20mm/s", "--json", "--quiet", "--cycles", cycles, "--curve", curve});
  const std::string cycles_csv = test::content_of(cycles);
  const std::string curve_csv = test::content_of(curve);
  CHECK(first_line(cycles_csv) ==
        "cycle,peak_s,trough_s,peak_force_N,trough_force_N,force_drop_N,used,onset_s,end_s,onset_force_N,"
        "level_force_N,residual_rms_N");
  CHECK(first_line(curve_csv) == "time_s,force_N,fitted_N,residual_N");
  CHECK(test::lines_in(cycles_csv) == document["cycles"]["count"].get<std::size_t>() + 1);
  const auto samples = document["recording"]["samples"].get<std::size_t>();
  CHECK(test::lines_in(curve_csv) == samples + 1);
  std::size_t fitted = 0;
  std::istringstream lines(curve_csv);
  for (std::string line; std::getline(lines, line);) fitted += line.back() != ',' ? 1U : 0U;
  CHECK(fitted > samples / 2);
}

TEST_CASE("simulate gives the same bytes for the same seed, and slipfit reads them back") {
  const std::string csv = test::simulated_csv("3");
  CHECK(csv == test::simulated_csv("3"));
  CHECK(csv != test::simulated_csv("4"));
  CHECK(csv.rfind("# ", 0) == 0);
  const test::TemporaryFolder folder;
  const auto document = test::json_of({"analyze", folder.file("run.csv", csv), "--speed", "20mm/s", "--json"});
  CHECK(document["recording"]["samples"].get<std::size_t>() + 2 == test::lines_in(csv));
}

TEST_CASE("a fixed parameter is held and said to be fixed") {
  const SimulatedRun example;
  const auto document =
      test::json_of({"fit", "--fix", "damping_ratio=0.06", example.file, "--speed", "20mm/s", "--json"});
  CHECK(document["parameters"]["damping_ratio"]["value"] == 0.06);
  CHECK(document["parameters"]["damping_ratio"]["status"] == "fixed");
}

TEST_CASE("intervals of the demonstration file include what it was made with, its trend read either way") {
  const std::string demo = std::string(SLIPFIT_TESTDATA_DIR) + "/demo.csv";
  const std::vector<std::string> arguments{"fit", demo, "--speed", "10mm/s", "--zero", "0", "--json"};
  const auto with_drift = [&](const std::string& reading) {
    std::vector<std::string> stated = arguments;
    stated.insert(stated.end(), {"--drift", reading});
    return test::json_of(stated);
  };
  const auto document = test::json_of(arguments);
  for (const auto& [name, truth] : {std::pair{"stiffness_N_per_m", 5000.0},
                                    {"friction_difference_N", 1.0},
                                    {"static_friction_N", 4.0},
                                    {"kinetic_friction_N", 3.0},
                                    {"natural_frequency_rad_per_s", 900.0},
                                    {"mass_kg", 5000.0 / (900.0 * 900.0)},
                                    {"damping_ratio", 0.05}}) {
    CAPTURE(name, truth);
    CHECK(document["parameters"][name]["ci95"][0] <= truth);
    CHECK(document["parameters"][name]["ci95"][1] >= truth);
  }
  CHECK(document["parameters"]["static_friction_N"]["status"] == "conditional");
  CHECK(document["level_trend"]["reading"] == "open");
  CHECK(document["level_trend"]["ci95"][0] <= 0.2);
  CHECK(document["level_trend"]["ci95"][1] >= 0.2);
  const auto sensor = with_drift("sensor")["parameters"]["stiffness_N_per_m"];
  const auto friction = with_drift("friction")["parameters"]["stiffness_N_per_m"];
  CHECK(sensor["ci95"][1] < friction["ci95"][0]);  // 0.2 N/s over 10 mm/s: 20 N/m
  const auto open = document["parameters"]["stiffness_N_per_m"];
  CHECK(open["ci95"][0] <= sensor["ci95"][0]);
  CHECK(open["ci95"][1] >= friction["value"]);
  const auto none = with_drift("none");
  CHECK(none["level_trend"]["reading"] == "none");
  CHECK(none["parameters"]["static_friction_N"]["se"] < document["parameters"]["static_friction_N"]["se"]);
  CHECK(none["warnings"].dump().find("although no trend is stated") != std::string::npos);
  CHECK(run_slipfit({"fit", demo, "--speed", "10mm/s", "--drift", "up"}).exit_code == 2);
}

TEST_CASE(
    "fewer than three cycles, or fewer than two samples in a cycle, identify nothing that they do not determine") {
  const test::TemporaryFolder folder;
  const auto fit = [&](std::size_t samples, double period_s) {
    const auto force_N = [period_s](double time_s) { return test::sawtooth_N(time_s, period_s); };
    const std::string file = folder.file("run.csv", test::recording_csv(samples, 1000.0, force_N));
    return test::json_of({"fit", file, "--speed", "10mm/s", "--json", "--quiet"});
  };
  CHECK(fit(1800, 1.0)["status"] == "undetermined");
  const auto aliased = fit(3000, 1.0 / 613.0);
  for (const std::string name : {"damping_ratio", "natural_frequency_rad_per_s"}) {
    const bool given = aliased.contains("parameters") && aliased["parameters"].contains(name);
    CHECK((!given || aliased["parameters"][name]["status"] != "identified"));
  }
}
