#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "examples.hpp"
#include "report/html/speed_figures.hpp"
#include "slipfit/report/sweep_html.hpp"

using Catch::Contains;
using namespace slipfit;

namespace {

Estimate known(double value, double low, double high) {
  return {value, 0.25 * (high - low), Interval{low, high}, {}};
}

/// Two recordings at 10 and 100 mm/s that were fitted together, and a prediction between and beyond them. The numbers
/// are made up.
struct Sweep {
  std::vector<SweepEntry> entries;
  SweepAnalysis analysis;
  std::optional<Prediction> prediction;

  Sweep() {
    analysis.fit.emplace();
    for (const double speed_m_per_s : {0.01, 0.1}) {
      entries.push_back({entries.empty() ? "slow" : "fast", recording(speed_m_per_s, std::nullopt)});
      analysis.recordings.push_back(test::full_analysis());
      analysis.roles.push_back(SweepRole::Cycles);
      SweepPoint point;
      point.spacing_m = known(0.0018, 0.0017, 0.0019);
      point.spacing_left_out_m = point.spacing_m;
      analysis.fit->points.push_back(point);
    }
    analysis.fit_reason = "2 with stick-slip cycles, 0 sliding steadily, 0 left out";
    prediction.emplace();
    for (const double speed_m_per_s : {0.01, 0.1, 1.0}) {
      PredictedMotion row;
      row.speed_m_per_s = speed_m_per_s;
      row.periodic_displacement_m = known(0.0018, 0.0017, 0.0019);
      prediction->rows.push_back(row);
    }
  }

  static Recording recording(double speed_m_per_s, std::optional<double> surface_spacing_m) {
    const Recording small = test::small_recording();
    Conditions conditions = small.conditions();
    conditions.speed_m_per_s = speed_m_per_s;
    conditions.measured_spacing_m = surface_spacing_m;
    return Recording::create({small.time_s().begin(), small.time_s().end()},
                             {small.force().begin(), small.force().end()}, conditions, small.provenance())
        .value();
  }

  [[nodiscard]] html::Figure spacing_figure() const {
    return html::sweep_spacing_figure({entries, analysis, prediction});
  }
  [[nodiscard]] std::string page() const { return to_html(entries, analysis, prediction, {"dry", {}}); }
};

}  // namespace

TEST_CASE("the chart of spacing over speed shows where stick-slip ends, with its interval") {
  Sweep sweep;
  sweep.prediction->critical_speed_m_per_s = known(0.3, 0.2, 0.5);
  const html::Figure figure = sweep.spacing_figure();
  REQUIRE(figure.chart);
  const chart::Panel& panel = figure.chart->panels.at(0);
  CHECK(panel.x.label == "driving speed [mm/s]");
  const chart::Line& end = panel.lines.back();
  CHECK(end.name == "stick-slip ends, 95 %");
  REQUIRE(end.points.size() == 2);
  for (const chart::Point& point : end.points) CHECK(point.x == Approx(300.0));
  const chart::Area& band = panel.areas.back();
  REQUIRE(band.outline.size() == 4);
  CHECK(band.outline[0].x == Approx(200.0));
  CHECK(band.outline[2].x == Approx(500.0));
  CHECK(band.outline[0].y == panel.y.low);
  CHECK(band.outline[2].y == panel.y.high);
  CHECK_THAT(sweep.page(), Contains("stick-slip ends, 95 %"));
}

TEST_CASE("the band of the critical speed ends with the axis, and is absent if the speed is outside") {
  Sweep sweep;
  sweep.prediction->critical_speed_m_per_s = known(0.3, 0.001, 50.0);
  const html::Figure figure = sweep.spacing_figure();
  const chart::Panel& panel = figure.chart->panels.at(0);
  CHECK(panel.areas.back().outline[0].x == panel.x.low);
  CHECK(panel.areas.back().outline[2].x == panel.x.high);
  sweep.prediction->critical_speed_m_per_s = known(30.0, 20.0, 50.0);
  CHECK_THAT(sweep.page(), !Contains("stick-slip ends, 95 %"));
  sweep.prediction->critical_speed_m_per_s = {};
  CHECK_THAT(sweep.page(), !Contains("stick-slip ends, 95 %"));
}

