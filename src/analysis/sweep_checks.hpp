#pragma once

#include <span>
#include <vector>

#include "slipfit/sweep.hpp"

namespace slipfit {

/// Returns the use of each recording in a fit of a sweep. Slips that the model does not fit are not used. A slip within
/// one or two samples fits the model of the others at many onsets: such recordings are left out if the others suffice.
std::vector<SweepRole> roles_of(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses);

/// Warns of recordings that are left out because the sampling does not resolve their slips.
Warnings check_resolution(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                          const std::vector<SweepRole>& roles);

/// "4 with stick-slip cycles, 1 sliding steadily, 1 left out".
std::string describe_roles(const std::vector<SweepRole>& roles);

/// Fastest run with stick-slip; slowest one that slides steadily or rings down beyond all that stick, or may: the
/// sensor shows swings through its average, stated or found by the fit of the sweep.
ObservedEnd observed_end(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                         const FitResult& result);

/// Warns of repetitions that several speeds identify as geometry or a control loop instead of stick-slip.
Warnings check_frequency_follows_speed(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses);

/// The analyses, those without a fitted slip undetermined where the frequency does not follow the speed as in
/// stick-slip. `warnings`: of check_frequency_follows_speed.
std::vector<Analysis> without_passing_patterns(std::vector<Analysis> analyses, const Warnings& warnings);

/// Warns of force levels that repeat (`level_repeats` of the recordings) after one displacement at all speeds, which is
/// texture of the counterface, or after one time.
Warnings check_level_repeats(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses);

/// Names the recording that differs most from the others if at least half of them agree: by the stiffness of its
/// own fit, else by the spacing that a fit without it predicts, else by its force level. Needs four with cycles.
Warnings check_agreement(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                         const SweepFit& fit);

/// Recordings with the same samples, whatever their files are called.
Warnings check_duplicates(std::span<const SweepEntry> entries);

/// Returns mean and scatter over recordings at one speed; empty if the speeds differ.
std::vector<Repeat> compare_repeats(std::span<const SweepEntry> entries, std::span<const Analysis> analyses);

}  // namespace slipfit
