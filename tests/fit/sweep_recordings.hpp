#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "model/velocity_law.hpp"
#include "slipfit/sweep.hpp"

namespace test {

/// A made-up pair of bodies with F_k(v) = f0 + f1 exp(alpha v), or another law that begins like it, and how it is
/// recorded.
struct SweepScene {
  double stiffness_N_per_m = 900.0;
  double natural_frequency_rad_per_s = 150.0;
  double damping_ratio = 0.06;
  double static_friction_N = 3.0;
  double f0_N = 1.6, f1_N = 0.4, alpha_s_per_m = -8.0;
  slipfit::model::LawShape law = slipfit::model::LawShape::Exponential;
  double cycles = 20.0;
  double samples_per_half_period = 25.0;
  std::size_t averaged = 1;      ///< samples: each is the mean of so many
  double lag_s = 0.0;            ///< of a sensor of first order, as stated; needs many samples in a slip
  double scatter_N = 0.0;        ///< of F_s
  double level_scatter_N = 0.0;  ///< of F_k from cycle to cycle
  double noise_N = 0.01;
  double offset_N = 0.0;  ///< of the sensor, different in every recording: recording i reads i times this too much
  std::optional<double> normal_force_N{};                ///< as stated; the zero of the sensor is then known too
  slipfit::ForceView view = slipfit::ForceView::Spring;  ///< or Transmitted
  std::uint64_t seed = 1;

  [[nodiscard]] double kinetic_friction_N() const { return f0_N + f1_N; }
  [[nodiscard]] double spacing_m(double speed_m_per_s) const;
};

std::vector<slipfit::SweepEntry> record_sweep(const SweepScene& scene, const std::vector<double>& speeds_m_per_s);

}  // namespace test
