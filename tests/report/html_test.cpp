#include "slipfit/report/html.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "examples.hpp"
#include "report/html/page.hpp"
#include "support/recordings.hpp"

using Catch::Contains;

namespace {

/// A saw-tooth at 1 kHz: rises for 90 samples, falls in 10.
slipfit::Recording sawtooth(const std::string& file = "run.csv", int samples = 2000) {
  std::vector<double> time_s;
  std::vector<double> force;
  for (int i = 0; i < samples; ++i) {
    const int phase = i % 100;
    time_s.push_back(0.001 * i);
    force.push_back(1.0 + 0.01 * (phase < 90 ? phase : 9 * (100 - phase)));
  }
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = 0.01;
  slipfit::Provenance provenance;
  provenance.file = file;
  return slipfit::Recording::create(std::move(time_s), std::move(force), conditions, std::move(provenance)).value();
}

std::string page_of(const slipfit::Recording& recording, const slipfit::Analysis& analysis) {
  return to_html(recording, analysis, gather_background(recording, analysis), {"slipfit fit run.csv"});
}

std::string section(const std::string& page, const std::string& id) {
  const std::size_t begin = page.find("<section id=\"" + id);
  REQUIRE(begin != std::string::npos);
  return page.substr(begin, page.find("</section>", begin) - begin);
}

slipfit::Analysis fitted(const slipfit::Recording& recording) {
  slipfit::FitOptions options;
  options.curve = true;
  return analyze_and_fit(recording, options);
}

/// The bytes of a base64 text.
std::vector<unsigned char> decoded(const std::string& text) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned int bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6U) | static_cast<unsigned int>(alphabet.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<unsigned char>((bits >> static_cast<unsigned int>(count)) & 0xFFU));
  }
  return bytes;
}

nlohmann::json trace_data_in(const std::string& page) {
  const std::string opening = "id=\"trace-data\">";
  const std::size_t begin = page.find(opening) + opening.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

}  // namespace

TEST_CASE("the page states the kind of motion in a sentence and the status of each parameter") {
  const slipfit::Recording recording = test::small_recording();
  const std::string page = page_of(recording, test::full_analysis());
  CHECK_THAT(page,
             Contains("<p class=\"headline\">Stick-slip at 5.432\u00a0±\u00a00.012\u00a0Hz: a pattern of 1.8409"));
  const std::string table = section(page, "parameters");
  CHECK_THAT(table, Contains("1002.3") && Contains("[999.9, 1004.8]"));
  CHECK_THAT(table, Contains("only an interval is known") && Contains("the data do not determine it") &&
                        Contains("fixed at the stated value") &&
                        Contains("needs <code class=\"option\">--zero</code>"));
  CHECK_THAT(section(page, "repeat"),
             Contains("slipfit fit run.csv") && Contains("xxh128:06b05ab6733a618578af5f94892f3950"));
}

TEST_CASE("text from outside stays text") {
  const std::string hostile = "</script><script>alert(1)</script>\"'&.csv";
  const slipfit::Recording recording = sawtooth(hostile);
  slipfit::Analysis analysis = fitted(recording);
  analysis.warnings.push_back({"hostile", hostile});
  const std::string page = page_of(recording, analysis);
  CHECK_THAT(page, !Contains("<script>alert"));
  CHECK_THAT(page, Contains("&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;&amp;.csv"));
  for (const slipfit::PictureFile& picture :
       report_pictures(recording, analysis, gather_background(recording, analysis))) {
    CHECK_THAT(picture.content, !Contains("<script"));
  }
}

TEST_CASE("JSON in a script element cannot end it") {
  CHECK(slipfit::html::script_json("\"</script>&\xE2\x80\xA8\xE2\x80\xA9\"") ==
        "\"\\u003c/script\\u003e\\u0026\\u2028\\u2029\"");
}

TEST_CASE("steady sliding: words in place of cycles, parameters and pattern") {
  const slipfit::Recording recording = sawtooth();
  slipfit::Analysis analysis = fitted(recording);
  analysis.motion = slipfit::MotionClass::SteadySliding;
  const std::string page = page_of(recording, analysis);
  CHECK_THAT(page, Contains("<p class=\"headline\">Steady sliding at 10\u00a0mm/s: no stick-slip, no pattern.</p>"));
  const std::string absent = section(page, "absent");
  for (const char* title : {"Overlaid cycles", "Damping from peaks and troughs", "Predicted abrasion pattern"}) {
    CAPTURE(title);
    CHECK_THAT(absent, !Contains("<svg") && Contains(std::string("<dt>") + title));
  }
  CHECK_THAT(section(page, "parameters"), Contains("this recording does not show") && !Contains("<table"));
  CHECK_FALSE(trace_data_in(page).contains("residual_levels"));
}

