#include <cmath>

#include "io/read_options.hpp"
#include "temp_file.hpp"

using namespace io_test;
using slipfit::Pieces;
using slipfit::ReadOptions;

namespace {

/// 1 kHz. A force of 1 to 1.4 N that opposes the motion, and turns within 40 ms of each second; zero at `zero_N`.
std::string reciprocating(int strokes, double zero_N, bool has_position) {
  std::string text = has_position ? "time [s],force [N],position [mm]\n" : "time [s],force [N]\n";
  for (int i = 0; i < 1000 * strokes; ++i) {
    const int in_stroke = i % 1000;
    const double side = i / 1000 % 2 == 0 ? 1.0 : -1.0;
    const double ramp = i < 1000 ? 1.0 : std::min(1.0, in_stroke / 20.0 - 1.0);
    const double force_N = side * ramp * (1.0 + 0.4 * (in_stroke % 100) / 100.0) + zero_N;
    text += std::to_string(1e-3 * i) + "," + std::to_string(force_N);
    if (has_position) text += "," + std::to_string(20.0 * std::cos(M_PI * 1e-3 * i));  // a crank
    text += "\n";
  }
  return text;
}

slipfit::Result<std::vector<slipfit::NamedRecording>> pieces_of(const std::string& content, Pieces pieces,
                                                                double speed_m_per_s = 0.02) {
  const TempFile file(content);
  ReadOptions options;
  options.pieces = pieces;
  return slipfit::read_pieces(file.path(), at_speed(speed_m_per_s), options);
}

double lowest(const slipfit::Recording& recording) {
  return *std::min_element(recording.force().begin(), recording.force().end());
}

}  // namespace

TEST_CASE("each stroke is a recording: its sign turned, its ends cut off, in pairs") {
  const auto strokes = pieces_of(reciprocating(7, 0.0, false), Pieces::Strokes);
  REQUIRE(strokes.ok());
  REQUIRE(strokes.value().size() == 7);
  CHECK(strokes.value()[0].id == "stroke 1 (+)");
  CHECK(strokes.value()[1].id == "stroke 2 (-)");
  for (const auto& [id, recording] : strokes.value()) {
    CAPTURE(id);
    CHECK(lowest(recording) >= 1.0);
    CHECK(recording.duration_s() > 0.8);
    CHECK(recording.duration_s() < 0.93);
    CHECK(says(recording, {"Stroke", "without the ends"}));
  }
  CHECK(strokes.value()[1].recording.time_s().front() > 1.04);
}

TEST_CASE("strokes of one sign, and at most sixteen") {
  const std::string many = reciprocating(61, 0.0, false);
  const auto positive = pieces_of(many, Pieces::PositiveStrokes);
  REQUIRE(positive.ok());
  CHECK(positive.value().size() == 16);
  for (const auto& stroke : positive.value()) CHECK(contains(stroke.id, "(+)"));
  const auto both = pieces_of(many, Pieces::Strokes);
  REQUIRE(both.ok());
  REQUIRE(both.value().size() == 16);
  const auto backward =
      std::count_if(both.value().begin(), both.value().end(), [](const auto& s) { return contains(s.id, "(-)"); });
  CHECK(backward == 8);
  CHECK(both.value().back().recording.time_s().front() > 40.0);
}

TEST_CASE("of a crank only what moves at nearly full speed is a stroke, and another speed is warned of") {
  const auto strokes = pieces_of(reciprocating(6, 0.0, true), Pieces::Strokes, 0.06);  // 63 mm/s in the middle
  REQUIRE(strokes.ok());
  CHECK(strokes.value()[2].recording.duration_s() < 0.4);
  CHECK(strokes.value()[2].recording.time_s().front() == Approx(2.35).margin(0.05));
  CHECK_FALSE(warns(strokes.value()[2].recording, "speed_differs_from_displacement"));
  const auto wrong = pieces_of(reciprocating(6, 0.0, true), Pieces::Strokes, 20e-3);
  REQUIRE(wrong.ok());
  CHECK(warns(wrong.value()[2].recording, "speed_differs_from_displacement"));
}

