#include "fit/inference/solution.hpp"

#include <algorithm>
#include <cmath>

#include "fit/inference/intervals.hpp"

namespace slipfit::fit {
namespace {

constexpr double kBendSigmas = 3.0;

Held held_by_user(const TierFits& fits) {
  Held held = fits.damped.held;
  held.damping = fits.damping_held();
  return held;
}

}  // namespace

Eigen::VectorXd unit_gradient(Eigen::Index quantity, double size) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(kQuantities);
  gradient(quantity) = size;
  return gradient;
}

Solution::Solution(const Recording& recording, const TierFits& fits, const Resolution& resolution)
    : uncertainty(fits.damped.uncertainty), held(held_by_user(fits)) {
  const BlockFit& blocks = choose_blocks(fits);
  const Shared& shared = blocks.parameters.shared;
  stiffness = std::exp(shared[0]);
  omega = std::exp(shared[1]);
  zeta = std::max(0.0, shared[2]);
  cycles = blocks.size();
  force = blocks.scales().force;
  scale = stiffness * blocks.scales().speed_m_per_s / omega;
  onset_force_sd = uncertainty.onset_force_sd * force;
  for (std::size_t i = 0; i < cycles; ++i) {
    const double share = 1.0 / static_cast<double>(cycles);
    onset_force += share * blocks.state(i).onset_force;
    level += share *
             blocks.model(i).level_at(blocks.reference_s(i), blocks.level_data(), blocks.parameters.cycles[i].data());
  }
  const Conditions& conditions = recording.conditions();
  relative_speed_se = conditions.speed_standard_error_m_per_s.value_or(0.0) / conditions.speed_m_per_s;
  level_trend = fit::level_trend(blocks);
  const std::optional<RampBend> found = ramp_bend(blocks);
  if (found && std::abs(found->log_ratio) > kBendSigmas * found->standard_error) bend = found;
  // A sensor that lags, or creep, moves w_n more than leaving out parts of the slip shows.
  shape_refused = fits.damped.refused_damping || fits.damped.misfit;
  bound_damping(fits, resolution, blocks);
}

/// The best fit with zeta >= 0: where the free one lies below, the fit with zeta = 0.
const BlockFit& Solution::choose_blocks(const TierFits& fits) {
  at_bound_ = fits.damped.blocks.parameters.shared[2] < 0.0 && !held.damping && fits.undamped.has_value();
  given_damping_ = at_bound_ && !uncertainty.from_refits ? fits.undamped->uncertainty.covariance
                                                         : uncertainty.covariance_given_damping;
  return at_bound_ ? fits.undamped->blocks : fits.damped.blocks;
}

void Solution::bound_damping(const TierFits& fits, const Resolution& resolution, const BlockFit& blocks) {
  damping_se = std::sqrt(std::max(0.0, uncertainty.covariance(kDamping, kDamping)));
  if (fits.damped.held.damping) {
    damping_ci = {zeta, zeta};
    return;
  }
  damping_ci =
      damping_interval(fits.damped.blocks.parameters.shared[2], damping_se, t_quantile(uncertainty.degrees_of_freedom));
  if (!resolution.slip_resolved || !needs_profile(fits.damped, resolution.samples_per_slip)) return;
  profile_ = profile_damping(fits.damped, blocks);
  if (profile_) damping_ci = profile_->interval;
}

Linear Solution::linear(double value, const Eigen::VectorXd& gradient, double variance) const {
  const double freedom = uncertainty.degrees_of_freedom;
  const double fitted = std::max(0.0, gradient.dot(uncertainty.covariance * gradient));
  const double conditional = std::max(0.0, gradient.dot(given_damping_ * gradient));
  Linear result{value, std::sqrt(fitted + variance), std::sqrt(conditional + variance), 0.0, 0.0, freedom};
  const double variance_of_zeta = uncertainty.covariance(kDamping, kDamping);
  if (profile_) {
    result.move_low = gradient.dot(profile_->move_low);
    result.move_high = gradient.dot(profile_->move_high);
  } else if (at_bound_ && variance_of_zeta > 0.0) {
    result.move_high = gradient.dot(uncertainty.covariance.col(kDamping)) / variance_of_zeta * damping_ci.high;
  }
  // Satterthwaite: the scatter has cycles - 1 degrees of freedom, the fit its own.
  const double total = fitted + variance;
  if (variance > 0.0 && total > 0.0) {
    const double scatter_freedom = static_cast<double>(cycles) - 1.0;
    result.degrees_of_freedom = total * total / (fitted * fitted / freedom + variance * variance / scatter_freedom);
  }
  return result;
}

Estimate Solution::estimate(const Linear& y) const {
  const double quantile = t_quantile(y.degrees_of_freedom);
  Estimate result{y.value, y.se, Interval{y.value - quantile * y.se, y.value + quantile * y.se}, {}};
  if (!at_bound_ && !profile_) return result;
  const double down = std::min({0.0, y.move_low, y.move_high});
  const double up = std::max({0.0, y.move_low, y.move_high});
  const double reach = quantile * y.se_given_damping;
  // At the bound every zeta of the interval is as good as the next; elsewhere its ends are as unlikely as the reach's.
  result.ci95 = at_bound_ ? Interval{y.value + down - reach, y.value + up + reach}
                          : Interval{y.value - std::hypot(down, reach), y.value + std::hypot(up, reach)};
  // One number for both sides: the farther one, or a truth there would seem many errors away.
  result.standard_error = std::max(result.ci95->high - y.value, y.value - result.ci95->low) / quantile;
  return result;
}

double Solution::scatter_variance(double spread) const {
  return uncertainty.from_cycles ? 0.0 : spread * spread / static_cast<double>(cycles);
}

}  // namespace slipfit::fit
