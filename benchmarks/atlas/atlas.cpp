// Speed against accuracy of methods, and where each of them fails: writes CSV, which draw.py draws.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "study.hpp"

int main(int argc, char** argv) {
  using Study = std::vector<atlas::File> (*)(atlas::Effort);
  const std::map<std::string, Study> studies{{"forward", atlas::study_forward},
                                             {"frequency", atlas::study_frequency},
                                             {"fits", atlas::study_fits},
                                             {"failures", atlas::map_failures},
                                             {"terms", atlas::map_term_failures}};
  bool quick = false;
  std::string out = "atlas_out";
  std::vector<std::string> chosen;
  for (const auto& [name, study] : studies) chosen.push_back(name);
  CLI::App program("Speed against accuracy of methods, and where each of them fails");
  program.add_flag("--quick", quick, "A coarse grid: under a minute");
  program.add_option("--out", out, "Folder for CSV")->capture_default_str();
  program.add_option("--only", chosen, "Studies to run")->check(CLI::IsMember(chosen));
  CLI11_PARSE(program, argc, argv);
  std::filesystem::create_directories(out);
  for (const std::string& name : chosen) {
    const double start_s = atlas::cpu_now_s();
    for (const atlas::File& file : studies.at(name)(quick ? atlas::Effort::Quick : atlas::Effort::Full)) {
      std::ofstream(std::filesystem::path(out) / file.name) << file.content;
    }
    fmt::print("{}: {:.1f} CPU seconds\n", name, atlas::cpu_now_s() - start_s);
  }
}
