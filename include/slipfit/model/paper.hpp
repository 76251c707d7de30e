#pragma once

#include "slipfit/core/result.hpp"
#include "slipfit/model/motion.hpp"

namespace slipfit {

/// The paper's approximation for low damping, [Paper] eqs (32)-(40), as printed; docs/errata.md lists its errors.
struct PaperCycle {
  double delta_e = 1.0;                   ///< eq. (33)
  double delta_t = 1.0;                   ///< eq. (34)
  double delta_s = 1.0;                   ///< eq. (35)
  double lambda_d = 0.0;                  ///< eq. (32)
  double slip_s = 0.0;                    ///< eq. (36)
  double stick_s = 0.0;                   ///< eq. (37), divided by w as printed (w_n is right)
  double sticking_degree = 0.0;           ///< eq. (38)
  double displacement_printed_m = 0.0;    ///< eq. (40)
  double displacement_corrected_m = 0.0;  ///< V (t_slip + t_stick) with t_stick divided by w_n
};

/// Returns the smallest self-consistent slip time of the paper's equations, whose damping parameters depend on each
/// other, by a bracketed root. The error is `no_solution` if there is none (eq. (36) has two roots or none). Damping
/// ratio below 1, speed > 0.
Result<PaperCycle> paper_cycle(const Slider& slider, const Friction& friction, double speed_m_per_s);

}  // namespace slipfit
