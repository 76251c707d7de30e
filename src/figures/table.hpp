#pragma once

#include <string>
#include <vector>

namespace slipfit::figures {

/// A CSV table of numbers under lines of comment; what is not finite becomes an empty cell.
class Table {
 public:
  Table(const std::vector<std::string>& comments, const std::vector<std::string>& columns);
  void add(const std::vector<double>& row);
  [[nodiscard]] const std::string& csv() const { return csv_; }

 private:
  std::size_t columns_ = 0;
  std::string csv_;
};

}  // namespace slipfit::figures
