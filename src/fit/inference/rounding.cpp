#include "fit/inference/rounding.hpp"

#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <random>
#include <utility>

namespace slipfit::fit {

namespace {

/// Returns the nearest integer for |x| < 2^51, without a call: the last bit of the sum is 1.
double nearest_integer(double x) {
  constexpr double kLastBitIsOne = 0x1.8p52;
  return (x + kLastBitIsOne) - kLastBitIsOne;
}

}  // namespace

RoundedCopies::RoundedCopies(std::vector<double> model, double step, double residual_rms)
    : model_(std::move(model)), step_(step), noise_(model_.size()) {
  const double rms = std::sqrt(std::max(0.0, residual_rms * residual_rms - step * step / 12.0));
  std::mt19937_64 generator(0);
  boost::random::normal_distribution<double> normal(0.0, rms);
  std::ranges::generate(noise_, [&] { return normal(generator); });
}

std::vector<double> RoundedCopies::draw(unsigned copy) const {
  std::mt19937_64 generator(copy + 1);
  boost::random::uniform_01<double> uniform;
  const double origin = step_ * uniform(generator);
  const auto count = static_cast<double>(model_.size());
  auto noise = noise_.begin() + static_cast<std::ptrdiff_t>(count * uniform(generator));
  std::vector<double> forces;
  forces.reserve(model_.size());
  for (const double force : model_) {
    const double steps = (force + *noise - origin) / step_;
    forces.push_back(step_ * nearest_integer(steps) + origin);
    if (++noise == noise_.end()) noise = noise_.begin();
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
