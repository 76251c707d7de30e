#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "io/container/formats.hpp"

namespace slipfit::reading {

struct ZipMember {
  std::string name;
  std::uintmax_t stated_bytes = 0;  ///< unpacked size by the archive's directory, which may be wrong
};

/// A zip archive open for reading, over minizip.
class ZipArchive {
 public:
  /// Opens an archive from its bytes. Errors: damaged_container, container_too_large.
  static ZipArchive open(std::string content, const std::string& name);

  [[nodiscard]] const std::vector<ZipMember>& members() const { return members_; }
  [[nodiscard]] const ZipMember* find(const std::string& member) const;
  /// One at a time; it keeps what the archive rests on.
  [[nodiscard]] std::unique_ptr<ByteStream> stream(const std::string& member) const;
  /// The whole of a member of at most `most` bytes. Errors: damaged_container, container_too_large.
  [[nodiscard]] std::string content(const std::string& member, std::size_t most) const;

 private:
  struct Handle;
  std::shared_ptr<Handle> handle_;
  std::string name_;
  std::vector<ZipMember> members_;
  std::unordered_map<std::string, std::size_t> places_;  ///< index into members_ by name
};

/// A workbook (.xlsx), whose sheets are read as CSV. Errors: damaged_container, container_too_large, unknown_sheet,
/// not_built_in.
Container workbook_in(const std::shared_ptr<const ZipArchive>& archive, const std::string& name);

/// The place of a part by its name, else by its 1-based number. Error: unknown_sheet, with the names listed.
std::size_t find_named(const std::vector<std::string>& names, const std::string& wanted, const std::string& file);

}  // namespace slipfit::reading
