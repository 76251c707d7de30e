// The paths on which the time of a fit goes, one function each, for callgrind to count (check.py).
//   hot_paths PATH FOLDER      PATH: read, slips, frequency, fit

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>

#include "slipfit/io/recording_reader.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/pipeline.hpp"

namespace {

using namespace slipfit;

constexpr double kSpeed_m_per_s = 0.01;

/// 100 cycles of 200 samples, noise of 1 % of F_s - F_k, scattering static friction: 20 000 samples.
Recording recording() {
  const Slider slider = Slider::create(5000.0, 900.0, 0.05).value();
  const Friction friction = Friction::create(4.0, 3.0).value();
  const double period_s = damped_motion(slider, friction, kSpeed_m_per_s).cycle->period_s;
  SimulationOptions options;
  options.duration_s = 100.0 * period_s;
  options.sample_rate_Hz = 200.0 / period_s;
  options.static_friction_sd_N = 0.05;
  options.noise_rms_N = 0.01;
  SimulatedTrace trace = simulate(slider, friction, kSpeed_m_per_s, options);
  Conditions conditions;
  conditions.speed_m_per_s = kSpeed_m_per_s;
  return Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions).value();
}

std::filesystem::path write(const Recording& recording, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "recording.csv";
  std::ofstream out(file);
  out << "time_s,force_N\n";
  for (std::size_t i = 0; i < recording.size(); ++i) {
    out << fmt::format("{:.6f},{:.5f}\n", recording.time_s()[i], recording.force()[i]);
  }
  return file;
}

}  // namespace

// Named for callgrind's --toggle-collect.
extern "C" {
[[gnu::noinline]] bool measured_read(const std::filesystem::path& file) {
  Conditions conditions;
  conditions.speed_m_per_s = kSpeed_m_per_s;
  return read_recording(file, conditions).ok();
}
[[gnu::noinline]] bool measured_slips(const Recording& recording) {
  return !find_slips(recording, assess_quality(recording)).slips.empty();
}
[[gnu::noinline]] bool measured_frequency(const Recording& recording) {
  return find_frequency(recording, compute_spectrum(recording), std::nullopt).value_Hz.has_value();
}
[[gnu::noinline]] bool measured_fit(const Recording& recording, const Quality& quality, const Segmentation& slips) {
  return fit_recording(recording, quality, slips, {}).has_value();
}
}

int main(int count, char** words) {
  if (count < 3) return 2;
  const Recording trace = recording();
  const std::filesystem::path file = write(trace, words[2]);
  const Quality quality = assess_quality(trace);
  const Segmentation slips = find_slips(trace, quality);
  const std::map<std::string, std::function<bool()>> paths{
      {"read", [&] { return measured_read(file); }},
      {"slips", [&] { return measured_slips(trace); }},
      {"frequency", [&] { return measured_frequency(trace); }},
      {"fit", [&] { return measured_fit(trace, quality, slips); }}};
  const auto path = paths.find(words[1]);
  return path != paths.end() && path->second() ? 0 : 1;
}
