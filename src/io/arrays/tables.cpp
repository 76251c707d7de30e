#include "io/arrays/tables.hpp"
#include "io/container/formats.hpp"
#include "io/message.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace slipfit::reading {
namespace {

constexpr std::uint64_t kMostNumbers = std::uint64_t{1} << 28U;
constexpr std::uint64_t kMostColumns = 1024;
constexpr std::size_t kMostListed = 12;

std::uint64_t numbers_in(const TableShape& table) {
  std::uint64_t numbers = 0;
  for (const ArrayShape& array : table.arrays) numbers += array.length() * array.width();
  return numbers;
}

std::uint64_t columns_of(const TableShape& table) {
  std::uint64_t columns = 0;
  for (const ArrayShape& array : table.arrays) columns += array.width();
  return columns;
}

/// Vectors of one length in one group, the largest such set of each group.
std::vector<TableShape> tables_of(const std::vector<ArrayShape>& arrays) {
  std::vector<TableShape> tables;
  std::map<std::pair<std::string, std::uint64_t>, TableShape> vectors;
  for (const ArrayShape& array : arrays) {
    if (!array.is_vector()) {
      tables.push_back({array.name, {array}});
    } else {
      TableShape& together = vectors[{array.group, array.length()}];
      together.name = array.group.empty() ? "vectors of the file" : array.group;
      together.arrays.push_back(array);
    }
  }
  for (auto& [key, table] : vectors) tables.push_back(std::move(table));
  return tables;
}

bool is_better(const TableShape& a, const TableShape& b) {
  const bool a_is_table = columns_of(a) > 1;
  const bool b_is_table = columns_of(b) > 1;
  return a_is_table != b_is_table ? a_is_table : numbers_in(a) > numbers_in(b);
}

/// Returns true if --variable can name the table, by an array or by the group of its vectors.
bool can_be_named(const TableShape& table) {
  return table.arrays.size() == 1 || !table.arrays.front().group.empty();
}

bool is_too_large(const TableShape& table, std::uint64_t file_size) {
  const std::uint64_t numbers = numbers_in(table);
  return numbers > kMostNumbers || columns_of(table) > kMostColumns || is_bomb(8 * numbers, file_size);
}

TableShape wanted_table(const std::vector<ArrayShape>& arrays, const std::string& variable) {
  for (const ArrayShape& array : arrays) {
    if (is_called(array.name, variable)) return {array.name, {array}};
  }
  std::optional<TableShape> best;
  for (TableShape& table : tables_of(arrays)) {
    const std::string& group = table.arrays.front().group;
    if (group.empty() || !is_called(group, variable) || (best && !is_better(table, *best))) continue;
    best = std::move(table);
  }
  if (best) return *std::move(best);
  throw Refusal({"unknown_variable",
                 "the file contains no numbers in '" + variable + "' but in " +
                     listed(arrays.size(), kMostListed, [&](std::size_t i) { return "'" + arrays[i].name + "'"; }) +
                     "; choose one with --variable"});
}

}  // namespace

bool is_called(const std::string& name, std::string wanted) {
  if (name == wanted || name == "/" + wanted) return true;
  std::ranges::replace(wanted, '.', '/');
  return name == "/" + wanted;
}

TableShape choose_table(const std::vector<ArrayShape>& arrays, const std::optional<std::string>& variable,
                        std::uint64_t file_size) {
  if (arrays.empty()) {
    throw Refusal({"unknown_variable",
                   "the file contains no array of numbers (MATLAB tables and other objects are not read); export it as "
                   "a matrix or CSV"});
  }
  TableShape chosen;
  if (variable) {
    chosen = wanted_table(arrays, *variable);
  } else {
    auto tables = tables_of(arrays);
    chosen = *std::ranges::min_element(tables, is_better);
  }
  if (is_too_large(chosen, file_size)) {
    throw Refusal({"container_too_large",
                   "'" + chosen.name +
                       "' claims to contain far more than the file or than a recording; export a part of it as CSV"});
  }
  return chosen;
}

std::vector<std::string> recordable_tables(const std::vector<ArrayShape>& arrays, std::uint64_t file_size) {
  constexpr std::uint64_t kFewestRows = 16;  // of a recording
  std::map<std::string, TableShape> by_name;
  for (TableShape& table : tables_of(arrays)) {
    if (!can_be_named(table) || columns_of(table) < 2 || table.arrays.front().length() < kFewestRows) continue;
    const auto [place, is_new] = by_name.try_emplace(table.name, table);
    if (!is_new && is_better(table, place->second)) place->second = std::move(table);
  }
  if (by_name.empty() && !arrays.empty()) {
    const std::vector<TableShape> all = tables_of(arrays);
    const auto best = std::ranges::min_element(all, is_better);
    if (can_be_named(*best)) by_name.emplace(best->name, *best);
  }
  std::vector<std::string> names;
  for (const auto& [name, table] : by_name) {
    if (!is_too_large(table, file_size)) names.push_back(name);
  }
  return names;
}

void add_columns(NumberTable& table, const ArrayShape& shape, const std::vector<double>& values,
                 const std::string& name) {
  const auto length = static_cast<std::size_t>(shape.length());
  const auto width = static_cast<std::size_t>(shape.width());
  const bool rows_are_long = shape.rows >= shape.columns;
  for (std::size_t c = 0; c < width; ++c) {
    std::vector<double> column(length);
    for (std::size_t r = 0; r < length; ++r) column[r] = values[rows_are_long ? r * width + c : c * length + r];
    table.names.push_back(width == 1 ? name : std::string());
    table.columns.push_back(std::move(column));
  }
}

}  // namespace slipfit::reading
