// Fits one recording and prints the stiffness with its 95 % interval:
//   example_fit_recording testdata/demo.csv 10mm/s

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
  const slipfit::Analysis analysis = slipfit::analyze_and_fit(recording.value(), {});
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
