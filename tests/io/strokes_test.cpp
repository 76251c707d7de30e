#include <algorithm>
#include <cmath>
#include <random>

#include "io/build.hpp"
#include "io/strokes.hpp"
#include "temp_file.hpp"

using namespace io_test;
using slipfit::reading::is_negative_throughout;

namespace {

constexpr std::size_t kSamples = 4000;

template <class Force>
std::vector<double> sample(const Force& force) {
  std::vector<double> values;
  for (std::size_t i = 0; i < kSamples; ++i) values.push_back(force(static_cast<double>(i) / kSamples));
  return values;
}

double fraction(double x) {
  return x - std::floor(x);
}

bool is_reciprocating(const std::vector<double>& force) {
  return !slipfit::reading::find_strokes({force, {}}).empty();
}

/// Strokes of +1 and -1, turning linearly over `turning` of each stroke.
double stroke(double t, double strokes, double turning) {
  const double phase = fraction(t * strokes / 2.0) * 2.0;
  const double side = phase < 1.0 ? 1.0 : -1.0;
  const double since_turn = fraction(phase);
  return side * (since_turn < turning ? 2.0 * since_turn / turning - 1.0 : 1.0);
}

std::string text_of(const std::vector<double>& force) {
  std::string text = "time,force\n";
  for (std::size_t i = 0; i < force.size(); ++i) {
    text += std::to_string(0.01 * static_cast<double>(i)) + "," + std::to_string(force[i]) + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("strokes are distinguished from stick-slip by the levels at which the force remains") {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto saw = [](double t, double cycles) { return fraction(t * cycles); };

  SECTION("strokes") {
    CHECK(is_reciprocating(sample([](double t) { return stroke(t, 6, 0.05); })));
    CHECK(is_reciprocating(sample([](double t) { return stroke(t, 3, 0.05); })));
    CHECK(is_reciprocating(sample([](double t) { return stroke(t, 40, 0.2); })));
    CHECK(is_reciprocating(sample([](double t) { return 0.2 + stroke(t, 8, 0.1); })));
    CHECK(is_reciprocating(sample([&](double t) { return stroke(t, 8, 0.1) + 0.1 * noise(random); })));
  }
  SECTION("stick-slip inside strokes") {
    CHECK(is_reciprocating(sample([&](double t) { return stroke(t, 6, 0.05) * (0.6 + 0.4 * saw(t, 120)); })));
    CHECK(is_reciprocating(
        sample([&](double t) { return stroke(t, 10, 0.1) * (0.7 + 0.3 * saw(t, 90)) + 0.05 * noise(random); })));
  }
  SECTION("saw-tooth through zero") {
    CHECK_FALSE(is_reciprocating(sample([&](double t) { return saw(t, 20) - 0.5; })));
    CHECK_FALSE(is_reciprocating(sample([&](double t) { return saw(t, 20) - 0.3; })));
    CHECK_FALSE(is_reciprocating(sample([&](double t) { return saw(t, 20) - 0.5 + 0.05 * noise(random); })));
    CHECK_FALSE(is_reciprocating(sample([&](double t) { return saw(t, 900) - 0.5; })));
  }
  SECTION("oscillation and noise about zero") {
    CHECK_FALSE(is_reciprocating(sample([](double t) { return std::sin(60.0 * t); })));
    CHECK_FALSE(
        is_reciprocating(sample([](double t) { return std::sin(60.0 * t) + 0.2 * std::sin(180.0 * t + 1.0); })));
    CHECK_FALSE(is_reciprocating(sample([&](double) { return noise(random); })));
    CHECK_FALSE(is_reciprocating(sample([&](double) { return noise(random) > 0.0 ? 0.5 : -0.5; })));  // 1-bit converter
  }
  SECTION("one turn is no reciprocation, and a force of one sign is none") {
    CHECK_FALSE(is_reciprocating(sample([](double t) { return t < 0.4 ? -1.0 : 1.0; })));
    CHECK_FALSE(is_reciprocating(sample([&](double t) { return 1.0 + 0.4 * saw(t, 30); })));
    CHECK_FALSE(is_reciprocating(sample([](double) { return 0.0; })));
  }
}

TEST_CASE("the strokes of a reciprocating recording are one recording, and a window selects one of them") {
  const std::string content =
      text_of(sample([](double t) { return stroke(t, 8, 0.05) * (0.7 + 0.3 * fraction(t * 100)); }));
  const auto whole = read_ok(content);
  CHECK(whole.provenance().strokes == 8);
  CHECK(warns(whole, "strokes_pooled"));
  CHECK(*std::min_element(whole.force().begin(), whole.force().end()) > 0.6);
  CHECK(whole.size() > 3000);
  slipfit::ReadOptions options;
  options.window = slipfit::TimeWindow{0.5, 4.5};
  const auto forward = read_ok(content, options);
  CHECK(*std::min_element(forward.force().begin(), forward.force().end()) > 0.6);
  options.window = slipfit::TimeWindow{5.5, 9.5};
  const auto backward = read_ok(content, options);
  CHECK(*std::min_element(backward.force().begin(), backward.force().end()) > 0.6);
  CHECK(says(backward, {"negative throughout"}));
}

TEST_CASE("a force that is negative throughout is turned, one that is often positive is not") {
  const auto mostly = [](std::size_t positive_of_100) {
    std::vector<double> force;
    for (std::size_t i = 0; i < 200; ++i)
      force.push_back(i % 100 < positive_of_100 ? 0.1 : -1.0 - 0.01 * static_cast<double>(i % 7));
    return force;
  };
  CHECK(is_negative_throughout(mostly(10)));
  CHECK_FALSE(is_negative_throughout(mostly(11)));
  const auto turned = read_ok(text_of(mostly(5)));
  CHECK(turned.force()[0] == -0.1);
  CHECK(turned.force()[50] == Approx(1.01));
  CHECK(says(turned, {"negative throughout"}));
  CHECK(read_ok(text_of(mostly(11))).force()[50] == Approx(-1.01));
}

TEST_CASE("where the zero is not stated, the sign of a force is that with which it falls suddenly") {
  const auto saw_tooth = [](double sign, double offset) {
    return sample(
        [=](double t) { return sign * (0.7 + 0.3 * std::min(fraction(t * 40), 9 - 9 * fraction(t * 40))) + offset; });
  };
  const auto first = [](const std::vector<double>& force, std::optional<double> zero = {}) {
    auto conditions = at_speed(1e-3);
    conditions.zero_force_N = zero;
    return read_ok(text_of(force), {}, conditions).force()[0];
  };
  CHECK(first(saw_tooth(1.0, 0.0)) == Approx(0.7));
  CHECK(first(saw_tooth(-1.0, 0.0)) == Approx(0.7));   // turned
  CHECK(first(saw_tooth(1.0, -5.0)) == Approx(-4.3));  // kept: the zero is off
  CHECK(first(saw_tooth(1.0, -5.0), 0.0) == Approx(4.3));
  CHECK(first(saw_tooth(-1.0, 0.78)) == Approx(-0.08));  // mostly negative, but not throughout
}

TEST_CASE("the zero force is subtracted before the sign is judged") {
  auto conditions = at_speed(1e-3);
  conditions.zero_force_N = 3.0;
  const auto recording = read_ok("time,force\n0,1.0\n1,2.0\n2,1.5\n", {}, conditions);
  CHECK(copy(recording.force()) == std::vector<double>{2.0, 1.0, 1.5});
}

namespace {

/// A spring behind a play of a fifth of the amplitude, pulled to and fro by a sine of 10 mm and 1 s; the friction
/// swings by a tenth, and the body rings while the play is taken up.
struct RigWithPlay {
  std::vector<double> displacement_mm;
  std::vector<double> force_N;
};

RigWithPlay rig_with_play(double periods) {
  constexpr double kRate_Hz = 1000.0;
  constexpr double kAmplitude_mm = 10.0;
  constexpr double kPlay_mm = 4.0;
  constexpr double kSpring_N_per_mm = 50.0;
  constexpr double kPi = 3.14159265358979;
  RigWithPlay rig;
  for (double t = 0.0; t < periods; t += 1.0 / kRate_Hz) {
    const double x_mm = -kAmplitude_mm * std::cos(2.0 * kPi * t);
    const bool is_forward = std::sin(2.0 * kPi * t) > 0.0;
    const double turned_mm = is_forward ? -kAmplitude_mm : kAmplitude_mm;
    const double way_mm = std::abs(x_mm - turned_mm) - kPlay_mm;
    const double friction_N = 100.0 + 10.0 * fraction(t * 40.0);
    const double ringing_N = way_mm < 0.0 ? 30.0 * std::sin(2.0 * kPi * 54.0 * t) : 0.0;
    const double size_N = std::clamp(kSpring_N_per_mm * way_mm, 0.0, friction_N) + ringing_N;
    rig.displacement_mm.push_back(x_mm);
    rig.force_N.push_back((is_forward ? 1.0 : -1.0) * size_N);
  }
  return rig;
}

std::vector<slipfit::NamedRecording> strokes_in(const std::string& content) {
  const TempFile file(content);
  slipfit::ReadOptions options;
  options.pieces = slipfit::Pieces::Strokes;
  auto strokes = slipfit::read_pieces(file.path(), at_speed(0.05), options);
  INFO((strokes ? std::string() : strokes.error().message));
  REQUIRE(strokes.ok());
  return std::move(strokes).value();
}

void check_strokes_with_play(const std::vector<slipfit::NamedRecording>& strokes) {
  CHECK(strokes.size() >= 11);
  CHECK(strokes.size() <= 12);
  for (const slipfit::NamedRecording& stroke : strokes) {
    CAPTURE(stroke.id);
    const auto force = stroke.recording.force();
    CHECK(*std::min_element(force.begin(), force.end()) > 95.0);
    CHECK(stroke.recording.duration_s() > 0.08);
    CHECK(stroke.recording.duration_s() < 0.4);
  }
}

}  // namespace

TEST_CASE("strokes of a sinusoidal test with play are found, with and without a displacement") {
  const RigWithPlay rig = rig_with_play(6.0);
  std::string with = "time (s),friction force (N),displacement (mm)\n";
  std::string without = "time (s),friction force (N)\n";
  for (std::size_t i = 0; i < rig.force_N.size(); ++i) {
    const std::string row = std::to_string(0.001 * static_cast<double>(i)) + "," + std::to_string(rig.force_N[i]);
    with += row + "," + std::to_string(rig.displacement_mm[i]) + "\n";
    without += row + "\n";
  }
  check_strokes_with_play(strokes_in(with));
  check_strokes_with_play(strokes_in(without));
  CHECK(read_ok(with).provenance().strokes == 12);
}

namespace {

/// Strokes of two to three slips: the force rises by 1 in 100 samples and falls by 1 in 5.
std::vector<double> short_strokes(int strokes, double offset) {
  std::vector<double> forces;
  double force = -2.0;
  for (int stroke = 0; stroke < strokes; ++stroke) {
    const double side = stroke % 2 == 0 ? 1.0 : -1.0;
    for (int i = 0, fall = 0; i < 650; ++i) {
      if (fall == 0 && force >= 2.0) fall = 5;
      force += fall > 0 ? -0.2 : 0.01;
      fall -= fall > 0 ? 1 : 0;
      forces.push_back(side * force + offset);
    }
    force = -force;
  }
  return forces;
}

}  // namespace

TEST_CASE("strokes whose reversal takes most of the time are found by slips to either side, whatever the zero is") {
  for (const double offset : {0.0, 0.7, -5.0}) {
    CAPTURE(offset);
    const auto recording = read_ok(text_of(short_strokes(6, offset)));
    CHECK(recording.provenance().strokes == 6);
    const auto [low, high] = std::ranges::minmax_element(recording.force());
    CHECK(*low > 0.9);
    CHECK(*high < 2.1);
  }
  CHECK_FALSE(is_reciprocating(sample([&](double t) { return std::sin(30.0 * t) + 0.3 * fraction(t * 60.0); })));
  CHECK_FALSE(is_reciprocating(sample([&](double t) { return std::sin(30.0 * t) + 0.3 * std::sin(300.0 * t); })));
}

TEST_CASE("a run between two rests whose sensor reads below zero is no reciprocating test") {
  const auto torque = [](double t) {
    const bool is_sliding = t > 0.3 && t < 0.7;
    return is_sliding ? 0.8 + 0.5 * fraction(t * 100.0) : -1.0 + 0.001 * fraction(t * 977.0);
  };
  CHECK_FALSE(is_reciprocating(sample(torque)));
  CHECK(read_ok(text_of(sample(torque))).size() == kSamples);
}
