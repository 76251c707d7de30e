#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "io/container/formats.hpp"
#include "io/container/zip_archive.hpp"
#include "io/message.hpp"

#ifdef SLIPFIT_HAS_ZIP
#include <minizip/unzip.h>
#endif

namespace slipfit::reading {

#ifdef SLIPFIT_HAS_ZIP

/// A file in memory for minizip.
struct MemoryFile {
  std::string content;
  std::size_t at = 0;
};

namespace {

MemoryFile& memory(voidpf file) {
  return *static_cast<MemoryFile*>(file);
}

unsigned long read_memory(voidpf /*opaque*/, voidpf file, void* buffer, unsigned long size) {
  const std::size_t count = memory(file).content.copy(static_cast<char*>(buffer), size, memory(file).at);
  memory(file).at += count;
  return count;
}

long seek_memory(voidpf /*opaque*/, voidpf file, ZPOS64_T offset, int origin) {
  const std::size_t size = memory(file).content.size();
  const std::size_t from = origin == ZLIB_FILEFUNC_SEEK_SET   ? 0
                           : origin == ZLIB_FILEFUNC_SEEK_CUR ? memory(file).at
                                                              : size;
  const ZPOS64_T to = from + offset;  // from the end it is below 0, which wraps to the same place
  if (to > size) return -1;
  memory(file).at = static_cast<std::size_t>(to);
  return 0;
}

unzFile open_in_memory(MemoryFile& content) {
  zlib_filefunc64_def functions{};
  functions.opaque = &content;
  functions.zopen64_file = [](voidpf opaque, const void* /*name*/, int /*mode*/) { return opaque; };
  functions.zread_file = read_memory;
  functions.zseek64_file = seek_memory;
  functions.ztell64_file = [](voidpf /*opaque*/, voidpf file) -> ZPOS64_T { return memory(file).at; };
  functions.zclose_file = [](voidpf /*opaque*/, voidpf /*file*/) { return 0; };
  functions.zerror_file = [](voidpf /*opaque*/, voidpf /*file*/) { return 0; };
  return unzOpen2_64("", &functions);
}

}  // namespace

struct ZipArchive::Handle {
  UnpackingLimit limit;  ///< of all members together
  MemoryFile content;
  unzFile file = nullptr;
  Handle(std::string bytes, const std::string& name)
      : limit(name, bytes.size()), content{std::move(bytes), 0}, file(open_in_memory(content)) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { unzClose(file); }
};

namespace {

constexpr std::size_t kMostMembers = 10000;

class MemberStream final : public ByteStream {
 public:
  /// `file` has the member open; `limit` belongs to the same archive and keeps it alive.
  MemberStream(unzFile file, std::shared_ptr<UnpackingLimit> limit, std::string name)
      : file_(file), limit_(std::move(limit)), name_(std::move(name)) {}

  std::size_t read(char* buffer, std::size_t size) override {
    std::size_t count = 0;
    while (count < size && !ended_) {
      const int got = unzReadCurrentFile(file_, buffer + count, static_cast<unsigned>(size - count));
      if (got < 0) throw damaged(name_, "the zip archive is damaged");
      count += static_cast<std::size_t>(got);
      ended_ = got == 0;
    }
    limit_->add_unpacked(count);
    if (ended_ && !checked_ && unzCloseCurrentFile(file_) == UNZ_CRCERROR) {
      throw damaged(name_, "the zip archive is damaged (checksum)");
    }
    checked_ = ended_;
    return count;
  }

