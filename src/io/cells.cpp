#include "io/cells.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/number_text.hpp"
#include "core/word_list.hpp"

namespace slipfit::reading {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kLongestNumber = 63;

struct Parsed {
  double value = kNone;
  std::size_t length = 0;  ///< characters used, 0 where there is no number
};

/// A number at the very start of the text. Correctly rounded (fast-cpp-csv-parser's own conversion is not).
Parsed parse_point(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && (is_digit(text[1]) || text[1] == '.');
  const char* begin = text.data() + (plus ? 1 : 0);
  Parsed parsed;
  const auto [end, error] = number_from_chars(begin, text.data() + text.size(), parsed.value);
  if (error != std::errc()) return {};
  parsed.length = static_cast<std::size_t>(end - text.data());
  if (std::abs(parsed.value) > kOverload) parsed.value = kNone;
  return parsed;
}

/// Characters of "-1.234.567": separators between groups of three digits; 0 where there is no separator.
std::size_t length_of_groups(std::string_view text, char separator) {
  std::size_t at = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const auto digits = [&] {
    std::size_t count = 0;
    while (at < text.size() && is_digit(text[at])) ++at, ++count;
    return count;
  };
  if (at < text.size() && text[at] == '0') return 0;
  const std::size_t first = digits();
  if (first < 1 || first > 3) return 0;
  const std::size_t begin = at;
  while (at < text.size() && text[at] == separator) {
    ++at;
    if (digits() != 3) return 0;
  }
  return at > begin ? at : 0;
}

/// Reads with `parse` what is left without the separators within the first `groups` characters.
Parsed parse_without(char separator, std::size_t groups, std::string_view text, Parsed (*parse)(std::string_view)) {
  std::string plain(text.substr(0, groups));
  const std::size_t separators = std::erase(plain, separator);
  Parsed parsed = parse(plain.append(text.substr(groups)));
  if (parsed.length > 0) parsed.length += separators;
  return parsed;
}

Parsed parse_comma(std::string_view text) {
  if (const std::size_t groups = length_of_groups(text, '.'); groups > 0 && text.size() <= kLongestNumber) {
    return parse_without('.', groups, text, parse_comma);
  }
  std::array<char, kLongestNumber> copy{};
  const std::size_t length = std::min(text.size(), copy.size());
  if (text.substr(0, length).find('.') != std::string_view::npos) {
    // "1.5" is no number where the comma is decimal, but a tag after a number may contain it.
    const Parsed parsed = parse_comma(text.substr(0, text.find('.')));
    return parsed.length == text.find('.') ? Parsed{} : parsed;
  }
  std::replace_copy(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(length), copy.begin(), ',', '.');
  const Parsed parsed = parse_point({copy.data(), length});
  const bool is_cut = parsed.length > 0 && parsed.length < text.size() && text[parsed.length - 1] == ',';
  return is_cut ? Parsed{} : parsed;  // "1,on" is a cell, a delimiter and another cell
}

/// Minus signs of typesetting in UTF-8: minus sign, en dash, fullwidth hyphen-minus.
constexpr std::array<std::string_view, 3> kMinusSigns = {"\xE2\x88\x92", "\xE2\x80\x93", "\xEF\xBC\x8D"};
constexpr std::size_t kMinusBytes = 3;

bool is_minus_at(std::string_view text, std::size_t place) {
  return std::ranges::find(kMinusSigns, text.substr(std::min(place, text.size()), kMinusBytes)) != kMinusSigns.end();
}

Parsed parse(std::string_view text, bool decimal_comma) {
  const Decimal quick = read_decimal(text.data(), text.data() + text.size(), decimal_comma ? ',' : '.');
  if (quick.is_number && quick.end == text.data() + text.size()) return {quick.value, text.size()};
  const std::size_t exponent = text.find_first_of("eE");
  for (const std::size_t place : {std::size_t{0}, exponent == std::string_view::npos ? exponent : exponent + 1}) {
    if (!is_minus_at(text, place)) continue;
    std::string plain(text.substr(0, place));
    plain += '-';
    plain += text.substr(place + kMinusBytes);
    Parsed parsed = parse(plain, decimal_comma);
    if (parsed.length > place) parsed.length += kMinusBytes - 1;
    return parsed;
  }
  if (decimal_comma) return parse_comma(text);
  // "1,234" alone may have a decimal comma; "1,234.5" has not.
  const std::size_t groups = length_of_groups(text, ',');
  const bool has_point = groups > 0 && groups < text.size() && text[groups] == '.';
  return has_point ? parse_without(',', groups, text, parse_point) : parse_point(text);
}

bool is_missing(std::string_view text) {
  constexpr std::string_view kWords =
      "nan na n/a #n/a null none inf +inf -inf +nan -nan infinity ol overload overflow err error - -- --- ---- #value! "
      "#div/0! 1.#qnan 1.#inf -1.#ind 1.#ind invalid "
      "\xE2\x88\x92 \xE2\x80\x93 \xE2\x80\x94";  // dashes
  constexpr std::size_t kLongest = 8;
  if (text.size() > kLongest) return false;
  return is_in(kWords, lower(text));
}

constexpr double kHalfDay_s = 43200.0;

/// Takes "AM" or "PM" off the end of the text: 0 or 12 hours to add, 12 o'clock counted as 0. Empty where there is
/// none.
std::optional<double> take_half_day_s(std::string_view& text) {
  const std::string small = lower(text.substr(text.size() - std::min<std::size_t>(4, text.size())));
  for (const std::string_view ending : {"am", "pm", "a.m.", "p.m."}) {
    if (!small.ends_with(ending)) continue;
    text = trim(text.substr(0, text.size() - ending.size()));
    return ending[0] == 'p' ? kHalfDay_s : 0.0;
  }
  return std::nullopt;
}

/// h:m:s with decimals after a point or a comma, on 24 or on 12 hours ("1:05:00 PM"); anything else gives no number.
Parsed parse_time_of_day(std::string_view text) {
  const std::size_t length = text.size();
  const auto half_day_s = take_half_day_s(text);
  double seconds = 0.0;
  for (int colons = 0; colons < 2; ++colons) {
    int part = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), part);
    const auto used = static_cast<std::size_t>(end - text.data());
    if (error != std::errc() || part < 0 || used >= text.size() || text[used] != ':') return {};
    seconds = (seconds + part) * 60.0;
    text.remove_prefix(used + 1);
  }
  if (text.empty() || !is_digit(text[0])) return {};
  const Parsed rest = parse(text, text.find(',') != std::string_view::npos);
  if (rest.length != text.size() || !(rest.value < 61.0)) return {};
  seconds += rest.value;
  if (half_day_s) seconds = std::fmod(seconds, kHalfDay_s) + *half_day_s;
  return {seconds, length};
}

