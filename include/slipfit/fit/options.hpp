#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/fit/ring_down.hpp"

namespace slipfit {

struct FitOptions {
  std::optional<Tier> tier{};  ///< empty: chosen by the data
  HeldParameters held{};
  /// The free oscillation of the rig after its release, used as data for w_n and zeta if it is the same motion as the
  /// slips.
  std::optional<RingDown> ring_down{};
  bool curve = false;  ///< fill FitResult::curve (16 bytes a sample)
  /// Called with each step of a fit of several recordings ("fitting without recording 3 of 13"), by one thread at a
  /// time, not always the caller's; may be empty.
  std::function<void(const std::string&)> notify_step{};
};

/// The number of recordings in a fit: one, or those of a sweep.
enum class FitKind { Single, Sweep };

/// Parses the options as people type them: "auto" or a tier, and "NAME=VALUE" for each parameter to fix. Errors:
/// unknown_tier, unknown_fix, bad_number, out_of_range.
Result<FitOptions> parse_fit_options(const std::string& tier, const std::vector<std::string>& fixed, FitKind kind);

}  // namespace slipfit
