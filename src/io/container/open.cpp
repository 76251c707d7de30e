#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

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

ThrownError open_error(const std::string& name, int reason) {
  if (reason == ENOENT || reason == ENOTDIR) {
    return ThrownError({"file_not_found", name + ": no such file; check the path"});
  }
  return ThrownError(
      {"not_readable", name + ": cannot be opened (" + std::strerror(reason) + "); check the permissions"});
}

/// A kind of file by its first bytes, and the option that chooses a table in it.
struct Format {
  std::string_view magic;
  std::size_t offset = 0;
  OpenFormat* open = nullptr;
  std::string_view kind;
  std::optional<std::string> ReadOptions::*choice = nullptr;
};

using namespace std::string_view_literals;
constexpr std::array kFormats = std::to_array<Format>({
    {"\x1F\x8B"sv, 0, open_gzip, "text compressed with gzip"},
    {"PK\x03\x04"sv, 0, open_zip, "a workbook or a zip archive", &ReadOptions::sheet},
    {"TDSm"sv, 0, open_tdms, "a TDMS file", &ReadOptions::variable},
    {"\x89HDF\r\n\x1a\n"sv, 0, open_hdf5, "an HDF5 file", &ReadOptions::variable},
    {"MATLAB 5.0 MAT-file"sv, 0, open_mat, "a MATLAB file", &ReadOptions::variable},
    {"\x89HDF\r\n\x1a\n"sv, 512, open_hdf5, "a MATLAB file", &ReadOptions::variable},  // after the user's own block
    {"\x93NUMPY"sv, 0, open_npy, "an array of NumPy"},
    {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv, 0, open_old_workbook, {}},
    {{}, 0, [](TextStream text, const std::string&) { return one_table(std::move(text)); }, "plain text"},
});

struct TableOption {
  std::optional<std::string> ReadOptions::*choice = nullptr;
  std::string_view name;
  std::string_view tables;
};
constexpr std::array<TableOption, 2> kTableOptions{
    {{&ReadOptions::sheet, "--sheet", "sheets"}, {&ReadOptions::variable, "--variable", "variables"}}};

/// An option that has no meaning in this kind of file is no option to leave unread.
void check_choice(std::optional<std::string> ReadOptions::*choice, std::string_view kind, const ReadOptions& options,
                  const std::string& name) {
  for (const TableOption& given : kTableOptions) {
    if (!(options.*given.choice) || choice == given.choice) continue;
    const auto* const other = std::ranges::find(kTableOptions, choice, &TableOption::choice);
    const std::string advice =
        other == kTableOptions.end() ? std::string() : fmt::format(" (or choose with {})", other->name);
    throw ThrownError({"no_container", fmt::format("{}: is {}, which has no {}; leave out {}{}", name, kind,
                                                   given.tables, given.name, advice)});
  }
}

}  // namespace

ThrownError damaged(const std::string& name, const std::string& what) {
  return ThrownError({"damaged_container", fmt::format("{}: {}; copy or export the file again", name, what)});
}

ThrownError too_large(const std::string& name) {
  return ThrownError(
      {"container_too_large",
       name + ": decompresses to far more than a recording; decompress it yourself and give the file in it"});
}

ThrownError not_built_in(const std::string& name, const std::string& kind, const std::string& package) {
  return ThrownError(
      {"not_built_in", fmt::format("{}: {}, which this build of slipfit cannot read; export it as CSV, or build "
                                   "slipfit with Debian's {}",
                                   name, kind, package)});
}

TextStream open_plain(const std::filesystem::path& file) {
  constexpr std::size_t kStart = 1024;
  const std::string name = name_of_file(file);
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw ThrownError({"is_directory", name + ": is a folder; give a file in it"});
  }
  std::FILE* const opened = file == "-" ? ::fdopen(::dup(STDIN_FILENO), "rb") : std::fopen(file.c_str(), "rb");
  if (opened == nullptr) throw open_error(name, errno);
  std::string start(kStart, '\0');
  start.resize(std::fread(start.data(), 1, kStart, opened));
  if (std::ferror(opened) != 0) {
    const int reason = errno;
    std::fclose(opened);
    throw open_error(name, reason);
  }
  auto digester = std::make_shared<Digester>();
  TextStream stream;
  stream.bytes = std::make_unique<FileStream>(opened, start, digester);
  stream.digester = std::move(digester);
  stream.start = std::move(start);
  const auto size = std::filesystem::file_size(file, ignored);
  if (!ignored) stream.size = static_cast<std::size_t>(size);
  return stream;
}

Container open_old_workbook(TextStream /*packed*/, const std::string& name) {
  throw ThrownError(
      {"old_workbook",
       name + ": a workbook in the format used before 2007 (.xls) or a similar document; save it as .xlsx or CSV"});
}

Container one_table(TextStream text) {
  return {[kept = std::make_shared<TextStream>(std::move(text))](const auto&) { return std::move(*kept); }};
}

Container open_container(TextStream file, const std::string& name, const ReadOptions& options) {
  const std::string_view start = file.start;
  const Format& format = *std::ranges::find_if(kFormats, [start](const Format& one) {
    return start.size() >= one.offset && start.substr(one.offset).starts_with(one.magic);
  });
  check_choice(format.choice, format.kind, options, name);
  auto digester = file.digester;
  Container container = format.open(std::move(file), name);
  container.choice = format.choice;
  container.kind = format.kind;
  container.digester = std::move(digester);
  return container;
}

TextStream table_in(const Container& container, const std::string& name, const ReadOptions& options) {
  check_choice(container.choice, container.kind, options, name);
  TextStream text = container.open(container.choice == nullptr ? std::nullopt : options.*container.choice);
  text.digester = container.digester;
  return text;
}

std::optional<std::string> read_all(ByteStream& stream, std::size_t most) {
  constexpr std::size_t kPiece = std::size_t{256} * 1024;
  std::string content;
  for (std::size_t got = kPiece; got == kPiece;) {
    const std::size_t before = content.size();
    content.resize(before + kPiece);
    got = stream.read(content.data() + before, kPiece);
    content.resize(before + got);
    if (content.size() > most) return std::nullopt;
  }
  return content;
}

std::string read_all(TextStream& packed, const std::string& name) {
  auto content = read_all(*packed.bytes, std::size_t{2} << 30U);
  if (!content) throw too_large(name);
  return *std::move(content);
}

}  // namespace slipfit::reading
