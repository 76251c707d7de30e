// What people read: each message says what was seen and what it means, in words that need no documentation.

#include <algorithm>
#include <catch2/catch.hpp>
#include <regex>

#include "report/format.hpp"
#include "run_program.hpp"

using Catch::Contains;

namespace {

const std::string kDemo = std::string(SLIPFIT_TESTDATA_DIR) + "/demo.csv";

std::string fit_text(const std::vector<std::string>& options) {
  std::vector<std::string> arguments{"fit", kDemo, "--details"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto run = test::run_slipfit(arguments);
  REQUIRE(run.exit_code == 0);
  return run.out;
}

std::string unwrapped(const std::string& text) {
  return std::regex_replace(text, std::regex("\n {4,}"), " ");
}

}  // namespace

TEST_CASE("no line of all results is longer than a line of text") {
  const std::size_t longest = test::widest_line(fit_text({"--speed", "10mm/s"}));
  CHECK(longest <= slipfit::kLineWidth);
  CHECK(longest > slipfit::kLineWidth / 2);
}

TEST_CASE("a test without a finding states its level") {
  const std::string text = fit_text({"--speed", "10mm/s"});
  CHECK_THAT(text, Contains("from start to end: not proven at the 0.1 % level (p ") && !Contains("chance"));
}

TEST_CASE("AICc is printed with the compared model, the sign in words and the threshold") {
  const std::string text = unwrapped(fit_text({"--speed", "10mm/s"}));
  CHECK_THAT(
      text, Contains("lower than that of the undamped model: the added parameter is justified (10 lower is required)"));
  CHECK_THAT(text, Contains("a model with more parameters is justified") && !Contains("pays"));
  CHECK_THAT(fit_text({"--speed", "10mm/s", "--tier", "undamped"}), Contains("requested by --tier\n"));
  const std::string sawtooth = unwrapped(fit_text({"--speed", "10mm/s", "--tier", "sawtooth"}));
  CHECK_THAT(sawtooth, Contains("requested by --tier; the data alone: a model with more parameters is justified"));
  CHECK_THAT(sawtooth, Contains("the slips of the sawtooth model, which --tier requests, take no time"));
}

TEST_CASE("the residual is printed as a multiple of the noise, with its whiteness") {
  const std::string text = fit_text({"--speed", "10mm/s"});
  CHECK_THAT(text, Contains("0.99 times the noise (reduced chi2 0.98)"));
  CHECK_THAT(text, Contains("residuals: consistent with white noise (whiteness p 0.14, level 0.001)"));
}

TEST_CASE("forces without a stated zero are conditional, with the condition and the remedy, in text and page") {
  const test::TemporaryFolder folder;
  const std::string text = fit_text({"--speed", "10mm/s", "--report", folder.path("r.html")});
  const std::string condition = "assumes that the sensor reads 0 without force";
  CHECK_THAT(text, Contains("static friction F_s, kinetic friction F_k: " + condition) && Contains("--zero"));
  CHECK_THAT(text, Contains("conditional: determined if the assumption in its note holds"));
  const std::string page = test::content_of(folder.path("r.html"));
  CHECK_THAT(page, Contains("<span class=\"status conditional\">conditional</span>") &&
                       Contains("<li>conditional: determined if the assumption in its note holds</li>"));
  CHECK_THAT(page, !Contains("fixed at the stated value"));
  CHECK_THAT(fit_text({"--speed", "10mm/s", "--zero", "0"}), !Contains("reads 0 without force"));
}

TEST_CASE("speeds come back in the unit that they were given in, in text and page") {
  const test::TemporaryFolder folder;
  const std::string text =
      fit_text({"--speed", "600 mm/min", "--report", folder.path("r.html"), "--plots", folder.path("p")});
  CHECK_THAT(text, Contains("measured (V/f) at 600 mm/min") && Contains("mm/min  [") && !Contains("mm/s"));
  CHECK_THAT(test::content_of(folder.path("r.html")),
             Contains("600\u00a0mm/min") && Contains("driving speed [mm/min]"));
  CHECK_THAT(test::content_of(folder.path("p/speed.svg")), Contains("driving speed [mm/min]"));
  CHECK_THAT(fit_text({"--speed", "10000um/s"}), Contains("at 10000 um/s"));
  CHECK_THAT(fit_text({"--speed", "0.01"}), Contains("at 10 mm/s"));
  CHECK_THAT(fit_text({"--speed", "8rpm", "--radius", "12mm"}), Contains("at 10.0531 mm/s"));
}

TEST_CASE("a prediction, a plan and a sweep show speeds in the unit that they were given in") {
  const test::TemporaryFolder folder;
  fit_text({"--speed", "10mm/s", "--json", "--out", folder.path("fit.json")});
  const auto predicted = test::run_slipfit({"predict", folder.path("fit.json"), "--speeds", "300mm/min,600mm/min"});
  CHECK_THAT(predicted.out, Contains("[mm/min]") && Contains("critical speed: 12") && !Contains("mm/s"));
  const auto plan =
      test::run_slipfit({"plan", folder.path("fit.json"), "--for", "periodic_displacement_m", "--at", "600mm/min"});
  CHECK_THAT(plan.out, Contains("at 600.0 mm/min") && !Contains("mm/s"));
  const std::string row = "," + kDemo + ",600\n";
  const std::string manifest = folder.file("runs.csv", "id,file,speed [mm/min]\na" + row + "b" + row);
  CHECK_THAT(test::run_slipfit({"fit", "--joint", manifest}).out, Contains("600 mm/min") && !Contains("mm/s"));
}

TEST_CASE("the default text is one screen, and it names the way to all results") {
  const auto run = test::run_slipfit({"fit", kDemo, "--speed", "10mm/s"});
  REQUIRE(run.exit_code == 0);
  CHECK(std::count(run.out.begin(), run.out.end(), '\n') <= 25);
  CHECK_THAT(run.out, Contains("friction drop F_s - F_k") && Contains("conditional (1)") && Contains("--details"));
  CHECK_THAT(run.out, Contains("pattern spacing V/f") && !Contains("Frequency\n"));
}
