#include <catch2/catch.hpp>

#include "run_program.hpp"

namespace {

test::ProgramResult in_shell(const std::string& script) {
  return test::run_program("sh", {"-c", script, SLIPFIT_EXECUTABLE, std::string(SLIPFIT_TESTDATA_DIR) + "/demo.csv"});
}

}  // namespace

TEST_CASE("what cannot be written to standard output is an error, also of --help and --version") {
  for (const std::string command : {"--help", "--version", "fit --help", "fit \"$1\" --speed 10mm/s"}) {
    for (const std::string closed : {">/dev/full", ">&-"}) {
      CAPTURE(command, closed);
      const auto run = in_shell("\"$0\" " + command + " " + closed);
      CHECK(run.exit_code == 2);
      CHECK_THAT(run.err, Catch::StartsWith("slipfit: cannot write to standard output") && Catch::EndsWith("\n"));
    }
  }
}

TEST_CASE("the solver's logging options in the environment change no output") {
  const std::string fit = "\"$0\" fit \"$1\" --speed 10mm/s --json";
  const auto quiet = in_shell(fit);
  const auto noisy = in_shell(
      "GLOG_v=9 GLOG_vmodule='*=9' GLOG_logtostderr=1 GLOG_alsologtostderr=1 "
      "GLOG_minloglevel=0 GLOG_stderrthreshold=0 " +
      fit);
  REQUIRE(quiet.exit_code == 0);
  CHECK(noisy.out == quiet.out);
  CHECK(noisy.err.empty());
}
