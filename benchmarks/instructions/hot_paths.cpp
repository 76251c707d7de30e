// The paths on which the time of a fit goes, one function each, for callgrind to count (check.py).
//   hot_paths PATH FOLDER      PATH: read, slips, frequency, fit

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>

#include "slipfit/io/recording_reader.hpp"
#include "slipfit/pipeline.hpp"
#include "usual_recording.hpp"

namespace {

using namespace slipfit;

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
  conditions.speed_m_per_s = 0.01;
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
  const Recording trace = usual_recording(100.0, 200.0);
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
