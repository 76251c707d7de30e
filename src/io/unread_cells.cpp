#include "io/unread_cells.hpp"

#include <algorithm>

#include "io/cells.hpp"
#include "io/decimal.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kLongest = 64;
constexpr std::size_t kMostShapes = 256;

/// Returns the shape of a cell, or an empty text if it does not look like a number.
std::string shape_of(std::string_view cell) {
  std::string shape;
  bool has_digit = false;
  for (const char c : cell) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (cell.size() > kLongest || c == ':' || c == '/' || (is_letter && c != 'e' && c != 'E')) return {};
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
