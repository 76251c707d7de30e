#include <catch2/catch.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "examples.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/text.hpp"

using Catch::Contains;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string summary_of(const slipfit::Analysis& analysis) {
  return to_summary(test::small_recording(), analysis);
}

}  // namespace

TEST_CASE("the summary begins with motion, frequency, count and speed") {
  CHECK(lines_of(summary_of(test::full_analysis())).front() ==
        "folder/run.csv: stick-slip at 5.432 Hz [5.408, 5.456], 4 slips, driven at 10 mm/s");
}

TEST_CASE("the summary shows values with units, intervals without a value, and numbers the notes") {
  const std::string text = summary_of(test::full_analysis());
  CHECK_THAT(text, Contains("tangential stiffness k") && Contains("1002.3 N/m") && Contains("identified"));
  CHECK_THAT(text, Contains("[1.00, 2.00] N") && Contains("bounded (1)") && Contains("(1) the slip is not resolved."));
  CHECK_THAT(text, Contains("Not determined: static friction F_s: needs --zero."));
  CHECK_THAT(text, Contains("consistent with white noise") && !Contains("1.50"));
}

TEST_CASE("a note that continues another one is numbered for its rest alone") {
  slipfit::Analysis analysis = test::full_analysis();
  std::size_t count = 0;
  for (slipfit::Parameter& parameter : analysis.fit->parameters) {
    parameter.status = slipfit::ParameterStatus::Weak;
    parameter.estimate.note = ++count == 1 ? "the slips are rounded; at a stick time of 1 s" : "the slips are rounded";
  }
  const std::string text = summary_of(analysis);
  CHECK_THAT(text, Contains("weak (1, 2)") && Contains("weak (1)") && !Contains("weak (2)"));
  CHECK_THAT(text, Contains("(1) the slips are rounded.\n") && Contains("(2) at a stick time of 1 s.\n"));
}

TEST_CASE("a reason is printed once, for every parameter that is not determined and in footnotes") {
  slipfit::Analysis analysis = test::full_analysis();
  for (slipfit::Parameter& parameter : analysis.fit->parameters) {
    const bool is_bounded = parameter.id == slipfit::ParameterId::FrictionDifference;
    parameter.status = is_bounded ? slipfit::ParameterStatus::Bounded : slipfit::ParameterStatus::Unidentified;
    parameter.estimate.note = is_bounded ? "between half and all of the drop; the slip is no oscillation"
                              : parameter.id == slipfit::ParameterId::StaticFriction
                                  ? "needs --zero"
                                  : "the slip is no oscillation; the sensor may be slow";
  }
  analysis.warnings = {{"model_misfit", "the sensor may be slow; the slips are rounded"}};
  const std::string text = summary_of(analysis);
  const auto count_of = [&text](const std::string& words) {
    std::size_t count = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
    return count;
  };
  CHECK_THAT(text, Contains("bounded (1, 2)") && Contains("Not determined: static friction F_s: needs --zero."));
  CHECK(count_of("no oscillation") == 1);
  CHECK(count_of("needs --zero") == 1);
  CHECK(count_of("Not determined") == 2);
}

TEST_CASE("a summary is at most one screen") {
  slipfit::Analysis analysis = test::full_analysis();
  const std::string words = "a long explanation with many words that a reader of the first screen does not need; ";
  for (slipfit::Parameter& parameter : analysis.fit->parameters) {
    parameter.status = slipfit::ParameterStatus::Weak;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(parameter.id) % 4; ++i) parameter.estimate.note += words;
  }
  for (int i = 0; i < 20; ++i) analysis.warnings.push_back({"model_misfit", std::to_string(i) + words + words + words});
  for (int i = 0; i < 20; ++i) analysis.warnings.push_back({"gaps", words + words});
  const std::vector<std::string> lines = lines_of(summary_of(analysis));
  CHECK(lines.size() <= 25);
  for (const std::string& line : lines) CHECK(line.size() <= 100);
  CHECK_THAT(summary_of(analysis), Contains("more warnings: --details"));
}

TEST_CASE("the summary orders warnings by their effect and leaves facts to a sentence") {
  slipfit::Analysis analysis = test::full_analysis();
  analysis.warnings = {{"period_drifts", "the period drifts"},
                       {"gaps", "3 gaps in the clock"},
                       {"implausible_units", "a stiffness of 1 MN/m"}};
  const std::string text = summary_of(analysis);
  CHECK(text.find("! a stiffness of 1 MN/m.") < text.find("! the period drifts."));
  CHECK_THAT(text, Contains("3 gaps in the clock.") && !Contains("! 3 gaps"));
}

TEST_CASE("a saved document has the summary of its fit") {
  const slipfit::Recording recording = test::small_recording();
  const slipfit::Analysis analysis = test::full_analysis();
  const auto saved = slipfit::summary_of_document(to_json(recording, analysis), "run.json", {"more", "all"});
  CHECK(saved.value() == to_summary(recording, analysis, {"more", "all"}));
  CHECK(slipfit::summary_of_document("{}", "run.json").error().code == "bad_document");
}

TEST_CASE("an analysis without results has a summary without numbers") {
  const std::string text = summary_of(slipfit::Analysis());
  CHECK_THAT(text, Contains("motion undetermined") && !Contains("nan") && !Contains("value"));
}