/// A time of day, after a date or alone.
Parsed parse_clock(std::string_view text) {
  const auto date = read_date(text);
  if (!date) return parse_time_of_day(text);
  const Parsed clock = date->clock.empty() ? Parsed{} : parse_time_of_day(date->clock);
  return clock.length == 0 ? Parsed{} : Parsed{date->midnight_s + clock.value, text.size()};
}

/// A tag begins with a letter or a unit sign, after the blanks: neither a second number nor the rest of a date.
bool is_tag(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  return std::isalpha(first) != 0 || first >= 0x80 || first == '%' || first == '[' || first == '(';
}

/// Takes a quoted field off the front of `rest`; nothing where its quote is not closed.
std::optional<std::string> take_quoted(std::string_view& rest) {
  std::string field;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] != '"') {
      field += rest[i];
    } else if (i + 1 < rest.size() && rest[i + 1] == '"') {
      field += rest[i++];
    } else {
      rest.remove_prefix(i + 1);
      return field;
    }
  }
  return std::nullopt;
}

/// A tab that is the delimiter is no blank.
std::string_view skip_blanks(std::string_view text, char delimiter) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t') && text.front() != delimiter) {
    text.remove_prefix(1);
  }
  return text;
}

}  // namespace

std::string_view unquote(std::string_view text) {
  text = trim(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return trim(text.substr(1, text.size() - 2));
  return text;
}

double plain_number(std::string_view text, bool decimal_comma) {
  text = trim(text);
  if (text.empty()) return kNone;
  const Parsed parsed = parse(text, decimal_comma);
  return parsed.length == text.size() ? parsed.value : kNone;
}

Cell read_cell(std::string_view text, bool decimal_comma) {
  text = unquote(text);
  if (text.empty()) return {CellKind::Blank, kNone, {}};
  const Parsed parsed = parse(text, decimal_comma);
  if (parsed.length > 0) {
    const std::string_view rest = trim(text.substr(parsed.length));
    const bool finite = std::isfinite(parsed.value);
    const bool apart =
        is_blank(text[std::min(parsed.length, text.size() - 1)]);  // "Info", "Nanometer" hold inf and nan
    if (rest.empty() || (is_tag(rest) && (finite || apart))) {
      return {finite ? CellKind::Number : CellKind::Missing, parsed.value, rest};
    }
  }
  if (is_missing(text)) return {CellKind::Missing, kNone, {}};
  const Parsed clock = parse_clock(text);
  if (clock.length > 0) return {CellKind::Clock, clock.value, {}};
  if (const auto date = read_date(text); date && date->clock.empty()) return {CellKind::Date, kNone, {}};
  return {CellKind::Text, kNone, {}};
}

bool is_comma_in_clock(const char* begin, const char* comma, const char* line_end) {
  if (comma == line_end || *comma != ',' || comma - begin < 3 || !is_digit(comma[-1])) return false;
  const bool has_colon = comma[-2] == ':' || (is_digit(comma[-2]) && comma[-3] == ':');
  return has_colon && comma + 1 != line_end && is_digit(comma[1]);
}

std::vector<std::string_view> split(std::string_view line, const Dialect& dialect) {
  std::vector<std::string_view> cells;
  split(line, dialect, cells);
  return cells;
}

void split(std::string_view line, const Dialect& dialect, std::vector<std::string_view>& cells) {
  cells.clear();
  if (dialect.delimiter == '\0') {
    cells.push_back(line);
    return;
  }
  const char* cell = line.data();
  const char* const line_end = cell + line.size();
  for (;;) {
    if (dialect.delimiter == ' ') {
      while (cell != line_end && is_blank(*cell)) ++cell;
      if (cell == line_end) return;
    }
    const char* end = end_of_cell(cell, line_end, dialect);
    cells.emplace_back(cell, static_cast<std::size_t>(end - cell));
    if (end == line_end) return;
    cell = end + 1;
  }
}

std::optional<std::vector<std::string>> csv_fields(std::string_view line, char delimiter) {
  std::vector<std::string> fields;
  for (;;) {
    line = skip_blanks(line, delimiter);
    std::optional<std::string> quoted;
    if (!line.empty() && line.front() == '"') {
      quoted = take_quoted(line);
      if (!quoted) return std::nullopt;
    }
    const std::size_t end = std::min(line.find(delimiter), line.size());
    const std::string_view plain = trim(line.substr(0, end));
    if (quoted && !plain.empty()) return std::nullopt;
    fields.push_back(quoted ? *std::move(quoted) : std::string(plain));
    if (end == line.size()) return fields;
    line.remove_prefix(end + 1);
  }
}

namespace {

struct DateParts {
  std::array<int, 3> numbers{};
  std::array<std::size_t, 3> digits{};
  char separator = '\0';
  std::size_t length = 0;
};

/// Three numbers with the same sign between them.
std::optional<DateParts> read_parts(std::string_view text) {
  DateParts parts;
  const char* p = text.data();
  const char* const end = p + text.size();
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0 && (p == end || (i == 2 && *p != parts.separator))) return std::nullopt;
    if (i > 0) parts.separator = *p++;
    const auto [stop, error] = std::from_chars(p, end, parts.numbers.at(i));
    if (error != std::errc() || parts.numbers.at(i) < 0) return std::nullopt;
    parts.digits.at(i) = static_cast<std::size_t>(stop - p);
    p = stop;
  }
  parts.length = static_cast<std::size_t>(p - text.data());
  return parts;
}

