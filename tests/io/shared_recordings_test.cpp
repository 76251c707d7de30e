#include <fstream>
#include <sstream>

#include "temp_file.hpp"

using namespace io_test;

namespace {

const std::filesystem::path kData = std::filesystem::path(SLIPFIT_SHARED_DIR) / "data";

bool is_absent() {
  if (std::filesystem::exists(kData)) return false;
  WARN("skipped: no shared recordings in " + kData.string());
  return true;
}

slipfit::Recording read_shared(const std::string& file, double speed_m_per_s,
                               const slipfit::ReadOptions& options = {}) {
  auto recording = slipfit::read_recording(kData / file, at_speed(speed_m_per_s), options);
  INFO((recording.ok() ? file : recording.error().message));
  REQUIRE(recording.ok());
  return std::move(recording).value();
}

struct Ends {
  std::size_t samples;
  double first_s, last_s, first_N, last_N;
};

void check_ends(const slipfit::Recording& recording, const Ends& ends) {
  CHECK(recording.size() == ends.samples);
  CHECK(recording.time_s().front() == ends.first_s);
  CHECK(recording.time_s().back() == Approx(ends.last_s).epsilon(1e-15));
  CHECK(recording.force().front() == ends.first_N);
  CHECK(recording.force().back() == ends.last_N);
}

}  // namespace

TEST_CASE("real: paper on paper") {
  if (is_absent()) return;
  check_ends(read_shared("real/colas/colas_k168_v42.csv", 42e-6), {200000, 231.7295, 331.7290, 0.0725211, 0.0873419});
  check_ends(read_shared("real/colas/colas_k2254_v42.csv", 42e-6), {200000, 231.6995, 331.6990, 0.1175786, 0.0965242});
  const auto fast = read_shared("real/colas/colas_k1002_v4300.csv", 4.3e-3);
  check_ends(fast, {7521, 0.9395, 4.6995, 0.0681589, 0.0924915});
  CHECK(fast.provenance().warnings.empty());
  CHECK(says(fast, {"Force is column 2 'tangential_force_N', in N."}));
}

TEST_CASE("real: printed plastic, with the displacement as a check on the speed in the file name") {
  if (is_absent()) return;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kData / "real" / "fdm")) {
    const std::string name = entry.path().filename().string();
    int grams = 0;
    int mm_per_min = 0;
    if (std::sscanf(name.c_str(), "fdm_%dg_%dmm_min.csv", &grams, &mm_per_min) != 2) continue;
    CAPTURE(name);
    ++files;
    const double speed_m_per_s = mm_per_min * 1e-3 / 60.0;
    const auto recording = read_shared("real/fdm/" + name, speed_m_per_s);
    CHECK_FALSE(warns(recording, "speed_differs_from_displacement"));
    CHECK(warns(read_shared("real/fdm/" + name, 1.1 * speed_m_per_s), "speed_differs_from_displacement"));
    CHECK(says(recording, {"Force is column 3 'force_N'"}));
    CHECK(recording.provenance().rows_repeating_time >= 1);
  }
  CHECK(files == 26);
}

TEST_CASE("real: a tester's own export gives the numbers of its cleaned copy") {
  if (is_absent()) return;
  const auto raw = read_shared("real/fdm/raw_layout_232g_50mm_min.tsv", 50e-3 / 60.0);
  const auto clean = read_shared("real/fdm/fdm_232g_50mm_min.csv", 50e-3 / 60.0);
  REQUIRE(raw.size() == clean.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    REQUIRE(raw.time_s()[i] == Approx(clean.time_s()[i]).margin(5.1e-5));  // the copy has 4 decimals
    REQUIRE(raw.force()[i] == Approx(clean.force()[i]).margin(5.1e-7));    // and 6
  }
  CHECK(says(raw, {"Time is column 1 'Test time', in min."}));
  CHECK(says(raw, {"Force is column 3 'Standard force', in N."}));
  CHECK(says(raw, {"1 line before the data was skipped"}));
}

