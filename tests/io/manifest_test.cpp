#include "slipfit/io/manifest.hpp"

#include "temp_file.hpp"

using namespace io_test;
using slipfit::ManifestEntry;
using slipfit::ManifestReader;

namespace {

std::vector<ManifestEntry> entries_of(const std::filesystem::path& file) {
  auto entries = slipfit::read_manifest_group(file, std::nullopt);
  INFO((entries.ok() ? std::string() : entries.error().message));
  REQUIRE(entries.ok());
  return std::move(entries).value();
}

std::vector<ManifestEntry> entries_in(std::string_view content) {
  const TempFile file(content, "runs.csv");
  return entries_of(file.path());
}

/// The only recording of a manifest with these two lines behind `id,file,speed_m_per_s` and `a,a.csv,0.01`.
ManifestEntry entry_with(const std::string& columns, const std::string& cells) {
  return entries_in("id,file,speed_m_per_s," + columns + "\na,a.csv,0.01," + cells + "\n").at(0);
}

void check_error(std::string_view content, const std::string& code, const std::vector<std::string>& parts) {
  const TempFile file(content, "runs.csv");
  const auto entries = slipfit::read_manifest_group(file.path(), std::nullopt);
  CAPTURE(content);
  REQUIRE_FALSE(entries.ok());
  const std::string& message = entries.error().message;
  CHECK(entries.error().code == code);
  CHECK_THAT(message, Catch::Contains("runs.csv:"));
  CHECK(std::none_of(message.begin(), message.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }));
  for (const std::string& part : parts) CHECK_THAT(message, Catch::Contains(part));
}

}  // namespace

TEST_CASE("ids, groups and files may be in any script") {
  const auto entries =
      entries_in("id,file,speed_m_per_s,group\nобразец-один,записи/первая.csv,0.01,резина\nゴム,板.csv,0.01,резина\n");
  REQUIRE(entries.size() == 2);
  CHECK(entries[0].id == "образец-один");
  CHECK(entries[1].id == "ゴム");
  CHECK(entries[1].group == "резина");
}

TEST_CASE("a manifest gives ids, files next to it and speeds, in its own order") {
  const TempFile file("id,file,speed_m_per_s\nb,runs/b.csv,0.02\na,/data/a.csv,1e-3\n", "runs.csv");
  const auto entries = entries_of(file.path());
  REQUIRE(entries.size() == 2);
  CHECK(entries[0].id == "b");
  CHECK(entries[0].file == file.path().parent_path() / "runs/b.csv");
  CHECK(entries[0].conditions.speed_m_per_s == 0.02);
  CHECK(entries[0].group.empty());
  CHECK_FALSE(entries[0].conditions.measured_spacing_m);
  CHECK(entries[0].row == 1);
  CHECK(entries[0].line == 2);
  CHECK(entries[1].file == "/data/a.csv");
  CHECK(entries[1].row == 2);
}

TEST_CASE("every optional column of a manifest reaches the entry, and an empty cell is ignored") {
  const std::string columns =
      "normal_force_N,zero_force_N,speed_se_m_per_s,force_view,group,time_column,force_column,time_unit,force_unit,"
      "sample_rate_Hz,window_s,measured_spacing_m,sample,material,operator";
  const ManifestEntry full =
      entry_with(columns, "5,-0.5,1e-4,contact,rubber,t,Ft,ms,mN,1000,1.5:20,4e-4,S 7,\"EPDM, 70 Sh A\",K\xF6nig");
  CHECK(full.conditions.normal_force_N == 5.0);
  CHECK(full.conditions.zero_force_N == -0.5);
  CHECK(full.conditions.speed_standard_error_m_per_s == 1e-4);
  CHECK(full.conditions.force_view == slipfit::ForceView::Contact);
  CHECK(full.group == "rubber");
  CHECK(full.conditions.labels.group == "rubber");
  CHECK(full.conditions.labels.sample == "S 7");
  CHECK(full.conditions.labels.material == "EPDM, 70 Sh A");
  CHECK(full.conditions.labels.operator_name == "K\u00F6nig");  // Latin-1 becomes UTF-8
  CHECK(full.options.time_column == "t");
  CHECK(full.options.force_column == "Ft");
  CHECK(full.options.time_unit == "ms");
  CHECK(full.options.force_unit == "mN");
  CHECK(full.options.sample_rate_Hz == 1000.0);
  REQUIRE(full.options.window);
  CHECK(full.options.window->begin_s == 1.5);
  CHECK(full.options.window->end_s == 20.0);
  CHECK(full.conditions.measured_spacing_m == 4e-4);

  const ManifestEntry empty = entry_with(columns, ",,,,,,,,,,,,,,");
  CHECK_FALSE(empty.conditions.normal_force_N);
  CHECK_FALSE(empty.conditions.zero_force_N);
  CHECK(empty.conditions.force_view == slipfit::ForceView::Spring);
  CHECK_FALSE(empty.options.time_column);
  CHECK_FALSE(empty.options.sample_rate_Hz);
  CHECK_FALSE(empty.options.window);
  CHECK(empty.conditions.labels.sample.empty());
}

