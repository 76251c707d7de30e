#include <fmt/format.h>

#include "temp_file.hpp"

using namespace io_test;

namespace {

/// 100 rows at 10 Hz with 0.5, 1.5, 0.5, ... where `replace` does not give another line.
template <class Replace>
std::string rows(const Replace& replace) {
  std::string text = "time,force\n";
  for (int i = 0; i < 100; ++i) {
    const std::string other = replace(i);
    text += (other.empty() ? std::to_string(0.1 * i) + "," + std::to_string(0.5 + i % 2) : other) + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("rows without a number are left out, counted and warned of") {
  const auto recording = read_ok(rows([](int i) -> std::string {
    switch (i) {
      case 10:
        return "1.0,nan";
      case 20:
        return "2.0,";
      case 30:
        return ",0.5";
      case 40:
        return "4.0,inf";
      case 50:
        return "5.0,overload";
      case 60:
        return "6.0,broken";
      case 70:
        return "7.0";
      case 80:
        return "8.0,1e999";
      default:
        return {};
    }
  }));
  CHECK(recording.size() == 92);
  CHECK(recording.provenance().rows_without_number == 8);
  CHECK(warns(recording, "rows_without_number"));
}

TEST_CASE("where cells of one shape cost more than a tenth of the rows, they are refused with a place and a remedy") {
  const auto with = [](int every, const std::string& cell) {
    return rows([&](int i) { return i % every == 4 ? std::to_string(0.1 * i) + "," + cell : ""; });
  };
  const auto error_of = [](const std::string& content, const slipfit::ReadOptions& options = {}) {
    const auto recording = read(content, options);
    REQUIRE_FALSE(recording.ok());
    return recording.error();
  };
  for (const char* const cell : {"(0.25)", "0.25-",
                                 "\x96"
                                 "0.25",
                                 "1'000.5"}) {
    CAPTURE(cell);
    const slipfit::Error error = error_of(with(8, cell));
    CHECK(error.code == "unread_numbers");
    CHECK(contains(error.message, "run7.csv:6: 12 cells such as"));
    CHECK(contains(error.message, "in column 2 'force'"));
    CHECK(contains(error.message, "--force-column"));
    CHECK(warns(read_ok(with(12, cell)), "rows_without_number"));  // 8 of 100
  }
  CHECK(contains(
      error_of(rows([](int i) { return i % 8 == 4 ? std::to_string(0.1 * i).insert(0, 1, '(') + "),1" : ""; })).message,
      "--time-column"));
  // A column alone, whose lost cells are lines without any number.
  slipfit::ReadOptions options;
  options.sample_rate_Hz = 10.0;
  std::string alone = "Kraft [N]\n";
  for (int i = 0; i < 100; ++i) alone += i % 8 == 4 ? "0.25-\n" : std::to_string(i % 3) + ".5\n";
  CHECK(error_of(alone, options).code == "unread_numbers");
  options.rows = slipfit::RowRange{1, 5};
  CHECK(read(alone, options).ok());
}

TEST_CASE("cells of many shapes, missing readings and words are left out and counted, however many they are") {
  CHECK(read_ok(rows([](int i) {
          std::string damage = "1!";
          for (int k = 0; k < i % 20; ++k) damage.insert(0, 1, '#');
          return i % 5 == 4 ? std::to_string(0.1 * i) + "," + damage : "";
        })).size() == 80);
  for (const char* const cell : {"", "nan", "---", "\xE2\x80\x94", "broken", "range 2 to 3", "12:30 pause"}) {
    CAPTURE(cell);
    const auto recording = read_ok(rows([&](int i) { return i % 5 == 4 ? std::to_string(0.1 * i) + "," + cell : ""; }));
    CHECK(recording.size() == 80);
    CHECK(recording.provenance().rows_without_number == 20);
  }
}

TEST_CASE("text lines among the data are skipped and counted, with the first line number") {
  const auto recording = read_ok(rows([](int i) -> std::string {
    return i == 10 ? "motor restarted" : i == 20 ? "# note" : i == 30 ? "time,force" : "";
  }));
  CHECK(recording.size() == 97);
  CHECK(recording.provenance().rows_without_number == 0);
  CHECK(says(recording, {"3 lines of text", "the first is line 12"}));
}

TEST_CASE("single backward stamps are left out, counted and warned of") {
  const auto recording = read_ok(rows([](int i) -> std::string {
    return i == 50 ? "4.85,9" : i == 51 ? "4.8,9" : "";
  }));
  CHECK(recording.size() == 98);
  CHECK(recording.provenance().rows_backward_in_time == 2);
  CHECK(warns(recording, "time_runs_backwards"));
  CHECK(std::is_sorted(recording.time_s().begin(), recording.time_s().end()));
  CHECK(*std::max_element(recording.force().begin(), recording.force().end()) == 1.5);
}

TEST_CASE("times at another rate than the stated one are warned of, coarse and unknown ones are not") {
  const auto warns_at = [](const std::string& name, int rows_a_stamp, double rate_Hz) {
    std::string text = name + ",force [N]\n";
    for (int i = 0; i < 100; ++i) text += fmt::format("{},{}\n", i / rows_a_stamp, i % 7);
    slipfit::ReadOptions options;
    options.sample_rate_Hz = rate_Hz;
    return warns(read_ok(text, options), "sample_rate_differs");
  };
  CHECK(warns_at("time [ms]", 1, 500.0));
  CHECK_FALSE(warns_at("time [ms]", 1, 1001.0));
  CHECK_FALSE(warns_at("time [ms]", 5, 5000.0));  // five rows a stamp: the rate is the better clock
  CHECK_FALSE(warns_at("time", 1, 500.0));        // a number of samples
}

TEST_CASE("repeated stamps are kept, counted and warned of") {
  const auto recording = read_ok(rows([](int i) -> std::string { return i == 50 ? "4.9,0.75" : ""; }));
  CHECK(recording.size() == 100);
  CHECK(recording.provenance().rows_repeating_time == 1);
  CHECK(warns(recording, "repeated_time_stamps"));
}

TEST_CASE("a window takes part of the recording, bounds included, on the recording's own clock") {
  slipfit::ReadOptions options;
  options.window = slipfit::TimeWindow{102.0, 104.0};
  const auto recording = read_ok("time,force\n100,1\n101,2\n102,3\n103,4\n104,5\n105,6\n", options);
  CHECK(copy(recording.time_s()) == std::vector<double>{102, 103, 104});
  CHECK(copy(recording.force()) == std::vector<double>{3, 4, 5});
  CHECK(says(recording, {"window 102:104 s", "100 to 105 s"}));
}

TEST_CASE("defects outside the window do not count") {
  slipfit::ReadOptions options;
  options.window = slipfit::TimeWindow{0.0, 4.0};
  const auto recording =
      read_ok(rows([](int i) -> std::string { return i == 60  ? "6.0,nan"
                                                     : i > 80 ? "7.0,1"
                                                              : ""; }), options);
  CHECK(recording.size() == 41);
  CHECK(recording.provenance().warnings.empty());
}

TEST_CASE("a NUL among the text costs its row only") {
  std::string content;
  for (int i = 0; i < 9000; ++i) content += std::to_string(0.1 * i) + "," + std::to_string(i % 2) + "\n";
  const auto at = content.find("800.0");
  REQUIRE(at > 70'000);  // behind the part that is looked at for binary content
  content[at + 8] = '\0';
  const auto recording = read_ok(content);
  CHECK(recording.size() == 8999);
  CHECK(recording.provenance().rows_without_number == 1);
}

TEST_CASE("the displacement is compared with the stated speed") {
  std::string content = "time [s],displacement [mm],force [N]\n";
  for (int i = 0; i < 500; ++i) {
    const double moved_mm = i < 100 ? 0.0 : 0.02 * (i - 100);  // stands for 1 s, then 2 mm/s
    content += std::to_string(0.01 * i) + "," + std::to_string(moved_mm) + "," + std::to_string(i % 5) + "\n";
  }
  CHECK_FALSE(warns(read_ok(content, {}, at_speed(2e-3)), "speed_differs_from_displacement"));
  CHECK_FALSE(warns(read_ok(content, {}, at_speed(2.08e-3)), "speed_differs_from_displacement"));
  const auto recording = read_ok(content, {}, at_speed(2.12e-3));
  REQUIRE(warns(recording, "speed_differs_from_displacement"));
  CHECK(contains(recording.provenance().warnings.back().message, "0.00212 m/s"));
  CHECK(contains(recording.provenance().warnings.back().message, "0.002 m/s"));
}

TEST_CASE("a stated speed that a displacement contradicts by the factor of a unit is an error") {
  std::string content = "time [s],displacement [mm],force [N]\n";
  for (int i = 0; i < 500; ++i) {
    content += std::to_string(0.01 * i) + "," + std::to_string(0.02 * i) + "," + std::to_string(i % 5) + "\n";
  }
  for (const double stated_m_per_s : {2.0, 2e-6, 0.12, 0.02, 2e-4}) {
    const auto refused = read(content, {}, at_speed(stated_m_per_s));
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().code == "speed_contradicted");
    CHECK(contains(refused.error().message, "; give --speed "));
  }
  slipfit::Conditions in_millimetres = at_speed(0.12);
  in_millimetres.speed_unit = "mm/s";
  CHECK(contains(read(content, {}, in_millimetres).error().message, "--speed 120mm/min"));
  CHECK(contains(read(content, {}, at_speed(2e-4)).error().message, "--speed 0.002m/s"));
  CHECK(warns(read_ok(content, {}, at_speed(4e-3)), "speed_differs_from_displacement"));
  const auto recording = read_ok(content, {}, at_speed(2e-3));
  REQUIRE(recording.provenance().moved_m_per_s);
  CHECK(*recording.provenance().moved_m_per_s->value == Approx(2e-3));
}

TEST_CASE("a displacement that changes its speed is warned of, and one that moves to and fro is not compared") {
  std::string faster = "time [s],displacement [mm],force [N]\n";
  std::string to_and_fro = faster;
  for (int i = 0; i < 500; ++i) {
    const std::string force = "," + std::to_string(i % 5) + "\n";
    faster += std::to_string(0.01 * i) + "," + std::to_string(1e-4 * i * i) + force;
    to_and_fro += std::to_string(0.01 * i) + "," + std::to_string(20.0 * std::sin(0.02 * i)) + force;
  }
  CHECK(warns(read_ok(faster, {}, at_speed(1e-3)), "speed_differs_from_displacement"));
  CHECK_FALSE(warns(read_ok(to_and_fro, {}, at_speed(1e-3)), "speed_differs_from_displacement"));
}

TEST_CASE("a first row with a cell that is no number is no row of units") {
  slipfit::ReadOptions options;
  options.force_column = "2";
  const auto recording =
      read_ok("time [s],force [N],spare [N]\n0.0,(0.5),1\n0.1,1.5,1\n0.2,0.5,2\n0.3,1.5,1\n", options);
  CHECK(recording.size() == 3);
}
