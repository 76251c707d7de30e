#include "fit/selection/tiers.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::fit {

namespace {

/// Returns AICc. Every tier has the same onset and force for each cycle: only the shared parameters distinguish them.
double aicc(double rms, double effective, double parameters) {
  const double room = std::max(1.0, effective - parameters - 1.0);
  return effective * std::log(rms * rms) + 2.0 * parameters * effective / room;
}

double rms_of(const DampedFit& fit) {
  return fit.blocks.scales().noise * std::sqrt(fit.uncertainty.chi2 / std::max(1.0, fit.uncertainty.samples));
}

/// Between the sticks before and after.
double drop_of(const CycleState& state) {
  return state.force_scale * (state.z0() - state.intercept());
}

std::string against(const Candidate& candidate, const Candidate& other) {
  const double gain = *other.aicc - *candidate.aicc;
  return fmt::format(
      "AICc {:.1f} {} than that of the {} model: {} ({:g} lower is required)", std::abs(gain),
      gain < 0.0 ? "higher" : "lower", other.tier == Tier::Sawtooth ? "sawtooth" : "undamped",
      gain > thresholds::kTierPrice ? "the added parameter is justified" : "the added parameter is not justified",
      thresholds::kTierPrice);
}

}  // namespace

double error_of(const DampedFit& fit, Coordinate coordinate) {
  return std::sqrt(std::max(0.0, fit.uncertainty.covariance(coordinate, coordinate)));
}

double damping_error(const DampedFit& fit) {
  return error_of(fit, kDamping);
}

double sigmas_of_distance(const DampedFit& fit) {
  const double root = fit.blocks.parameters.values(kSlipDistance);
  const double variance = fit.uncertainty.covariance(kSlipDistance, kSlipDistance);
  return variance > 0.0 ? 0.5 * std::abs(root) / std::sqrt(variance) : 0.0;
}

double effective_samples(const DampedFit& fit) {
  const double rho = std::clamp(fit.uncertainty.lag1_correlation, 0.0, 0.99);
  return std::max(fit.uncertainty.samples * (1.0 - rho) / (1.0 + rho), static_cast<double>(fit.blocks.size()));
}

Candidate candidate_of(const DampedFit& fit, Tier tier, std::size_t parameters, double effective) {
  const double rms = rms_of(fit);
  return {tier, parameters, rms, aicc(rms, effective, static_cast<double>(parameters)), false, {}};
}

bool noise_exceeds_shape(double noise_rms, const DampedFit& fit) {
  double drop = 0.0;
  for (std::size_t i = 0; i < fit.blocks.size(); ++i) drop += drop_of(fit.blocks.state(i));
  return noise_rms > thresholds::kLooseFit * drop / static_cast<double>(fit.blocks.size());
}

SawtoothFit fit_sawtooth(const DampedFit& damped) {
  const BlockFit& blocks = damped.blocks;
  SawtoothFit result;
  std::vector<double> drops;
  double sum = 0.0;
  double samples = 0.0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const CycleData& data = blocks.data(i);
    const CycleState state = blocks.state(i);
    // Lines of the fit before and after, continued to the middle of the slip.
    const double jump = drop_of(state);
    drops.push_back(jump);
    result.fall +=
        (jump - state.force_scale * state.omega_rad_per_s * state.slip_s()) / static_cast<double>(blocks.size());
    const double middle_s = blocks.reference_s(i);
    const double* local = blocks.parameters.cycles[i].data();
    for (std::size_t j = 0; j < data.time_s.size(); ++j) {
      const double line = data.time_s[j] < middle_s ? state.z0() : state.intercept();
      const double z = line + state.tau_at(data.time_s[j] - blocks.scales().sensor_lag_s);
      const double level = blocks.model(i).level_at(data.time_s[j], blocks.level_data(), local);
      const double residual = data.force[j] - level - state.force_scale * z;
      sum += residual * residual;
      samples += 1.0;
    }
    for (const auto* bins : {&data.bins_before, &data.bins_after}) {
      for (const StickBin& bin : *bins) {
        sum += bin.scatter;
        samples += bin.count;
      }
    }
  }
  result.rms = std::sqrt(sum / std::max(1.0, samples));
  const MeanAndSpread jump = describe(drops);
  result.drop = jump.mean;
  result.drop_sd = jump.sd;
  return result;
}

double gain_of(const DampedFit& fit, const DampedFit& other) {
  return 2.0 * effective_samples(other) * std::log(other.uncertainty.noise / fit.uncertainty.noise);
}

std::string too_few_samples(double samples_per_slip, double sample_interval_s) {
  const double rate_Hz = std::ceil(6.0 / samples_per_slip) / sample_interval_s;
  return fmt::format("the slip has {:.1f} samples; sample at {} or more", samples_per_slip,
                     rate_Hz < 1000.0 ? fmt::format("{:.3g} Hz", rate_Hz) : fmt::format("{:.3g} kHz", 1e-3 * rate_Hz));
}

Candidate requested(Candidate candidate) {
  candidate.chosen = true;
  candidate.reason = "requested by --tier" + (candidate.reason.empty() ? "" : "; the data alone: " + candidate.reason);
  return candidate;
}

