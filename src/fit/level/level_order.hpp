#pragma once

#include <cstddef>
#include <vector>

namespace slipfit::fit {

/// Number of Legendre terms (1: constant) that the middles of the slips justify, by BIC with a handicap against drift
/// that scatter only imitates; at most a third of the slips.
std::size_t choose_level_terms(const std::vector<double>& time_s, const std::vector<double>& level);

/// That polynomial of so many terms, at each of the middles.
std::vector<double> smooth_level(const std::vector<double>& time_s, const std::vector<double>& level,
                                 std::size_t terms);

/// What is left of the middles (standard deviation) after that polynomial and the drops: with one kinetic friction the
/// middle of a slip goes with its drop, however the static friction scatters.
double unexplained_level(const std::vector<double>& time_s, const std::vector<double>& level,
                         const std::vector<double>& drop, std::size_t terms);

}  // namespace slipfit::fit
