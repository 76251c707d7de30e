#pragma once

#include <string>

#include "fit/inference/joint_quantities.hpp"

namespace slipfit::fit {

/// What the named parameters of a sweep are made from.
struct SweepEvidence {
  SweepVector values;
  JointScales scales;
  SweepIntervals intervals;
  double free_damping_ratio = 0.0;  ///< best value, negative ones included; the model's is cut at 0
  bool depends_on_speed = false;    ///< the velocity tier is chosen
  std::string law_reason{};         ///< why it is, or not
  bool zero_known = false;
  bool shares_all = false;  ///< level and static friction are the same in all recordings
  bool misfit = false;      ///< residuals well above the noise: no interval holds what the model lacks
  JointHeld held{};
  StaticFriction static_friction = StaticFriction::Constant;
  std::size_t cycles = 0;
  double samples_per_slip = 0.0;
  std::optional<double> reference_normal_force_N{};  ///< known for all recordings
};

/// Fills parameters, correlation and the model estimate.
void report_sweep(const SweepEvidence& evidence, FitResult& result);

}  // namespace slipfit::fit
