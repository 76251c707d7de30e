#pragma once

#include <cstdint>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/velocity_friction.hpp"

namespace slipfit {

/// Disturbances that are added to the force of the model, and the scatter of the static friction.
struct SimulationOptions {
  double duration_s = 1.0;
  double sample_rate_Hz = 1000.0;
  ForceView force_view = ForceView::Spring;
  double static_friction_sd_N = 0.0;  ///< normal, drawn anew for each cycle; never below the kinetic friction
  double noise_rms_N = 0.0;           ///< white
  double offset_N = 0.0;
  double drift_N_per_s = 0.0;
  double hum_N = 0.0;  ///< amplitude of a sine at the mains frequency
  double hum_frequency_Hz = 50.0;
  std::uint64_t seed = 1;
};

struct SimulatedTrace {
  std::vector<double> time_s;
  std::vector<double> force_N;
};

/// Simulates a recording of the exact Coulomb model from rest (a relaxed spring, first a ramp). If a slip does not
/// stick again, the motion decays to steady sliding. The same options give the same numbers on every platform (own
/// normal deviates).
SimulatedTrace simulate(const Slider& slider, const Friction& friction, double speed_m_per_s,
                        const SimulationOptions& options);

/// Simulates a recording with friction that depends on speed. Errors: parameter_out_of_range (speed <= 0 or not finite;
/// lambda or alpha * speed that overflows), no_convergence (the slip runs away, or is so stiff that the bounded work
/// does not reach its end).
Result<SimulatedTrace> simulate(const Slider& slider, const VelocityFriction& friction, double speed_m_per_s,
                                const SimulationOptions& options);

}  // namespace slipfit
