#pragma once

#include <string>
#include <vector>

#include "slipfit/analysis.hpp"

namespace slipfit {

/// The pairs of quantities that a document gives in two ways, as far as both are known. Of stick-slip with a fit.
std::vector<AuditPair> audit_of(const Recording& recording, const Analysis& analysis);

/// The fit with the parameters of contradicted pairs not identified, in intervals that include both values.
FitResult with_audit(FitResult fit, const std::vector<AuditPair>& pairs);

/// The same of the quoted frequency.
FrequencyReport with_audit(FrequencyReport frequency, const std::vector<AuditPair>& pairs);

/// "A is 3, B is 4": both values are known.
std::string sentence_of(const AuditPair& pair);

}  // namespace slipfit
