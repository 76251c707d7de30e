// Bytes as a recording's file: either a recording that keeps its promises, or one line that says why not.
#include <algorithm>
#include <cmath>

#include "demand.hpp"
#include "memory_file.hpp"
#include "slipfit/io/recording_reader.hpp"

namespace {

void read(const fuzz::MemoryFile& file, const slipfit::ReadOptions& options) {
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = 0.01;
  conditions.normal_force_N = 2.0;
  const auto recording = slipfit::read_recording(file.name(), conditions, options);
  if (!recording) return fuzz::demand_readable(recording.error());
  const auto finite = [](double value) { return std::isfinite(value); };
  const slipfit::Recording& read = recording.value();
  fuzz::demand(std::all_of(read.force().begin(), read.force().end(), finite), "forces are finite");
  fuzz::demand(std::all_of(read.time_s().begin(), read.time_s().end(), finite), "times are finite");
  fuzz::demand(std::is_sorted(read.time_s().begin(), read.time_s().end()), "time does not run backwards");
  fuzz::demand(read.sample_interval_s() > 0.0, "there is a sample interval");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  read(file, {});
  slipfit::ReadOptions options;
  options.force_column = "2";
  options.sample_rate_Hz = 100.0;
  options.window = slipfit::TimeWindow{0.1, 5.0};
  read(file, options);
  return 0;
}
