#include "slipfit/report/batch_html.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "examples.hpp"
#include "slipfit/report/json.hpp"

using Catch::Contains;

namespace {

std::string document(const std::string& id) {
  slipfit::JsonOptions options;
  options.id = id;
  options.layout = slipfit::JsonLayout::OneLine;
  return to_json(test::small_recording(), test::full_analysis(), options);
}

}  // namespace

TEST_CASE("a batch's page has a row a recording, sortable by value, with a link and a sparkline") {
  const slipfit::BatchPage batch{"batch",
                                 {{document("run 7"), "reports/run 7#.html", {0.0, 1.0, 0.5}}},
                                 {{"run8", "no_force_column", "no force"}}};
  const auto page = to_html(batch);
  REQUIRE(page);
  CHECK_THAT(page.value(), Contains("1 recording: 1 stick-slip; 1 more could not be read."));
  CHECK_THAT(page.value(), Contains("<a href=\"./reports/run%207%23.html\">run 7</a>"));
  CHECK_THAT(page.value(), Contains("data-value=\"5.4321\">5.432<small>[5.408, 5.456]</small>"));
  CHECK_THAT(page.value(), Contains("M0.0 28.0L60.0 2.0L120.0 15.0"));
  CHECK_THAT(page.value(), Contains("no_force_column"));
}

TEST_CASE("a batch's page keeps text from outside text") {
  const std::string hostile = "</script><script>alert(1)</script>";
  const auto page =
      to_html(slipfit::BatchPage{hostile, {{document(hostile), "x\"><script>", {}}}, {{hostile, hostile, hostile}}});
  REQUIRE(page);
  CHECK_THAT(page.value(), !Contains("<script>alert") && !Contains("\"><script>"));
}

TEST_CASE("what is no fit document is refused, what a document leaves out is a dash") {
  for (const char* line :
       {"", "{", "[]", "null", "{\"schema\":1}", "{\"schema\":\"slipfit.predict/1\",\"id\":\"a\"}"}) {
    CAPTURE(line);
    const auto page = to_html(slipfit::BatchPage{"batch", {{line, "", {}}}, {}});
    REQUIRE_FALSE(page);
    CHECK(page.error().code == "bad_document");
  }
  const char* bare = R"({"schema":"slipfit.fit/1","id":"a","status":"undetermined","parameters":null,"derived":3,)"
                     R"("frequency":{"value_Hz":"x","ci95_Hz":[1]},"recording":[]})";
  const auto page = to_html(slipfit::BatchPage{"batch", {{bare, "", {}}}, {}});
  REQUIRE(page);
  CHECK_THAT(page.value(), Contains("<td class=\"number\" data-value=\"\">-</td>"));
}

TEST_CASE("a sparkline is short and keeps the extremes") {
  std::vector<double> time_s;
  std::vector<double> force;
  for (int i = 0; i < 10000; ++i) {
    time_s.push_back(i);
    force.push_back(i == 5432 ? 7.0 : i == 1234 ? -3.0 : 0.0);
  }
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = 0.01;
  const auto recording = slipfit::Recording::create(time_s, force, conditions);
  const std::vector<double> line = slipfit::sparkline_of(recording.value());
  CHECK(line.size() <= 120);
  CHECK(*std::max_element(line.begin(), line.end()) == 7.0);
  CHECK(*std::min_element(line.begin(), line.end()) == -3.0);
}