TEST_CASE("the band over speed ends where an interval is unknown, and begins again behind it") {
  Sweep sweep;
  PredictedMotion row = sweep.prediction->rows.front();
  sweep.prediction->rows.clear();
  for (const double speed_m_per_s : {0.01, 0.02, 0.04, 0.06, 0.08, 0.1}) {
    row.speed_m_per_s = speed_m_per_s;
    row.periodic_displacement_m = known(0.0018, 0.0017, 0.0019);
    if (speed_m_per_s == 0.04) row.periodic_displacement_m.ci95.reset();
    if (speed_m_per_s == 0.08) row.periodic_displacement_m = {};
    sweep.prediction->rows.push_back(row);
  }
  const chart::Panel panel = sweep.spacing_figure().chart->panels.at(0);
  REQUIRE(panel.areas.size() == 3);
  CHECK(panel.areas[0].name == "its 95 % band");
  CHECK(panel.areas[1].name.empty());
  CHECK(panel.areas[0].outline.size() == 4);  // 10 and 20 mm/s
  CHECK(panel.areas[1].outline.size() == 2);  // 60 mm/s
  CHECK(panel.areas[2].outline.size() == 2);  // 100 mm/s
  const chart::Line& line = panel.lines.front();
  REQUIRE(line.points.size() == 6);
  CHECK(std::isfinite(line.points[2].y));
  CHECK_FALSE(std::isfinite(line.points[4].y));
}

TEST_CASE("the axis of spacing against speed includes the intervals unless they are much wider than the values") {
  Sweep sweep;
  sweep.prediction->rows.back().periodic_displacement_m = known(0.0018, 0.0009, 0.0036);
  chart::Panel panel = sweep.spacing_figure().chart->panels.at(0);
  CHECK(panel.y.low < 0.9);
  CHECK(panel.y.high > 3.6);
  sweep.prediction->rows.back().periodic_displacement_m = known(0.0018, 0.0, 180.0);
  panel = sweep.spacing_figure().chart->panels.at(0);
  CHECK(panel.y.low > 0.1);
  CHECK(panel.y.high < 20.0);
}

TEST_CASE("recordings of one speed are one point of the fitted line") {
  Sweep sweep;
  sweep.entries.push_back({"again", Sweep::recording(0.1, std::nullopt)});
  sweep.analysis.recordings.push_back(test::full_analysis());
  sweep.analysis.roles.push_back(SweepRole::Cycles);
  sweep.analysis.fit->points.push_back(sweep.analysis.fit->points.back());
  sweep.analysis.fit->points.back().spacing_m = known(0.0020, 0.0018, 0.0023);
  sweep.prediction.reset();
  const chart::Panel panel = sweep.spacing_figure().chart->panels.at(0);
  REQUIRE(panel.lines.front().points.size() == 2);
  CHECK(panel.lines.front().points[1].y == Approx(1.9));
  REQUIRE(panel.areas.front().outline.size() == 4);
  CHECK(panel.areas.front().outline[1].y == Approx(1.7));
  CHECK(panel.areas.front().outline[2].y == Approx(2.3));
}

TEST_CASE("the recordings of a large sweep are drawn with their residuals in pictures that fit on a printed page") {
  Sweep sweep;
  for (std::size_t i = sweep.entries.size(); i < 7; ++i) {
    sweep.entries.push_back(sweep.entries.front());
    sweep.analysis.recordings.push_back(sweep.analysis.recordings.front());
  }
  const std::vector<html::Figure> figures =
      html::sweep_traces_figures({sweep.entries, sweep.analysis, sweep.prediction});
  REQUIRE(figures.size() == 2);
  CHECK(figures[0].id == "sweep-traces");
  CHECK(figures[1].id == "sweep-traces-2");
  CHECK(figures[0].chart->panels.size() == 8);
  CHECK(figures[1].chart->panels.size() == 6);
}

