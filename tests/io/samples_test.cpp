#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "slipfit/io/manifest_entry.hpp"
#include "slipfit/io/recording_reader.hpp"

using namespace slipfit;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Conditions at(double speed_m_per_s) {
  Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  return conditions;
}

std::string code_of(const Samples& samples, const ReadOptions& options = {}) {
  const auto read = read_samples(samples, at(0.01), options);
  return read ? "" : read.error().code;
}

std::string code_of_cells(const std::vector<NamedCell>& cells) {
  const auto entry = entry_from_cells(cells);
  return entry ? "" : entry.error().code;
}

}  // namespace

TEST_CASE("samples are read as a file of two columns would be") {
  Conditions conditions = at(0.01);
  conditions.zero_force_N = 1.0;
  ReadOptions options;
  options.time_unit = "ms";
  options.force_unit = "kN";
  const auto read = read_samples({"run7", {0, 1, 2, 3, 4}, {1, 2, kNaN, 4, 5}}, conditions, options);
  REQUIRE(read);
  const Recording& recording = read.value().front().recording;
  CHECK(recording.size() == 4);
  CHECK(recording.time_s()[3] == Approx(0.004).epsilon(1e-15));
  CHECK(recording.force()[3] == Approx(4999.0).epsilon(1e-15));
  CHECK(recording.provenance().rows_without_number == 1);
  CHECK(recording.provenance().warnings.front().code == "rows_without_number");
  CHECK(recording.provenance().file == "run7");
  CHECK_FALSE(recording.provenance().input_digest);
}

TEST_CASE("samples without times have the clock of the sampling rate, and a part can be read") {
  ReadOptions options;
  options.sample_rate_Hz = 4.0;
  options.window = TimeWindow{0.5, 1.5};
  const auto read = read_samples({"log", {}, {1, 2, 3, 4, 5, 6, 7, 8}}, at(0.01), options);
  REQUIRE(read);
  const Recording& recording = read.value().front().recording;
  CHECK(recording.size() == 5);
  CHECK(recording.time_s().front() == 0.5);
  CHECK(recording.force().front() == 3.0);
  CHECK(recording.provenance().window_given);
}

TEST_CASE("samples that are no recording are refused") {
  CHECK(code_of({"a", {0, 1}, {1, 2, 3}}) == "length_mismatch");
  CHECK(code_of({"a", {}, {1, 2, 3}}) == "no_time_column");
  CHECK(code_of({"a", {0.0}, {1.0}}) == "too_few_samples");
  CHECK(code_of({"a", {0, 1, 2}, {kNaN, kNaN, kNaN}}) == "no_number_in_column");
  CHECK(code_of({"a", {3, 2, 1, 0}, {1, 2, 3, 4}}) == "time_runs_backwards");
  CHECK(code_of({"a", {0, 0, 0}, {1, 2, 3}}) == "time_constant");
  ReadOptions options;
  options.force_unit = "m";
  CHECK(code_of({"a", {0, 1, 2}, {1, 2, 3}}, options) == "unknown_unit");
}

TEST_CASE("cells have the meaning of the columns of a manifest") {
  const std::vector<NamedCell> cells{{"speed_se", "1 %"}, {"speed", "60 rpm"},       {"radius", "10 mm"},
                                     {"mass", "30 g"},    {"normal_force", "41 gf"}, {"window", "1:2"},
                                     {"where", "Step=3"}};
  const auto entry = entry_from_cells(cells);
  REQUIRE(entry);
  const Conditions& conditions = entry.value().conditions;
  constexpr double kSpeed = 0.01 * 2.0 * 3.14159265358979323846;
  CHECK(conditions.speed_m_per_s == Approx(kSpeed).epsilon(1e-12));
  CHECK(conditions.speed_unit == "rpm");
  CHECK(conditions.speed_standard_error_m_per_s.value() == Approx(0.01 * kSpeed).epsilon(1e-12));
  CHECK(conditions.mass_kg.value() == Approx(0.03));
  CHECK(conditions.normal_force_N.value() == Approx(0.041 * 9.80665));
  CHECK(entry.value().options.window->end_s == 2.0);
  CHECK(entry.value().options.where->value == "3");
}

TEST_CASE("empty cells are refused with their column") {
  CHECK(code_of_cells({{"colour", "red"}}) == "unknown_option");
  CHECK(code_of_cells({{"speed", "fast"}}) == "bad_number");
  CHECK(code_of_cells({{"speed", "-1"}}) == "out_of_range");
  CHECK(code_of_cells({{"speed", "60 rpm"}}) == "out_of_range");
  CHECK(code_of_cells({{"mass", "0"}}) == "out_of_range");
  CHECK(code_of_cells({{"window", "2:1"}}) == "bad_window");
  CHECK(code_of_cells({{"speed_se", "1%"}}) == "no_speed");
}
