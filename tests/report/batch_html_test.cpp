#include "report/batch_html.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "examples.hpp"
#include "slipfit/report/json.hpp"

using Catch::Contains;

namespace {

// Places in BatchPageRow::quantities.
constexpr std::size_t kForceDifference = 3;
constexpr std::size_t kDampingRatio = 4;

slipfit::BatchPageRow row(const std::string& id) {
  slipfit::JsonOptions options;
  options.id = id;
  options.layout = slipfit::JsonLayout::OneLine;
  return slipfit::batch_page_row(to_json(test::small_recording(), test::full_analysis(), options)).value();
}

/// "1-2 3" as "1 -2 3"
std::string spaced(std::string path) {
  for (std::size_t at = path.find('-'); at != std::string::npos; at = path.find('-', at + 2)) path.insert(at, " ");
  return path;
}

}  // namespace

TEST_CASE("a batch's page has a row a recording, sortable by value, with a link and a sparkline") {
  slipfit::BatchPage batch{"batch", {row("run 7")}, {{"run8", "no_force_column", "no force"}}};
  batch.rows[0].report_file = "reports/run 7#.html";
  batch.rows[0].sparkline = "M0 26l60-26 60 13";
  const std::string page = to_html(batch);
  CHECK_THAT(page, Contains("1 recording: 1 stick-slip; 1 failed."));
  CHECK_THAT(page, Contains("<a href=\"./reports/run%207%23.html\">run 7</a>"));
  CHECK_THAT(page, Contains("data-value=\"5.4321\">5.432<small>[5.408, 5.456]</small>"));
  CHECK_THAT(page, Contains("M0 26l60-26 60 13"));
  CHECK_THAT(page, Contains("no_force_column"));
}

TEST_CASE("the page of a batch shows the status of F_s - F_k and of the damping ratio") {
  slipfit::BatchPageRow shown = row("run");
  shown.quantities[kForceDifference].estimate = {1.25, 1e-9, slipfit::Interval{1.249999998, 1.250000002}, {}};
  shown.quantities[kForceDifference].status = "conditional";
  const std::string page = to_html(slipfit::BatchPage{"batch", {shown}, {}});
  CHECK_THAT(page, Contains("F_s - F_k [N]"));
  CHECK_THAT(page, Contains("1.2500<small>[1.2500, 1.2500]</small><small><span class=\"status conditional\">"));
}

TEST_CASE("a file that is not a fit document is refused, and a missing quantity is a dash") {
  for (const char* line :
       {"", "{", "[]", "null", "{\"schema\":1}", "{\"schema\":\"slipfit.predict/1\",\"id\":\"a\"}",
        R"({"schema":"slipfit.fit/1","id":"a","status":"undetermined","frequency":{"ci95_Hz":[1]}})"}) {
    CAPTURE(line);
    const auto bad = slipfit::batch_page_row(line);
    REQUIRE_FALSE(bad);
    CHECK(bad.error().code == "bad_document");
  }
  const char* bare = R"({"schema":"slipfit.fit/1","id":"a","status":"undetermined","parameters":null,"derived":{},)"
                     R"("frequency":{"value_Hz":null,"ci95_Hz":null}})";
  const auto read = slipfit::batch_page_row(bare);
  REQUIRE(read);
  CHECK_THAT(to_html(slipfit::BatchPage{"batch", {read.value()}, {}}),
             Contains("<td class=\"number\" data-value=\"\">-</td>"));
}

TEST_CASE("a group is counted on its own and stays out of the distributions") {
  slipfit::BatchPage batch{"batch", {6, row("run")}, {}};
  for (std::size_t i = 0; i < 2; ++i) batch.rows[i].id = "group:" + std::to_string(i);
  const std::string page = to_html(batch);
  CHECK_THAT(page, Contains("4 recordings: 4 stick-slip; 2 groups."));
  CHECK_THAT(page, !Contains("<h2>Distributions</h2>"));  // of five recordings at least
}

TEST_CASE("a distribution states the values that a logarithmic axis cannot show") {
  slipfit::BatchPage batch{"batch", {7, row("run")}, {}};
  for (slipfit::BatchPageRow& each : batch.rows) each.quantities[kDampingRatio].estimate.value = 0.05;
  CHECK_THAT(to_html(batch), Contains(">damping ratio zeta [-]<"));
  batch.rows[2].quantities[kDampingRatio].estimate.value = 0.0;
  batch.rows[3].quantities[kDampingRatio].estimate.value = 1e-12;
  CHECK_THAT(to_html(batch), Contains(">damping ratio zeta [-], 2 at zero not drawn<"));
}

TEST_CASE("a long table shows its first rows at once, keeps more for the script, and states what it leaves out") {
  const slipfit::BatchPage batch{"batch", {10001, row("run")}, {10002, {"bad", "empty", "no data"}}};
  const std::string page = to_html(batch);
  const auto rows_before = [&page](const char* what) {
    const std::size_t end = page.find(what);
    std::size_t count = 0;
    for (std::size_t at = page.find("<tr data-status"); at < end; at = page.find("<tr data-status", at + 1)) ++count;
    return count;
  };
  CHECK(rows_before("<template id=\"later\"") == 500);
  CHECK(rows_before("</template>") == 10000);
  CHECK_THAT(page, Contains("1 more are in results.jsonl") && Contains("2 more are in failures.csv"));
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
  const std::string line = slipfit::sparkline_of(recording.value());
  CHECK(line.size() <= 1024);
  CHECK(line.find_first_not_of("Ml0123456789 -") == std::string::npos);
  std::istringstream numbers(line.substr(1, line.find('l') - 1) + " " + spaced(line.substr(line.find('l') + 1)));
  double x = 0.0;
  double y = 0.0;
  double lowest = 26.0;
  double highest = 0.0;
  for (double dx = 0.0, dy = 0.0; numbers >> dx >> dy;) {
    x += dx;
    y += dy;
    lowest = std::min(lowest, y);
    highest = std::max(highest, y);
  }
  CHECK(x == 120.0);
  CHECK(lowest == 0.0);
  CHECK(highest == 26.0);
}

TEST_CASE("the distributions of a batch are as wide as a telephone, and long names break") {
  slipfit::BatchPage batch{"batch", {}, {}};
  for (int i = 0; i < 6; ++i) batch.rows.push_back(row("run" + std::to_string(i)));
  const std::string page = to_html(batch);
  CHECK_THAT(page, Contains("id=\"frequency_Hz\"") && Contains("viewBox=\"0 0 380 "));
  CHECK_THAT(page, Contains("text-wrap: balance; overflow-wrap: anywhere"));
}