std::string no_damped_oscillation(double best_damping_ratio) {
  return fmt::format("the slip is not a damped oscillation (best damping ratio {:.2f})", best_damping_ratio);
}

Resolution resolution_of(const Recording& recording, const TierFits& fits) {
  const BlockFit& blocks = fits.damped.blocks;
  Resolution result;
  result.samples_per_slip = median_slip_s(blocks) / recording.sample_interval_s();
  const bool held = fits.damping_held();
  const bool scatter_is_informative =
      !fits.damped.refused_damping && damping_error(fits.damped) < thresholds::kPinningDamping;
  if (result.samples_per_slip < thresholds::kResolvedSamples && !held && !scatter_is_informative) {
    result.reason = too_few_samples(result.samples_per_slip, recording.sample_interval_s());
    return result;
  }
  result.slip_resolved = true;
  if (!held && fits.damped.refused_damping) {
    result.reason = no_damped_oscillation(*fits.damped.refused_damping);
  } else if (!held && !(damping_error(fits.damped) < thresholds::kInformativeDamping)) {
    result.reason = fmt::format("the standard error of the damping ratio is {:.2g}; {}", damping_error(fits.damped),
                                result.samples_per_slip < 6.0
                                    ? too_few_samples(result.samples_per_slip, recording.sample_interval_s())
                                    : std::string("less noise or more cycles would lower it"));
  } else {
    result.damping_resolved = true;
  }
  return result;
}

std::vector<Candidate> choose_tier(const TierFits& fits, const Resolution& resolution, std::optional<Tier> forced) {
  const double effective = effective_samples(fits.damped);
  Candidate sawtooth{Tier::Sawtooth, 1, fits.sawtooth.rms, std::nullopt, false, {}};
  sawtooth.aicc = aicc(fits.sawtooth.rms, effective, 1.0);
  Candidate damped{Tier::Damped, 3, std::nullopt, std::nullopt, false, {}};
  if (!fits.damped.refused_damping) damped = candidate_of(fits.damped, Tier::Damped, 3, effective);
  Candidate undamped{Tier::Undamped, 2, std::nullopt, std::nullopt, false, {}};
  if (const DampedFit* fit = fits.without_damping()) undamped = candidate_of(*fit, Tier::Undamped, 2, effective);

  Tier chosen = Tier::Sawtooth;
  if (!resolution.slip_resolved) {
    sawtooth.reason = "the slip is not resolved: " + resolution.reason;
    undamped.reason = damped.reason = "its slip cannot be distinguished from a jump here";
  } else {
    const bool undamped_pays = undamped.aicc && *undamped.aicc + thresholds::kTierPrice < *sawtooth.aicc;
    const bool damped_pays = resolution.damping_resolved && damped.aicc &&
                             *damped.aicc + thresholds::kTierPrice < undamped.aicc.value_or(INFINITY) &&
                             *damped.aicc + thresholds::kTierPrice < *sawtooth.aicc;
    chosen = damped_pays ? Tier::Damped : undamped_pays ? Tier::Undamped : Tier::Sawtooth;
    if (undamped.aicc) undamped.reason = against(undamped, sawtooth);
    if (damped.aicc) damped.reason = against(damped, undamped.aicc ? undamped : sawtooth);
    if (!resolution.damping_resolved) damped.reason = resolution.reason;
    sawtooth.reason = chosen == Tier::Sawtooth ? "no model with more parameters is justified"
                                               : "a model with more parameters is justified";
  }
  if (forced) chosen = *forced;
  std::vector<Candidate> candidates{sawtooth, undamped, damped};
  for (Candidate& candidate : candidates) {
    candidate.chosen = candidate.tier == chosen;
    if (candidate.chosen && forced) candidate = requested(std::move(candidate));
  }
  return candidates;
}

DampedFit widened_by_rival(DampedFit fit, const DampedFit& other) {
  const CoordinateMatrix own = fit.uncertainty.covariance;
  CoordinateMatrix wide = other.uncertainty.covariance;
  for (Eigen::Index i = 0; i < kCoordinates; ++i) {
    const bool is_shared = own(i, i) > 0.0 && wide(i, i) > 0.0;
    const double scale = is_shared ? std::sqrt(std::max(1.0, own(i, i) / wide(i, i))) : 0.0;
    wide.row(i) *= scale;
    wide.col(i) *= scale;
    if (!is_shared) wide(i, i) = own(i, i);
  }
  if (fit.average && other.average) {
    double& error_s = fit.average->standard_error_s;
    error_s = std::hypot(error_s, other.average->seconds - fit.average->seconds);
  }
  fit.rivals.push_back(coordinates_of(other.blocks));
  fit.uncertainty.covariance = wide;
  fit.uncertainty.degrees_of_freedom =
      std::min(fit.uncertainty.degrees_of_freedom, other.uncertainty.degrees_of_freedom);
  return fit;
}

std::vector<Coordinates> moves_to_rivals(const DampedFit& fit, const BlockFit& blocks) {
  std::vector<Coordinates> all;
  for (const Coordinates& rival : fit.rivals) {
    Coordinates moves = rival - coordinates_of(blocks);
    if (blocks.scales().law == FrictionLaw::Coulomb) moves(kSlipDistance) = 0.0;
    all.push_back(moves);
  }
  return all;
}

}  // namespace slipfit::fit
