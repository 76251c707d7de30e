// The kind of motion of measured recordings beside what their README says; skips, and says so, without the folder.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slipfit/io/recording_reader.hpp"
#include "slipfit/pipeline.hpp"
#include "support/recordings.hpp"

using namespace slipfit;

namespace {

const std::filesystem::path kReal = std::filesystem::path(SLIPFIT_SHARED_DIR) / "data/real";

/// Kinds of motion that the README accepts, a letter each: S stick-slip, O oscillatory slip, U undetermined, C
/// continuous (steady) sliding, I undetermined by the name of irregular.
struct Stated {
  std::string file;
  double speed_m_per_s;
  std::string kinds;
  double events_per_s = 0.0;  ///< of slips, where the README states it
  double tolerance = 0.05;
  std::optional<std::string> force_column = {};
  std::optional<double> sample_rate_Hz = {};
};

std::vector<Stated> stated() {
  std::vector<Stated> list{{"colas/colas_k168_v42.csv", 42e-6, "S", 0.6, 0.12},
                           {"colas/colas_k1002_v4300.csv", 4.3e-3, "OU", 35.0, 0.04},
                           {"colas/colas_k2254_v42.csv", 42e-6, "CUO"},
                           {"guldstrand/Force7_OG.txt", 1.198e-3, "S", 0.159, 0.05, {}, 4.0},
                           {"giacomel/giacomel_velstep3_TR2_exp013_sepiolite.txt", 1e-5, "CU"},
                           {"clutch/clutch_free_V300_a.csv", 5e-4, "S", 14.2},
                           {"clutch/clutch_25Hz_V250_a.csv", 5e-4, "S", 25.05},
                           {"clutch/clutch_V200_f10.csv", 5e-4, "S", 10.0},
                           {"clutch/clutch_V250_f10.csv", 5e-4, "S", 10.5, 0.06},
                           {"clutch/clutch_V300_f100.csv", 5e-4, "SI", 10.0, 0.2},
                           {"clutch/clutch_V300_f1000_w6.csv", 5e-4, "SI", 16.0, 0.1},
                           {"clutch/clutch_V100_f1000_steady.csv", 5e-4, "C"},
                           {"damper/damper_p0_push.csv", 0.01147, "SO", 47.4},
                           {"damper/damper_p5_push.csv", 0.02247, "SO", 50.9},
                           {"damper/damper_p9_push.csv", 0.03371, "SO", 51.6},
                           {"damper/damper_p0_pull.csv", 0.01148, "SOI", 33.0, 0.16},
                           {"damper/damper_p5_pull.csv", 0.02256, "SOI", 33.0, 0.16},
                           {"damper/damper_d1_0.5Hz_20lb_push.csv", 0.07, "CUO"},
                           {"damper/damper_d1_0.5Hz_35lb_push.csv", 0.07, "CUO"},
                           {"damper/damper_d1_0.5Hz_70lb_push.csv", 0.07, "CUO"},
                           {"damper/damper_d1_0.5Hz_80lb_push.csv", 0.07, "CUO"},
                           {"damper/damper_d1_0.5Hz_70lb_pull.csv", 0.0715, "SOUC", 158.5},
                           {"oil/oil_0-1rps_0-3N.csv", 0.1, "CU"},
                           {"oil/oil_0-1rps_15N.csv", 0.1, "CU"},
                           {"oil/oil_1rps_3N.csv", 0.1, "CU"},
                           {"oil/oil_2-5rps_6N.csv", 0.1, "CU"},
                           {"pin/pin_PPS_60N_1.tsv", 0.1, "CU", 0.0, 0.0, "14"},
                           {"pin/pin_test_time.tsv", 0.1, "CU", 0.0, 0.0, "14"},
                           {"robot/robot_q1_03.txt", 3e-4, "CUO"},
                           {"robot/robot_q1_5.txt", 5e-3, "CUO"}};
  for (const char* const mass : {"77", "232"}) {
    for (const int speed : {10, 30, 50, 100, 150, 200, 300, 600, 800, 1000, 1400, 1800}) {
      list.push_back({"fdm/fdm_" + std::string(mass) + "g_" + std::to_string(speed) + "mm_min.csv", speed / 6e4,
                      speed <= 300 ? "SO" : "CUO"});
    }
  }
  return list;
}

bool accepts(const std::string& kinds, const Analysis& analysis) {
  const auto has = [&](char kind) { return kinds.find(kind) != std::string::npos; };
  switch (analysis.motion) {
    case MotionClass::StickSlip:
      return has('S');
    case MotionClass::OscillatorySlip:
      return has('O');
    case MotionClass::SteadySliding:
      return has('C');
    case MotionClass::Undetermined:
      return has('U') || (has('I') && analysis.motion_reason.find("irregular") != std::string::npos);
  }
  return false;
}

/// A quoted frequency is the stated one; events that are steady sliding to slipfit have none.
bool has_events(const Stated& row, const Analysis& analysis) {
  const std::optional<double>& quoted_Hz = analysis.frequency.quoted.value;
  if (row.events_per_s == 0.0 || !quoted_Hz) return true;
  return std::abs(*quoted_Hz / row.events_per_s - 1.0) < row.tolerance;
}

/// The recording of that row; it fails the test where there is none.
std::optional<Recording> read(const Stated& row) {
  Conditions conditions;
  conditions.speed_m_per_s = row.speed_m_per_s;
  ReadOptions options;
  options.force_column = row.force_column;
  options.sample_rate_Hz = row.sample_rate_Hz;
  auto recording = read_recording(kReal / row.file, conditions, options);
  if (recording.ok()) return std::move(recording.value());
  FAIL_CHECK(recording.error().message);
  return std::nullopt;
}

void check(const Stated& row, const Recording& recording) {
  const Analysis analysis = analyze_and_fit(recording);
  CAPTURE(row.file, row.kinds, row.events_per_s, recording.size());
  CAPTURE(static_cast<int>(analysis.motion), analysis.motion_reason, analysis.frequency.quoted.value.value_or(0.0));
  CHECK(accepts(row.kinds, analysis));
  CHECK(has_events(row, analysis));
}

bool is_absent() {
  if (std::filesystem::exists(kReal / "robot")) return false;
  WARN("skipped: no measured recordings beside the checkout");
  return true;
}

}  // namespace

