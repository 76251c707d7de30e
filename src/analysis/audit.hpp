#pragma once

#include <vector>

#include "slipfit/analysis.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

/// The pairs of quantities that a document gives in two ways, as far as both are known. Of stick-slip with a fit.
/// `fit`: whose parameters are compared with what the recording shows.
std::vector<AuditPair> audit_of(const Recording& recording, const Analysis& analysis, const FitResult& fit);

/// Returns the audit of a recording of a joint fit: the shared parameters at its speed, and its own frequencies.
std::vector<AuditPair> joint_audit_of(const SweepEntry& entry, const Analysis& analysis, const FitResult& joint);

/// The fit with the parameters of contradicted pairs not identified, in intervals that include both values.
FitResult with_audit(FitResult fit, const std::vector<AuditPair>& pairs);

/// Returns the derived quantities with the measured spacing by the speed of a displacement column, too.
Derived with_audit(Derived derived, const std::vector<AuditPair>& pairs);

/// Returns the reported frequency with its audit.
FrequencyReport with_audit(FrequencyReport frequency, const std::vector<AuditPair>& pairs);

/// One for each contradicted pair; of a joint fit, for those of shared values.
Warnings warn_of(const std::vector<AuditPair>& pairs);

/// "A is 3, B is 4": both values are known.
std::string sentence_of(const AuditPair& pair);

}  // namespace slipfit