 private:
  unzFile file_;
  std::shared_ptr<UnpackingLimit> limit_;
  std::string name_;
  bool ended_ = false;
  bool checked_ = false;
};

/// Hidden files and those that a Mac adds are none.
bool is_file(const ZipMember& member) {
  const std::string base = member.name.substr(member.name.rfind('/') + 1);
  return !base.empty() && base.front() != '.' && !member.name.starts_with("__MACOSX/");
}

}  // namespace

ZipArchive ZipArchive::open(std::string content, const std::string& name) {
  ZipArchive archive;
  archive.name_ = name;
  archive.handle_ = std::make_shared<Handle>(std::move(content), name);
  unzFile const file = archive.handle_->file;
  if (file == nullptr) throw damaged(name, "begins like a zip archive but is not one, or is truncated");
  for (int status = unzGoToFirstFile(file); status == UNZ_OK; status = unzGoToNextFile(file)) {
    unz_file_info64 info{};
    std::array<char, 1024> member{};
    if (unzGetCurrentFileInfo64(file, &info, member.data(), member.size() - 1, nullptr, 0, nullptr, 0) != UNZ_OK) {
      throw damaged(name, "the zip archive is damaged");
    }
    archive.places_.emplace(member.data(), archive.members_.size());
    archive.members_.push_back({member.data(), info.uncompressed_size});
    if (archive.members_.size() > kMostMembers) throw too_large(name);
  }
  return archive;
}

const ZipMember* ZipArchive::find(const std::string& member) const {
  const auto found = places_.find(member);
  return found == places_.end() ? nullptr : &members_[found->second];
}

std::unique_ptr<ByteStream> ZipArchive::stream(const std::string& member) const {
  unzFile const file = handle_->file;
  if (find(member) == nullptr || unzLocateFile(file, member.c_str(), 1) != UNZ_OK ||
      unzOpenCurrentFile(file) != UNZ_OK) {
    throw damaged(name_,
                  fmt::format("'{}' in it cannot be decompressed (encrypted, damaged, or not compressed with deflate)",
                              printable_utf8(member)));
  }
  return std::make_unique<MemberStream>(file, std::shared_ptr<UnpackingLimit>(handle_, &handle_->limit), name_);
}

std::string ZipArchive::content(const std::string& member, std::size_t most) const {
  auto text = read_all(*stream(member), most);
  if (!text) throw too_large(name_);
  return *std::move(text);
}

namespace {

std::vector<std::string> files_in(const ZipArchive& archive, const std::string& name) {
  std::vector<std::string> names;
  for (const ZipMember& member : archive.members()) {
    if (is_file(member)) names.push_back(member.name);
  }
  if (names.empty()) throw damaged(name, "the zip archive contains no file");
  return names;
}

TextStream text_of_member(const ZipArchive& archive, const std::string& member) {
  TextStream text;
  text.bytes = archive.stream(member);
  text.assumed.push_back(fmt::format("The file is a zip archive: '{}' was read.", printable_utf8(member)));
  return text;
}

}  // namespace

Container open_zip(TextStream packed, const std::string& name) {
  const auto archive = std::make_shared<const ZipArchive>(ZipArchive::open(read_all(packed, name), name));
  if (archive->find("xl/workbook.xml") != nullptr) return workbook_in(archive, name);
  const std::vector<std::string> names = files_in(*archive, name);
  const auto open = [=](const std::optional<std::string>& file) {
    if (names.size() > 1 && !file) {
      throw ThrownError(
          {"unknown_sheet",
           fmt::format("{}: the zip archive contains {} files ({}, {}, ...); unpack it, or choose one with --sheet",
                       name, names.size(), printable_utf8(names[0]), printable_utf8(names[1]))});
    }
    return text_of_member(*archive, names[file ? find_named(names, *file, name) : 0]);
  };
  return {open, [=] { return std::vector(names); }};
}

#else

Container open_zip(TextStream /*packed*/, const std::string& name) {
  throw not_built_in(name, "a zip archive or a workbook (.xlsx)", "zlib1g-dev, libminizip-dev and libpugixml-dev");
}

#endif

std::size_t find_named(const std::vector<std::string>& names, const std::string& wanted, const std::string& file) {
  const auto found = std::ranges::find(names, wanted);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  if (const auto place = place_in_list(wanted, names.size())) return *place;
  constexpr std::size_t kMostListed = 12;
  const auto text_of = [&](std::size_t i) { return fmt::format("{} '{}'", i + 1, printable_utf8(names[i])); };
  throw ThrownError({"unknown_sheet", fmt::format("{}: contains no '{}', only {}; choose one with --sheet", file,
                                                  printable_utf8(wanted), listed(names.size(), kMostListed, text_of))});
}

}  // namespace slipfit::reading
