#include "report/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/statistics.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit {
namespace {

constexpr int kDigitsOfError = 2;  // the usual rule for a standard error
constexpr int kDigitsWithoutError = 4;
/// Relative error that driving speeds and force sensors have at best: digits finer than it are not printed. JSON has
/// them.
constexpr double kFinestError = 1e-3;
constexpr int kMostDigits = 9;  // beyond any force sensor and clock
constexpr int kSmallestFixedExponent = -4;
constexpr int kLargestFixedExponent = 6;

int exponent_of(double value) {
  return value == 0.0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
}

bool usable(std::optional<double> uncertainty) {
  return uncertainty && std::isfinite(*uncertainty) && *uncertainty > 0.0;
}

/// Power of ten of the last digit worth writing.
int last_digit_exponent(double value, std::optional<double> uncertainty) {
  const int by_error = usable(uncertainty) ? exponent_of(*uncertainty) - (kDigitsOfError - 1)
                                           : exponent_of(value) - (kDigitsWithoutError - 1);
  return std::max(by_error, exponent_of(value) - (kMostDigits - 1));
}

std::string fixed_text(double value, int last_digit) {
  const double unit = std::pow(10.0, std::max(last_digit, 0));
  std::string text =
      fmt::format("{:.{}f}", last_digit > 0 ? std::round(value / unit) * unit : value, std::max(-last_digit, 0));
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  if (is_zero && text.front() == '-') text.erase(0, 1);
  return text;
}

/// The standard error, else half the interval over kNormalQuantile; at least kFinestError of the value.
std::optional<double> uncertainty_of(const Estimate& estimate) {
  std::optional<double> error = estimate.standard_error;
  if (!usable(error) && estimate.ci95) error = (estimate.ci95->high - estimate.ci95->low) / (2.0 * kNormalQuantile);
  if (!error || !estimate.value) return error;
  return std::max(*error, kFinestError * std::abs(*estimate.value));
}

}  // namespace

std::size_t shown_width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

namespace {

/// End of the word that begins there: a number and what it counts are one.
std::size_t end_of_word(const std::string& text, std::size_t begin) {
  const std::size_t end = std::min(text.find(' ', begin), text.size());
  const auto is_digit_at = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  const bool has_unit = end > begin && end < text.size() && is_digit_at(end - 1) && !is_digit_at(end + 1);
  return has_unit ? std::min(text.find(' ', end + 1), text.size()) : end;
}

}  // namespace

std::vector<std::string> wrapped(const std::string& first, const std::string& text) {
  const std::size_t indent = shown_width(first);
  std::vector<std::string> lines{first};
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = end_of_word(text, begin);
    const std::string word = text.substr(begin, end - begin);
    const bool is_empty = shown_width(lines.back()) == indent;
    if (!is_empty && shown_width(lines.back()) + 1 + shown_width(word) > kLineWidth) {
      lines.push_back(std::string(indent, ' ') + word);
    } else {
      lines.back() += (is_empty ? "" : " ") + word;
    }
    begin = end + 1;
  }
  return lines;
}

std::string wrapped_text(const std::string& first, const std::string& text) {
  std::string all;
  for (const std::string& line : wrapped(first, text)) all += line + "\n";
  return all;
}

std::string rounded(double value, std::optional<double> uncertainty) {
  if (!std::isfinite(value)) return "-";
  if (value == 0.0 && !usable(uncertainty)) return "0";
  const int exponent = exponent_of(value);
  const int last_digit = last_digit_exponent(value, uncertainty);
  const bool drowned = last_digit > exponent;  // the error is larger than the number: one digit place is all there is
  const int leading = drowned ? last_digit : exponent;
  if (leading >= kSmallestFixedExponent && leading <= kLargestFixedExponent) return fixed_text(value, last_digit);
  return fmt::format("{:.{}e}", value, std::max(0, exponent - last_digit));
}