TEST_CASE("a unit is in the name of a column of the manifest, or in the cell") {
  const auto speed = [](const std::string& name, const std::string& cell) {
    return entries_in("id,file," + name + "\na,a.csv," + cell + "\n").at(0).conditions.speed_m_per_s;
  };
  CHECK(speed("speed [mm/s]", "10") == Approx(0.01).epsilon(1e-15));
  CHECK(speed("Speed (mm/min)", "600") == Approx(0.01).epsilon(1e-15));
  CHECK(speed("speed_mm_per_s", "10") == Approx(0.01).epsilon(1e-15));
  CHECK(speed("speed", "10 mm/s") == Approx(0.01).epsilon(1e-15));
  CHECK(speed("speed", "0.01") == 0.01);
  CHECK(entry_with("normal_force [gf]", "100").conditions.normal_force_N == Approx(0.980665).epsilon(1e-15));
  CHECK(entry_with("window [ms]", "500:1500").options.window->end_s == Approx(1.5).epsilon(1e-15));
  CHECK(entry_with("measured_spacing_um", "400").conditions.measured_spacing_m == Approx(4e-4).epsilon(1e-15));
  CHECK(entry_with("sample_rate_kHz", "2").options.sample_rate_Hz == Approx(2000.0).epsilon(1e-15));
}

TEST_CASE("a manifest may have a byte order mark, CRLF, quotes, comments, blank lines, semicolons and tabs") {
  const auto entries = entries_in(
      "\xEF\xBB\xBF# made by hand\r\n\r\n\"id\",file , speed_m_per_s,group\r\n"
      "\"a, \"\"first\"\"\",\"x,y.csv\",0.01,\r\n# left out\r\n b ,b.csv,0.02,g\r\n");
  REQUIRE(entries.size() == 2);
  CHECK(entries[0].id == "a, \"first\"");
  CHECK(entries[0].file.filename() == "x,y.csv");
  CHECK(entries[1].id == "b");
  CHECK(entries[1].line == 6);
  CHECK(entries_in("id;file;speed [mm/s]\na;a.csv;0,5\n").at(0).conditions.speed_m_per_s == Approx(5e-4));
  CHECK(entries_in("id\tfile\tgroup\tspeed [mm/s]\na\ta.csv\t\t1\n").at(0).group.empty());
}

TEST_CASE("a cell may be a rotation or a percentage, in any order with radius and speed") {
  const auto entry = entries_in("id,file,speed_se,speed,radius_m\na,a.csv,1 %,60 rpm,0.01\n").at(0);
  CHECK(entry.conditions.speed_m_per_s == Approx(0.01 * 2.0 * 3.14159265358979323846).epsilon(1e-12));
  CHECK(entry.conditions.speed_standard_error_m_per_s.value() == Approx(0.01 * entry.conditions.speed_m_per_s));
  CHECK(entry.conditions.speed_unit == "rpm");
}

TEST_CASE("columns that mean nothing are named, not used") {
  const TempFile file("id,weather,file,speed_m_per_s,speed_old\na,fair,a.csv,1,x\n", "runs.csv");
  const auto reader = ManifestReader::open(file.path());
  REQUIRE(reader.ok());
  CHECK(reader.value().ignored_columns() == std::vector<std::string>{"weather", "speed_old"});
}

