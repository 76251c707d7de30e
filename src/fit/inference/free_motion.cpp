#include "fit/inference/free_motion.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"

namespace slipfit::fit {
namespace {

double half_width(const Estimate& estimate) {
  return 0.5 * (estimate.ci95->high - estimate.ci95->low);
}

}  // namespace

std::string FreeMotion::words() const {
  const double zeta = values(1);
  const double damped_rad_per_s = std::exp(values(0)) * std::sqrt(std::max(0.0, 1.0 - zeta * zeta));
  const double frequency_Hz = damped_rad_per_s / (2.0 * std::numbers::pi);
  const double zeta_error = std::sqrt(covariance(1, 1));
  std::string frequency = fmt::format("{:.3g} ± {:.2g} Hz", frequency_Hz, frequency_Hz * std::sqrt(covariance(0, 0)));
  if (!(zeta_error < thresholds::kInformativeDamping)) return frequency;
  return fmt::format("{} with a damping ratio of {:.2g} ± {:.1g}", frequency, zeta, zeta_error);
}

FreeMotion motion_of_slips(const Coordinates& values, const CoordinateMatrix& covariance, double off) {
  FreeMotion motion{values.segment<2>(kLogFrequency), covariance.block<2, 2>(kLogFrequency, kLogFrequency)};
  motion.covariance(0, 0) += off * off / 3.0;  // anything up to it is as likely
  return motion;
}

FreeMotion motion_of(const RingDown& ring, double degrees_of_freedom) {
  const double quantile = t_quantile(degrees_of_freedom);
  const double zeta = *ring.damping_ratio.value;
  const double zeta_error = half_width(ring.damping_ratio) / quantile;
  const double log_error = half_width(ring.frequency_Hz) / quantile / *ring.frequency_Hz.value;
  const double by_zeta = zeta / (1.0 - zeta * zeta);  // of ln w_n = ln w_d - ln(1 - zeta^2) / 2
  FreeMotion motion;
  motion.values << std::log(2.0 * std::numbers::pi * *ring.frequency_Hz.value) - 0.5 * std::log1p(-zeta * zeta), zeta;
  const double mixed = by_zeta * zeta_error * zeta_error;
  motion.covariance << log_error * log_error + by_zeta * mixed, mixed, mixed, zeta_error * zeta_error;
  return motion;
}

SameMotion compare_motions(const FreeMotion& slips, const FreeMotion& ring) {
  if (!(slips.covariance.determinant() > 0.0) || !(ring.covariance.determinant() > 0.0)) return {};
  if (!(std::sqrt(slips.covariance(0, 0)) < thresholds::kInformativeFrequency)) return {};
  const Eigen::Vector2d apart = ring.values - slips.values;
  const Eigen::Matrix2d gain = slips.covariance * (slips.covariance + ring.covariance).inverse();
  const double chi2 = apart.dot((slips.covariance + ring.covariance).inverse() * apart);
  const double chance = std::exp(-0.5 * chi2);  // of chi-square with two degrees of freedom
  if (!(chance > thresholds::kSignificant)) return {std::nullopt, true};
  FreeMotion both{slips.values + gain * apart, slips.covariance - gain * slips.covariance};
  both.covariance = 0.5 * std::max(1.0, 0.5 * chi2) * (both.covariance + both.covariance.transpose());
  both.values(1) = std::max(0.0, both.values(1));
  return {both, false};
}

Warning differing_motions(const FreeMotion& slips, const FreeMotion& ring) {
  return {"ring_down_differs",
          fmt::format("the slips are those of an oscillation of {}, the rig rings down at {}: not one motion, or the "
                      "contact changes it; the fit rests on the slips",
                      slips.words(), ring.words())};
}

CoordinateMatrix with_motion(const CoordinateMatrix& held, const MotionMoves& moves, const FreeMotion& motion) {
  const CoordinateMatrix sum = held + moves * motion.covariance * moves.transpose();
  return 0.5 * (sum + sum.transpose());
}

}  // namespace slipfit::fit
