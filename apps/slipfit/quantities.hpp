#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "failure.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/fit/options.hpp"

// Text of the command line into SI numbers. Each throws Failure(WrongUsage) that names the option, the text and the
// remedy.

enum class Limits { None, AboveZero, NotNegative };

/// A number (SI) or a number with a unit of this dimension.
double quantity(const std::string& option, const std::string& text, slipfit::Dimension dimension,
                Limits limits = Limits::None);

/// An option of a `quantity`; the target is a double, or a std::optional of one.
template <class Target>
CLI::Option* add_quantity(CLI::App& command, const std::string& option, Target& target, slipfit::Dimension dimension,
                          Limits limits, const std::string& help) {
  return command.add_option_function<std::string>(
      option,
      [&target, option, dimension, limits](const std::string& text) {
        target = quantity(option, text, dimension, limits);
      },
      help);
}

/// The value, or Failure(WrongUsage) that the option is missing; `meaning` says what to give.
template <class Value>
const Value& required(const std::optional<Value>& value, const std::string& option, const std::string& meaning) {
  if (!value) refuse("{} is missing: give {}", option, meaning);
  return *value;
}

/// Returns the key of the parameter with this symbol ("k", "zeta", "w_n"), otherwise the text itself.
std::string key_of_parameter(const std::string& text);

/// Returns the options `--tier` and `--fix` as typed.
slipfit::FitOptions fit_options_from(const std::string& tier, const std::vector<std::string>& fixed,
                                     slipfit::FitKind kind);
