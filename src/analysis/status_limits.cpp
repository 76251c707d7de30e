#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "analysis/audit.hpp"

namespace slipfit {
namespace {

using Id = ParameterId;

constexpr std::array kOfSpeed{Id::Stiffness, Id::StiffnessExponent, Id::Mass, Id::DampingCoefficient};
constexpr std::span<const Id> kAll{};

/// The highest status of parameters beside a warning.
struct StatusLimit {
  std::string_view code;
  std::span<const Id> parameters;  ///< empty: all of them
  ParameterStatus highest{};
};

constexpr std::array kLimits = std::to_array<StatusLimit>({
    {"model_misfit", kAll, ParameterStatus::Weak},
    {"implausible_units", kAll, ParameterStatus::Weak},
    {"speed_differs_from_displacement", kOfSpeed, ParameterStatus::Conditional},
    {"speed_differs", kOfSpeed, ParameterStatus::Conditional},
});

/// Of the statuses that a warning can lower: a higher one says more.
int rank_of(ParameterStatus status) {
  if (status == ParameterStatus::Identified) return 2;
  return status == ParameterStatus::Conditional ? 1 : 0;
}

bool concerns(const StatusLimit& limit, Id id) {
  return limit.parameters.empty() ||
         std::find(limit.parameters.begin(), limit.parameters.end(), id) != limit.parameters.end();
}

}  // namespace

FitResult limited_by(const Warnings& warnings, FitResult fit) {
  for (const StatusLimit& limit : kLimits) {
    const auto is_it = [&](const Warning& warning) { return warning.code == limit.code; };
    if (std::none_of(warnings.begin(), warnings.end(), is_it)) continue;
    for (Parameter& parameter : fit.parameters) {
      if (!concerns(limit, parameter.id) || rank_of(parameter.status) <= rank_of(limit.highest)) continue;
      parameter.status = limit.highest;
      std::string& note = parameter.estimate.note;
      note += fmt::format("{}see the warning {}", note.empty() ? "" : "; ", limit.code);
    }
  }
  return fit;
}

}  // namespace slipfit
