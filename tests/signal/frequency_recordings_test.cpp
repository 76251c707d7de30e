#include <catch2/catch.hpp>

#include "finding.hpp"

using namespace slipfit;
using traces::find;
using traces::find_held;
using traces::names_line;

TEST_CASE("synthetic recordings: the frequency that was put in") {
  const auto table = traces::load_table(traces::shared("synthetic/truth.csv"));
  if (table.empty()) {
    WARN("skipped: no shared data");
    return;
  }
  int compared = 0;
  for (const auto& row : table) {
    const auto recording = traces::load(traces::shared("synthetic/" + row.at("id") + ".csv"));
    REQUIRE(recording);
    const auto found = find_held(*recording);
    CAPTURE(row.at("id"), row.at("note"));
    if (row.at("family") == "steady") CHECK_FALSE(found.value_Hz);
    if (row.count("f") == 0 || row.at("f").empty()) continue;
    const double truth = std::stod(row.at("f"));
    traces::check_frequency(found, truth, 0.01);
    CHECK(std::abs(*found.value_Hz - truth) < 3.5 * *found.standard_error_Hz);
    ++compared;
  }
  CHECK(compared >= 40);
}

TEST_CASE("paper on paper: oscillation at 35 Hz, no line in a trace whose periods scatter by 40 %, none in sliding") {
  const auto fast = traces::load(traces::shared("real/colas/colas_k1002_v4300.csv"));
  const auto slow = traces::load(traces::shared("real/colas/colas_k168_v42.csv"));
  const auto sliding = traces::load(traces::shared("real/colas/colas_k2254_v42.csv"));
  if (!fast || !slow || !sliding) {
    WARN("skipped: no shared data");
    return;
  }
  CHECK(find_held(*fast).value_Hz.value() == Approx(35.0).epsilon(0.04));
  // The spectrum of so irregular a trace has a shoulder there, no line: nothing, or the right thing.
  CHECK(find_held(*slow, 0.6).value_Hz.value_or(0.6) == Approx(0.6).margin(0.1));
  for (const bool held : {false, true}) {
    const auto none = held ? find_held(*sliding) : find(*sliding);
    CHECK_FALSE(none.value_Hz);
    CHECK(none.false_alarm_probability > 0.05);
    CHECK(names_line(none, 50.0, "mains 50 Hz"));
  }
}

TEST_CASE("printed plastic, uneven clock: within 12 % of the published spacing where the run-in is short") {
  const auto table = traces::load_table(traces::shared("real/fdm/published_spacing.csv"));
  if (table.empty()) {
    WARN("skipped: no shared data");
    return;
  }
  int compared = 0;
  for (const auto& row : table) {
    const double speed_mm_per_s = std::stod(row.at("speed_mm_min")) / 60.0;
    if (speed_mm_per_s < 1.6 || speed_mm_per_s > 5.1) continue;  // 100 to 300 mm/min
    const auto recording =
        traces::load(traces::shared("real/fdm/fdm_" + row.at("mass_g") + "g_" + row.at("speed_mm_min") + "mm_min.csv"));
    REQUIRE(recording);
    CAPTURE(row.at("mass_g"), row.at("speed_mm_min"));
    const auto found = find_held(*recording);
    REQUIRE(found.value_Hz);
    CHECK(speed_mm_per_s / *found.value_Hz == Approx(std::stod(row.at("published_spacing_mm"))).epsilon(0.12));
    ++compared;
  }
  CHECK(compared == 8);
}