/// "Z", "+02:00", "-0500" at the end of an ISO time: the same for all rows.
std::string_view without_zone(std::string_view clock) {
  if (clock.ends_with('Z')) return clock.substr(0, clock.size() - 1);
  const std::size_t sign = clock.find_last_of("+-");
  return sign == std::string_view::npos ? clock : clock.substr(0, sign);
}

}  // namespace

std::optional<DateStart> read_date(std::string_view text) {
  const auto parts = read_parts(text);
  if (!parts) return std::nullopt;
  std::string_view clock = text.substr(parts->length);
  if (!clock.empty() && clock.front() != ' ' && clock.front() != 'T') return std::nullopt;
  if (!clock.empty()) clock.remove_prefix(1);
  while (clock.starts_with(' ')) clock.remove_prefix(1);
  const auto& [first, second, third] = parts->numbers;
  const bool is_ISO = (parts->separator == '-' || parts->separator == '/') && parts->digits[0] == 4;
  const bool is_German = parts->separator == '.' && (parts->digits[2] == 4 || parts->digits[2] == 2);
  const bool is_slashed = parts->separator == '/' && (parts->digits[2] == 4 || parts->digits[2] == 2);
  if (!is_ISO && is_slashed && std::max(first, second) <= 31 && std::min(first, second) <= 12) {
    return DateStart{0.0, clock};
  }
  if (!is_ISO && !is_German) return std::nullopt;
  const int century = parts->digits[2] == 2 ? 2000 : 0;
  using namespace std::chrono;
  const year_month_day date =
      is_ISO ? year_month_day{year{first}, month{static_cast<unsigned>(second)}, day{static_cast<unsigned>(third)}}
             : year_month_day{year{century + third}, month{static_cast<unsigned>(second)},
                              day{static_cast<unsigned>(first)}};
  if (!date.ok()) return std::nullopt;
  const auto since_1970 = sys_days{date}.time_since_epoch();
  return DateStart{86400.0 * static_cast<double>(since_1970.count()), is_ISO ? without_zone(clock) : clock};
}

