#include "fit/selection/finish.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "fit/inference/misfit.hpp"
#include "fit/inference/rounding.hpp"
#include "fit/inference/segment_influence.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/outliers.hpp"

namespace slipfit::fit {
namespace {

constexpr int kFewIterations = 12;  // from the solution to one beside it
constexpr int kMostIterations = 60;
constexpr double kFinishTolerance = 1e-3;  // SolveOptions::tolerance

std::vector<double> references_of(const BlockFit& fit) {
  std::vector<double> references_s;
  for (std::size_t i = 0; i < fit.size(); ++i) references_s.push_back(fit.reference_s(i));
  return references_s;
}

class Finisher {
 public:
  Finisher(const Recording& recording, const Quality& quality, const Segmentation& segmentation, double half_width_s)
      : recording_(recording), quality_(quality), segmentation_(segmentation), half_width_s_(half_width_s) {}

  /// Empty where the normal equations are singular: the cycles do not tell the shared parameters apart.
  [[nodiscard]] std::optional<DampedFit> finish(DampedFit result) const {
    result.uncertainty = estimate_uncertainty(result.blocks, {result.held, false});
    if (!is_regular(result.uncertainty, result.held)) return std::nullopt;
    const bool is_coulomb = result.blocks.scales().law == FrictionLaw::Coulomb;  // RampResidual
    if (is_coulomb && !result.blocks.level().per_cycle && !result.uncertainty.from_cycles) join_ramps(result);
    // Noise of a step and more spreads the rounding evenly: it is white then.
    if (quality_.quantisation_step && result.uncertainty.noise < *quality_.quantisation_step) {
      const Moves moves = moves_by_rounding(result);
      if (moves.rows() < kRoundedCopies / 2) return std::nullopt;
      result.uncertainty = with_rounding(result.uncertainty, moves);
    }
    const double least_force = 0.5 * quality_.quantisation_step.value_or(0.0);
    result.ripple = find_stick_ripple(recording_, result.blocks, least_force);
    if ((result.misfit = find_misfit(result.blocks, least_force))) {
      result.uncertainty = with_misfit(result.uncertainty, influence_of_segments(result.blocks, result.held));
    }
    return result;
  }

 private:
  /// What refits to rounded copies of the model move the quantities by.
  [[nodiscard]] Moves moves_by_rounding(const DampedFit& result) const {
    const Residuals residuals = residuals_of(recording_, result.blocks, {});
    std::vector<double> model(recording_.force().begin(), recording_.force().end());
    for (std::size_t i = 0; i < model.size(); ++i) model[i] -= residuals.value[i];
    const RoundedCopies copies(std::move(model), *quality_.quantisation_step, result.uncertainty.noise);
    Moves moves(kRoundedCopies, kCoordinates);
    Eigen::Index fitted = 0;
    for (unsigned copy = 0; copy < kRoundedCopies; ++copy) {
      const auto time_s = recording_.time_s();
      const auto rounded =
          Recording::create({time_s.begin(), time_s.end()}, copies.draw(copy), recording_.conditions());
      BlockFit refit = same_cycles(rounded.value(), result);
      if (!std::isfinite(solve(refit, {result.held, result.continuous, true, kFewIterations, kFinishTolerance})))
        continue;
      moves.row(fitted++) = (coordinates_of(refit) - coordinates_of(result.blocks)).transpose();
    }
    return moves.topRows(fitted);
  }

  /// The cycles of a fit cut from another recording with the same clock.
  [[nodiscard]] BlockFit same_cycles(const Recording& recording, const DampedFit& result) const {
    const BlockFit& fit = result.blocks;
    std::vector<CycleData> kept;
    const HumLines hum{fit.level().lines_Hz, fit.scales().time_begin_s};
    std::size_t next = 0;
    for (CycleData& cycle : cut_cycles(recording, segmentation_, half_width_s_, result.excluded, hum)) {
      if (next == fit.size() || cycle.slip != fit.data(next).slip) continue;
      cycle.continuous_with_next = fit.data(next).continuous_with_next;
      kept.push_back(std::move(cycle));
      ++next;
    }
    BlockFit same(std::move(kept), references_of(fit), fit.scales(), fit.level());
    same.parameters = fit.parameters;
    return same;
  }

  static bool is_regular(const Uncertainty& uncertainty, const Held& held) {
    const CoordinateMatrix& c = uncertainty.covariance;
    const auto is_known = [&](Coordinate i) { return held[static_cast<std::size_t>(i)] || c(i, i) > 0.0; };
    return c.allFinite() && is_known(kLogStiffness) && is_known(kLogFrequency) && is_known(kDamping);
  }

  /// Joined ramps halve the error of k where the data agree: F test, one degree of freedom a ramp.
  static void join_ramps(DampedFit& result) {
    double ramps = 0.0;
    for (std::size_t i = 0; i + 1 < result.blocks.size(); ++i) {
      ramps += result.blocks.data(i).continuous_with_next ? 1.0 : 0.0;
    }
    if (ramps < 1.0) return;
    const Parameters before = result.blocks.parameters;
    if (std::isfinite(solve(result.blocks, {result.held, true, true, kMostIterations, kFinishTolerance}))) {
      const Uncertainty joined = estimate_uncertainty(result.blocks, {result.held, true});
      const double freedom = std::max(1.0, result.uncertainty.degrees_of_freedom);
      const double ratio = (joined.chi2 - result.uncertainty.chi2) / ramps / (result.uncertainty.chi2 / freedom);
      const boost::math::fisher_f_distribution<double> chance(ramps, freedom);
      if (!is_regular(joined, result.held)) {
        result.blocks.parameters = before;
        return;
      }
      if (ratio <= 0.0 || boost::math::cdf(boost::math::complement(chance, ratio)) > thresholds::kShareChance) {
        result.continuous = true;
        result.uncertainty = joined;
        return;
      }
    }
    result.blocks.parameters = before;
  }

  const Recording& recording_;
  const Quality& quality_;
  const Segmentation& segmentation_;
  double half_width_s_;
};

}  // namespace

std::optional<DampedFit> finish_fit(const Recording& recording, const Quality& quality,
                                    const Segmentation& segmentation, double half_width_s, DampedFit draft) {
  return Finisher(recording, quality, segmentation, half_width_s).finish(std::move(draft));
}

}  // namespace slipfit::fit
