#include "fit_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "failure.hpp"
#include "quantities.hpp"

namespace {

struct Fixable {
  std::string_view name;
  std::string_view range;
  double above;  ///< exclusive, but for the damping ratio
  double below;
};

constexpr double kNoLimit = 1e300;

// The shared parameters of the tiers; what follows from them (mass, damping coefficient) cannot be held on its own.
constexpr std::array<Fixable, 3> kFixable{{
    {"stiffness_N_per_m", "above 0", 0.0, kNoLimit},
    {"natural_frequency_rad_per_s", "above 0", 0.0, kNoLimit},
    {"damping_ratio", "at least 0 and below 1", 0.0, 1.0},
}};

std::string known_names() {
  std::string names;
  for (const Fixable& parameter : kFixable) names += (names.empty() ? "" : ", ") + std::string(parameter.name);
  return names;
}

std::optional<slipfit::Tier> tier_from(const std::string& text, FitKind kind) {
  if (text == "auto") return std::nullopt;
  if (text == "damped") return slipfit::Tier::Damped;
  if (kind == FitKind::Joint) {
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

std::pair<std::string, double> fixed_from(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    throw Failure(ExitCode::WrongUsage, fmt::format("--fix: bad '{}', expected NAME=VALUE", text));
  }
  const std::string name = text.substr(0, equals);
  const auto* const known = std::find_if(kFixable.begin(), kFixable.end(),
                                         [&name](const Fixable& parameter) { return parameter.name == name; });
  if (known == kFixable.end()) {
    throw Failure(ExitCode::WrongUsage,
                  fmt::format("--fix: unknown parameter '{}', expected one of {}", name, known_names()));
  }
  const double value = plain_number("--fix " + name, text.substr(equals + 1), "SI");
  const bool may_be_zero = known->name == "damping_ratio";
  if (value < known->above || value >= known->below || (value == 0.0 && !may_be_zero)) {
    throw Failure(ExitCode::WrongUsage,
                  fmt::format("--fix {}: {} is out of range, expected a value {}", name, value, known->range));
  }
  return {name, value};
}

}  // namespace

slipfit::FitOptions fit_options_from(const std::string& tier, const std::vector<std::string>& fixed, FitKind kind) {
  slipfit::FitOptions options;
  options.tier = tier_from(tier, kind);
  for (const std::string& text : fixed) {
    const auto parameter = fixed_from(text);
    const bool twice = std::any_of(options.fixed.begin(), options.fixed.end(),
                                   [&parameter](const auto& other) { return other.first == parameter.first; });
    if (twice) throw Failure(ExitCode::WrongUsage, fmt::format("--fix: '{}' is given twice", parameter.first));
    options.fixed.push_back(parameter);
  }
  return options;
}
