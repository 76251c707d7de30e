// Reads a recording and says its stick-slip frequency, without a fit:
//   example_frequency testdata/demo.csv 10mm/s

#include <cstdio>

#include "recording_argument.hpp"

int main(int argc, char** argv) {
  const slipfit::Analysis analysis = slipfit::analyze(recording_of(argc, argv));
  const slipfit::Estimate& frequency = analysis.frequency.quoted;
  if (frequency.value) {
    std::printf("%.2f Hz from %zu slips\n", *frequency.value, analysis.cycles.count);
  } else {
    std::printf("no frequency: %s\n", analysis.motion_reason.c_str());
  }
  return 0;
}
