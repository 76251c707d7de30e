// Fits one recording and prints the stiffness with its 95 % interval:
//   example_fit_recording testdata/demo.csv 10mm/s

#include <cstdio>

#include "recording_argument.hpp"

int main(int argc, char** argv) {
  const slipfit::Analysis analysis = slipfit::analyze_and_fit(recording_of(argc, argv));
  if (!analysis.fit) {
    std::printf("no fit: %s\n", analysis.motion_reason.c_str());
    return 0;
  }
  const slipfit::Estimate stiffness = analysis.fit->stiffness();
  if (!stiffness.value || !stiffness.ci95) {
    std::printf("stiffness not known: %s\n", stiffness.note.c_str());
    return 0;
  }
  std::printf("stiffness %.1f N/m, 95 %% interval %.1f to %.1f N/m\n", *stiffness.value, stiffness.ci95->low,
              stiffness.ci95->high);
  return 0;
}
