#include "io/cells.hpp"
#include "temp_file.hpp"

using namespace io_test;
using slipfit::reading::read_date;

TEST_CASE("dates are read as ISO, Germans and Americans write them, and nothing else is one") {
  REQUIRE(read_date("1970-01-02T00:00:01Z"));
  CHECK(read_date("1970-01-02T00:00:01Z")->midnight_s == 86400.0);
  CHECK(read_date("1970-01-02T00:00:01Z")->clock == "00:00:01");
  CHECK(read_date("2024/02/29 12:00:00.5+02:00")->clock == "12:00:00.5");
  CHECK(read_date("02.01.1970 00:00:01,5")->midnight_s == 86400.0);
  CHECK(read_date("02.01.70 00:00:01")->midnight_s == 86400.0 * (36525 + 1));
  REQUIRE(read_date("2024-05-12"));
  CHECK(read_date("2024-05-12")->clock.empty());
  for (const char* const text : {"2023-02-29 12:00:00", "1.5", "1.2.3", "12-05-2024 12:00:00", "2024-05-12x",
                                 "13/13/2024 1:00:00", "12.13.2024 1:00:00", "", "1--2-3 4"}) {
    CAPTURE(text);
    CHECK_FALSE(read_date(text));
  }
}

TEST_CASE("clocks with a date, with a decimal comma, over midnight and in Excel's days are seconds") {
  struct Case {
    std::string what;
    std::string content;
    std::vector<double> times;
  };
  const std::vector<Case> cases = {
      {"ISO",
       "time,force\n2024-05-12T12:00:00.25Z,1\n2024-05-12T12:00:00.50Z,2\n2024-05-12T12:00:00.75Z,1\n",
       {43200.25, 43200.5, 43200.75}},
      {"German",
       "Zeit;Kraft [N]\n12.05.2024 23:59:59,5;1,5\n13.05.2024 00:00:00,0;2,5\n13.05.2024 00:00:00,5;1,5\n",
       {86399.5, 86400, 86400.5}},
      {"comma", "Zeit;Kraft [N]\n01:00:00,250;1.5\n01:00:00,500;2.5\n01:00:00,750;1.5\n", {3600.25, 3600.5, 3600.75}},
      {"midnight", "time;force\n23:59:59.5;1\n00:00:00.0;2\n00:00:00.5;1\n", {86399.5, 86400, 86400.5}},
      {"Excel", "Date,force\n45424.5000000,1\n45424.5000058,2\n45424.5000116,1\n", {43200, 43200.5, 43201}},
  };
  for (const Case& c : cases) {
    CAPTURE(c.what);
    const auto recording = read_ok(c.content);
    REQUIRE(recording.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) CHECK(recording.time_s()[i] == Approx(c.times[i]).epsilon(0).margin(0.01));
  }
}

TEST_CASE("without a clock the displacement over the speed is the time, and is said to be") {
  std::string content = "Standardweg [mm];Standardkraft [N]\n";
  for (int i = 0; i < 100; ++i) content += std::to_string(-0.5 - 0.01 * i) + ";" + std::to_string(i % 5) + "\n";
  const auto recording = read_ok(content, {}, at_speed(2e-3));
  CHECK(recording.size() == 100);
  CHECK(recording.duration_s() == Approx(0.495));
  CHECK(says(recording, {"Time is column 1 'Standardweg [mm]' divided by the driving speed, t = x/V"}));
  CHECK(read_error(content, {}, at_speed(0.0)).code == "no_time_column");
}
