#include "figures/table.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace slipfit::figures {

Table::Table(const std::vector<std::string>& comments, const std::vector<std::string>& columns)
    : columns_(columns.size()) {
  for (const std::string& comment : comments) csv_ += "# " + comment + "\n";
  csv_ += fmt::format("{}\n", fmt::join(columns, ","));
}

void Table::add(const std::vector<double>& row) {
  assert(row.size() == columns_);
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) csv_ += ',';
    if (std::isfinite(row[i])) csv_ += fmt::format("{}", row[i]);
  }
  csv_ += '\n';
}

}  // namespace slipfit::figures