namespace {

constexpr std::size_t kMostShapes = 256;

/// Returns the shape of a cell, or an empty text if it does not look like a number.
std::string shape_of(std::string_view cell) {
  std::string shape;
  bool has_digit = false;
  for (const char c : cell) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (cell.size() > kLongestNumber || c == ':' || c == '/' || (is_letter && c != 'e' && c != 'E')) return {};
    has_digit = has_digit || is_digit(c);
    if (!is_digit(c)) {
      shape += c;
    } else if (shape.empty() || shape.back() != '0') {
      shape += '0';
    }
  }
  return has_digit ? shape : std::string();
}

}  // namespace

void UnreadCellCount::add(std::string_view cell, std::size_t column, unsigned line) {
  cell = unquote(cell);
  std::string shape = shape_of(cell);
  if (shape.empty()) return;
  std::pair key(column, std::move(shape));
  if (by_shape_.size() >= kMostShapes && !by_shape_.contains(key)) return;
  UnreadCells& cells = by_shape_[std::move(key)];
  if (cells.count++ == 0) cells = {1, column, line, std::string(cell)};
}

std::optional<UnreadCells> UnreadCellCount::most() const {
  const auto found =
      std::ranges::max_element(by_shape_, [](const auto& a, const auto& b) { return a.second.count < b.second.count; });
  return found == by_shape_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace slipfit::reading
