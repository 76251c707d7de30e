#include "temp_file.hpp"

using namespace io_test;

namespace {

const std::vector<double> kExpectedTime = {0.0, 0.5, 1.0, 1.5};
const std::vector<double> kExpectedForce = {1.25, -2.0, 3.5, 4.0};

struct Format {
  std::string what;
  std::string content;
};

std::string replace_all(std::string_view text, std::string_view from, std::string_view to) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const bool found = text.substr(i).starts_with(from);
    result += found ? to : text.substr(i, 1);
    i += found ? from.size() : 1;
  }
  return result;
}

const std::string kPlain = "time [s],force [N]\n0,1.25\n0.5,-2\n1,3.5\n1.5,4\n";

std::string utf16(const std::string& text, bool big_endian, bool mark) {
  std::string result = !mark ? "" : big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) {
    if (big_endian) result += '\0';
    result += c;
    if (!big_endian) result += '\0';
  }
  return result;
}

const std::string kNames = "time [s];force [N]\n";
const std::vector<Format> kFormats = {
    {"comma", kPlain},
    {"semicolon", replace_all(kPlain, ",", ";")},
    {"tab", replace_all(kPlain, ",", "\t")},
    {"bar", replace_all(kPlain, ",", "|")},
    {"blank", "t F\n0 1.25\n0.5 -2\n1 3.5\n1.5 4\n"},
    {"thousands of blanks", replace_all("t F\n 0 1.25 \n0.5 -2\n1 3.5\n1.5 4\n", " ", std::string(3000, ' '))},
    {"blanks and tabs", "t F\n  0 \t 1.25\n0.5\t-2\n 1\t\t3.5\n1.5  4\n"},
    {"comma and blank", "time, force\n0, 1.25\n0.5, -2\n1, 3.5\n1.5, 4\n"},
    {"decimal comma, semicolon", kNames + "0,0;1,25\n0,5;-2,0\n1,0;3,5\n1,5;4,0\n"},
    {"decimal comma, whole numbers between", kNames + "0;1,25\n0,5;-2\n1;3,5\n1,5;4\n"},
    {"decimal comma, tab", "Zeit [s]\tKraft [N]\n0,0\t1,25\n0,5\t-2,0\n1,0\t3,5\n1,5\t4,0\n"},
    {"decimal comma, blank", "0,0 1,25\n0,5 -2,0\n1,0 3,5\n1,5 4,0\n"},
    {"decimal comma in quotes, comma", "t,F\n\"0,0\",\"1,25\"\n\"0,5\",\"-2,0\"\n\"1,0\",\"3,5\"\n\"1,5\",\"4,0\"\n"},
    {"UTF-8 mark", "\xEF\xBB\xBF" + kPlain},
    {"UTF-16 little-endian", utf16(kPlain, false, true)},
    {"UTF-16 big-endian", utf16(kPlain, true, true)},
    {"UTF-16 without mark", utf16(kPlain, false, false)},
    {"UTF-16 with CRLF", utf16(replace_all(kPlain, "\n", "\r\n"), false, true)},
    {"CRLF", replace_all(kPlain, "\n", "\r\n")},
    {"CR", replace_all(kPlain, "\n", "\r")},
    {"CR CR LF", replace_all(kPlain, "\n", "\r\r\n")},
    {"mixed line ends", "time [s],force [N]\r\n0,1.25\n0.5,-2\r1,3.5\r\n1.5,4\r"},
    {"no line end at the end", kPlain.substr(0, kPlain.size() - 1)},
    {"blank lines", replace_all(kPlain, "\n", "\n\n")},
    {"console text before", "Calibrating cell 1\n   Ready\n\n" + kPlain},
    {"settings before", "Speed;10\nOperator;Kim\n" + replace_all(kPlain, ",", ";")},
    {"comment lines", "# rig 3\n# time, force\n" + kPlain.substr(kPlain.find('\n') + 1)},
    {"comment names, blanks", "# t [s]  F [N]\n0 1.25\n0.5 -2\n1 3.5\n1.5 4\n"},
    {"title row", "Specimen 3,Specimen 3\n" + kPlain},
    {"names and units rows", "Title,Title\ntime,force\ns,N\n0,1.25\n0.5,-2\n1,3.5\n1.5,4\n"},
    {"bracketed units row", "time,force\n[s],[N]\n0,1.25\n0.5,-2\n1,3.5\n1.5,4\n"},
    {"units row alone", "s,N\n0,1.25\n0.5,-2\n1,3.5\n1.5,4\n"},
    {"milliseconds and millinewtons", "time_ms,force_mN\n0,1250\n500,-2000\n1000,3500\n1500,4000\n"},
    {"round brackets", "Time(ms),Ft (mN)\n0,1250\n500,-2000\n1000,3500\n1500,4000\n"},
    {"minutes row",
     "Test time\tStandard force\nmin\tmN\n0\t1250\n0.00833333333333333333\t-2000\n"
     "0.01666666666666666667\t3500\n0.025\t4000\n"},
    {"blanks in names", "Time (s)   Friction force (N)\n0  1.25\n0.5  -2\n1 3.5\n1.5 4\n"},
    {"quoted names", "\"time [s]\",\"force, left [N]\"\n0,1.25\n0.5,-2\n1,3.5\n1.5,4\n"},
    {"quoted numbers", "\"t\",\"F\"\n\"0\",\"1.25\"\n\"0.5\",\"-2\"\n\"1\",\"3.5\"\n\"1.5\",\"4\"\n"},
    {"tags", "0 s, 1.25 N1 \n0.5 s, -2 N1\n1 s, 3.5 N1\n1.5 s, 4 N1\n"},
    {"no names", kPlain.substr(kPlain.find('\n') + 1)},
    {"trailing delimiter", "time [s],force [N],\n0,1.25,\n0.5,-2,\n1,3.5,\n1.5,4,\n"},
    {"trailing delimiter in the data only", "time [s],force [N]\n0,1.25,\n0.5,-2,\n1,3.5,\n1.5,4,\n"},
    {"plus signs and exponents", "t,F\n+0,+1.25\n5e-1,-2.0E+00\n+1.0e0,35E-1\n.15e1,4.\n"},
    {"minus sign of typesetting", replace_all(kPlain, "-", "\xE2\x88\x92")},
    {"minus sign in front and in the exponent, with a tag",
     "0 s, 1.25 N1 \n0.5 s, \xE2\x88\x92"
     "20e\xE2\x88\x92"
     "1 N1\n1 s, 3.5 N1\n1.5 s, 4 N1\n"},
    {"minus sign, decimal comma",
     "t;F\n0,0;1,25\n0,5;\xE2\x88\x92"
     "2,0\n1,0;3,5\n1,5;4,0\n"},
    {"minus sign in UTF-16", "\xFF\xFE" + utf16(kPlain.substr(0, kPlain.find('-')), false, false) + "\x12\x22" +
                                 utf16(kPlain.substr(kPlain.find('-') + 1), false, false)},
    {"en dash", replace_all(kPlain, "-", "\xE2\x80\x93")},
    {"clock", "Time,Force\n11:59:59.500,1.25\n12:00:00.000,-2\n12:00:00.500,3.5\n12:00:01.000,4\n"},
    {"text column", "t,state,F\n0,ok,1.25\n0.5,ok,-2\n1,slip,3.5\n1.5,ok,4\n"},
    {"line numbers", "1,0,1.25\n2,0.5,-2\n3,1,3.5\n4,1.5,4\n"},
    {"empty lines of a spreadsheet at the end", kPlain + ",\n,\n"},
};

}  // namespace

