#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/container/formats.hpp"
#include "slipfit/core/digest.hpp"

namespace slipfit::reading {

/// The bytes of a text file as the readers of lines take them: UTF-8 or Latin-1 (UTF-16 is converted), no byte order
/// mark, lines that end in LF or CRLF (a lone CR becomes LF), no NUL, and a line end after the last line. (The line
/// reader of fast-cpp-csv-parser cuts lines at NUL, and without a final line end it reads one byte past the data.)
/// `read` throws std::system_error when the disk fails, and so do ParsedLines and TextLines.
class TextSource {
 public:
  /// Opens a text. Errors: file_not_found, is_directory, not_readable, empty_file, binary_file.
  static std::unique_ptr<TextSource> open(const std::filesystem::path& file);
  /// Reads the text of an open file; messages show `name`. Errors: empty_file, binary_file.
  static std::unique_ptr<TextSource> over(TextStream stream, const std::string& name);

  /// The first `size` bytes of the text (fewer when there are no more), without consuming them.
  std::string_view head(std::size_t size);
  /// Returns true if the last `head` contains the whole text.
  [[nodiscard]] bool head_is_everything() const { return ended_; }
  /// Returns the approximate size of the text; 0 if the file does not state it (a pipe).
  [[nodiscard]] std::size_t estimated_size() const { return estimated_size_; }
  /// Sentences about what the text was packed in, and its encoding.
  [[nodiscard]] const std::vector<std::string>& assumed() const { return stream_.assumed; }
  [[nodiscard]] const Warnings& warnings() const { return stream_.warnings; }
  /// Returns the digest of the bytes of the file as they are read; it outlives the source, which a reader of lines
  /// takes.
  [[nodiscard]] std::shared_ptr<const Digester> digester() const { return stream_.digester; }
  [[nodiscard]] bool is_utf16() const { return encoding_ != Encoding::Bytes; }

  int read(char* buffer, int size);

 private:
  enum class Encoding { Bytes, Utf16LittleEndian, Utf16BigEndian };

  TextSource() = default;
  void detect_encoding();
  std::size_t read_raw(char* buffer, std::size_t size);
  std::size_t decode(char* buffer, std::size_t size);
  void decode_utf16_chunk();
  std::size_t fill(char* buffer, std::size_t size);

  TextStream stream_;
  Encoding encoding_ = Encoding::Bytes;
  std::string raw_;  ///< read while opening
  std::size_t raw_used_ = 0;
  std::string pending_;  ///< decoded, not yet handed out
  std::string head_;
  std::size_t head_used_ = 0;
  std::size_t estimated_size_ = 0;
  char last_ = '\n';
  bool ended_ = false;
};

}  // namespace slipfit::reading
