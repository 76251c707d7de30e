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
  /// Of the rig of one recording, after its release: data of w_n and zeta where the slips are the same motion.
  std::optional<RingDown> ring_down{};
  bool curve = false;  ///< fill FitResult::curve (16 bytes a sample)
  /// Told of each step of a fit of several recordings ("fitting without recording 3 of 13"); may be empty.
  std::function<void(const std::string&)> tell_step{};
};

/// How many recordings a fit is of.
enum class FitKind { Single, Sweep };

/// What people type: "auto" or a tier, and "NAME=VALUE" for each parameter to hold. Errors: unknown_tier, unknown_fix,
/// bad_number, out_of_range.
Result<FitOptions> parse_fit_options(const std::string& tier, const std::vector<std::string>& fixed, FitKind kind);

}  // namespace slipfit