std::string with_error(const Estimate& estimate) {
  if (!estimate.value || !std::isfinite(*estimate.value)) return "-";
  if (!usable(estimate.standard_error)) return rounded(*estimate.value, std::nullopt);
  return fmt::format("{} ± {}", rounded(*estimate.value, estimate.standard_error),
                     rounded(*estimate.standard_error, estimate.standard_error));
}

DisplayUnit display_unit(const std::string& SI_unit, std::optional<double> typical) {
  if (SI_unit == "1/m") return {1e-3, "1/mm"};
  constexpr std::array<const char*, 6> kPrefixable{"m", "m/s", "s", "N", "kg", "J"};
  const bool prefixable = std::ranges::find(kPrefixable, SI_unit) != kPrefixable.end();
  if (!prefixable || !typical || !std::isfinite(*typical) || *typical == 0.0) return {1.0, SI_unit};
  const double magnitude = std::abs(*typical);
  if (magnitude >= 1.0) return {1.0, SI_unit};
  const std::string base = SI_unit == "kg" ? "g" : SI_unit;
  const double base_per_SI = SI_unit == "kg" ? 1e3 : 1.0;
  if (SI_unit == "kg" && magnitude >= 1e-3) return {base_per_SI, base};
  if (magnitude * base_per_SI >= 1e-3) return {1e3 * base_per_SI, "m" + base};
  if (magnitude * base_per_SI >= 1e-6) return {1e6 * base_per_SI, "µ" + base};
  return {1e9 * base_per_SI, "n" + base};
}

DisplayUnit suitable_unit(const Estimate& estimate, const std::string& SI_unit) {
  std::optional<double> typical = estimate.value;
  if (!typical && estimate.ci95) typical = estimate.ci95->high;
  if (typical && estimate.standard_error) typical = std::max(std::abs(*typical), *estimate.standard_error);
  return display_unit(SI_unit, typical);
}

DisplayUnit speed_unit(const std::string& given, std::optional<double> typical_m_per_s) {
  if (!given.empty()) {
    if (const auto unit = parse_unit(given, Dimension::Speed)) return {1.0 / unit.value(), given};
  }
  return display_unit("m/s", typical_m_per_s);
}

std::string in_speed_unit(const std::string& note, const std::string& given) {
  constexpr std::string_view kUnit = " m/s";
  std::string text;
  std::size_t done = 0;
  for (std::size_t at = note.find(kUnit); at != std::string::npos; at = note.find(kUnit, done)) {
    // 0 where all before it are of the number.
    const std::size_t begin = at == 0 ? 0 : note.find_last_not_of("0123456789.e+-", at - 1) + 1;
    double m_per_s = 0.0;
    const auto [end, error] = std::from_chars(note.data() + begin, note.data() + at, m_per_s);
    const bool is_unit = note.find_first_of("0123456789", at + kUnit.size()) != at + kUnit.size();  // not m/s2
    const bool is_speed = is_unit && error == std::errc() && end == note.data() + at && begin >= done;
    text += note.substr(done, (is_speed ? begin : at + kUnit.size()) - done);
    if (is_speed) {
      const DisplayUnit unit = speed_unit(given, m_per_s);
      text += fmt::format("{:.4g} {}", m_per_s * unit.per_SI, unit.unit);
    }
    done = at + kUnit.size();
  }
  return text + note.substr(done);
}

std::string with_error(const Estimate& estimate, const std::string& SI_unit) {
  const DisplayUnit unit = display_unit(SI_unit, estimate.value);
  const std::string text = with_error(scaled(estimate, unit.per_SI));
  return unit.unit.empty() || text == "-" ? text : text + " " + unit.unit;
}

std::string force_unit(ForceQuantity quantity) {
  return quantity == ForceQuantity::Force_N ? "N" : "";
}

EstimateRow estimate_row(const Estimate& estimate, const std::string& SI_unit) {
  return estimate_row(estimate, suitable_unit(estimate, SI_unit));
}

