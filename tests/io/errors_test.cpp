#include "temp_file.hpp"

using namespace io_test;

namespace {

struct Refused {
  std::string what;
  std::string content;
  std::string code;
  std::string part;  ///< of the message: place, value or remedy
};

}  // namespace

TEST_CASE("unusable contents beside those of docs/errors.md have their own errors") {
  const std::string rows = "0,1\n1,2\n2,1\n3,2\n";
  const std::vector<Refused> cases = {
      {"blank lines", "\n  \n\t\n", "empty_file", "blank"},
      {"binary", std::string("PK\x07\x04\0\0\0\x08", 8) + "abc", "binary_file", "not a text file"},
      {"no archive", std::string("PK\x03\x04\0\0\0\x08", 8) + "abc", "damaged_container", "is truncated"},
      {"no gzip", "\x1F\x8B stream", "damaged_container", "gzip"},
      {"no TDMS", "TDSm and nothing else", "damaged_container", "TDMS"},
      {"unprintable", "\x01\x02\x03\x04\x05\x06\x07\x0e\x0f text", "binary_file", "not a text file"},
      {"no encoding at all", "\xC0\xC1\xF8\xFF\xC0\xC1\xF8\xFF,1\n", "binary_file", "in UTF-8, Latin-1 or UTF-16"},
      {"UTF-16 of few digits without a mark", std::string("\x11\x04\x12\x04\x13\x04\x31\0\x32\0", 10), "binary_file",
       "with a byte order mark"},
      {"names only", "time,force\n", "no_numeric_column", "no rows of numbers"},
      {"time unit unknown", "time [furlong],force\n" + rows, "unknown_unit", "--time-unit"},
  };
  for (const Refused& c : cases) {
    CAPTURE(c.what);
    const auto error = read_error(c.content);
    CHECK(error.code == c.code);
    CHECK(contains(error.message, c.part));
  }
}

TEST_CASE("impossible options beside those of docs/errors.md have their own errors") {
  const std::string content = "time,force\n0,1\n1,2\n2,1\n3,2\n";
  const auto code_of = [&](auto change, std::string_view part) {
    slipfit::ReadOptions options;
    change(options);
    const auto error = read_error(content, options);
    CAPTURE(error.message);
    CHECK(contains(error.message, part));
    return error.code;
  };
  using Options = slipfit::ReadOptions;
  CHECK(code_of([](Options& o) { o.time_column = "9"; }, "no column '9'") == "unknown_column");
  CHECK(code_of([](Options& o) { o.force_column = "0"; }, "--force-column") == "unknown_column");
  CHECK(code_of([](Options& o) { o.force_unit = "mm"; }, "'mm'") == "unknown_unit");
  CHECK(code_of([](Options& o) { o.time_unit = "N"; }, "'N'") == "unknown_unit");
  CHECK(code_of([](Options& o) { o.window = {{1.0, std::nan("")}}; }, "window") == "bad_window");
  CHECK(code_of([](Options& o) { o.window = {{0.9, 1.1}}; }, "contains 1 sample;") == "window_empty");
  CHECK(code_of([](Options& o) { o.sample_rate_Hz = -4.0; }, "-4") == "bad_sample_rate");
  CHECK(code_of(
            [](Options& o) {
              o.time_column = "2";
              o.force_column = "2";
            },
            "both") == "conflicting_options");
}

TEST_CASE("a file that cannot be read is an error with the reason") {
  const TempFile file("time,force\n0,1\n1,2\n");
  const auto loop = file.path().parent_path() / "loop.csv";
  std::filesystem::create_symlink(loop, loop);  // unreadable for root too
  const auto recording = slipfit::read_recording(loop, at_speed(1e-3));
  REQUIRE_FALSE(recording.ok());
  CHECK(recording.error().code == "not_readable");
  CHECK(contains(recording.error().message, "loop.csv"));
  CHECK(contains(recording.error().message, "Too many levels of symbolic links"));
}

TEST_CASE("a line above 16 MB is refused and not read further") {
  const std::string content = "time,force\n0,1\n1,2\n2,1\n" + std::string(17 << 20, '7') + "\n";
  const auto error = read_error(content);
  CHECK(error.code == "line_too_long");
  CHECK(contains(error.message, "run7.csv:5:"));
}

TEST_CASE("a row of a million columns is reported as too long, not as lacking numbers") {
  std::string names = "time";
  std::string row = "0";
  for (int i = 0; i < 1000000; ++i) {
    names += ",force_" + std::to_string(i);
    row += "," + std::to_string(i);
  }
  for (const std::string& first : {row, names}) {
    const auto error = read_error(first + "\n" + row + "\n" + row + "\n");
    CHECK(error.code == "line_too_long");
    CHECK(contains(error.message, "run7.csv:1:"));
    CHECK(contains(error.message, "too many columns"));
  }
}

TEST_CASE("the rules of Recording::create are reported with the file") {
  const auto error = read_error("time,force\n0,1\n1,2\n", {}, at_speed(0.0));
  CHECK(error.code == "no_speed");
  CHECK(read_error("time,force\n0,1\n1,2\n", {}, at_speed(-1.0)).code == "speed_not_positive");
}
