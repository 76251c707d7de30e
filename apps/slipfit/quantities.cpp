#include "quantities.hpp"

#include <utility>

using slipfit::Dimension;

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& message) {
  throw Failure(ExitCode::WrongUsage, fmt::format("{}: {}", option, message));
}

double within(double value, Limits limits, const std::string& option, const std::string& text) {
  if (limits == Limits::AboveZero && !(value > 0.0)) refuse(option, fmt::format("'{}' is not above zero", text));
  if (limits == Limits::NotNegative && !(value >= 0.0)) refuse(option, fmt::format("'{}' is below zero", text));
  return value;
}

}  // namespace

double quantity(const std::string& option, const std::string& text, Dimension dimension, Limits limits) {
  const slipfit::Result<double> parsed = slipfit::parse_quantity(text, dimension);
  if (!parsed) refuse(option, parsed.error().message);
  return within(parsed.value(), limits, option, text);
}

double plain_number(const std::string& option, const std::string& text, const std::string& unit, Limits limits) {
  const auto value = slipfit::parse_quantity(text, Dimension::Dimensionless);
  if (!value || !slipfit::unit_in(text).empty()) {
    refuse(option, fmt::format("bad number '{}', expected a plain number ({})", text, unit));
  }
  return within(value.value(), limits, option, text);
}

slipfit::FitOptions fit_options_from(const std::string& tier, const std::vector<std::string>& fixed,
                                     slipfit::FitKind kind) {
  auto options = slipfit::parse_fit_options(tier, fixed, kind);
  if (!options) throw Failure(ExitCode::WrongUsage, options.error().message);
  return std::move(options).value();
}
