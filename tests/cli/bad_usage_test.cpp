#include <catch2/catch.hpp>

#include "recordings.hpp"
#include "refusal.hpp"
#include "run_program.hpp"

using test::check_refused;
using test::run_slipfit;

TEST_CASE("speeds of several recordings are given with a comma behind each unit, or one by one") {
  const std::string file = SLIPFIT_TESTDATA_DIR "/demo.csv";
  const test::ProgramResult listed = run_slipfit({"fit", file, file, "--speed", "10mm/s,20mm/s", "--json"});
  CHECK(listed.exit_code == 0);
  CHECK(listed.out == run_slipfit({"fit", file, file, "--speed", "10mm/s", "--speed", "20mm/s", "--json"}).out);
  CHECK_THAT(listed.out, Catch::Contains("\"speed_m_per_s\": 0.02"));
}

TEST_CASE("a file in place of a command is fitted, and symbols name parameters") {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("run.csv", test::simulated_csv("5"));
  const test::ProgramResult fitted = run_slipfit({file, "--speed", "10mm/s", "--fix", "zeta=0.05", "--json"});
  CHECK(fitted.exit_code == 0);
  CHECK_THAT(fitted.out, Catch::Contains("\"damping_ratio\": 0.05"));
  CHECK(fitted.out == run_slipfit({"fit", file, "--speed", "10mm/s", "--fix", "damping_ratio=0.05", "--json"}).out);
}

TEST_CASE("a file behind --json is no recording") {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("run.csv", test::simulated_csv("5"));
  check_refused({"fit", file, "--speed", "10mm/s", "--json", "out.json"}, "give --json --out out.json");
  const std::string model = folder.file("fit.json", run_slipfit({"fit", file, "--speed", "10mm/s", "--json"}).out);
  CHECK(run_slipfit({"predict", "--speeds", "20mm/s", "--json", model}).exit_code == 0);
}

TEST_CASE("a speed that cannot be a driving speed is refused") {
  const std::string file = "no-such-recording.csv";
  for (const std::string command : {"analyze", "fit"}) {
    check_refused({command, file, "--speed", "-1"}, "not above zero");
    check_refused({command, file, "--speed", "-1mm/s"}, "not above zero");
    check_refused({command, file, "--speed", "fast"}, "fast");
    check_refused({command, file, "--speed", "0,01"}, "write the decimal sign as a point");
    check_refused({command, file, "--speed", "nan"}, "nan");
    check_refused({command, file, "--speed", "inf"}, "inf");
    check_refused({command, file, "--speed", ""}, "--speed");
    check_refused({command, file, "--speed", "3 kg"}, "kg");
    check_refused({command, file, "--speed", "60rpm"}, "--radius");
    check_refused({command, file, "--speed", "60rpm", "--radius", "0"}, "--radius");
    check_refused({command, file, "--speed", "60rpm", "--radius", "-3mm"}, "--radius");
    check_refused({command, file, "--speed", "1", "--speed-uncertainty", "-1%"}, "--speed-uncertainty");
    check_refused({command, file, "--speed", "1", "--speed-uncertainty", "60%"}, "more than half of the speed");
  }
}

TEST_CASE("options of the recording that make no sense are refused") {
  const std::vector<std::string> start{"analyze", "no-such-recording.csv", "--speed", "0.01"};
  const auto refused = [&start](const std::string& option, const std::string& text, const std::string& part) {
    std::vector<std::string> arguments = start;
    arguments.insert(arguments.end(), {option, text});
    check_refused(arguments, option);
    check_refused(arguments, part);
  };
  refused("--normal-force", "0", "not above zero");
  refused("--normal-force", "5 m", "not a unit of force");
  refused("--window", "3", "T0:T1");
  refused("--window", "a:b", "a");
  refused("--time-unit", "furlong", "furlong");
  refused("--force-unit", "furlong", "furlong");
  refused("--force-view", "sideways", "spring, transmitted or contact");
  refused("--radius", "x", "x");
}

TEST_CASE("options of the fit that make no sense are refused") {
  const std::vector<std::string> start{"fit", "no-such-recording.csv", "--speed", "0.01"};
  const auto refused = [&start](const std::string& option, const std::string& text, const std::string& part) {
    std::vector<std::string> arguments = start;
    arguments.insert(arguments.end(), {option, text});
    check_refused(arguments, part);
  };
  refused("--tier", "velocity", "speed sweep");
  refused("--fix", "damping_ratio", "NAME=VALUE");
  refused("--fix", "damping_ratio=1", "below 1");
  refused("--fix", "stiffness_N_per_m=0", "above 0");
  refused("--fix", "stiffness_N_per_m=1e400", "1e400");
  refused("--fix", "stiffness_N_per_m=12x", "12x");
  check_refused({"fit", "x.csv", "--speed", "1", "--fix", "damping_ratio=0.1", "--fix", "damping_ratio=0.2"}, "twice");
}

TEST_CASE("an output that would destroy the recording, or has no place, is refused") {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("run.csv", "time_s,force_N\n0,1\n");
  const std::string link = folder.path("link.csv");
  std::filesystem::create_symlink(file, link);
  for (const std::string option : {"--out", "--cycles", "--curve"}) {
    check_refused({"fit", file, "--speed", "1", option, link}, "the recording itself");
    check_refused({"fit", file, "--speed", "1", option, folder.path("")}, "folder");
    check_refused({"fit", file, "--speed", "1", option, folder.path("none/x.csv")}, "does not exist");
  }
  check_refused({"fit", file, "--speed", "1", "--out", folder.path("a"), "--cycles", folder.path("a")}, "same file");
  CHECK(test::content_of(file) == "time_s,force_N\n0,1\n");
}

TEST_CASE("a simulation that makes no sense is refused") {
  const std::vector<std::string> start{"simulate", "--stiffness", "1000", "--static-friction", "6", "--speed",
                                       "0.02",     "--duration",  "1",    "--sample-rate"};
  const auto refused = [&start](const std::vector<std::string>& rest, const std::string& part) {
    std::vector<std::string> arguments = start;
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    check_refused(arguments, part);
  };
  refused({"1000", "--mass", "1"}, "--kinetic-friction is missing");
  refused({"1000", "--kinetic-friction", "4"}, "--natural-frequency");
  refused({"1000", "--kinetic-friction", "4", "--mass", "0"}, "--mass");
  refused({"1000", "--kinetic-friction", "7", "--mass", "1"}, "static");
  refused({"1000", "--kinetic-friction", "4", "--mass", "1", "--damping-ratio", "-0.1"}, "damping");
  refused({"1000", "--kinetic-friction", "4", "--mass", "1", "--noise", "-1"}, "--noise");
  refused({"1000", "--kinetic-friction", "4", "--mass", "1", "--seed", "x"}, "--seed");
  refused({"1000", "--mass", "1", "--f0", "3", "--f1", "1"}, "--alpha is missing");
  refused({"1000", "--mass", "1", "--f0", "3", "--f1", "1", "--alpha", "x"}, "--alpha");
  refused({"1000", "--mass", "1", "--f0", "3", "--f1", "-4", "--alpha", "-1"}, "f0 + f1 (N) is -1");
  refused({"1000", "--mass", "1", "--f0", "3", "--f1", "9", "--alpha", "-1"}, "static friction");
  refused({"1000", "--mass", "1", "--f0", "3", "--f1", "1", "--alpha", "1e9"}, "alpha * speed");
  refused({"0", "--kinetic-friction", "4", "--mass", "1"}, "--sample-rate");
  refused({"1e15", "--kinetic-friction", "4", "--mass", "1"}, "samples");
}
