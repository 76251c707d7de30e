#include "fit_options.hpp"

#include <fmt/format.h>

#include <optional>

#include "failure.hpp"
#include "quantities.hpp"

namespace {

// What follows from these (mass, damping coefficient) cannot be held on its own.
std::string known_names() {
  std::string names;
  for (const slipfit::ParameterInfo& parameter : slipfit::parameter_table()) {
    if (parameter.can_be_held) names += (names.empty() ? "" : ", ") + std::string(parameter.key);
  }
  return names;
}

std::optional<slipfit::Tier> tier_from(const std::string& text, FitKind kind) {
  if (text == "auto") return std::nullopt;
  if (text == "damped") return slipfit::Tier::Damped;
  if (kind == FitKind::Sweep) {
    if (text == "velocity") return slipfit::Tier::Velocity;
    throw Failure(ExitCode::WrongUsage,
                  fmt::format("--tier: '{}' is no tier of a joint fit, expected auto, damped or velocity", text));
  }
  if (text == "sawtooth") return slipfit::Tier::Sawtooth;
  if (text == "undamped") return slipfit::Tier::Undamped;
  if (text == "velocity") {
    throw Failure(ExitCode::WrongUsage,
                  "--tier velocity needs a speed sweep (--joint): one speed cannot tell velocity dependence from "
                  "damping, choose auto, sawtooth, undamped or damped");
  }
  throw Failure(ExitCode::WrongUsage,
                fmt::format("--tier: unknown tier '{}', expected auto, sawtooth, undamped or damped", text));
}

std::optional<double>& place_of(slipfit::ParameterId id, slipfit::HeldParameters& held) {
  if (id == slipfit::ParameterId::Stiffness) return held.stiffness_N_per_m;
  return id == slipfit::ParameterId::NaturalFrequency ? held.natural_frequency_rad_per_s : held.damping_ratio;
}

/// "NAME=VALUE"
void hold(const std::string& text, slipfit::HeldParameters& held) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    throw Failure(ExitCode::WrongUsage, fmt::format("--fix: bad '{}', expected NAME=VALUE", text));
  }
  const std::string name = text.substr(0, equals);
  const std::optional<slipfit::ParameterId> known = slipfit::parameter_with_key(name);
  if (!known || !slipfit::info(*known).can_be_held) {
    throw Failure(ExitCode::WrongUsage,
                  fmt::format("--fix: unknown parameter '{}', expected one of {}", name, known_names()));
  }
  const double value = plain_number("--fix " + name, text.substr(equals + 1), "SI");
  constexpr double kNoLimit = 1e300;
  const bool is_share = *known == slipfit::ParameterId::DampingRatio;
  if (is_share ? value < 0.0 || value >= 1.0 : value <= 0.0 || value >= kNoLimit) {
    throw Failure(ExitCode::WrongUsage, fmt::format("--fix {}: {} is out of range, expected a value {}", name, value,
                                                    is_share ? "at least 0 and below 1" : "above 0"));
  }
  std::optional<double>& place = place_of(*known, held);
  if (place) throw Failure(ExitCode::WrongUsage, fmt::format("--fix: '{}' is given twice", name));
  place = value;
}

}  // namespace

slipfit::FitOptions fit_options_from(const std::string& tier, const std::vector<std::string>& fixed, FitKind kind) {
  slipfit::FitOptions options;
  options.tier = tier_from(tier, kind);
  for (const std::string& text : fixed) hold(text, options.held);
  return options;
}
