#include "manifests.hpp"

#include <sstream>

#include "slipfit/model/simulation.hpp"
#include "slipfit/report/csv.hpp"

namespace test {
namespace {

std::string recording(std::size_t number) {
  const auto slider = slipfit::Slider::create(1000.0, 200.0, 0.05).value();
  const auto friction = slipfit::Friction::create(6.0, 4.0).value();
  const slipfit::SimulationOptions options{.duration_s = 1.0 + 0.5 * static_cast<double>(number % 5),
                                           .static_friction_sd_N = 0.05,
                                           .noise_rms_N = 0.02,
                                           .seed = number + 1};
  return slipfit::trace_to_csv(slipfit::simulate(slider, friction, 0.02, options), "of a test");
}

}  // namespace

BatchScene::BatchScene(std::size_t recordings) {
  std::string manifest = "id,file,speed_m_per_s,group\n";
  for (std::size_t i = 0; i < recordings; ++i) {
    const std::string name = "r" + std::to_string(i);
    (void)folder_.file(name + ".csv", recording(i));
    manifest += name + "," + name + ".csv,0.02," + (i % 3 == 2 ? "" : "g" + std::to_string(i % 3)) + "\n";
  }
  (void)folder_.file("runs.csv", manifest);
}

ProgramResult batch(const std::string& manifest, const std::string& out, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"batch", manifest, "--out", out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_slipfit(arguments);
}

BatchFiles files_in(const std::string& folder) {
  return {content_of(folder + "/results.jsonl"), content_of(folder + "/summary.csv"),
          content_of(folder + "/failures.csv")};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace test
