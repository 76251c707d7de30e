// Delimiter, decimal sign, dates and clocks that are decided together; rows that may not be lost; stamps too coarse.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "temp_file.hpp"

using namespace io_test;

namespace {

constexpr int kRows = 400;

/// A head and rows of 5 ms each, made of seconds and milliseconds of the clock and of the force.
template <class Line>
std::string text_of(const std::string& head, const Line& line) {
  std::string text = head + "\n";
  for (int i = 0; i < kRows; ++i) text += line(i / 200, 5 * (i % 200), 1.0 + 0.01 * (i % 37)) + "\n";
  return text;
}

std::string with_comma(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  const auto point = text.find('.');
  if (point != std::string::npos) text[point] = ',';
  return text;
}

void check_samples(const slipfit::Recording& recording, double begin_s) {
  REQUIRE(recording.size() == kRows);
  CHECK(recording.time_s()[0] == Approx(begin_s).margin(5e-7));
  // A double that counts seconds since 1970 is exact to 2.4e-7 s.
  CHECK(recording.time_s()[1] - recording.time_s()[0] == Approx(0.005).margin(5e-7));
  CHECK(recording.time_s()[kRows - 1] - recording.time_s()[0] == Approx(0.005 * (kRows - 1)).margin(5e-7));
  CHECK(recording.force()[1] == Approx(1.01).margin(1e-6));
}

}  // namespace

TEST_CASE("a date, a clock and a force in columns of their own, with decimal commas and points") {
  for (const char clock_sign : {',', '.'}) {
    for (const char delimiter : {';', '\t'}) {
      CAPTURE(clock_sign, delimiter);
      const std::string d(1, delimiter);
      check_samples(read_ok(text_of(fmt::format("Datum{0}Uhrzeit{0}Kraft in N", d),
                                    [&](int s, int ms, double force) {
                                      return fmt::format("26.11.2026{}10:00:{:02d}{}{:03d}{}{}", d, s, clock_sign, ms,
                                                         d, with_comma(force, 4));
                                    })),
                    36000.0);
    }
  }
}

TEST_CASE("a comma in the seconds of a clock parts no columns") {
  for (const std::string date : {"2026-11-26 ", "2026-11-26T", "26.11.2026 ", ""}) {
    CAPTURE(date);
    check_samples(read_ok(text_of("time,force",
                                  [&](int s, int ms, double force) {
                                    return fmt::format("{}10:00:{:02d},{:03d},{:.4f}", date, s, ms, force);
                                  })),
                  36000.0);
  }
  // A column of whole numbers behind a clock stays one.
  const auto counted = read_ok("clock,count,force\n10:00:00,5,1\n10:00:01,6,2\n10:00:02,7,1\n");
  CHECK(copy(counted.force()) == std::vector<double>{1.0, 2.0, 1.0});
}

TEST_CASE("dates of the United States and clocks of 12 hours are read") {
  const auto line = [](const std::string& date, int hour, const std::string& half) {
    return [=](int s, int ms, double force) {
      return fmt::format("{}{}:59:{:02d}.{:03d}{},{:.4f}", date, hour, s + 58, ms, half, force);
    };
  };
  check_samples(read_ok(text_of("time,force", line("11/26/2026 ", 10, " AM"))), 39598.0);
  check_samples(read_ok(text_of("time,force", line("11/26/2026 ", 12, " AM"))), 3598.0);
  check_samples(read_ok(text_of("time,force", line("11/26/26 ", 1, " PM"))), 50398.0);
  check_samples(read_ok(text_of("time,force", line("", 12, "pm"))), 46798.0);
  check_samples(read_ok(text_of("time,force", line("26/11/2026 ", 13, ""))), 50398.0);
  // Over noon, where the hour falls from 12 to 1, and over midnight.
  const auto noon = read_ok("time,force\n12:59:59 PM,1\n1:00:00 PM,2\n1:00:01 PM,1\n");
  CHECK(copy(noon.time_s()) == std::vector<double>{46799.0, 46800.0, 46801.0});
  const auto midnight =
      read_ok("time,force\n12/31/2026 11:59:59 PM,1\n1/1/2027 12:00:00 AM,2\n1/1/2027 12:00:01 AM,1\n");
  CHECK(copy(midnight.time_s()) == std::vector<double>{86399.0, 86400.0, 86401.0});
}

TEST_CASE("a number may end with its decimal sign") {
  const std::string commas = "Zeit in s;Kraft in N\n0,;1,\n1,;1,5\n2,;2,\n3,;1,\n";
  CHECK(copy(read_ok(commas).force()) == std::vector<double>{1.0, 1.5, 2.0, 1.0});
  CHECK(copy(read_ok(commas).time_s()) == std::vector<double>{0.0, 1.0, 2.0, 3.0});
  CHECK(copy(read_ok("time_s,force_N\n0.,1.\n1.,1.5\n2.,2.\n").force()) == std::vector<double>{1.0, 1.5, 2.0});
  CHECK(copy(read_ok("Zeit [s]\tKraft [N]\n0,\t1,\n1,\t1,5\n2,\t2,\n3,\t1,5\n").force()) ==
        std::vector<double>{1.0, 1.5, 2.0, 1.5});
  // Where the comma parts the columns it stays a delimiter.
  CHECK(copy(read_ok("time,force\n0, 1\n1, 2\n2, 1\n").force()) == std::vector<double>{1.0, 2.0, 1.0});
}

TEST_CASE("rows are not lost as lines before the data without an error") {
  const auto content = [](int broken) {
    std::string text = "time\tforce\n";
    for (int i = 0; i < 40; ++i) text += fmt::format("{}{}\t{}\n", i, i < broken ? ".1.2" : "", i % 7);
    return text;
  };
  CHECK(read_ok(content(3)).size() == 37);
  const auto error = read_error(content(4));
  CHECK(error.code == "rows_before_data");
  CHECK(contains(error.message, "run7.csv:2: 4 lines before line 6"));
  // Names and values above the data are a preamble.
  std::string preamble;
  for (int i = 0; i < 60; ++i) preamble += fmt::format("setting {};{}\n", static_cast<char>('a' + i % 26), i);
  std::string data = "time;force\n";
  for (int i = 0; i < 300; ++i) data += fmt::format("{};{}\n", i, i % 7);
  CHECK(read_ok(preamble + data).size() == 300);
}

TEST_CASE("stamps that are coarser than the sampling advise a sampling rate") {
  const auto stamped = [](int rows_per_stamp) {
    std::string text = "time (s),force (N)\n";
    for (int i = 0; i < 3000; ++i) text += fmt::format("{},{:.2f}\n", i / rows_per_stamp, 1.0 + 0.01 * (i % 37));
    return text;
  };
  const auto error = read_error(stamped(1000));
  CHECK(error.code == "time_too_coarse");
  CHECK(contains(error.message, "1000 rows share each time in column 1 'time (s)'"));
  CHECK(contains(error.message, "--sample-rate 1000"));
  slipfit::ReadOptions options;
  options.sample_rate_Hz = 1000.0;
  CHECK(read_ok(stamped(1000), options).size() == 3000);
  const auto coarse = read_ok(stamped(5));
  const auto& warnings = coarse.provenance().warnings;
  CHECK(std::any_of(warnings.begin(), warnings.end(), [](const slipfit::Warning& warning) {
    return warning.code == "repeated_time_stamps" && contains(warning.message, "--sample-rate 5");
  }));
}
