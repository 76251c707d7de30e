#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fit/selection/solution.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// Poorest tier: straight ramps of one slope, joined by jumps. Nothing about the slip itself.
struct SawtoothFit {
  double drop = 0.0;  ///< mean jump between the ramps at the middle of the slip
  double fall = 0.0;  ///< mean from onset to end of slip
  double drop_sd = 0.0;
  double rms = 0.0;
};

/// Noise of the recording (Quality::noise_rms) that is more than a fit that is kept leaves (kLooseFit), whatever onset
/// force it has, which is at most the drop between the sticks: another law of friction or an average of the sensor,
/// which change the shape of every slip alike, need not be tried.
bool noise_exceeds_shape(double noise_rms, const DampedFit& fit);

SawtoothFit fit_sawtooth(const DampedFit& damped);

/// Returns the candidate with rms and AICc on so many independent samples.
Candidate candidate_of(const DampedFit& fit, Tier tier, std::size_t parameters, double effective);

/// What the choice of a tier rests on. Where the free damping ratio was refused (DampedFit::refused_damping), `damped`
/// is the fit with zeta = 0 and there is no other undamped one.
struct TierFits {
  SawtoothFit sawtooth;
  std::optional<DampedFit> undamped;
  DampedFit damped;

  /// zeta was held by the user.
  [[nodiscard]] bool damping_held() const { return damped.held[kDamping] && !damped.refused_damping; }
  /// Returns what the user held: neither a refused zeta nor the w_n and zeta of a ring-down.
  [[nodiscard]] Held held_by_user() const {
    Held held = damped.held;
    held[kDamping] = damping_held() && !damped.motion;
    if (damped.motion) held[kLogFrequency] = false;
    return held;
  }
  [[nodiscard]] const DampedFit* without_damping() const {
    if (damped.refused_damping) return &damped;
    return undamped ? &*undamped : nullptr;
  }
};

/// Says how far the slip is resolved: by samples, by the likelihood of zeta, by the misfit of its shape.
struct Resolution {
  double samples_per_slip = 0.0;
  bool slip_resolved = false;     ///< w_n and F_s - F_k can be read from the slip
  bool damping_resolved = false;  ///< zeta can
  std::string reason;             ///< why not, or empty
};

/// Returns the standard error of a coordinate, in its own units; 0 where it is held.
double error_of(const DampedFit& fit, Coordinate coordinate);

/// Standard error of zeta.
double damping_error(const DampedFit& fit);

/// D_c over its standard error; 0 where that is not known.
double sigmas_of_distance(const DampedFit& fit);

/// Independent residuals: neighbours that correlate by rho count as (1 - rho) / (1 + rho) of themselves; a cycle counts
/// at least once.
double effective_samples(const DampedFit& fit);

/// Twice the logarithm of the likelihood of one fit over that of another, each at its best noise.
double gain_of(const DampedFit& fit, const DampedFit& other);

/// "the slip has 1.4 samples; sample at 8.0 kHz or more": for 6 samples in a slip.
std::string too_few_samples(double samples_per_slip, double sample_interval_s);

/// "the slip is not a damped oscillation (best damping ratio -0.29)"
std::string no_damped_oscillation(double best_damping_ratio);

Resolution resolution_of(const Recording& recording, const TierFits& fits);

/// Chosen by the user whatever the data say.
Candidate requested(Candidate candidate);

/// The poorest tier that explains the recording, with the reason for each; `forced` takes the place of the choice.
std::vector<Candidate> choose_tier(const TierFits& fits, const Resolution& resolution, std::optional<Tier> forced);

/// The fit of the fewest terms stays where the data do not pay for more; where they do not rule a fit with more terms
/// out either, its intervals hold what both say. The covariance becomes that of `other`, and nowhere smaller than it
/// was; the way to the values of `other` lengthens one side (moves_to_rivals).
DampedFit widened_by_rival(DampedFit fit, const DampedFit& other);

/// Returns the moves from `blocks`, the reported ones of a fit, to each of its rivals, in the coordinates that both
/// have.
std::vector<Coordinates> moves_to_rivals(const DampedFit& fit, const BlockFit& blocks);

}  // namespace slipfit::fit
