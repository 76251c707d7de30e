#include <algorithm>
#include <array>
#include <map>

#include "core/word_list.hpp"
#include "io/decimal.hpp"
#include "io/layout.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kLinesTried = 256;  // a dozen dialects on each cost under a millisecond

// In the order of preference where two explain the lines equally well.
constexpr std::array kDialects = std::to_array<Dialect>({{',', false},
                                                         {',', false, true},
                                                         {';', false},
                                                         {'\t', false},
                                                         {'|', false},
                                                         {' ', false},
                                                         {'\0', false},
                                                         {';', true},
                                                         {'\t', true},
                                                         {'|', true},
                                                         {' ', true},
                                                         {'\0', true},
                                                         {',', true}});

struct Score {
  double weight = 0.0;
  std::size_t columns = 0;
};

/// "005": behind a clock these are its decimals, and no column.
bool has_zero_in_front(std::string_view cell) {
  cell = unquote(cell);
  return cell.size() > 1 && cell[0] == '0' && is_digit(cell[1]);
}

/// Returns how much of a row is understood: 1 if every column is, little if one is not, 0 without a number. Dates and
/// missing readings are understood but are not numbers. Blank cells count a little: "6,<tab>1," has two columns of
/// numbers, not three of which the last is blank in some rows.
double row_weight(const std::vector<std::string_view>& cells, bool decimal_comma) {
  constexpr double kBlank = 0.05;
  double numbers = 0.0;
  double texts = 0.0;
  double blanks = 0.0;
  CellKind before = CellKind::Text;
  for (const std::string_view text : cells) {
    CellKind kind = read_cell(text, decimal_comma).kind;
    if (kind == CellKind::Number && before == CellKind::Clock && has_zero_in_front(text)) kind = CellKind::Text;
    numbers += kind == CellKind::Number || kind == CellKind::Clock ? 1.0 : 0.0;
    texts += kind == CellKind::Text ? 1.0 : 0.0;
    blanks += kind == CellKind::Blank ? 1.0 : 0.0;
    before = kind;
  }
  if (numbers == 0.0) return 0.0;
  const auto columns = static_cast<double>(cells.size());
  const double part = numbers / columns;
  return texts == 0.0 ? 1.0 - kBlank * blanks / columns : 0.25 * part * part;
}

/// Nothing as soon as `least` is out of reach: a line adds 1 at most.
Score score(const std::vector<std::string_view>& lines, const Dialect& dialect, double least) {
  std::map<std::size_t, double> weight_by_columns;
  std::vector<std::string_view> cells;
  double most = 0.0;
  double left = static_cast<double>(lines.size());
  for (const std::string_view line : lines) {
    split(line, dialect, cells);
    double& weight = weight_by_columns[cells.size()];
    weight += row_weight(cells, dialect.decimal_comma);
    most = std::max(most, weight);
    left -= 1.0;
    if (most + left < least) return {};
  }
  Score best;
  for (const auto& [columns, weight] : weight_by_columns) {
    if (weight > best.weight) best = {weight, columns};
  }
  return best;
}

/// A comma between digits may be all that a decimal comma needs; between columns it needs a quote or another sign
/// beside it.
bool is_worth_trying(const Dialect& dialect, std::string_view all) {
  const auto holds = [&](char c) { return all.find(c) != std::string_view::npos; };
  if (dialect.decimal_comma && !holds(',')) return false;
  if (dialect.comma_in_clock && !holds(':')) return false;
  if (dialect.delimiter == ',' && dialect.decimal_comma) return holds('"');
  if (dialect.delimiter == ' ') return holds(' ') || holds('\t');
  return dialect.delimiter == '\0' || holds(dialect.delimiter);
}

bool is_one_number(std::string_view line) {
  return read_cell(line, true).kind == CellKind::Number;
}

/// "0,51" below a single name ("Kraft [N]") is one number, not two columns.
bool is_single_column(const std::vector<std::string_view>& lines) {
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    if (!is_one_number(lines[i + 1])) continue;
    const ColumnName name = read_name(lines[i], {});
    return lines[i].find(',') == std::string_view::npos && (name.role != Role::Unknown || !name.unit.empty());
  }
  return false;
}

}  // namespace

std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::vector<std::string_view> choose_samples(const std::vector<std::string_view>& lines) {
  std::vector<std::string_view> with_digit;
  for (const std::string_view line : lines) {
    if (line.find_first_of("0123456789") != std::string_view::npos) with_digit.push_back(line);
  }
  const std::size_t last = with_digit.size() - std::min(with_digit.size(), kLinesTried / 2);
  const std::size_t stride = 1 + 2 * last / kLinesTried;
  std::vector<std::string_view> chosen;
  for (std::size_t i = 0; i < last; i += stride) chosen.push_back(with_digit[i]);
  chosen.insert(chosen.end(), with_digit.begin() + static_cast<std::ptrdiff_t>(last), with_digit.end());
  return chosen;
}

std::optional<Dialect> find_dialect(const std::vector<std::string_view>& lines) {
  const auto tried = choose_samples(lines);
  std::string all;
  for (const std::string_view line : tried) all.append(line);
  std::optional<Dialect> best;
  Score best_score;
  for (const Dialect& dialect : kDialects) {
    if (!is_worth_trying(dialect, all)) continue;
    const double equal_weight = best_score.weight * 0.999;
    const Score found = score(tried, dialect, equal_weight);
    const bool is_better = found.weight > best_score.weight * 1.001;
    const bool is_equal = found.weight > 0.0 && found.weight >= equal_weight;
    if (!is_better && !(is_equal && found.columns > best_score.columns)) continue;
    best = dialect;
    best_score = found;
  }
  const bool are_pairs = best && best->delimiter == ',' && !best->decimal_comma && best_score.columns == 2;
  if (are_pairs && std::ranges::any_of(tried, is_one_number) && is_single_column(lines)) {
    return Dialect{'\0', true};
  }
  return best;
}

bool is_comma_twice(const std::vector<std::string_view>& lines, const Layout& layout) {
  const std::size_t columns = layout.columns.size();
  const bool are_whole = std::ranges::all_of(
      layout.columns, [](const Column& column) { return column.is_whole && column.clocks == 0 && column.texts == 0; });
  if (layout.dialect.delimiter != ',' || layout.dialect.decimal_comma || !are_whole || columns < 3) return false;
  bool has_zero = false;  // "001" is no whole number that anybody writes
  for (std::size_t i = layout.first_data_line - 1; i < lines.size(); ++i) {
    if (lines[i].find('.') != std::string_view::npos) return false;
    for (const std::string_view cell : split(lines[i], layout.dialect)) {
      has_zero = has_zero || has_zero_in_front(cell);
    }
  }
  std::size_t above = layout.first_data_line - 1;
  while (above > 0 && trim(lines[above - 1]).empty()) --above;
  const std::size_t names = above > 0 ? split(lines[above - 1], layout.dialect).size() : 0;
  return names > 1 && names < columns ? columns == 2 * names || has_zero
                                      : has_zero && names != columns && columns % 2 == 0;
}

}  // namespace slipfit::reading
