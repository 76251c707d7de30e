#include "io/container/table_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>

namespace slipfit::reading {
namespace {

class StoredText final : public ByteStream {
 public:
  explicit StoredText(std::string text) : text_(std::move(text)) {}
  std::size_t read(char* buffer, std::size_t size) override {
    const std::size_t count = std::min(size, text_.size() - used_);
    std::memcpy(buffer, text_.data() + used_, count);
    used_ += count;
    return count;
  }

 private:
  std::string text_;
  std::size_t used_ = 0;
};

class TableText final : public ByteStream {
 public:
  explicit TableText(NumberTable table) : table_(std::move(table)) {
    for (const auto& column : table_.columns) rows_ = std::max(rows_, column.size());
    for (std::size_t c = 0; c < table_.names.size(); ++c) {
      pending_ += (c == 0 ? "" : ",") + csv_cell(table_.names[c]);
    }
    pending_ += '\n';
  }

  std::size_t read(char* buffer, std::size_t size) override {
    std::size_t count = 0;
    while (count < size) {
      if (used_ == pending_.size() && !next_rows()) break;
      const std::size_t part = std::min(size - count, pending_.size() - used_);
      std::memcpy(buffer + count, pending_.data() + used_, part);
      used_ += part;
      count += part;
    }
    return count;
  }

 private:
  bool next_rows() {
    constexpr std::size_t kRows = 1024;
    pending_.clear();
    used_ = 0;
    for (const std::size_t end = std::min(rows_, row_ + kRows); row_ < end; ++row_) {
      for (std::size_t c = 0; c < table_.columns.size(); ++c) {
        if (c > 0) pending_ += ',';
        if (row_ < table_.columns[c].size()) append(table_.columns[c][row_]);
      }
      pending_ += '\n';
    }
    return !pending_.empty();
  }

  void append(double value) {
    if (!std::isfinite(value)) {
      pending_ += "nan";
      return;
    }
    fmt::format_to(std::back_inserter(pending_), "{}", value);
  }

  NumberTable table_;
  std::string pending_;
  std::size_t used_ = 0;
  std::size_t row_ = 0;
  std::size_t rows_ = 0;
};

}  // namespace

std::unique_ptr<ByteStream> text_of(NumberTable table) {
  return std::make_unique<TableText>(std::move(table));
}

std::unique_ptr<ByteStream> text_of(std::string text) {
  return std::make_unique<StoredText>(std::move(text));
}

std::string csv_cell(std::string_view text) {
  std::string cell(text);
  for (char& c : cell) {
    if (static_cast<unsigned char>(c) < 0x20 || c == '"') c = ' ';
  }
  const bool is_plain = cell.find_first_of(",;\t") == std::string::npos;
  return is_plain ? cell : '"' + cell + '"';
}

}  // namespace slipfit::reading
