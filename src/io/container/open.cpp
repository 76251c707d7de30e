#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/container/byte_stream.hpp"
#include "io/container/formats.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// The first bytes may be looked at before they are read.
class FileStream final : public ByteStream {
 public:
  FileStream(std::FILE* file, std::string start, std::shared_ptr<Digester> digester)
      : file_(file), start_(std::move(start)), digester_(std::move(digester)) {
    digester_->add(start_);
  }
  std::size_t read(char* buffer, std::size_t size) override {
    const std::size_t kept = std::min(size, start_.size() - used_);
    std::memcpy(buffer, start_.data() + used_, kept);
    used_ += kept;
    if (kept == size) return size;
    const std::size_t got = std::fread(buffer + kept, 1, size - kept, file_.get());
    if (std::ferror(file_.get()) != 0) throw std::system_error(errno, std::generic_category(), "reading failed");
    digester_->add({buffer + kept, got});
    return kept + got;
  }

 private:
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::string start_;
  std::size_t used_ = 0;
  std::shared_ptr<Digester> digester_;
};

Error open_error(const std::string& name, int reason) {
  if (reason == ENOENT || reason == ENOTDIR) return {"file_not_found", name + ": no such file; check the path"};
  return {"not_readable", name + ": cannot be opened (" + std::strerror(reason) + "); check the permissions"};
}

struct OpenedBytes {
  TextStream stream;
  std::string start;
};

Result<OpenedBytes> open_bytes(const std::filesystem::path& file) {
  constexpr std::size_t kStart = 1024;
  const std::string name = printable(file.string());
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    return Error{"is_directory", name + ": is a folder; name a file in it"};
  }
  std::FILE* const opened = std::fopen(file.c_str(), "rb");
  if (opened == nullptr) return open_error(name, errno);
  std::string start(kStart, '\0');
  start.resize(std::fread(start.data(), 1, kStart, opened));
  if (std::ferror(opened) != 0) {
    const int reason = errno;
    std::fclose(opened);
    return open_error(name, reason);
  }
  auto digester = std::make_shared<Digester>();
  OpenedBytes bytes{{std::make_unique<FileStream>(opened, start, digester), digester, 0, {}}, start};
  const auto size = std::filesystem::file_size(file, ignored);
  if (!ignored) bytes.stream.size = static_cast<std::size_t>(size);
  return bytes;
}

/// Containers that are read here and there instead of from front to end: the digest is made first.
std::uintmax_t digest_all(ByteStream& bytes) {
  std::vector<char> piece(std::size_t{256} * 1024);
  std::uintmax_t size = 0;
  while (const std::size_t got = bytes.read(piece.data(), piece.size())) size += got;
  return size;
}

using OpenFormat = Result<TextStream> (*)(const ContainerFile&, const ContainerChoice&);

struct Format {
  std::string_view magic;
  std::size_t offset = 0;
  OpenFormat open = nullptr;
};

using namespace std::string_view_literals;
constexpr std::array kFormats = std::to_array<Format>({
    {"PK\x03\x04"sv, 0, open_zip},
    {"TDSm"sv, 0, open_tdms},
    {"\x89HDF\r\n\x1a\n"sv, 0, open_hdf5},
    {"MATLAB 5.0 MAT-file"sv, 0, open_mat},
    {"\x89HDF\r\n\x1a\n"sv, 512, open_hdf5},  // behind a block of the user's own: MATLAB 7.3
    {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv, 0, open_old_workbook},
});

}  // namespace

Result<TextStream> open_plain(const std::filesystem::path& file) {
  auto opened = open_bytes(file);
  if (!opened) return opened.error();
  return std::move(opened).value().stream;
}

Result<TextStream> open_unpacked(const std::filesystem::path& file, const ContainerChoice& choice) {
  auto opened = open_bytes(file);
  if (!opened) return opened.error();
  OpenedBytes bytes = std::move(opened).value();
  const std::string name = printable(file.string());
  if (bytes.start.starts_with("\x1F\x8B")) return unpack_gzip(std::move(bytes.stream), name);
  for (const Format& format : kFormats) {
    if (bytes.start.size() < format.offset ||
        !std::string_view(bytes.start).substr(format.offset).starts_with(format.magic)) {
      continue;
    }
    const std::uintmax_t size = digest_all(*bytes.stream.bytes);
    auto unpacked = format.open({file, name, size}, choice);
    if (!unpacked) return unpacked;
    TextStream text = std::move(unpacked).value();
    text.digester = bytes.stream.digester;
    return text;
  }
  return std::move(bytes.stream);
}

}  // namespace slipfit::reading
