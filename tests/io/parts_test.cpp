#include <filesystem>

#include "temp_file.hpp"

using namespace io_test;
using slipfit::ReadOptions;

namespace {

/// As a CETR tester exports it: a header block, names and units above every step; the clock begins again.
std::string cetr(int steps, int rows) {
  std::string text = "Created by CETR Data Viewer\nTotal number of steps = 2\n\n";
  for (int step = 1; step <= steps; ++step) {
    text += "Step No. " + std::to_string(step) + "\nVelocity     = 240\nData Count   = 9\n\n";
    text += "Fx,Fz,Z,V1,V2,T,Ff,COF,AE,Wear\ng,g,mm,mm/sec,mm/sec,sec,g,,dB,a.b.u\n\n";
    for (int i = 0; i < rows; ++i) {
      const int force_g = 100 * step + i % 7;
      text += std::to_string(-force_g) + ",-200,0.1,0.01,0," + std::to_string(0.02 * i) + "," +
              std::to_string(force_g) + "," + std::to_string(force_g / 200.0) + ",3,4\n";
    }
  }
  return text;
}

/// One row each 0.1 s in steps of 20 rows, whose clock begins again; speed and load by the step.
std::string stepped(const std::string& numbers, const std::string& speeds) {
  std::string text = "Step,Timestamp [s],Fx [N],Fy [N],Fz [N],COF,Velocity [mm/s]\n";
  for (std::size_t step = 0; step < numbers.size(); ++step) {
    for (int i = 0; i < 20; ++i) {
      const double force_N = 1.0 + static_cast<double>(step) + 0.1 * (i % 3);
      text += std::string(1, numbers[step]) + "," + std::to_string(0.1 * i) + "," + std::to_string(0.01 * (i % 2)) +
              "," + std::to_string(force_N) + ",2," + std::to_string(force_N / 2.0) + "," +
              std::string(1, speeds[step]) + "\n";
    }
  }
  return text;
}

slipfit::Recording read_step(const std::string& text, std::size_t step) {
  ReadOptions options;
  options.step = step;
  return read_ok(text, options);
}

}  // namespace

TEST_CASE("an export in blocks of steps is read without options: units, force, load, the first long step") {
  const auto recording = read_ok(cetr(2, 30));
  CHECK(recording.size() == 30);
  CHECK(recording.force()[0] == Approx(100.0 * 9.80665e-3));
  CHECK(recording.conditions().normal_force_N == Approx(200.0 * 9.80665e-3));
  CHECK(says(recording, {"Time is column 6 'T', in sec"}));
  CHECK(says(recording, {"Force is column 7 'Ff', in g"}));
  CHECK(warns(recording, "several_steps"));
  const auto second = read_step(cetr(2, 30), 2);
  CHECK(second.force()[0] == Approx(200.0 * 9.80665e-3));
  CHECK(second.duration_s() == Approx(0.58));
  CHECK_FALSE(warns(second, "several_steps"));
}

TEST_CASE("an unknown unit neither conceals the names nor refuses the file") {
  const auto recording = read_ok("T,Ff,Foo,Bar\nsec,g,blurb,mm\n0,1,3,4\n1,2,3,5\n2,1,3,6\n3,2,3,7\n");
  CHECK(says(recording, {"Force is column 2 'Ff', in g"}));
}

TEST_CASE("a column of steps parts a file, and the force is the one that gives the friction coefficient") {
  const auto recording = read_ok(stepped("479", "555"));
  CHECK(recording.size() == 20);
  CHECK(says(recording, {"Force is column 4 'Fy [N]'"}));
  CHECK(says(recording, {"Step 4 is the recording (rows 1 to 20)"}));
  CHECK(read_step(stepped("479", "555"), 7).force()[0] == 2.0);
  CHECK(read_step(stepped("479", "555"), 3).force()[0] == 3.0);  // no step is called 3: the third
  CHECK(read_step(stepped("474", "555"), 3).force()[0] == 3.0);  // two are called 4: counted
  ReadOptions options;
  options.step = 12;
  const auto error = read_error(stepped("479", "555"), options);
  CHECK(error.code == "unknown_step");
  CHECK(contains(error.message, "3 steps (4, 7, 9)"));
}

TEST_CASE("steps on one clock at one speed and load are one recording") {
  std::string text = "Step,time,force\n";
  for (int i = 0; i < 60; ++i)
    text += std::to_string(i / 20) + "," + std::to_string(i) + "," + std::to_string(i % 3) + "\n";
  const auto recording = read_ok(text);
  CHECK(recording.size() == 60);
  CHECK(says(recording, {"All 3 steps", "one recording"}));
  CHECK(read_step(text, 1).size() == 20);
}

TEST_CASE("levels of the speed are steps where nothing else is") {
  std::string text = "time [s],force [N],speed [mm/s]\n";
  for (int i = 0; i < 300; ++i) {
    text += std::to_string(0.1 * i) + "," + std::to_string(i % 5) + "," + (i < 100 ? "1" : i < 200 ? "0" : "2") + "\n";
  }
  const auto recording = read_ok(text, {}, at_speed(0.0));
  CHECK(recording.conditions().speed_m_per_s == Approx(1e-3));
  CHECK(recording.size() == 100);
  CHECK(warns(recording, "several_steps"));
  ReadOptions options;
  options.step = 2;
  CHECK(read_ok(text, options, at_speed(0.0)).conditions().speed_m_per_s == Approx(2e-3));
}

