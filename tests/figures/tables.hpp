#pragma once

#include <map>
#include <string>
#include <vector>

namespace test {

/// A CSV table: the lines of comment, and the numbers by column (empty cell: nan).
struct Table {
  std::string comments;
  std::map<std::string, std::vector<double>> columns;

  [[nodiscard]] std::size_t rows() const;
};

/// Throws where a row has not as many cells as there are names.
Table parse_table(const std::string& csv);

/// The file of that name among the figures.
std::string figure_file(const std::string& name);
Table figure_table(const std::string& name);

}  // namespace test
