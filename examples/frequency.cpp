// Reads a recording and says its stick-slip frequency, without a fit:
//   example_frequency testdata/demo.csv 10mm/s

#include <cstdio>
#include <slipfit/slipfit.hpp>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s RECORDING.csv SPEED\n", argv[0]);
    return 2;
  }
  const auto speed_m_per_s = slipfit::parse_quantity(argv[2], slipfit::Dimension::Speed);
  if (!speed_m_per_s) {
    std::fprintf(stderr, "%s\n", speed_m_per_s.error().message.c_str());
    return 2;
  }
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s.value();
  const auto recording = slipfit::read_recording(argv[1], conditions);
  if (!recording) {
    std::fprintf(stderr, "%s\n", recording.error().message.c_str());
    return 3;
  }
  const slipfit::Analysis analysis = slipfit::analyze(recording.value());
  const slipfit::Estimate& frequency = analysis.frequency.quoted;
  if (frequency.value) {
    std::printf("%.2f Hz from %zu slips\n", *frequency.value, analysis.cycles.count);
  } else {
    std::printf("no frequency: %s\n", analysis.motion_reason.c_str());
  }
  return 0;
}
