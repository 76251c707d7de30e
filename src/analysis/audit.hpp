#pragma once

#include <span>
#include <vector>

#include "slipfit/analysis.hpp"

namespace slipfit {

/// The pairs of quantities that a document gives in two ways, as far as both are known. Of stick-slip with a fit.
std::vector<AuditPair> audit_of(const Recording& recording, const Analysis& analysis);

/// Of the fit of several recordings together, with the analyses of each: k against the mean over the recordings of the
/// slope of their sticks.
std::vector<AuditPair> audit_of(std::span<const Recording* const> recordings, std::span<const Analysis* const> analyses,
                                const FitResult& joint);

/// The fit with the parameters of contradicted pairs not identified, in intervals that include both values.
FitResult with_audit(FitResult fit, const std::vector<AuditPair>& pairs);

/// The same of the quoted frequency.
FrequencyReport with_audit(FrequencyReport frequency, const std::vector<AuditPair>& pairs);

/// One for each contradicted pair.
Warnings warn_of(const std::vector<AuditPair>& pairs);

/// The fit with each parameter's status no higher than the warnings allow (the table is in status_limits.cpp).
FitResult limited_by(const Warnings& warnings, FitResult fit);

}  // namespace slipfit
