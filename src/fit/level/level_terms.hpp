#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::fit {

/// Returns the values of the first Legendre polynomials on [begin_s, end_s], a row for each of the times.
Eigen::MatrixXd legendre_basis(const std::vector<double>& time_s, double begin_s, double end_s, std::size_t terms);

/// Number of Legendre terms (1: constant) that the middles of the slips justify, by BIC with a handicap against drift
/// that scatter only imitates; at most a third of the slips.
std::size_t choose_level_terms(const std::vector<double>& time_s, const std::vector<double>& level);

/// Returns the values of that polynomial with so many terms, at each of the middles.
std::vector<double> smooth_level(const std::vector<double>& time_s, const std::vector<double>& level,
                                 std::size_t terms);

/// Returns the standard deviation of the middles about that polynomial and a multiple of the drops. With one kinetic
/// friction the middle of a slip varies with its drop, however the static friction scatters.
double unexplained_level(const std::vector<double>& time_s, const std::vector<double>& level,
                         const std::vector<double>& drop, std::size_t terms);

/// Adds `factor` times the fitted interference to those of the values at the samples [begin, end) that are not 0.
void add_hum(const Recording& recording, const BlockFit& fit, std::size_t begin, std::size_t end, double factor,
             std::vector<double>& values);

/// The fitted lines, and the recording without them, for cycles that are cut anew.
HumLines hum_of(const Recording& recording, const BlockFit& fit);

}  // namespace slipfit::fit
