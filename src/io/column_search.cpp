#include "io/column_search.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/thrown_error.hpp"
#include "core/word_list.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kMostListed = 24;

template <class Matches>
std::vector<std::size_t> columns_where(const Layout& layout, const Matches& matches) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    if (matches(layout.columns[c].name)) found.push_back(c);
  }
  return found;
}

std::vector<std::size_t> columns_called(const Layout& layout, const std::string& wanted) {
  if (wanted.empty()) return {};
  auto found = columns_where(layout, [&](const ColumnName& name) { return name.text == wanted; });
  if (found.empty()) {
    found = columns_where(layout, [&](const ColumnName& name) {
      return lower(name.text) == lower(wanted) || lower(name.base) == lower(wanted);
    });
  }
  return found;
}

}  // namespace

std::string describe(const Layout& layout, std::size_t column) {
  const std::string& name = layout.columns[column].name.text;
  return name.empty() ? fmt::format("column {}", column + 1) : fmt::format("column {} '{}'", column + 1, name);
}

std::string list_columns(const Layout& layout) {
  std::string list = layout.columns.size() == 1 ? "the only column is " : "the columns are ";
  for (std::size_t c = 0; c < layout.columns.size() && c < kMostListed; ++c) {
    const std::string& name = layout.columns[c].name.text;
    list += fmt::format("{}{}{}", c == 0 ? "" : ", ", c + 1, name.empty() ? "" : fmt::format(" '{}'", name));
  }
  if (layout.columns.size() > kMostListed) list += fmt::format(" and {} more", layout.columns.size() - kMostListed);
  return list + (layout.has_names ? "" : " (without names)");
}

std::size_t find_column_of_any(const Layout& layout, const std::string& wanted, const std::string& option,
                               const std::string& file) {
  auto found = columns_called(layout, printable(wanted));
  const auto place = place_in_list(wanted, layout.columns.size());
  if (found.empty() && place) found = {*place};
  if (found.empty()) {
    throw ThrownError({"unknown_column", fmt::format("{}: no column '{}'; {}; choose one with {}", file,
                                                     printable(wanted), list_columns(layout), option)});
  }
  if (found.size() > 1) {
    throw ThrownError({"unknown_column", fmt::format("{}: several columns are called '{}'; {}; give the number with {}",
                                                     file, printable(wanted), list_columns(layout), option)});
  }
  return found.front();
}

std::size_t find_column(const Layout& layout, const std::string& wanted, const std::string& option,
                        const std::string& file) {
  const std::size_t found = find_column_of_any(layout, wanted, option, file);
  if (layout.columns[found].may_be_numeric()) return found;
  throw ThrownError({"column_not_numeric", fmt::format("{}:{}: {} contains text, not numbers; choose another with {}",
                                                       file, layout.first_data_line, describe(layout, found), option)});
}

std::optional<std::size_t> find_time_column(const Layout& layout, const std::string& file) {
  auto found = best_columns(layout, [](const Column& column, std::size_t) {
    if (column.name.role != Role::Time || !column.may_be_numeric()) return 0;
    return column.name.rank + (column.never_decreases ? 8 : 0) +
           (column.name.unit.empty() && column.clocks == 0 ? 0 : 4);
  });
  const auto rises = [](const Column& column) {
    return column.name.role == Role::Unknown && column.is_numeric() && column.never_decreases;
  };
  const auto is_numeric = [](const Column& column) { return column.is_numeric(); };
  const bool is_alone = std::ranges::count_if(layout.columns, is_numeric) == 1;
  if (found.empty() && !is_alone) {
    // Monotonic columns are compared: a clock has even steps, and a column of integers with step one next to it
    // contains line numbers.
    found = best_columns(layout, [&](const Column& column, std::size_t) {
      const bool is_counter = column.is_whole && column.is_regular && column.median_step == 1.0;
      return !rises(column) ? 0 : is_counter ? 1 : column.is_regular ? 3 : 2;
    });
  }
  if (found.size() > 1) {
    throw ThrownError({"ambiguous_time_column",
                       fmt::format("{}: {} and {} may both be the time; {}; choose one with --time-column", file,
                                   describe(layout, found[0]), describe(layout, found[1]), list_columns(layout))});
  }
  return found.empty() ? std::nullopt : std::optional(found.front());
}

}  // namespace slipfit::reading