TEST_CASE("the same four samples come out of every layout") {
  for (const Format& format : kFormats) {
    CAPTURE(format.what);
    const auto recording = read_ok(format.content);
    const double start_s = format.what == "clock" ? 43199.5 : 0.0;
    REQUIRE(recording.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(recording.time_s()[i] - start_s == Approx(kExpectedTime[i]).margin(1e-12));
      CHECK(recording.force()[i] == Approx(kExpectedForce[i]).epsilon(1e-14));
    }
    CHECK(recording.provenance().rows_without_number == 0);
    CHECK(recording.provenance().warnings.empty());
  }
}

TEST_CASE("UTF-8 is text in any script, also where hardly a letter is ASCII") {
  std::string comment;
  for (int i = 0; i < 200; ++i) comment += "摩擦試験の記録、ゴム板と紙、試験機三号";
  const std::string cyrillic = "образец резины, испытание первое";
  for (const std::string& head : {"# " + comment + "\n", "\xEF\xBB\xBF# " + comment + "\n", "# " + cyrillic + "\n"}) {
    CHECK(read_ok(head + kPlain).size() == 4);
  }
  // A character cut where the first look at the file ends.
  for (std::size_t shift = 0; shift < 3; ++shift) {
    std::string lines(shift, ' ');
    while (lines.size() < 66000) lines += "# 摩擦試験の記録\n";
    CHECK(read_ok(lines + kPlain).size() == 4);
  }
}

TEST_CASE("what SCPI instruments write for an overload is no reading") {
  const auto recording = read_ok("t,F\n0,1\n1,9.9E37\n2,-9.9E+37\n3,9.91E37\n4,1e300\n5,2\n6,1\n");
  CHECK(copy(recording.force()) == std::vector<double>{1.0, 2.0, 1.0});
  CHECK(recording.provenance().rows_without_number == 4);
}