TEST_CASE("what the fit does not know is said in words, with the reason") {
  const slipfit::Recording recording = sawtooth();
  slipfit::Analysis analysis = fitted(recording);
  REQUIRE(analysis.fit);
  analysis.motion = slipfit::MotionClass::StickSlip;
  analysis.fit->estimate.reset();
  analysis.fit->parameters = {{slipfit::ParameterId::DampingRatio,
                               {{}, {}, {}, "the slip is not resolved"},
                               slipfit::ParameterStatus::Unidentified}};
  analysis.derived = {};
  analysis.derived.lambda.note = "needs zeta";
  const std::string page = page_of(recording, analysis);
  const std::string absent = section(page, "absent");
  CHECK_THAT(absent, Contains("The damping ratio is not known: the slip is not resolved."));
  CHECK_THAT(absent, Contains("The position on the map is unknown: needs ζ"));
  CHECK_THAT(absent, Contains("No prediction for other speeds: needs ζ"));
  CHECK_THAT(page, Contains("<dt>damping ratio ζ</dt><dd>not known</dd>"));
}

TEST_CASE("peaks and troughs are not drawn against the damping where the sensor blunts them") {
  const slipfit::Recording recording = test::stick_slip_recording(0.01);  // w_n 200 rad/s
  const slipfit::Analysis analysis = fitted(recording);
  const auto page_with = [&](std::optional<double> bandwidth_Hz) {
    slipfit::Conditions conditions = recording.conditions();
    conditions.sensor_bandwidth_Hz = bandwidth_Hz;
    return page_of(slipfit::Recording::create({recording.time_s().begin(), recording.time_s().end()},
                                              {recording.force().begin(), recording.force().end()}, conditions,
                                              recording.provenance())
                       .value(),
                   analysis);
  };
  const std::string reason = "Averaging or lag of the sensor reduces peaks and troughs";
  CHECK_THAT(page_with({}), Contains("<svg class=\"chart\" id=\"pairs\"") && !Contains(reason));
  CHECK_THAT(page_with(1000.0), !Contains(reason));  // w_n tau = 0.03: the peak is 0.05 % too low
  CHECK_THAT(page_with(100.0), Contains(reason));    // 0.32: 5 %
}

TEST_CASE("the packed trace gives every sample back to half a level") {
  const slipfit::Recording recording = sawtooth();
  const nlohmann::json data = trace_data_in(page_of(recording, fitted(recording)));
  const std::vector<unsigned char> bytes = decoded(data["force_levels"]);
  REQUIRE(bytes.size() == 2 * recording.size());
  const double low = data["force_low"];
  const double step = (data["force_high"].get<double>() - low) / 65534.0;
  double worst = 0.0;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const double force = low + step * (bytes[2 * i] + 256.0 * bytes[2 * i + 1]);
    worst = std::max(worst, std::abs(force - recording.force()[i]));
  }
  CHECK(worst <= 0.5 * step * (1.0 + 1e-9));
  CHECK_FALSE(data.contains("ticks"));
  CHECK(data["last_s"] == recording.time_s().back());
}

TEST_CASE("the work between slips is the speed times the integral of the force") {
  const slipfit::Recording recording = sawtooth();
  const slipfit::Analysis analysis = slipfit::analyze(recording);
  const slipfit::Background background = gather_background(recording, analysis);
  const auto figure = slipfit::html::evolution_figure(slipfit::html::source_of(recording, analysis, background));
  const slipfit::chart::Panel& work = figure.chart->panels.back();
  CHECK(work.y.label == "work [mJ]");
  const std::vector<slipfit::chart::Point>& points = work.lines.front().points;
  REQUIRE(points.size() == analysis.cycle_table.size());
  // 10 mm/s, 0.1 s, and a mean of 1.45 N, whatever the phase of the onset.
  for (std::size_t i = 1; i < points.size(); ++i) CHECK(points[i].y == Approx(1.45).epsilon(1e-6));
}

