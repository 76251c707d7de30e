#include "io/file_name.hpp"

#include "slipfit/io/manifest_draft.hpp"
#include "temp_file.hpp"

using namespace io_test;
using slipfit::reading::read_file_name;

TEST_CASE("speed, load and group are read from the names that people give") {
  struct Case {
    std::string name;
    std::optional<double> speed_m_per_s, normal_force_N;
    std::string group;
  };
  const std::vector<Case> cases = {
      {"fdm_232g_50mm_min", 0.05 / 60, 0.232 * 9.80665, "fdm_232g"},
      {"BeigeCotton_F210_V-100mmps_2", 0.1, std::nullopt, "BeigeCotton_F210"},
      {"pad 3N 10mm-s run2", 0.01, 3.0, "pad 3N"},
      {"PTFE_0.5mm_per_s_01", 0.0005, std::nullopt, "PTFE"},
      {"2,5mm_s", 0.0025, std::nullopt, ""},
      {"test12mmsample", std::nullopt, std::nullopt, "test12mmsample"},
      {"recording-7", std::nullopt, std::nullopt, "recording"},
      {"", std::nullopt, std::nullopt, ""},
  };
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const auto told = read_file_name(c.name);
    CHECK(told.speed_m_per_s.has_value() == c.speed_m_per_s.has_value());
    if (c.speed_m_per_s && told.speed_m_per_s) CHECK(*told.speed_m_per_s == Approx(*c.speed_m_per_s));
    CHECK(told.normal_force_N.has_value() == c.normal_force_N.has_value());
    if (c.normal_force_N && told.normal_force_N) CHECK(*told.normal_force_N == Approx(*c.normal_force_N));
    CHECK(told.group == c.group);
  }
}

TEST_CASE("a draft has a row for each recording and lists the other files") {
  const TempFile first("time,Ft [N],Fz [N]\n0,1,2\n1,2,2\n2,1,2\n3,2,2\n", "pad_10mm_s_1.csv");
  const auto folder = first.path().parent_path();
  std::string steps = "Step,time,force,speed [mm/s]\n";
  for (int i = 0; i < 60; ++i) {
    steps += std::to_string(1 + i / 30) + "," + std::to_string(i % 30) + "," + std::to_string(i % 4) + "," +
             std::to_string(1 + i / 30) + "\n";
  }
  std::ofstream(folder / "steps.txt") << steps;
  std::ofstream(folder / "notes.txt") << "nothing here\n";
  std::ofstream(folder / "picture.png") << "0,1\n1,2\n2,1\n";
  const auto draft = slipfit::draft_manifest({folder});
  CHECK(draft.skipped.size() == 1);
  CHECK(slipfit::to_csv(draft, folder) ==
        "id,file,speed_m_per_s,normal_force_N,group,step\n"
        "pad_10mm_s_1,pad_10mm_s_1.csv,0.01,2,pad,\n"
        "steps-step1,steps.txt,0.001,,steps,1\n"
        "steps-step2,steps.txt,0.002,,steps,2\n");
}