TEST_CASE("stretches of one speed each are segments, in each step of the file") {
  std::string text = "Step,time [s],force [N],speed [mm/s]\n";
  int row = 0;
  for (const int step : {1, 2}) {
    for (const int speed : {2, 4, 8}) {
      for (int i = 0; i < 200; ++i, ++row) {
        text += std::to_string(step) + "," + std::to_string(0.01 * row) + "," + std::to_string(i % 9) + "," +
                std::to_string(step * speed) + "\n";
      }
    }
  }
  const auto segments = pieces_of(text, Pieces::Segments, 0.0);
  REQUIRE(segments.ok());
  REQUIRE(segments.value().size() == 6);
  std::vector<double> speeds_mm_per_s;
  for (const auto& segment : segments.value()) {
    speeds_mm_per_s.push_back(1e3 * segment.recording.conditions().speed_m_per_s);
  }
  CHECK(speeds_mm_per_s[0] == Approx(2.0));
  CHECK(speeds_mm_per_s[4] == Approx(8.0));
  CHECK(segments.value()[5].id == "segment 6");
  CHECK(says(segments.value()[5].recording, {"Segment 6", "rows 1001 to 1200"}));
}

TEST_CASE("a scale turns volts into newtons, whatever prefix the column has") {
  ReadOptions options;
  options.force_scale = "-2.5 mN/mV";
  const auto recording = read_ok("time [s],U [V]\n0,0.1\n1,0.2\n2,0.1\n", options);
  CHECK(recording.force()[0] == Approx(0.25));  // negative throughout: turned
  options.force_scale = "5 N/V";
  CHECK(read_ok("time [s],U [mV]\n0,100\n1,200\n2,100\n", options).force()[1] == Approx(1.0));
  CHECK(read_ok("time [s],force\n0,0.1\n1,0.2\n2,0.1\n", options).force()[1] == Approx(1.0));
  options.force_column = "2";
  CHECK(contains(read_error("time [s],gap [mm]\n0,1\n1,2\n2,1\n", options).message, "--force-scale '5 N/V'"));
  CHECK_FALSE(slipfit::reading::parse_force_scale("5 N"));
  CHECK_FALSE(slipfit::reading::parse_force_scale("5 V/N"));
}

TEST_CASE("points between thousands belong to a number where the comma is the decimal sign") {
  const auto recording = read_ok("Zeit [s];Kraft [mN]\n0,5;998,5\n1,0;1.000,5\n1,5;-1.234.567,25\n2,0;12.345,0\n");
  CHECK(copy(recording.force()) == std::vector<double>{0.9985, 1.0005, -1234.56725, 12.345});
  const auto pointed = read_ok("Run 1, old\ntime [s];force [N]\n1.001;2.002\n1.002;3.003\n1.003;4.004\n");
  CHECK(pointed.force()[0] == 2.002);
}

TEST_CASE("commas between thousands belong to a number that has a decimal point") {
  const auto recording =
      read_ok("time [s],force [mN]\n0.5,998.5\n1.0,\"1,000.5\"\n1.5,\"-1,234,567.25\"\n2.0,\"12,345.0\"\n");
  CHECK(copy(recording.force()) == std::vector<double>{0.9985, 1.0005, -1234.56725, 12.345});
  const auto decimal = read_ok("time [s];force [N]\n1,001;2,002\n1,002;3,003\n1,003;4,004\n");
  CHECK(decimal.force()[0] == 2.002);
}

TEST_CASE("a comma that is both separator and decimal sign is reported as such") {
  CHECK(read_error("time,force\n0,001,0,512\n0,002,0,613\n0,003,0,714\n").code == "comma_twice");
  CHECK(read_error("0,001,0,51\n0,002,0,61\n0,003,0,71\n").code == "comma_twice");
  CHECK(read_ok("time,force\n0,1\n1,2\n2,3\n").size() == 3);
  CHECK(read_ok("time,force\n0,001\n1,002\n2,003\n").size() == 3);  // whole numbers with zeros in front
}