TEST_CASE("an uneven clock travels with the trace") {
  const std::vector<double> time_s{0.0, 0.1, 0.15, 0.4, 0.5};
  const slipfit::Recording recording =
      slipfit::Recording::create(time_s, {0.0, 1.0, 2.0, 1.0, 0.0}, sawtooth().conditions()).value();
  const std::vector<unsigned char> bytes = decoded(trace_data_in(page_of(recording, analyze(recording)))["ticks"]);
  REQUIRE(bytes.size() == 4 * time_s.size());
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    double tick = 0.0;
    for (std::size_t byte = 4; byte-- > 0;) tick = 256.0 * tick + bytes[4 * i + byte];
    CHECK(tick / 4294967295.0 * 0.5 == Approx(time_s[i]).margin(1e-9));
  }
}

TEST_CASE("gaps of the clock and outliers travel with the trace") {
  std::vector<double> time_s;
  std::vector<double> force_N;
  for (int i = 0; i < 100; ++i) {
    time_s.push_back(i < 60 ? 0.01 * i : 0.01 * i + 0.25);
    force_N.push_back(1.0 + 0.01 * ((i * 7) % 5));
  }
  force_N[30] = 9.0;
  const slipfit::Recording recording = slipfit::Recording::create(time_s, force_N, sawtooth().conditions()).value();
  const nlohmann::json data = trace_data_in(page_of(recording, analyze(recording)));
  CHECK(decoded(data["gaps"]).size() == 2 * 4);
  const std::vector<unsigned char> outliers = decoded(data["outliers"]);
  REQUIRE(outliers.size() == 4);
  const double part = (outliers[3] + outliers[2] / 256.0) / 256.0;
  CHECK(part * recording.duration_s() == Approx(time_s[30]).margin(1e-3));
}

TEST_CASE("any number of cycles gives a page (6 cycles once ended the program)") {
  for (int cycles = 1; cycles <= 12; ++cycles) {
    CAPTURE(cycles);
    const slipfit::Recording recording = sawtooth("run.csv", 100 * cycles);
    CHECK_THAT(section(page_of(recording, fitted(recording)), "trace-section"), Contains("<svg"));
  }
}

TEST_CASE("a force that differs in its last digit alone is a flat trace, not a picture of rounding") {
  std::vector<double> time_s;
  std::vector<double> force;
  for (int i = 0; i < 500; ++i) {
    time_s.push_back(0.001 * i);
    force.push_back(i % 2 == 0 ? 0.3 : 0.1 + 0.2);
  }
  const auto recording = test::recording_of(std::move(time_s), std::move(force), 0.01);
  const std::string page = page_of(recording, fitted(recording));
  CHECK(page.size() < 400'000);
  const std::size_t begin = page.find("\"force_low\":");
  REQUIRE(begin != std::string::npos);
  const std::string low = page.substr(begin + 12, page.find(',', begin) - begin - 12);
  CHECK_THAT(page, Contains("\"force_high\":" + low + ","));
}

TEST_CASE("each chart names its axes and series, and the page has a script to save them") {
  const std::string page = to_html(test::small_recording(), test::full_analysis(), {}, {"slipfit fit run.csv"});
  CHECK_THAT(page, Contains("<g class=\"panel\" data-axes=\"friction force [N] over time [s]\" data-x=\""));
  CHECK_THAT(page, Contains(" data-name=\"measured\""));
  CHECK_THAT(page, Contains("Copy table"));
}

TEST_CASE("the page shows coefficients of friction and the requirements of the standards") {
  slipfit::Analysis analysis = test::full_analysis();
  analysis.coefficients.emplace();
  analysis.coefficients->static_first_peak = {0.51, 0.01, slipfit::Interval{0.49, 0.53}, {}};
  analysis.coefficients->standards.push_back(
      {"ASTM D1894", "a sled", {}, {0.4, 0.01, slipfit::Interval{0.38, 0.42}, {}}, {"driven at 50 mm/min, not 150"}});
  const std::string page = to_html(test::small_recording(), analysis, {}, {});
  CHECK_THAT(page, Contains("static, first peak") && Contains("0.510"));
  CHECK_THAT(page, Contains("kinetic, as ASTM D1894") && Contains("driven at 50 mm/min, not 150"));
}
