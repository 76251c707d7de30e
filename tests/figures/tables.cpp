#include "tables.hpp"

#include <limits>
#include <sstream>
#include <stdexcept>

#include "slipfit/figures/figures.hpp"

namespace test {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char letter : line) {
    if (letter == ',') {
      cells.emplace_back();
    } else {
      cells.back() += letter;
    }
  }
  return cells;
}

}  // namespace

std::size_t Table::rows() const {
  return columns.empty() ? 0 : columns.begin()->second.size();
}

Table parse_table(const std::string& csv) {
  Table table;
  std::vector<std::string> names;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("# ", 0) == 0) {
      table.comments += line + "\n";
      continue;
    }
    const std::vector<std::string> cells = cells_of(line);
    if (names.empty()) {
      names = cells;
      continue;
    }
    if (cells.size() != names.size()) throw std::runtime_error("cells and names differ: " + line);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      table.columns[names[i]].push_back(cells[i].empty() ? std::numeric_limits<double>::quiet_NaN()
                                                         : std::stod(cells[i]));
    }
  }
  return table;
}

std::string figure_file(const std::string& name) {
  for (const slipfit::FigureFile& file : slipfit::paper_figures()) {
    if (file.name == name) return file.content;
  }
  throw std::runtime_error("no figure file " + name);
}

Table figure_table(const std::string& name) {
  return parse_table(figure_file(name));
}

}  // namespace test
