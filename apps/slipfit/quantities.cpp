#include "quantities.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "failure.hpp"

using slipfit::Dimension;
using slipfit::Result;

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& message) {
  throw Failure(ExitCode::WrongUsage, fmt::format("{}: {}", option, message));
}

/// radius of --radius in metres, for a speed given as a rotation
double radius_m(const std::string& option, const std::string& text, const std::optional<std::string>& radius) {
  if (!radius) {
    refuse(option, fmt::format("'{}' is a rotation: add --radius, the distance of the contact from the axis", text));
  }
  return positive_quantity("--radius", *radius, Dimension::Length);
}

double speed_or_rotation(const std::string& option, const std::string& text, const std::optional<std::string>& radius) {
  const Result<double> speed = slipfit::parse_quantity(text, Dimension::Speed);
  if (speed) return speed.value();
  const Result<double> rotation = slipfit::parse_quantity(text, Dimension::AngularSpeed);
  if (rotation) return rotation.value() * radius_m(option, text, radius);
  refuse(option, speed.error().message);
}

}  // namespace

const std::string& required(const std::optional<std::string>& text, const std::string& option,
                            const std::string& meaning) {
  if (!text) throw Failure(ExitCode::WrongUsage, fmt::format("{} is missing: give {}", option, meaning));
  return *text;
}

double quantity(const std::string& option, const std::string& text, Dimension dimension) {
  const Result<double> parsed = slipfit::parse_quantity(text, dimension);
  if (!parsed) refuse(option, parsed.error().message);
  return parsed.value();
}

double positive_quantity(const std::string& option, const std::string& text, Dimension dimension) {
  const double value = quantity(option, text, dimension);
  if (!(value > 0.0)) refuse(option, fmt::format("'{}' is not above zero", text));
  return value;
}

double quantity_not_negative(const std::string& option, const std::string& text, Dimension dimension) {
  const double value = quantity(option, text, dimension);
  if (!(value >= 0.0)) refuse(option, fmt::format("'{}' is below zero", text));
  return value;
}

double plain_number(const std::string& option, const std::string& text, const std::string& unit) {
  const auto value = slipfit::parse_quantity(text, Dimension::Dimensionless);
  if (!value || !slipfit::unit_in(text).empty()) {
    refuse(option, fmt::format("bad number '{}', expected a plain number ({})", text, unit));
  }
  return value.value();
}

double driving_speed(const std::string& text, const std::optional<std::string>& radius) {
  const double speed_m_per_s = speed_or_rotation("--speed", text, radius);
  if (!(speed_m_per_s > 0.0)) refuse("--speed", fmt::format("'{}' is not above zero", text));
  if (!std::isfinite(speed_m_per_s)) refuse("--speed", fmt::format("'{}' times the radius is no number", text));
  return speed_m_per_s;
}

double speed_standard_error(const std::string& text, double speed_m_per_s, const std::optional<std::string>& radius) {
  const std::string option = "--speed-uncertainty";
  const bool percentage = !text.empty() && text.back() == '%';
  const double error_m_per_s = percentage ? quantity(option, text, Dimension::Dimensionless) * speed_m_per_s
                                          : speed_or_rotation(option, text, radius);
  if (!(error_m_per_s >= 0.0)) refuse(option, fmt::format("'{}' is below zero", text));
  return error_m_per_s;
}

slipfit::TimeWindow time_window(const std::string& text) {
  const std::string option = "--window";
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) refuse(option, fmt::format("bad window '{}', expected T0:T1 in seconds", text));
  const slipfit::TimeWindow window{quantity(option, text.substr(0, colon), Dimension::Time),
                                   quantity(option, text.substr(colon + 1), Dimension::Time)};
  if (!(window.begin_s < window.end_s)) {
    refuse(option, fmt::format("'{}' ends before it begins, expected T0:T1 with T0 < T1", text));
  }
  return window;
}

slipfit::RowRange row_range(const std::string& text) {
  const std::optional<slipfit::RowRange> rows = slipfit::parse_row_range(text);
  if (!rows) refuse("--rows", fmt::format("bad rows '{}', expected A:B with 1 <= A < B", text));
  return *rows;
}

slipfit::ColumnValue column_value(const std::string& text) {
  const std::optional<slipfit::ColumnValue> where = slipfit::parse_column_value(text);
  if (!where) refuse("--where", fmt::format("bad '{}', expected COLUMN=VALUE", text));
  return *where;
}

slipfit::ForceView force_view(const std::string& text) {
  if (text == "spring") return slipfit::ForceView::Spring;
  if (text == "transmitted") return slipfit::ForceView::Transmitted;
  if (text == "contact") return slipfit::ForceView::Contact;
  refuse("--force-view", fmt::format("unknown view '{}', expected spring, transmitted or contact", text));
}

slipfit::FitOptions fit_options_from(const std::string& tier, const std::vector<std::string>& fixed,
                                     slipfit::FitKind kind) {
  auto options = slipfit::parse_fit_options(tier, fixed, kind);
  if (!options) throw Failure(ExitCode::WrongUsage, options.error().message);
  return std::move(options).value();
}
