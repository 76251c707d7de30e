#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

#include "io/text_source.hpp"

namespace slipfit::reading {

/// A line of 16 MB or more, by its number. Thrown by TextLines and ParsedLines.
struct LineTooLong : std::runtime_error {
  explicit LineTooLong(unsigned line) : std::runtime_error("a line is longer than 16 MB"), number(line) {}
  unsigned number;
};

/// The lines of a manifest or a profile, one after the other, by the line reader of fast-cpp-csv-parser; its header is
/// included by text_lines.cpp alone.
class ParsedLines {
 public:
  explicit ParsedLines(std::unique_ptr<TextSource> source);
  ParsedLines(ParsedLines&&) noexcept;
  ParsedLines& operator=(ParsedLines&&) noexcept;
  ParsedLines(const ParsedLines&) = delete;
  ParsedLines& operator=(const ParsedLines&) = delete;
  ~ParsedLines();

  /// Returns the next line, as TextLines::next does.
  const char* next();
  /// Returns the number of the latest line, counted from 1.
  [[nodiscard]] unsigned number() const;

 private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
};

/// The lines of a recording, one after the other. As ParsedLines, with which it shares its limits, but the line ends
/// are looked for with vector instructions, in a buffer that stays in the processor's cache.
class TextLines {
 public:
  explicit TextLines(std::unique_ptr<TextSource> source);

  /// Returns the next line, in which a NUL replaces the LF or CRLF, or a null pointer after the last line. The line is
  /// valid until the next call. Throws what the source throws, and LineTooLong beyond 16 MB.
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
