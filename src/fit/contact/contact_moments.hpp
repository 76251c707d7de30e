#pragma once

#include <Eigen/Dense>
#include <optional>

#include "fit/contact/contact_cycles.hpp"

namespace slipfit::fit {

/// Holds the four means over the cycles with their errors: ln(k V), onset jump, end jump, slip time.
struct ContactMoments {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double jump_sd = 0.0;  ///< spread of the onset jump over cycles
};

ContactMoments moments_of(const ContactCycles& found);

/// (ln k V, ln w_n, zeta, ln (F_s - F_k)) and their covariance; zeta may come out slightly negative.
struct ContactSolution {
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
};

/// Solves slip time and end jump of the model for w_n and zeta. Empty where no zeta in (-0.1, 0.6) does.
std::optional<ContactSolution> solve_moments(const ContactMoments& moments);

}  // namespace slipfit::fit
