#include "io/container/kept_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include "core/platform.hpp"
#include "io/container/formats.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

constexpr std::uintmax_t kMostKept = std::uintmax_t{1} << 30U;  // larger files are read for each table

/// The bytes of a file in memory, which others read, too.
class MemoryStream final : public ByteStream {
 public:
  MemoryStream(std::shared_ptr<const void> owner, int file) : owner_(std::move(owner)), file_(file) {}
  std::size_t read(char* buffer, std::size_t size) override {
    std::size_t count = 0;
    while (count < size) {
      const ::ssize_t got = ::pread(file_, buffer + count, size - count, static_cast<::off_t>(place_));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw std::system_error(errno, std::generic_category(), "reading failed");
      if (got == 0) break;
      count += static_cast<std::size_t>(got);
      place_ += static_cast<std::size_t>(got);
    }
    return count;
  }

 private:
  std::shared_ptr<const void> owner_;
  int file_;
  std::size_t place_ = 0;
};

}  // namespace

FileHandle file_in_memory(ByteStream& stream, const std::string& name) {
  constexpr std::size_t kMostBytes = std::size_t{2} << 30U;
  FileHandle file(platform::open_nameless_file());
  if (!file) throw too_large(name);
  std::vector<char> piece(std::size_t{256} * 1024);
  std::size_t size = 0;
  while (const std::size_t got = stream.read(piece.data(), piece.size())) {
    size += got;
    if (size > kMostBytes) throw too_large(name);
    for (std::size_t written = 0; written < got;) {
      const ::ssize_t count = ::write(file.get(), piece.data() + written, got - written);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) throw too_large(name);
      written += static_cast<std::size_t>(count);
    }
  }
  (void)::lseek(file.get(), 0, SEEK_SET);  // a program may inherit the place
  return file;
}

TextStream KeptFile::open(const std::filesystem::path& file) {
  std::error_code no_size;
  std::error_code no_time;
  const std::uintmax_t size = std::filesystem::file_size(file, no_size);
  const auto changed = std::filesystem::last_write_time(file, no_time);
  if (no_size || no_time || size > kMostKept) return open_plain(file);
  if (!bytes_ || path_ != file || size_ != size || changed_ != changed) {
    bytes_.reset();
    TextStream plain = open_plain(file);
    FileHandle memory = file_in_memory(*plain.bytes, name_of_file(file));
    bytes_ = std::make_shared<const Bytes>(Bytes{std::move(memory), plain.digester, plain.start});
    path_ = file;
    size_ = size;
    changed_ = changed;
  }
  TextStream stream;
  stream.memory = std::shared_ptr<const FileHandle>(bytes_, &bytes_->memory);
  stream.bytes = std::make_unique<MemoryStream>(stream.memory, stream.memory->get());
  stream.digester = bytes_->digester;
  stream.size = static_cast<std::size_t>(size);
  stream.start = bytes_->start;
  return stream;
}

}  // namespace slipfit::reading
