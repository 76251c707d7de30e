#include "slipfit/fit/options.hpp"

#include <fmt/format.h>

#include <utility>

#include "slipfit/core/units.hpp"

namespace slipfit {
namespace {

// What follows from these (mass, damping coefficient) cannot be held on its own.
std::string known_names() {
  std::string names;
  for (const ParameterInfo& parameter : parameter_table()) {
    if (parameter.can_be_held) names += (names.empty() ? "" : ", ") + std::string(parameter.key);
  }
  return names;
}

Result<std::optional<Tier>> tier_from(const std::string& text, FitKind kind) {
  if (text == "auto") return std::optional<Tier>();
  if (text == "damped") return std::optional(Tier::Damped);
  if (kind == FitKind::Sweep) {
    if (text == "velocity") return std::optional(Tier::Velocity);
    return Error{"unknown_tier",
                 fmt::format("--tier: '{}' is no tier of a joint fit, expected auto, damped or velocity", text)};
  }
  if (text == "sawtooth") return std::optional(Tier::Sawtooth);
  if (text == "undamped") return std::optional(Tier::Undamped);
  if (text == "weakening") return std::optional(Tier::Weakening);
  if (text == "velocity") {
    return Error{"unknown_tier",
                 "--tier velocity needs a speed sweep (--joint): one speed cannot separate velocity dependence from "
                 "damping, choose auto, sawtooth, undamped, damped or weakening"};
  }
  return Error{"unknown_tier",
               fmt::format("--tier: unknown tier '{}', expected auto, sawtooth, undamped, damped or weakening", text)};
}

std::optional<double>& place_of(ParameterId id, HeldParameters& held) {
  if (id == ParameterId::Stiffness) return held.stiffness_N_per_m;
  return id == ParameterId::NaturalFrequency ? held.natural_frequency_rad_per_s : held.damping_ratio;
}

Dimension dimension_of(ParameterId id) {
  if (id == ParameterId::Stiffness) return Dimension::Stiffness;
  return id == ParameterId::NaturalFrequency ? Dimension::AngularSpeed : Dimension::Dimensionless;
}

Result<double> held_value(ParameterId id, const std::string& text) {
  const std::string_view name = info(id).key;
  const Result<double> parsed = parse_quantity(text, dimension_of(id));
  if (!parsed) return Error{parsed.error().code, fmt::format("--fix {}={}: {}", name, text, parsed.error().message)};
  const double value = parsed.value();
  constexpr double kNoLimit = 1e300;
  const bool is_share = id == ParameterId::DampingRatio;
  if (is_share ? value < 0.0 || value >= 1.0 : value <= 0.0 || value >= kNoLimit) {
    return Error{"out_of_range", fmt::format("--fix {}: {} is out of range, expected a value {}", name, value,
                                             is_share ? "at least 0 and below 1" : "above 0")};
  }
  return value;
}

/// Returns the held parameters with "NAME=VALUE" added, or an error where that is not valid.
Result<HeldParameters> with_held(HeldParameters held, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    return Error{"unknown_fix", fmt::format("--fix: bad '{}', expected NAME=VALUE", text)};
  }
  const std::string name = text.substr(0, equals);
  const std::optional<ParameterId> known = parameter_with_key(name);
  if (!known || !info(*known).can_be_held) {
    return Error{"unknown_fix", fmt::format("--fix: unknown parameter '{}', expected one of {}", name, known_names())};
  }
  const Result<double> value = held_value(*known, text.substr(equals + 1));
  if (!value) return value.error();
  std::optional<double>& place = place_of(*known, held);
  if (place) return Error{"unknown_fix", fmt::format("--fix: '{}' is given twice, expected it once", name)};
  place = value.value();
  return held;
}

}  // namespace

Result<FitOptions> parse_fit_options(const std::string& tier, const std::vector<std::string>& fixed, FitKind kind) {
  FitOptions options;
  const auto parsed = tier_from(tier, kind);
  if (!parsed) return parsed.error();
  options.tier = parsed.value();
  for (const std::string& text : fixed) {
    auto held = with_held(options.held, text);
    if (!held) return held.error();
    options.held = std::move(held).value();
  }
  return options;
}

}  // namespace slipfit
