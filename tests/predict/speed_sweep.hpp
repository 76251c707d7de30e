#pragma once

#include <cstdint>
#include <vector>

#include "slipfit/sweep.hpp"

namespace test {

/// A slider with friction f0 + f1 exp(alpha v), and how its recordings scatter.
struct SpeedSweep {
  double stiffness_N_per_m = 1000.0;
  double omega_rad_per_s = 200.0;
  double damping_ratio = 0.08;
  double static_friction_N = 6.0;  ///< after 1 s of stick, less the cut-off
  double ageing_N = 0.0;           ///< what ln ((stick time + cut-off) / 1 s) adds to it
  double ageing_cutoff_s = 0.0;
  double f0_N = 3.5;
  double f1_N = 0.5;
  double alpha_s_per_m = -8.0;
  double static_friction_sd_N = 0.02;
  double noise_rms_N = 0.01;
};

/// Integrated by small steps of its own, with no code of the library.
slipfit::SweepEntry record(const SpeedSweep& model, double speed_m_per_s, std::uint64_t seed);
std::vector<slipfit::SweepEntry> record(const SpeedSweep& model, const std::vector<double>& speeds_m_per_s,
                                        std::uint64_t seed);

/// V times the period at the mean static friction, after many cycles; 0 where the slips die out.
double spacing_m(const SpeedSweep& model, double speed_m_per_s);
/// Duration of the first slip at the mean static friction.
double slip_s(const SpeedSweep& model, double speed_m_per_s);

}  // namespace test
