#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/fit/options.hpp"
#include "slipfit/io/read_options.hpp"

// Text of the command line into SI numbers. Each throws Failure(WrongUsage) that names the option, the text and the
// remedy.

/// The text, or Failure(WrongUsage) that the option is missing; `meaning` says what to give.
const std::string& required(const std::optional<std::string>& text, const std::string& option,
                            const std::string& meaning);

/// A number (SI) or a number with a unit.
double quantity(const std::string& option, const std::string& text, slipfit::Dimension dimension);
double positive_quantity(const std::string& option, const std::string& text, slipfit::Dimension dimension);
double quantity_not_negative(const std::string& option, const std::string& text, slipfit::Dimension dimension);

/// A finite number without a unit; `unit` is for the message.
double plain_number(const std::string& option, const std::string& text, const std::string& unit);

/// The driving speed; "60rpm" needs the radius at which the sensor touches: V = omega R.
double driving_speed(const std::string& text, const std::optional<std::string>& radius);

/// Standard error of the speed: a speed, or a percentage of it.
double speed_standard_error(const std::string& text, double speed_m_per_s, const std::optional<std::string>& radius);

/// "T0:T1" in seconds, T0 < T1.
slipfit::TimeWindow time_window(const std::string& text);

/// "A:B" rows, 1 <= A < B.
slipfit::RowRange row_range(const std::string& text);

/// "COLUMN=VALUE"; the column may hold an equals sign, the value none.
slipfit::ColumnValue column_value(const std::string& text);

slipfit::ForceView force_view(const std::string& text);

/// `--tier` and `--fix` as typed.
slipfit::FitOptions fit_options_from(const std::string& tier, const std::vector<std::string>& fixed,
                                     slipfit::FitKind kind);