TEST_CASE("units of the file are converted and said") {
  const auto recording = read_ok("Zeit [min];Reibkraft [gf]\n0,0;100\n0,5;200\n1,0;300\n");
  CHECK(recording.time_s()[1] == Approx(30.0).epsilon(1e-15));
  CHECK(recording.force()[1] == Approx(200 * 9.80665e-3).epsilon(1e-15));
  CHECK(says(recording, {"Time is column 1 'Zeit [min]'", "in min"}));
  CHECK(says(recording, {"Force is column 2 'Reibkraft [gf]'", "in gf"}));
  CHECK(says(recording, {"comma is the decimal sign"}));
}

TEST_CASE("units stated by the user replace those of the file") {
  slipfit::ReadOptions options;
  options.time_unit = "ms";
  options.force_unit = "mN";
  const auto recording = read_ok(kPlain, options);
  CHECK(recording.time_s()[3] == Approx(1.5e-3).epsilon(1e-15));
  CHECK(recording.force()[3] == Approx(4e-3).epsilon(1e-15));
  CHECK(says(recording, {"in mN (as stated)"}));
}

TEST_CASE("a Latin-1 header gives a micro sign and names in UTF-8") {
  const auto recording = read_ok(
      "Pr\xFC"
      "fzeit [\xB5s],Kraft [\xB5N]\n0,100\n1000,200\n2000,150\n");
  CHECK(recording.time_s()[1] == Approx(1e-3).epsilon(1e-15));
  CHECK(recording.force()[1] == Approx(2e-4).epsilon(1e-15));
  CHECK(says(recording, {"'Pr\xC3\xBC"
                         "fzeit [\xC2\xB5s]'"}));
}

TEST_CASE("whole time stamps without a unit are milliseconds, and that is said") {
  const auto recording = read_ok("timestamp,force\n5909621,1\n5909649,2\n5909677,1\n5909705,3\n");
  CHECK(recording.time_s()[0] == Approx(5909.621).epsilon(1e-15));
  CHECK(recording.sample_interval_s() == Approx(0.028).epsilon(1e-9));
  CHECK(says(recording, {"timestamp", "in ms", "whole time stamps"}));
  const auto since_1970 = read_ok("timestamp,force\n1700000000000000,1\n1700000000001000,2\n1700000000002000,1\n");
  // A double of this size resolves 0.24 us.
  CHECK(since_1970.sample_interval_s() == Approx(1e-3).epsilon(1e-3));
  const auto seconds = read_ok("time,force\n0,1\n10,2\n20,1\n30,2\n");
  CHECK(seconds.sample_interval_s() == 10.0);
}

TEST_CASE("without a time column the sampling rate is the clock, and a missing reading keeps its place in it") {
  slipfit::ReadOptions options;
  options.sample_rate_Hz = 4.0;
  const auto recording = read_ok(
      "Starting\n1.0 N1 \r\n2.0 N1 \r\nnan N1\r\n3.0 N1\r\ncell 1 not found.826091 ms\r\n3 cells ready\r\n4.0 N1 \r\n",
      options);
  CHECK(copy(recording.time_s()) == std::vector<double>{0.0, 0.25, 0.75, 1.0});
  CHECK(copy(recording.force()) == std::vector<double>{1.0, 2.0, 3.0, 4.0});
  CHECK(recording.provenance().rows_without_number == 1);
  CHECK(says(recording, {"2 lines", "skipped", "line 6"}));
  CHECK(says(recording, {"4 samples per second"}));
}

TEST_CASE("a single column with a decimal comma below its name is not read as two columns") {
  slipfit::ReadOptions options;
  options.sample_rate_Hz = 10.0;
  const auto recording = read_ok("Kraft [N]\n0,51\n0,73\n1,02\n", options);
  CHECK(copy(recording.force()) == std::vector<double>{0.51, 0.73, 1.02});
}

TEST_CASE("a preamble longer than the first look is passed over") {
  std::string content;
  for (int i = 0; i < 4000; ++i) content += "console says hello again\n";
  const auto recording = read_ok(content + kPlain);
  CHECK(recording.size() == 4);
  CHECK(says(recording, {"4000 lines before the data"}));
}

TEST_CASE("a file of many blocks of the line reader is read to its last row") {
  std::string content = "time_s,force_N\n";
  constexpr std::size_t kRows = 2'200'000;  // 34 MB: LineReader's 2 x 16 MB are filled and refilled
  content.reserve(kRows * 17);
  char row[40];
  for (std::size_t i = 0; i < kRows; ++i) {
    const int length = std::snprintf(row, sizeof row, "%08.3f,%06.3f\r\n", static_cast<double>(i) * 1e-3,
                                     static_cast<double>(i % 97) * 0.25);
    content.append(row, static_cast<std::size_t>(length));
  }
  content.pop_back();
  content.pop_back();  // and no line end behind the last row
  const auto recording = read_ok(content);
  REQUIRE(recording.size() == kRows);
  CHECK(recording.time_s().back() == Approx((kRows - 1) * 1e-3).epsilon(1e-15));
  CHECK(recording.force().back() == 0.25 * ((kRows - 1) % 97));
  CHECK(recording.provenance().rows_without_number == 0);
}
