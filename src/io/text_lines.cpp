#include "io/text_lines.hpp"

#include <cstring>
#include <utility>

#include "io/line_reader.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kLineBuffer = std::size_t{256} * 1024;
constexpr std::size_t kMostInLine = std::size_t{16} * 1024 * 1024;

}  // namespace

TextLines::TextLines(std::unique_ptr<TextSource> source) : source_(std::move(source)), buffer_(kLineBuffer, '\0') {}

const char* TextLines::next() {
  std::size_t looked = begin_;
  for (;;) {
    char* const line = buffer_.data() + begin_;
    void* const found = std::memchr(buffer_.data() + looked, '\n', end_ - looked);
    if (found == nullptr && !ended_) {
      const std::size_t length = end_ - begin_;
      read_on();
      looked = begin_ + length;
      continue;
    }
    if (found == nullptr && begin_ == end_) return nullptr;
    char* end = found != nullptr ? static_cast<char*>(found) : buffer_.data() + end_;
    check_length(static_cast<std::size_t>(end - line));
    begin_ = found != nullptr ? static_cast<std::size_t>(end - buffer_.data()) + 1 : end_;
    ++number_;
    *end = '\0';
    if (end != line && end[-1] == '\r') end[-1] = '\0';
    return line;
  }
}

/// Checks the length of the line after the latest, or of its available part.
void TextLines::check_length(std::size_t length) const {
  if (length < kMostInLine) return;
  ::io::error::line_length_limit_exceeded error;
  error.set_file_line(static_cast<int>(number_ + 1));
  throw error;
}

/// The line that is not whole yet goes to the front.
void TextLines::read_on() {
  const std::size_t length = end_ - begin_;
  check_length(length);
  std::memmove(buffer_.data(), buffer_.data() + begin_, length);
  begin_ = 0;
  if (2 * length > buffer_.size()) buffer_.resize(2 * buffer_.size());
  const std::size_t room = buffer_.size() - 1 - length;
  const int got = source_->read(buffer_.data() + length, static_cast<int>(room));
  end_ = length + static_cast<std::size_t>(got);
  ended_ = static_cast<std::size_t>(got) < room;
}

}  // namespace slipfit::reading
