#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "io/text_source.hpp"

namespace slipfit::reading {

/// The lines of a recording, one after the other. As io::LineReader, with which it shares its limits, but the line ends
/// are looked for with vector instructions, in a buffer that stays in the processor's cache.
class TextLines {
 public:
  explicit TextLines(std::unique_ptr<TextSource> source);

  /// The next line with a NUL in place of its LF or CRLF, until the next call; null behind the last one. Throws what
  /// the source throws, and io::error::line_length_limit_exceeded beyond 16 MB.
  const char* next();
  /// Returns the number of the latest line, from 1.
  [[nodiscard]] unsigned number() const { return number_; }

 private:
  void check_length(std::size_t length) const;
  void read_on();

  std::unique_ptr<TextSource> source_;
  std::string buffer_;  ///< always one byte longer than what is read
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  unsigned number_ = 0;
  bool ended_ = false;
};

}  // namespace slipfit::reading
