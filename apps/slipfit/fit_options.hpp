#pragma once

#include <string>
#include <vector>

#include "slipfit/fit/fit.hpp"

/// How many recordings a fit is of.
enum class FitKind { Single, Sweep };

/// `--tier` and `--fix` as typed, into what the fit takes. Throws Failure(WrongUsage).
slipfit::FitOptions fit_options_from(const std::string& tier, const std::vector<std::string>& fixed, FitKind kind);
