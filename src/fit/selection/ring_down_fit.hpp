#pragma once

#include <optional>
#include <span>

#include "fit/inference/free_motion.hpp"
#include "fit/selection/solution.hpp"
#include "fit/sweep/sweep_data.hpp"
#include "fit/sweep/sweep_outcome.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit::fit {

/// Holds what slips and ring-downs say of w_n and zeta, and their comparison.
struct RingEvidence {
  FreeMotion slips, rings;
  SameMotion same;
};

/// Compares the slips and the ring-down of one recording. The result is empty where `fit`, that of its slips, has no
/// w_n and zeta of its own, or where these are uncertain and differ from the ring-down's.
std::optional<RingEvidence> ring_evidence(const Recording& recording, const DampedFit& fit, const RingDown& ring);

/// Compares the slips and the ring-downs of a sweep under Coulomb friction, with w_n at the mean of its speeds.
/// `outcome` is the fit of its slips. Where zeta is held there because the slips say nothing of it, w_n of the slips is
/// the one that belongs to the zeta of the ring-downs. The result is empty where no recording shows a ring-down.
std::optional<RingEvidence> ring_evidence(std::span<const SweepRecording> recordings, const SweepData& data,
                                          const SweepOutcome& outcome);

/// `outcome` with w_n and zeta by slips and ring-downs together where these are of one motion; why not, where they are
/// not. `held`: by the user, who knows better.
std::optional<Warning> join_ring_downs(std::span<const SweepRecording> recordings, const HeldParameters& held,
                                       SweepData& data, SweepOutcome& outcome);

/// `fit` under its law with w_n and zeta held at `motion`, whose errors are in its covariance; an average that it found
/// goes with them. Empty where it has no solution there.
std::optional<DampedFit> held_at(const FreeMotion& motion, const FitInput& input, DampedFit fit);

}  // namespace slipfit::fit
