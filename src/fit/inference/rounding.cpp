#include "fit/inference/rounding.hpp"

#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <random>
#include <utility>

namespace slipfit::fit {

namespace {

/// For |x| < 2^51, without a call: the last bit of the sum is 1.
double nearest_integer(double x) {
  constexpr double kLastBitIsOne = 0x1.8p52;
  return (x + kLastBitIsOne) - kLastBitIsOne;
}

}  // namespace

RoundedCopies::RoundedCopies(std::vector<double> model, double step, double residual_rms)
    : model_(std::move(model)),
      step_(step),
      noise_(std::sqrt(std::max(0.0, residual_rms * residual_rms - step * step / 12.0))) {}

std::vector<double> RoundedCopies::draw(unsigned copy) const {
  std::mt19937_64 generator(copy + 1);
  boost::random::normal_distribution<double> normal;
  const double origin = step_ * boost::random::uniform_01<double>()(generator);
  std::vector<double> forces;
  forces.reserve(model_.size());
  for (const double force : model_) {
    const double noisy = force + noise_ * normal(generator);
    forces.push_back(step_ * nearest_integer((noisy - origin) / step_) + origin);
  }
  return forces;
}

Uncertainty with_rounding(Uncertainty uncertainty, const Moves& moves) {
  uncertainty.from_refits = true;
  const CoordinateMatrix spread = moves.transpose() * moves / static_cast<double>(moves.rows());
  if (uncertainty.from_cycles) {
    uncertainty.covariance += spread;
  } else {
    uncertainty.covariance = spread;
    uncertainty.degrees_of_freedom = std::min(uncertainty.degrees_of_freedom, static_cast<double>(moves.rows()));
  }
  return uncertainty;
}

}  // namespace slipfit::fit
