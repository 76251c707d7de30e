#pragma once

#include "report/json_values.hpp"
#include "slipfit/analysis.hpp"

namespace slipfit {

// One function a section of the document (docs/formats.md).
Json options_json(const AskedFit& asked);
Json recording_json(const Recording& recording, const Analysis& analysis);
Json frequency_json(const FrequencyReport& frequency);
Json cycles_json(const CycleStatistics& cycles, ForceQuantity quantity);
Json model_json(const FitResult& fit, ForceQuantity quantity);
Json parameters_json(const FitResult& fit);
Json correlation_json(const FitResult& fit);
Json level_trend_json(const LevelTrend& trend, ForceQuantity quantity);
Json audit_json(const std::vector<AuditPair>& pairs);
Json tests_json(const std::vector<ShortTest>& tests);
Json derived_json(const Derived& derived);
Json coefficients_json(const std::optional<Coefficients>& coefficients);
Json transients_json(const Transients& transients, ForceQuantity quantity);

}  // namespace slipfit
