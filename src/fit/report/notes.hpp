#pragma once

#include <string>

#include "fit/inference/ageing_line.hpp"
#include "fit/level/stick_ripple.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/parameter.hpp"

namespace slipfit::fit {

/// The condition on a speed without a standard error, and which parameters depend on it.
inline constexpr const char* kStatedSpeed =
    "the stated driving speed (k, m and c are inversely proportional to it; --speed-uncertainty widens their "
    "intervals)";

/// States why nothing that is read from the slip is identified where W is fitted.
inline constexpr const char* kFittedAverage = "assumes that the sensor averages uniformly over the fitted time";
/// States why a force level is conditional.
inline constexpr const char* kZeroUnknown =
    "assumes that the sensor reads 0 without force: state its reading with --zero";
/// States why F_s - F_k and zeta of one speed are conditional.
inline constexpr const char* kOneSpeed =
    "assumes kinetic friction that does not depend on sliding speed; one driving speed cannot test this: fit a sweep";

/// States why w_n and mass that are read from the slips alone are conditional. docs/model.md, section 16.
inline constexpr const char* kSlipsAlone =
    "assumes friction and a load that stay the same within a slip (a fall by half of F_s - F_k would make w_n 15 % "
    "higher): --mass tests this";
/// States the same where the measured normal force changes within a slip.
inline constexpr const char* kLoadFollows =
    "the measured normal force follows the force, and friction with it: m includes this; w_n, zeta and F_s - F_k are "
    "those of the slips";
/// States what both depend on, for FitResult::conditional_on.
inline constexpr const char* kSameWithinSlip = "friction and a load that stay the same within a slip (w_n and m)";

/// States the source of w_n and mass that are not read from the slips.
inline constexpr const char* kRingDown = "the free ring-down, which was used as data for w_n and zeta";
inline constexpr const char* kStatedMass = "from the stated mass, because sensor averaging hides w_n";

/// States why the mass is not identified where the force rises after a slip.
inline constexpr const char* kRiseOfTimeOrDistance =
    "the rise of the force after a slip may be the relaxation of the contact, whose stiffness in the slip is larger: "
    "the interval includes both";

/// Warns that an average of the samples is fitted.
Warning averaged_warning(double average_s);

/// Warns that a line swings in the sticks. It is of the drive, unless that would have to turn back.
Warning ripple_warning(const StickRipple& ripple);

/// What it would take to know zeta well enough. Its errors fall with the root of the cycles; identified from a quarter
/// on.
std::string weak_damping(const Estimate& damping);

/// Returns the cut-off of ageing where the recordings do not determine it: the part of its range that they allow.
Parameter held_cutoff(const AgeingCutoff& cutoff, double stick_s);

}  // namespace slipfit::fit
