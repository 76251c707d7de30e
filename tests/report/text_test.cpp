#include "slipfit/report/text.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <sstream>

#include "examples.hpp"
#include "slipfit/report/csv.hpp"

using Catch::Contains;

namespace {

std::string line_with(const std::string& text, const std::string& part) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(part) != std::string::npos) return line;
  }
  return {};
}

}  // namespace

TEST_CASE("the report begins with the judgement") {
  const std::string text = to_text(test::small_recording(), test::full_analysis());
  CHECK(text.rfind("folder/run.csv: stick-slip at 5.432 Hz", 0) == 0);
}

TEST_CASE("parameters are named in words, rounded, with interval, unit and status") {
  const std::string text = to_text(test::small_recording(), test::full_analysis());
  const std::string stiffness = line_with(text, "tangential stiffness");
  CHECK_THAT(stiffness, Contains("1002.3") && Contains("[999.9, 1004.8]") && Contains("N/m") && Contains("identified"));
  CHECK_THAT(line_with(text, "damping ratio"), Contains("0.051") && Contains("weak"));
}

TEST_CASE("a bounded parameter shows its interval, an unidentified one nothing, and both their notes") {
  const std::string text = to_text(test::small_recording(), test::full_analysis());
  const std::string bounded = line_with(text, "friction drop F_s - F_k");
  CHECK_THAT(bounded, Contains("[1.00, 2.00]") && !Contains("1.50") && Contains("bounded"));
  CHECK_THAT(text, Contains("the slip is not resolved") && Contains("needs --zero"));
}

TEST_CASE("each status but identified is explained once") {
  const std::string text = to_text(test::small_recording(), test::full_analysis());
  CHECK_THAT(text, Contains("  weak: an estimate that should be confirmed\n") &&
                       Contains("  bounded: only an interval is known\n") &&
                       !Contains("identified: the data determine"));
}

TEST_CASE("correlated residuals are named, and a probability of 0 is given as a bound") {
  auto analysis = test::full_analysis();
  analysis.fit->residual = {0.02, 156.0, 0.0};
  const std::string text = to_text(test::small_recording(), analysis);
  CHECK_THAT(text, Contains("12.5 times the noise (reduced chi2 156)"));
  CHECK_THAT(text, Contains("neighbouring residuals are correlated") && Contains("below 1e-6"));
}

TEST_CASE("both frequencies are printed") {
  const std::string text = to_text(test::small_recording(), test::full_analysis());
  CHECK_THAT(line_with(text, "by FFT"), Contains("5.430 ± 0.020 Hz"));
  CHECK_THAT(line_with(text, "by counting slips"), Contains("5.432 ± 0.012 Hz"));
  CHECK_THAT(text, Contains("mains 50 Hz"));
}

TEST_CASE("measured and predicted spacing are in separate blocks") {
  const std::string text = to_text(test::small_recording(), test::full_analysis());
  const std::size_t measured = text.find("Spacing, measured (V/f)");
  const std::size_t spacing = text.find("pattern spacing");
  const std::size_t predicted = text.find("Predicted by the model at this speed");
  const std::size_t displacement = text.find("periodic displacement");
  CHECK(measured < spacing);
  CHECK(spacing < predicted);
  CHECK(predicted < displacement);
  CHECK(displacement != std::string::npos);
  CHECK_THAT(line_with(text, "pattern spacing"), Contains("1.8409") && Contains("mm"));
}

TEST_CASE("an analysis that knows nothing is reported without numbers") {
  const std::string text = to_text(test::small_recording(), slipfit::Analysis());
  CHECK_THAT(text,
             Contains("motion undetermined") && !Contains("nan") && !Contains("Parameters") && !Contains("Predicted"));
}

TEST_CASE("where there is no stick-slip the model's numbers are not shown, where there may be none they are marked") {
  auto analysis = test::full_analysis();
  analysis.motion = slipfit::MotionClass::SteadySliding;
  const std::string steady = to_text(test::small_recording(), analysis);
  CHECK_THAT(steady, Contains("steady sliding") && !Contains("tangential stiffness") && !Contains("Predicted"));
  analysis.motion = slipfit::MotionClass::Undetermined;
  const std::string doubtful = to_text(test::small_recording(), analysis);
  CHECK_THAT(doubtful, Contains("unreliable") && Contains("tangential stiffness") && !Contains("Predicted"));
}

TEST_CASE("a friction coefficient is shown without newtons") {
  const auto recording = test::small_recording(slipfit::ForceQuantity::FrictionCoefficient);
  CHECK_THAT(line_with(to_text(recording, test::full_analysis()), "peak force"),
             Contains("6.250") && Contains("standard deviation 0.062") && !Contains(" N"));
}

TEST_CASE("the table of cycles leaves unknown cells empty") {
  const std::string csv = cycles_to_csv(test::small_recording(), test::full_analysis());
  CHECK_THAT(csv,
             Contains("\n1,0.1,0.12,6,3,3,1,0.099,0.121,5.9,4,0.02\n") && Contains("\n2,0.3,0.32,6.5,3.5,3,0,,,,,\n"));
}

TEST_CASE("the curve has a row for each sample, empty where the fit does not reach") {
  const std::string csv = curve_to_csv(test::small_recording(), test::full_analysis());
  CHECK(csv.rfind("time_s,force_N,fitted_N,residual_N\n0,1,,\n", 0) == 0);
  CHECK_THAT(csv, Contains("\n0.002,1.2,1.25,"));
  const auto coefficient = test::small_recording(slipfit::ForceQuantity::FrictionCoefficient);
  CHECK(curve_to_csv(coefficient, {}).rfind("time_s,force_coefficient,", 0) == 0);
}

TEST_CASE("a point of the curve outside the recording, or not finite, is left out") {
  auto analysis = test::full_analysis();
  analysis.fit->curve = {{1000, 1.0}, {0, std::numeric_limits<double>::quiet_NaN()}};
  const std::string csv = curve_to_csv(test::small_recording(), analysis);
  CHECK(csv.rfind("time_s,force_N,fitted_N,residual_N\n0,1,,\n", 0) == 0);
}

TEST_CASE("a trace is written with every bit and a comment of one line") {
  const slipfit::SimulatedTrace trace{{0.0, 0.1 + 0.2}, {1.0 / 3.0, -2.0}};
  CHECK(trace_to_csv(trace, "made\nhere") ==
        "# made\\nhere\ntime_s,force_N\n0,0.3333333333333333\n0.30000000000000004,-2\n");
}

TEST_CASE("run-up and ring-down are printed if they are known") {
  auto analysis = test::full_analysis();
  CHECK_THAT(to_text(test::small_recording(), analysis), !Contains("Before and after the sliding"));
  analysis.transients.breakaway_force = {5.25, 0.05, slipfit::Interval{5.15, 5.35}, ""};
  const std::string text = to_text(test::small_recording(), analysis);
  CHECK_THAT(text, Contains("Before and after the sliding") && !Contains("ring-down, frequency"));
  CHECK_THAT(line_with(text, "first peak (breakaway)"), Contains("5.250") && Contains("[5.150, 5.350]"));
}

TEST_CASE("parameters that the data hardly distinguish are listed with their correlation") {
  auto analysis = test::full_analysis();
  CHECK_THAT(to_text(test::small_recording(), analysis), !Contains("Correlated parameters"));
  analysis.fit->correlation->matrix = {{1.0, -0.95}, {-0.95, 1.0}};
  CHECK_THAT(line_with(to_text(test::small_recording(), analysis), "tangential stiffness k; damping ratio zeta"),
             Contains("-0.95"));
}
