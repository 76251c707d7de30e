#pragma once

#include <catch2/catch.hpp>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace test {

/// Rows of a table of tests/reference by column name.
inline std::vector<std::map<std::string, double>> reference_rows(const std::string& name) {
  std::ifstream file(std::filesystem::path(SLIPFIT_REFERENCE_DIR) / name);
  std::vector<std::string> names;
  std::vector<std::map<std::string, double>> rows;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    std::stringstream fields(line);
    std::map<std::string, double> row;
    std::size_t column = 0;
    for (std::string field; std::getline(fields, field, ','); ++column) {
      if (rows.empty() && names.size() == column && std::isalpha(static_cast<unsigned char>(field[0])) != 0 &&
          field != "nan") {
        names.push_back(field);
      } else {
        row[names.at(column)] = std::strtod(field.c_str(), nullptr);
      }
    }
    if (!row.empty()) rows.push_back(row);
  }
  REQUIRE_FALSE(rows.empty());
  return rows;
}

}  // namespace test