TEST_CASE("faults of a manifest beside those of docs/errors.md are one line with place, value and what was expected") {
  const std::string names = "id,file,speed_m_per_s\n";
  check_error("name,file,speed_m_per_s\n", "missing_column", {"'id'", "name"});
  check_error("# nothing\n\n", "missing_column", {"blank lines"});
  check_error("id,file,speed [furlong]\n", "unknown_unit", {"runs.csv:1", "speed [furlong]"});
  check_error("id,file,speed_m_per_s,time_unit\na,a.csv,1,kg\n", "unknown_unit", {"runs.csv:2", "'time_unit'", "kg"});
  check_error("id,file,speed\na,a.csv,1kg\n", "unknown_unit", {"runs.csv:2", "'speed'", "kg"});
  check_error(names + "a,a.csv,1,2\n", "wrong_field_count", {"4 fields"});
  check_error(names + "a,\"a\"x,1\n", "open_quote", {"runs.csv:2"});
  check_error(names + "a,a.csv,10mm/s\n", "bad_number", {"'10mm/s'"});
  check_error(names + "a,a.csv,nan\n", "bad_number", {"'nan'"});
  check_error("id,file,speed\na,a.csv,60 rpm\n", "out_of_range", {"'60 rpm' is a rotation", "the manifest's radius_m"});
  check_error("id,file,speed_m_per_s,step\na,a.csv,1,2.5\n", "bad_step", {"'2.5'"});
  check_error(names + "a,,1\n", "missing_value", {"'file'"});
  check_error(names + "group:x,a.csv,1\n", "bad_id", {"'group:x'"});
  check_error(names + "\"x\ty\",a.csv,1\n", "bad_id", {"x\\ty"});
  check_error("id,file,speed_m_per_s,window_s\na,a.csv,1,3:1\n", "bad_window", {"'3:1'", "T0 < T1"});
  check_error("id,file,speed_m_per_s,window_s\na,a.csv,1,3\n", "bad_window", {"'3'", "T0:T1"});
  for (const char* filter : {"4", "0; 200 Hz", "2.5; 200 Hz", "9; 200 Hz", "2; 0", "2; 3 mm", "; 200 Hz"}) {
    check_error(std::string("id,file,speed_m_per_s,sensor_filter\na,a.csv,1,") + filter + "\n", "bad_sensor_filter",
                {"an order from 1 to 8"});
  }
  check_error("id,file,speed_m_per_s,sensor_bandwidth_Hz,sensor_filter\na,a.csv,1,500,2; 1 kHz\n", "conflicting_sensor",
              {"either a bandwidth"});
}

TEST_CASE("the recordings of one group of a manifest") {
  const TempFile file("id,file,speed_m_per_s,group\na,a.csv,1,g\nb,b.csv,1,h\nc,c.csv,1,g\nd,d.csv,1,\n", "runs.csv");
  const auto group = slipfit::read_manifest_group(file.path(), "g");
  REQUIRE(group.ok());
  REQUIRE(group.value().size() == 2);
  CHECK(group.value()[1].id == "c");
  CHECK(group.value()[1].row == 3);
  const auto unknown = slipfit::read_manifest_group(file.path(), "x");
  REQUIRE_FALSE(unknown.ok());
  CHECK(unknown.error().code == "unknown_group");
  CHECK_THAT(unknown.error().message, Catch::Contains("'x'") && Catch::Contains("g, h"));
  const TempFile without("id,file,speed_m_per_s\na,a.csv,1\n", "without.csv");
  CHECK_THAT(slipfit::read_manifest_group(without.path(), "x").error().message,
             Catch::Contains("add a column 'group'"));
}

TEST_CASE("an error in one row of a manifest leaves the next rows readable") {
  const TempFile file("id,file,speed_m_per_s\na,a.csv,x\nb,b.csv,1\n", "runs.csv");
  auto opened = ManifestReader::open(file.path());
  REQUIRE(opened.ok());
  ManifestReader reader = std::move(opened).value();
  CHECK_FALSE(reader.next().ok());
  const auto second = reader.next();
  REQUIRE(second.ok());
  REQUIRE(second.value());
  CHECK(second.value()->id == "b");
  CHECK(second.value()->row == 2);
  const auto end = reader.next();
  REQUIRE(end.ok());
  CHECK_FALSE(end.value());
}

TEST_CASE("a manifest's line beyond 16 MB is refused by its number") {
  const TempFile file("id,file,speed_m_per_s\na,a.csv,0.01\n" + std::string(17 << 20, '7') + "\n", "runs.csv");
  const auto entries = slipfit::read_manifest_group(file.path(), std::nullopt);
  REQUIRE_FALSE(entries.ok());
  CHECK(entries.error().code == "not_readable");
  CHECK_THAT(entries.error().message, Catch::Contains("runs.csv:3: ") && Catch::Contains("longer than 16 MB"));
}
