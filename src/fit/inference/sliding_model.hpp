#pragma once

#include <optional>

#include "fit/inference/intervals.hpp"
#include "model/sliding.hpp"

namespace slipfit::fit {

using Reload = model::RiseOf<Jet>;
using Relaxation = model::RelaxationOf<Jet>;

/// The coordinates in SI with their derivatives. Forces at the reference load.
struct SlidingModel {
  Jet stiffness, omega, zeta, slope, alpha, level, difference, ageing, ageing_time, slip_distance,
      stiffness_exponent;                // k and w_n are those at Units::speed_m_per_s
  std::optional<Reload> reload;          ///< empty: the force does not rise after slips
  std::optional<Relaxation> relaxation;  ///< empty: the spring does not relax

  SlidingModel(const Coordinates& values, const Units& units);

  /// b (exp(alpha v) - 1) / alpha: how far F_k(v) lies above F_k(0+).
  [[nodiscard]] Jet excess_friction(double speed_m_per_s) const;
  /// V times the period of the limit cycle; empty where there is none.
  [[nodiscard]] std::optional<Jet> spacing(double speed_m_per_s, double load) const;
  /// The limit cycle of a given F_s - F_k(0+) at the reference load; empty where there is none.
  [[nodiscard]] std::optional<model::SlidingCycle<Jet>> cycle(double speed_m_per_s, double load,
                                                              const Jet& difference_N) const;

 private:
  [[nodiscard]] model::SlidingBody<Jet> body_at(double speed_m_per_s, double load) const;

  double reference_stick_s_ = 1.0;
  double reference_speed_m_per_s_ = 1.0;
};

}  // namespace slipfit::fit
