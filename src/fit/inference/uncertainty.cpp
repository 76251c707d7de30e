#include "fit/inference/uncertainty.hpp"

#include <algorithm>
#include <cmath>

#include "fit/inference/covariance.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Correlation of neighbouring residuals inside the slips, where samples are fitted one by one.
void measure_lag1(const BlockFit& fit, const std::vector<Normal>& normals, Uncertainty& result) {
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const auto samples = static_cast<Index>(fit.data(i).time_s.size());
    for (Index j = 0; j < samples; ++j) {
      const double r = normals[i].residuals(j);
      square += r * r;
      if (j > 0) {
        product += r * normals[i].residuals(j - 1);
        result.lag1_pairs += 1.0;
      }
    }
  }
  if (square > 0.0) result.lag1_correlation = product / square;
}

void count_residuals(const BlockFit& fit, const std::vector<Normal>& normals, Uncertainty& result) {
  const double noise2 = fit.scales().noise * fit.scales().noise;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    result.chi2 += normals[i].residuals.squaredNorm();
    result.samples += static_cast<double>(fit.data(i).time_s.size());
    for (const auto* bins : {&fit.data(i).bins_before, &fit.data(i).bins_after}) {
      for (const StickBin& bin : *bins) {
        result.chi2 += bin.scatter / noise2;
        result.samples += bin.count;
      }
    }
  }
}

/// Root mean square over the cycles of the error that noise of variance 1 gives to an onset force.
double error_of_onset_force(const std::vector<Normal>& normals) {
  double square = 0.0;
  for (const Normal& n : normals) square += n.own.inverse()(1, 1) / static_cast<double>(normals.size());
  return std::sqrt(std::max(0.0, square));
}

double spread_of_onset_force(const BlockFit& fit) {
  double sum = 0.0;
  double square = 0.0;
  for (const Own& own : fit.parameters.cycles) sum += own[1];
  const double mean = sum / static_cast<double>(fit.size());
  for (const Own& own : fit.parameters.cycles) square += (own[1] - mean) * (own[1] - mean);
  return std::sqrt(square / std::max(1.0, static_cast<double>(fit.size()) - 1.0));
}

}  // namespace

double reduced_chi2(const BlockFit& fit) {
  double chi2 = 0.0;
  double samples = 0.0;
  const double noise2 = fit.scales().noise * fit.scales().noise;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    chi2 += fit.cycle_sum_of_squares(i);
    samples += static_cast<double>(fit.data(i).time_s.size());
    for (const auto* bins : {&fit.data(i).bins_before, &fit.data(i).bins_after}) {
      for (const StickBin& bin : *bins) {
        chi2 += bin.scatter / noise2;
        samples += bin.count;
      }
    }
  }
  const auto parameters = static_cast<double>(common_size(fit) + own_size(fit) * static_cast<Index>(fit.size()));
  return chi2 / std::max(1.0, samples - parameters);
}

Eigen::VectorXd quantities_of(const BlockFit& fit) {
  const Selection selection = select(fit);
  VectorXd common(common_size(fit));
  std::copy(fit.parameters.shared.begin(), fit.parameters.shared.end(), common.data());
  std::copy(fit.parameters.level.begin(), fit.parameters.level.end(), common.data() + kShared);
  VectorXd quantities = selection.common.transpose() * common;
  for (const Own& own : fit.parameters.cycles) {
    for (Index i = 0; i < own_size(fit); ++i) {
      quantities += selection.own.row(i).transpose() * own[static_cast<std::size_t>(i)];
    }
  }
  return quantities;
}

Uncertainty estimate_uncertainty(const BlockFit& fit, const Held& held, bool continuous) {
  std::vector<Normal> normals;
  normals.reserve(fit.size());
  for (std::size_t i = 0; i < fit.size(); ++i) normals.push_back(normal_of(fit, i));
  Uncertainty result;
  count_residuals(fit, normals, result);
  measure_lag1(fit, normals, result);
  result.onset_force_sd = spread_of_onset_force(fit);
  const auto cycles = static_cast<double>(fit.size());
  double ramps = 0.0;
  for (std::size_t i = 0; continuous && i + 1 < fit.size(); ++i) ramps += fit.data(i).continuous_with_next ? 1.0 : 0.0;
  const double white_freedom =
      result.samples - static_cast<double>(common_size(fit)) - cycles * static_cast<double>(own_size(fit)) + ramps;
  const double variance = result.chi2 / std::max(1.0, white_freedom);
  result.noise = fit.scales().noise * std::sqrt(variance);
  result.onset_force_error = error_of_onset_force(normals) * std::sqrt(variance);

  // White intervals hold where neighbouring residuals are uncorrelated; the bound is four times the error of a
  // correlation, and 0.08 where that is smaller (below it the intervals are short by less than 8 %).
  const double white_bound = std::max(0.08, 4.0 / std::sqrt(std::max(1.0, result.lag1_pairs)));
  result.from_cycles = std::abs(result.lag1_correlation) > white_bound && !continuous;
  Held held_damping = held;
  held_damping.damping = true;
  if (result.from_cycles) {
    result.covariance = jackknife_covariance(fit, normals, held);
    result.covariance_given_damping = jackknife_covariance(fit, normals, held_damping);
    result.degrees_of_freedom = std::max(1.0, cycles - 1.0);
  } else {
    result.covariance = variance * white_covariance(fit, normals, held, continuous);
    result.covariance_given_damping = variance * white_covariance(fit, normals, held_damping, continuous);
    result.degrees_of_freedom = std::max(1.0, white_freedom);
  }
  return result;
}

}  // namespace slipfit::fit
