#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/report/estimate_row.hpp"

namespace slipfit {

/// The number with as many decimals as two significant digits of `uncertainty` need; without an uncertainty four
/// significant digits. "-" for what is not finite. Scientific below 1e-4 and from 1e7 on.
std::string rounded(double value, std::optional<double> uncertainty);

/// "2.345 ± 0.012", the standard error with two digits; the value alone where there is no standard error.
std::string with_error(const Estimate& estimate);
/// "407.1 ± 2.2 µm", in the unit that suits the value.
std::string with_error(const Estimate& estimate, const std::string& SI_unit);

/// A unit with the prefix that brings `typical` to between 1 and 1000: value_SI * per_SI is in `unit`.
struct DisplayUnit {
  double per_SI = 1.0;
  std::string unit;
};

/// Prefixes for m, m/s, s, N and kg (from nano to the unit itself); 1/m becomes 1/mm; other units stay.
DisplayUnit display_unit(const std::string& SI_unit, std::optional<double> typical);

/// Returns the unit that suits value and standard error of an estimate, else its interval.
DisplayUnit suitable_unit(const Estimate& estimate, const std::string& SI_unit);

/// The unit that the speed was given in; where none is known, the one that suits `typical_m_per_s`.
DisplayUnit speed_unit(const std::string& given, std::optional<double> typical_m_per_s);

/// A note of the library with its speeds, which are in m/s, in the unit that tables have them in (speed_unit).
std::string in_speed_unit(const std::string& note, const std::string& given);

EstimateRow estimate_row(const Estimate& SI, const DisplayUnit& unit);

/// "49.3 ms [47.1, 51.7]"; "-" where it is not known.
std::string estimate_text(const Estimate& estimate, const DisplayUnit& unit);
std::string estimate_text(const Estimate& estimate, const std::string& SI_unit);

/// "1.234 mm": a number without an error.
std::string quantity_text(std::optional<double> value, const std::string& SI_unit);
std::string quantity_text(double value, const DisplayUnit& unit);

/// "10 mm/s": a number that somebody stated, with the digits that it needs.
std::string stated_text(double value, const std::string& SI_unit);
std::string stated_text(double value, const DisplayUnit& unit);

/// The driving speed, in the unit that it was given in.
std::string speed_text(const Conditions& conditions);

/// A status, role or regime of the document in words: "stick-slip", "steady sliding".
std::string plain_words(std::string_view name);

/// The unit of the force column: N, or 1 (empty text) for a friction coefficient.
std::string force_unit(ForceQuantity quantity);

/// Returns a CSV cell: the shortest text that reads back as the same double; empty without a number.
std::string cell(std::optional<double> value);

/// Characters of a text, not bytes: the continuation bytes of UTF-8 take no room.
std::size_t shown_width(std::string_view text);

/// The characters of a line of text.
inline constexpr std::size_t kLineWidth = 100;

/// The text in lines of at most kLineWidth characters, the first after `first`, the others after as many blanks. No
/// line ends between a number and the word after it.
std::vector<std::string> wrapped(const std::string& first, const std::string& text);
std::string wrapped_text(const std::string& first, const std::string& text);

enum class Align { Left, Right };

/// Lines of cells in columns that are as wide as their widest cell, two blanks apart, indented by two. A column without
/// text is left out. Where the last column is aligned left its cells are wrapped at kLineWidth.
class Table {
 public:
  explicit Table(std::vector<Align> columns) : columns_(std::move(columns)) {}
  void add(std::vector<std::string> cells);  ///< at most as many cells as columns
  [[nodiscard]] bool empty() const { return rows_.empty(); }
  [[nodiscard]] std::string text() const;

 private:
  std::vector<Align> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// Notes of the rows of a table, each once; the rows that it is about bear its number.
class Footnotes {
 public:
  /// " (1)"; empty without a note.
  std::string mark(const std::string& note);
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::string> notes_;
};

/// Returns the value of a row with its unit.
[[nodiscard]] std::string value_text(const EstimateRow& row);

}  // namespace slipfit
