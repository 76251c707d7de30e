#include "io/text_source.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "io/message.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kProbe = std::size_t{64} * 1024;
constexpr std::size_t kPiece = std::size_t{256} * 1024;
constexpr char kNotText =
    '\x1A';  // replaces NUL: no number contains it, so the cell is counted as one without a number

bool holds_nul(std::string_view bytes) {
  return bytes.find('\0') != std::string_view::npos;
}

/// In pieces that a byte can count, which the compiler takes sixteen at a time.
template <class Predicate>
std::size_t count_bytes(std::string_view bytes, const Predicate& is_wanted) {
  constexpr std::size_t kPieceOfBytes = 255;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < bytes.size(); begin += kPieceOfBytes) {
    unsigned char in_piece = 0;
    for (const char c : bytes.substr(begin, kPieceOfBytes)) {
      if (is_wanted(static_cast<unsigned char>(c))) ++in_piece;
    }
    count += in_piece;
  }
  return count;
}

/// NUL, or more than a tenth of control characters, or, where it is no UTF-8 in any script, more than a third of bytes
/// beyond ASCII.
bool looks_binary(std::string_view bytes) {
  if (holds_nul(bytes)) return true;
  const auto is_control = [](unsigned char byte) {
    const bool is_blank = byte >= '\t' && byte <= '\r';
    return byte < 0x20 && !is_blank && byte != '\x1A';
  };
  const std::size_t control = count_bytes(bytes, is_control);
  const std::size_t high = count_bytes(bytes, [](unsigned char byte) { return byte >= 0x80; });
  return control * 10 > bytes.size() || (high * 3 > bytes.size() && check_utf8(bytes) == Utf8::Invalid);
}

/// Lone CR becomes LF; the CRs before a CRLF (files that went through two conversions) become blanks.
void unify_line_ends(char* begin, char* end, char next) {
  for (char* p = begin; (p = static_cast<char*>(std::memchr(p, '\r', static_cast<std::size_t>(end - p)))) != nullptr;) {
    char* run_end = p;
    while (run_end != end && *run_end == '\r') ++run_end;
    const char after = run_end == end ? next : *run_end;
    if (after == '\n') {
      std::fill(p, run_end - 1, ' ');
    } else {
      std::fill(p, run_end, '\n');
    }
    p = run_end;
  }
}

}  // namespace

std::unique_ptr<TextSource> TextSource::open(const std::filesystem::path& file) {
  return over(open_plain(file), name_of_file(file));
}

std::unique_ptr<TextSource> TextSource::over(TextStream stream, const std::string& name) {
  std::unique_ptr<TextSource> source(new TextSource);
  source->stream_ = std::move(stream);
  source->raw_.resize(kProbe);
  source->raw_.resize(source->stream_.bytes->read(source->raw_.data(), kProbe));
  if (source->raw_.empty()) throw ThrownError({"empty_file", name + ": the file is empty; export the recording again"});
  source->detect_encoding();
  if (!source->is_utf16() && looks_binary(source->raw_)) {
    throw ThrownError(
        {"binary_file",
         name + ": not a text file in UTF-8, Latin-1 or UTF-16 with a byte order mark; export it as CSV or text"});
  }
  if (source->is_utf16()) source->stream_.assumed.emplace_back("The text is in UTF-16.");
  source->estimated_size_ = source->is_utf16() ? source->stream_.size / 2 : source->stream_.size;
  return source;
}

/// Detects the encoding by the byte order mark, which is removed, or by a NUL next to every ASCII character.
void TextSource::detect_encoding() {
  const std::string_view start(raw_);
  std::array<std::size_t, 2> nul{};  // at even and at odd places
  if (holds_nul(start)) {
    for (std::size_t i = 0; i < start.size(); ++i) nul.at(i % 2) += start[i] == '\0' ? 1U : 0U;
  }
  if (start.starts_with("\xFF\xFE")) {
    encoding_ = Encoding::Utf16LittleEndian;
    raw_used_ = 2;
  } else if (start.starts_with("\xFE\xFF")) {
    encoding_ = Encoding::Utf16BigEndian;
    raw_used_ = 2;
  } else if (start.starts_with("\xEF\xBB\xBF")) {
    raw_used_ = 3;
  } else if (nul[0] == 0 && nul[1] * 10 > start.size() * 4) {
    encoding_ = Encoding::Utf16LittleEndian;
  } else if (nul[1] == 0 && nul[0] * 10 > start.size() * 4) {
    encoding_ = Encoding::Utf16BigEndian;
  }
}

std::size_t TextSource::read_raw(char* buffer, std::size_t size) {
  const std::size_t kept = std::min(size, raw_.size() - raw_used_);
  std::memcpy(buffer, raw_.data() + raw_used_, kept);
  raw_used_ += kept;
  if (kept == size) return size;
  return kept + stream_.bytes->read(buffer + kept, size - kept);
}

void TextSource::decode_utf16_chunk() {
  std::string chunk(kProbe, '\0');
  chunk.resize(read_raw(chunk.data(), chunk.size()));
  const std::size_t high = encoding_ == Encoding::Utf16LittleEndian ? 1 : 0;
  for (std::size_t i = 0; i + 1 < chunk.size(); i += 2) {
    append_utf8(pending_, static_cast<unsigned>(static_cast<unsigned char>(chunk[i + high]) << 8U) |
                              static_cast<unsigned char>(chunk[i + 1 - high]));
  }
}

std::size_t TextSource::decode(char* buffer, std::size_t size) {
  while (is_utf16() && pending_.size() < size) {
    const std::size_t before = pending_.size();
    decode_utf16_chunk();
    if (pending_.size() == before) break;
  }
  const std::size_t kept = std::min(size, pending_.size());
  std::memcpy(buffer, pending_.data(), kept);
  pending_.erase(0, kept);
  return is_utf16() ? kept : kept + read_raw(buffer + kept, size - kept);
}

std::size_t TextSource::fill(char* buffer, std::size_t size) {
  if (ended_ || size == 0) return 0;
  std::size_t count = decode(buffer, size);
  char next = '\0';
  if (count == size && buffer[count - 1] == '\r' && decode(&next, 1) == 1) pending_.insert(0, 1, next);
  if (std::memchr(buffer, '\0', count) != nullptr) std::replace(buffer, buffer + count, '\0', kNotText);
  unify_line_ends(buffer, buffer + count, next);
  if (count > 0) last_ = buffer[count - 1];
  if (count < size) {
    ended_ = true;
    if (last_ != '\n') buffer[count++] = '\n';
  }
  return count;
}

std::string_view TextSource::head(std::size_t size) {
  const std::size_t before = head_.size();
  if (size > before) {
    head_.resize(size);
    head_.resize(before + fill(head_.data() + before, size - before));
  }
  return head_;
}

int TextSource::read(char* buffer, int size) {
  const auto wanted = static_cast<std::size_t>(size);
  std::size_t count = std::min(wanted, head_.size() - head_used_);
  std::memcpy(buffer, head_.data() + head_used_, count);
  head_used_ += count;
  while (count < wanted) {  // in pieces that are still in the cache when they are looked through
    const std::size_t got = fill(buffer + count, std::min(wanted - count, kPiece));
    count += got;
    if (got == 0) break;
  }
  return static_cast<int>(count);
}

}  // namespace slipfit::reading
