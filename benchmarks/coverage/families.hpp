#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/pipeline.hpp"

namespace coverage {

/// What was put into a simulated recording; the friction difference and the spacing are those of the population.
struct Truth {
  double stiffness_N_per_m = 0.0;
  double natural_frequency_rad_per_s = 0.0;
  double damping_ratio = 0.0;
  double friction_difference_N = 0.0;
  double spacing_m = 0.0;  ///< 0 where there is no stick-slip
};

struct Scene {
  std::string family;
  std::string note;
  std::uint64_t seed = 0;
  Truth truth;
  slipfit::Recording recording;
  double noise_rms_N = 0.0;
  /// The same scene with 3 % of the noise: its fit gives the Fisher information at the truth. Only where noise
  /// is white and the cycles are regular ("clean").
  std::vector<double> nearly_noiseless_N;
};

const std::vector<std::string>& family_names();

/// Whether the right kind of motion is "stick_slip"; for "ringdown" and "steady" it is anything else.
bool is_stick_slip(const std::string& family);

/// Recording `index` of a family: every number of it follows from family, index and seed.
Scene make_scene(const std::string& family, std::uint64_t index, std::uint64_t seed);

}  // namespace coverage