TEST_CASE("the page of a sweep without a joint fit states the reason and shows each recording") {
  Sweep sweep;
  sweep.analysis.fit.reset();
  sweep.analysis.fit_reason = "1 with stick-slip cycles, 0 sliding steadily, 1 left out";
  sweep.analysis.roles[1] = SweepRole::LeftOut;
  sweep.prediction.reset();
  const std::string page = sweep.page();
  CHECK_THAT(page, Contains("<p class=\"headline\">2 recordings, no joint fit.</p>"));
  CHECK_THAT(page, Contains("<h2>Parameters of all recordings</h2>\n<p class=\"absent\">1 with stick-slip cycles"));
  CHECK_THAT(page, Contains("There is no joint fit: 1 with stick-slip cycles, 0 sliding steadily, 1 left out."));
  CHECK_THAT(page, Contains("Kinetic friction over speed is not known."));
  // V/f of both is a measurement; there is nothing to predict it by.
  CHECK_THAT(page,
             Contains("<th scope=\"row\">slow</th><td class=\"number\">10</td><td>stick-slip</td>") &&
                 Contains("<th scope=\"row\">fast</th><td class=\"number\">100</td><td>stick-slip, left out</td>") &&
                 Contains("1.8409<small>"));
  CHECK_THAT(page, Contains("<td class=\"number\" data-value=\"\">-</td><td class=\"number\">-</td></tr>"));
  CHECK_FALSE(sweep.spacing_figure().chart);
  CHECK_THAT(page, Contains("force over time of 2 recordings"));
}

TEST_CASE("the page of a sweep shows the spacing on the worn surface where the manifest gives it for any recording") {
  Sweep sweep;
  CHECK_THAT(sweep.page(), !Contains("spacing on the surface"));
  sweep.entries[1].recording = Sweep::recording(0.1, 0.00185);
  const std::string page = sweep.page();
  CHECK_THAT(page, Contains(">spacing on the surface [mm]</th>"));
  CHECK_THAT(page, Contains("<td>stick-slip</td><td class=\"number\" data-value=\"\">-</td>") &&
                       Contains("<td>stick-slip</td><td class=\"number\" data-value=\"0.00185\">1.85"));
}

TEST_CASE("cycles of a sweep lie over each other, each recording in a colour of its own with its name") {
  std::vector<SweepEntry> entries;
  for (const double speed : {0.02, 0.005, 0.01}) {
    entries.push_back({"run " + std::to_string(entries.size()), test::stick_slip_recording(speed)});
  }
  SweepAnalysis sweep = analyze_sweep(entries);
  const std::optional<Prediction> none;
  const html::Figure figure = html::sweep_cycles_figure({entries, sweep, none});
  REQUIRE(figure.chart);
  REQUIRE(figure.chart->panels.size() == 2);
  const chart::Panel& whole = figure.chart->panels.front();
  CHECK(whole.x.label == "path of the drive since the slip began [mm]");
  REQUIRE(whole.lines.size() == 3);
  CHECK(whole.lines[0].name == "run 1, 5 mm/s");
  CHECK(whole.lines[2].name == "run 0, 20 mm/s");
  CHECK(whole.lines[0].colour != whole.lines[1].colour);
  // Of path a period is (F_s - F_trough) / k = 0.93 mm and what passes in the slip, 0.3 mm at 20 mm/s.
  CHECK(whole.x.high - whole.x.low == Approx(1.1 * 1.2).epsilon(0.2));
  CHECK(figure.chart->panels.back().x.label == "time since the slip began [ms]");
  CHECK(figure.chart->panels.back().legend_at == chart::LegendAt::None);

  const std::string page = to_html(entries, sweep, none, {"dry", {}});
  CHECK_THAT(page, Contains("<ul class=\"legend-list\">") && Contains("</svg>run 1, 5 mm/s</li>") &&
                       Contains("<g class=\"entries\">"));
  sweep.recordings[0].motion = MotionClass::SteadySliding;
  CHECK(html::sweep_cycles_figure({entries, sweep, none}).chart->panels.front().lines.size() == 2);
  sweep.recordings[1].motion = MotionClass::SteadySliding;
  CHECK_FALSE(html::sweep_cycles_figure({entries, sweep, none}).chart);
}