TEST_CASE("measured recordings have the kind of motion that their README states") {
  if (is_absent()) return;
  for (const Stated& row : stated()) {
    if (const auto recording = read(row)) check(row, *recording);
  }
}

TEST_CASE("a wave once a turn is no friction in half of the recording either") {
  if (is_absent()) return;
  for (const char* const file : {"oil/oil_1rps_3N.csv", "oil/oil_2-5rps_6N.csv"}) {
    const Stated row{file, 0.1, "CU"};
    const auto recording = read(row);
    if (!recording) continue;
    const std::size_t half = recording->size() / 2;
    check(row, recording->part(0, half));
    check(row, recording->part(half, recording->size()));
  }
}

TEST_CASE("oscillations that a slow clock hardly resolves are not called steady sliding") {
  if (is_absent()) return;
  const std::vector<std::pair<Stated, std::size_t>> rows{
      {{"damper/damper_p0_push.csv", 0.01147, "SOU"}, 3},    {{"fdm/fdm_77g_150mm_min.csv", 0.0025, "SOU"}, 2},
      {{"fdm/fdm_77g_150mm_min.csv", 0.0025, "SOU"}, 3},     {{"fdm/fdm_77g_200mm_min.csv", 0.00333333, "SOU"}, 3},
      {{"fdm/fdm_77g_300mm_min.csv", 0.005, "SOU"}, 2},      {{"fdm/fdm_232g_400mm_min.csv", 0.00666667, "SOU"}, 2},
      {{"fdm/fdm_232g_400mm_min.csv", 0.00666667, "SOU"}, 3}};
  for (const auto& [row, every] : rows) {
    if (const auto recording = read(row)) check(row, test::thinned(*recording, every));
  }
}

TEST_CASE("a few sudden slips are not called a force that wanders") {
  if (is_absent()) return;
  const Stated row{"clutch/clutch_V300_f100.csv", 5e-4, "SU"};
  const auto recording = read(row);
  if (!recording) return;
  const std::size_t first = recording->size() / 5;
  const std::size_t length = (recording->size() - first) / 8;
  for (const std::size_t piece : {std::size_t{4}, std::size_t{5}, std::size_t{7}}) {  // 3 or 4 slips each
    check(row, recording->part(first + piece * length, first + (piece + 1) * length));
  }
}

TEST_CASE("a slope of the sensor or fewer samples make no stick-slip of cogging or of a wandering force") {
  if (is_absent()) return;
  const std::vector<Stated> rows{{"robot/robot_q1_5.txt", 5e-3, "CUO"}, {"damper/damper_p0_pull.csv", 0.01148, "OU"}};
  for (const Stated& row : rows) {
    const auto recording = read(row);
    if (!recording) continue;
    std::vector<double> sloping(recording->force().begin(), recording->force().end());
    const auto [low, high] = std::ranges::minmax(sloping);
    for (std::size_t i = 0; i < sloping.size(); ++i) {
      sloping[i] += 0.3 * (high - low) * static_cast<double>(i) / static_cast<double>(sloping.size());
    }
    check(row, test::with_force(*recording, std::move(sloping)));
    check(row, recording->part(0, 3 * recording->size() / 5));
    for (const std::size_t every : {std::size_t{2}, std::size_t{3}}) check(row, test::thinned(*recording, every));
  }
}
