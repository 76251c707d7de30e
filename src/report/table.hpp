#pragma once

#include <string>
#include <vector>

namespace slipfit {

enum class Align { Left, Right };

/// Lines of cells in columns that are as wide as their widest cell, two blanks apart, indented by two.
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

}  // namespace slipfit