std::string estimate_text(const Estimate& estimate, const DisplayUnit& unit) {
  if (!estimate.value || !std::isfinite(*estimate.value)) return "-";
  const EstimateRow row = estimate_row(estimate, unit);
  return row.value + (row.unit.empty() ? "" : " " + row.unit) + (row.interval.empty() ? "" : " " + row.interval);
}

std::string estimate_text(const Estimate& estimate, const std::string& SI_unit) {
  return estimate_text(estimate, suitable_unit(estimate, SI_unit));
}

EstimateRow estimate_row(const Estimate& SI, const DisplayUnit& unit) {
  const Estimate estimate = scaled(SI, unit.per_SI);
  const std::optional<double> uncertainty = uncertainty_of(estimate);
  EstimateRow row{"-", {}, unit.unit};
  if (estimate.value) row.value = rounded(*estimate.value, uncertainty);
  if (estimate.ci95 && std::isfinite(estimate.ci95->low) && std::isfinite(estimate.ci95->high)) {
    row.interval =
        fmt::format("[{}, {}]", rounded(estimate.ci95->low, uncertainty), rounded(estimate.ci95->high, uncertainty));
  }
  return row;
}

std::string quantity_text(std::optional<double> value, const std::string& SI_unit) {
  return value ? quantity_text(*value, display_unit(SI_unit, value)) : "-";
}

std::string quantity_text(double value, const DisplayUnit& unit) {
  const std::string text = rounded(value * unit.per_SI, std::nullopt);
  return unit.unit.empty() || text == "-" ? text : text + " " + unit.unit;
}

std::string stated_text(double value, const std::string& SI_unit) {
  return stated_text(value, display_unit(SI_unit, value));
}

std::string stated_text(double value, const DisplayUnit& unit) {
  return std::isfinite(value) ? fmt::format("{:.6g} {}", value * unit.per_SI, unit.unit) : "-";
}

std::string speed_text(const Conditions& conditions) {
  if (!conditions.speed_is_known) return "an unknown speed";
  return stated_text(conditions.speed_m_per_s, speed_unit(conditions.speed_unit, conditions.speed_m_per_s));
}

std::string plain_words(std::string_view name) {
  if (name == "stick_slip") return "stick-slip";
  std::string words = printable(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string cell(std::optional<double> value) {
  return value && std::isfinite(*value) ? fmt::format("{}", *value) : std::string();
}

void Table::add(std::vector<std::string> cells) {
  assert(cells.size() <= columns_.size());
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  std::vector<std::size_t> widths(columns_.size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], shown_width(row[i]));
  }
  std::string text;
  for (const auto& row : rows_) {
    const bool is_wrapped = row.size() == columns_.size() && columns_.back() == Align::Left && !row.back().empty();
    std::string line;
    for (std::size_t i = 0; i + (is_wrapped ? 1 : 0) < row.size(); ++i) {
      if (widths[i] == 0) continue;
      const std::string padding(widths[i] - shown_width(row[i]), ' ');
      line += "  " + (columns_[i] == Align::Left ? row[i] + padding : padding + row[i]);
    }
    if (is_wrapped) {
      text += wrapped_text(line + "  ", row.back());
    } else {
      text += line.erase(line.find_last_not_of(' ') + 1) + "\n";
    }
  }
  return text;
}

std::string Footnotes::mark(const std::string& note) {
  if (note.empty()) return {};
  const auto known = std::ranges::find(notes_, note);
  const auto index = known - notes_.begin();
  if (known == notes_.end()) notes_.push_back(note);
  return fmt::format(" ({})", index + 1);
}

std::string Footnotes::text() const {
  std::string text;
  for (std::size_t i = 0; i < notes_.size(); ++i)
    text += wrapped_text(fmt::format("  ({}) ", i + 1), printable(notes_[i]));
  return text;
}

std::string value_text(const EstimateRow& row) {
  return row.unit.empty() || row.value == "-" ? row.value : row.value + " " + row.unit;
}

}  // namespace slipfit
