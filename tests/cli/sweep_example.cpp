#include "sweep_example.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <utility>

#include "fit_example.hpp"

namespace test {

SweepExample::SweepExample() {
  const std::array<std::pair<const char*, const char*>, 3> speeds{
      {{"slow", "0.02"}, {"middle", "0.04"}, {"fast", "0.08"}}};
  std::string rows = "id,file,speed_m_per_s,force_view,group\n";
  for (const auto& [id, speed] : speeds) {
    std::vector<std::string> arguments{"simulate", "--speed", speed, "--duration", "4", "--sample-rate", "1kHz"};
    const std::vector<std::string> model = model_options();
    arguments.insert(arguments.end(), model.begin(), model.end());
    arguments.insert(arguments.end(), {"--noise", "0.02", "--jitter", "0.05", "--seed", std::to_string(rows.size())});
    const std::string name = std::string(id) + ".csv";
    const ProgramResult simulated = run_slipfit(arguments);
    REQUIRE(simulated.exit_code == 0);
    static_cast<void>(folder.file(name, simulated.out));
    rows += std::string(id) + "," + name + "," + speed + ",spring,pad\n";
    rows += std::string(id) + "-contact," + name + "," + speed + ",contact,contact\n";
  }
  static_cast<void>(folder.file("manifest.csv", rows));
}

nlohmann::json SweepExample::fit(const std::vector<std::string>& options) const {
  std::vector<std::string> arguments{"fit", "--joint", manifest, "--json", "--quiet", "--out", out};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const ProgramResult result = run_slipfit(arguments);
  CAPTURE(arguments, result.err);
  REQUIRE(result.exit_code == 0);
  return nlohmann::json::parse(content_of(out));
}

}  // namespace test
