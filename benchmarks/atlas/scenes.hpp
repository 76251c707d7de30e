#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/model/motion.hpp"

namespace atlas {

/// A simulated recording; forces as parts of the friction drop F_s - F_k.
struct Factors {
  double cycles = 40.0;
  double samples_per_slip = 20.0;
  double noise = 0.02;     ///< rms
  double jitter = 0.0;     ///< standard deviation of the static friction
  double drift = 0.0;      ///< over the whole recording
  double hum = 0.0;        ///< amplitude at 50 Hz
  double average = 0.0;    ///< of the sensor: w_n T_b
  double weakening = 0.0;  ///< slip distance: k D_c over the friction drop. Neither scatter, drift nor hum with the two
  double speedup = 1.0;    ///< driving speed over the usual one: lambda is 10 / speedup
};

/// One factor varied, the others as usual.
struct FactorSweep {
  std::string name;
  double Factors::*factor;
  std::vector<double> values;

  [[nodiscard]] Factors at(double value) const {
    Factors factors;
    factors.*factor = value;
    return factors;
  }
};

struct Scene {
  slipfit::Recording recording;
  slipfit::Slider slider;
  slipfit::Friction friction;
  slipfit::LimitCycle cycle;  ///< of the mean static friction
  double noise_N = 0.0;
  double begin_s = 0.0;  ///< from the onset of a slip to the first sample, where static friction does not scatter
};

/// lambda 10 and zeta 0.05 at the usual speed, about 17 slips a second: the seed draws phase, noise and 10 % of the
/// frequency (so that no method is favoured by a bin).
Scene make_scene(const Factors& factors, std::uint64_t seed);

/// Relative change of the period with relative change of F_s - F_k: what turns jitter into scatter of the periods.
double period_by_friction(const Scene& scene);

}  // namespace atlas