TEST_CASE("rows, cells and a window take a part before the clock is judged") {
  std::string text = "time,force,phase,test\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(i) + "," + std::to_string(i % 3) + ",run,1\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(i * 7 % 40) + "," + std::to_string(i % 3) + ",damaged,2\n";
  CHECK(read_error(text).code == "time_runs_backwards");
  ReadOptions rows;
  rows.rows = {3, 22};
  const auto recording = read_ok(text, rows);
  CHECK(recording.size() == 20);
  CHECK(recording.time_s().front() == 2.0);
  CHECK(says(recording, {"rows 3:22 of 80"}));
  ReadOptions where;
  where.where = {"phase", "run"};
  CHECK(read_ok(text, where).size() == 40);
  where.where = {"4", "1.0"};
  CHECK(read_ok(text, where).size() == 40);
  where.where = {"phase", "idle"};
  CHECK(contains(read_error(text, where).message, "with 'idle' in column 3 'phase'"));
  rows.rows = {90, 95};
  CHECK(read_error(text, rows).code == "part_empty");
  rows.rows = {5, 5};
  CHECK(read_error(text, rows).code == "bad_rows");
}

TEST_CASE("a window is cut from the step that was asked for") {
  ReadOptions options;
  options.step = 2;
  options.window = {{0.45, 1.05}};
  const auto recording = read_ok(stepped("123", "555"), options);
  CHECK(recording.size() == 6);
  CHECK(recording.time_s().front() == Approx(0.5));
}

TEST_CASE("a column of speeds replaces the stated speed, or contradicts it") {
  const auto text = [](const std::string& unit) {
    std::string rows = "time,force,Velocity [" + unit + "]\n";
    for (int i = 0; i < 100; ++i) {
      rows += std::to_string(0.1 * i) + "," + std::to_string(i % 5) + "," +
              std::to_string(i < 10 ? 0.0 : 60.0 + i % 2) + "\n";
    }
    return rows;
  };
  const auto read_speed = read_ok(text("mm/s"), {}, at_speed(0.0));
  CHECK(read_speed.conditions().speed_m_per_s == Approx(0.0605).epsilon(0.01));
  CHECK(says(read_speed, {"Speed is column 3"}));
  CHECK_FALSE(warns(read_ok(text("mm/s"), {}, at_speed(0.0605)), "speed_differs"));
  CHECK(warns(read_ok(text("mm/s"), {}, at_speed(0.066)), "speed_differs"));
  CHECK(read_error(text("rpm"), {}, at_speed(0.0)).code == "no_speed");
  ReadOptions radius;
  radius.radius_m = 0.01;
  CHECK(read_ok(text("rpm"), radius, at_speed(0.0)).conditions().speed_m_per_s == Approx(0.0634).epsilon(0.01));
}

TEST_CASE("a stated normal force takes precedence, and a column is selected by its name or an option") {
  const std::string text = "time,Ff [N],A [N],B [g]\n0,1,10,100\n1,2,10,100\n2,1,10,100\n3,2,10,100\n";
  CHECK_FALSE(read_ok(text).conditions().normal_force_N);
  ReadOptions options;
  options.normal_force_column = "B";
  const auto recording = read_ok(text, options);
  CHECK(recording.conditions().normal_force_N == Approx(0.980665));
  CHECK(says(recording, {"Normal force is column 4 'B [g]'"}));
  auto stated = at_speed(1e-3);
  stated.normal_force_N = 2.0;
  const auto differs = read_ok(text, options, stated);
  CHECK(differs.conditions().normal_force_N == 2.0);
  CHECK(warns(differs, "normal_force_differs"));
  options.normal_force_column = "time";
  CHECK(read_ok("time [s],Ff\n0,1\n1,2\n2,1\n3,2\n").size() == 4);
  CHECK(read_error("time [s],Ff\n0,1\n1,2\n2,1\n3,2\n", options).code == "unknown_unit");
}

TEST_CASE("exports of UMT testers are read without options") {
  const std::filesystem::path folder = std::string(SLIPFIT_SHARED_DIR) + "/data/real/umt";
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no measured recordings here");
    return;
  }
  const auto cetr_export = slipfit::read_recording(folder / "umt_HT-2n-6-4_005.csv", at_speed(0.1));
  REQUIRE(cetr_export.ok());
  CHECK(cetr_export.value().size() == 103);
  CHECK(cetr_export.value().conditions().normal_force_N == Approx(200 * 9.80665e-3).epsilon(0.01));
  const auto bruker = folder / "umt_014_FX2_316SS_rotary_3N_4tests.csv";
  for (const auto& [step, rpm] : {std::pair{4U, 477.4}, {7U, 238.7}, {10U, 119.4}, {13U, 47.7}}) {
    ReadOptions options;
    options.step = step;
    options.radius_m = 0.01;
    const auto read_step = slipfit::read_recording(bruker, at_speed(0.0), options);
    REQUIRE(read_step.ok());
    CHECK(read_step.value().conditions().speed_m_per_s == Approx(rpm / 60 * 6.2831853 * 0.01).epsilon(0.01));
  }
}