TEST_CASE("real: a serial log without a clock") {
  if (is_absent()) return;
  const auto refused = slipfit::read_recording(kData / "real/guldstrand/Force7_OG.txt", at_speed(1.198e-3));
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.error().code == "no_time_column");
  slipfit::ReadOptions options;
  options.sample_rate_Hz = 4.0;
  const auto recording = read_shared("real/guldstrand/Force7_OG.txt", 1.198e-3, options);
  check_ends(recording, {4261, 0.0, 1065.0, 0.0, 9.93});
  CHECK(says(recording, {"13 lines before the data"}));
  CHECK(says(recording, {"1 line of text among the data", "line 3308"}));
}

TEST_CASE("real: rock friction coefficient with a clock far from zero") {
  if (is_absent()) return;
  const std::string file = "real/giacomel/giacomel_velstep3_TR2_exp013_sepiolite.txt";
  const auto recording = read_shared(file, 2e-6);
  check_ends(recording, {16466, 20086.207, 22319.527, 0.455250, 0.496434});
  CHECK(recording.conditions().quantity == slipfit::ForceQuantity::FrictionCoefficient);
  auto conditions = at_speed(2e-6);
  conditions.normal_force_N = 3.0;
  const auto force = slipfit::read_recording(kData / file, conditions);
  REQUIRE(force.ok());
  CHECK(force.value().conditions().quantity == slipfit::ForceQuantity::Force_N);
  CHECK(force.value().force().front() == Approx(3.0 * 0.455250).epsilon(1e-15));
}

TEST_CASE("real: a tactile sensor of 16 channels needs to be told the column") {
  if (is_absent()) return;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kData / "real" / "fabricslide")) {
    ++files;
    const auto refused = slipfit::read_recording(entry.path(), at_speed(0.01));
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().code == "ambiguous_force_column");
    CHECK(contains(refused.error().message, "4 'channel1'"));
    slipfit::ReadOptions options;
    options.force_column = "channel1";
    const auto recording = slipfit::read_recording(entry.path(), at_speed(0.01), options);
    REQUIRE(recording.ok());
    CHECK(recording.value().sample_interval_s() == Approx(0.028).epsilon(0.02));
  }
  CHECK(files == 4);
}

TEST_CASE("synthetic: every recording of the manifest is read, row for row") {
  if (is_absent()) return;
  std::ifstream manifest(kData / "synthetic" / "manifest.csv");
  std::ifstream truth(kData / "synthetic" / "truth.csv");
  std::string line;
  std::string expected;
  std::getline(manifest, line);
  std::getline(truth, expected);
  int files = 0;
  while (std::getline(manifest, line) && std::getline(truth, expected)) {
    std::istringstream fields(line);
    std::string id, file, speed;
    std::getline(std::getline(std::getline(fields, id, ','), file, ','), speed, ',');
    CAPTURE(file);
    const auto recording = read_shared("synthetic/" + file, std::stod(speed));
    std::istringstream truths(expected);
    std::string field;
    for (int i = 0; i < 4; ++i) std::getline(truths, field, ',');
    REQUIRE(expected.rfind(id + ",", 0) == 0);
    CHECK(recording.size() + recording.provenance().rows_without_number == std::stoul(field));
    CHECK(says(recording, {"Time is column 1 'time [s]', in s."}));
    CHECK(says(recording, {"Force is column 2 'force [N]', in N."}));
    ++files;
  }
  CHECK(files == 52);
}

TEST_CASE("real: strokes of a damper with play between sine-driven ends") {
  if (is_absent()) return;
  slipfit::ReadOptions options;
  options.pieces = slipfit::Pieces::Strokes;
  const auto strokes =
      slipfit::read_pieces(kData / "real" / "damper" / "damper_whole_d1.csv", at_speed(0.066), options);
  REQUIRE(strokes.ok());
  CHECK(strokes.value().size() >= 10);
}

TEST_CASE("real: numbers that end with their decimal comma are read to the last row") {
  if (is_absent()) return;
  slipfit::ReadOptions options;
  options.time_column = "Test Time";
  options.force_column = "14";
  const auto recording = read_shared("real/pin/pin_test_time.tsv", 0.25, options);
  CHECK(recording.size() == 1801);
  CHECK(recording.provenance().rows_without_number == 0);
}
