#include "io/container/formats.hpp"
#include "io/container/zip_archive.hpp"

#ifdef SLIPFIT_HAS_XLSX
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <pugixml.hpp>
#include <string_view>
#include <utility>

#include "io/container/excel_dates.hpp"
#include "io/container/table_text.hpp"
#include "io/message.hpp"
#endif

namespace slipfit::reading {

#ifdef SLIPFIT_HAS_XLSX
namespace {

constexpr std::size_t kMostSheetBytes = std::size_t{160} << 20U;  // pugixml needs some eight times this
constexpr std::size_t kMostPartBytes = std::size_t{32} << 20U;
constexpr std::size_t kMostColumns = 16384;  // of Excel

struct Sheet {
  std::string name;
  std::string path;
  std::uintmax_t bytes = 0;
};

struct Workbook {
  std::vector<Sheet> sheets;
  std::vector<std::string> strings;
  std::vector<DateStyle> styles;  ///< by the number of a cell's style
  DateSystem system = DateSystem::Since1900;
};

/// The tag without its namespace's prefix.
bool is(const pugi::xml_node& node, const char* tag) {
  const char* const colon = std::strrchr(node.name(), ':');
  return std::strcmp(colon == nullptr ? node.name() : colon + 1, tag) == 0;
}

pugi::xml_node child(const pugi::xml_node& parent, const char* tag) {
  return parent.find_child([tag](const pugi::xml_node& node) { return is(node, tag); });
}

/// All text below a node, phonetic hints aside.
std::string text_below(const pugi::xml_node& node) {
  std::string text;
  for (const pugi::xml_node part : node) {
    if (is(part, "t")) text += part.text().get();
    for (const pugi::xml_node piece : is(part, "r") ? part : pugi::xml_node()) {
      if (is(piece, "t")) text += piece.text().get();
    }
  }
  return text;
}

/// An empty document where the workbook has no such part.
Result<pugi::xml_document> part_of(const ZipArchive& archive, const std::string& path, std::size_t most,
                                   const std::string& name) {
  pugi::xml_document document;
  if (archive.find(path) == nullptr) return document;
  auto content = archive.content(path, most);
  if (!content) return content.error();
  const auto parsed = document.load_buffer(content.value().data(), content.value().size(), pugi::parse_minimal);
  if (!parsed) return damaged(name, fmt::format("'{}' of the workbook is damaged", path));
  return document;
}

std::vector<DateStyle> styles_of(const pugi::xml_document& document) {
  const pugi::xml_node root = document.document_element();
  std::vector<std::pair<unsigned, DateStyle>> formats;
  for (const pugi::xml_node format : child(root, "numFmts")) {
    formats.emplace_back(format.attribute("numFmtId").as_uint(), date_style(format.attribute("formatCode").value()));
  }
  std::vector<DateStyle> styles;
  for (const pugi::xml_node style : child(root, "cellXfs")) {
    const unsigned id = style.attribute("numFmtId").as_uint();
    const auto own = std::ranges::find_if(formats, [id](const auto& f) { return f.first == id; });
    styles.push_back(own == formats.end() ? built_in_date_style(id) : own->second);
  }
  return styles;
}

Result<Workbook> read_workbook(const ZipArchive& archive, const std::string& name) {
  const auto book = part_of(archive, "xl/workbook.xml", kMostPartBytes, name);
  if (!book) return book.error();
  const auto links = part_of(archive, "xl/_rels/workbook.xml.rels", kMostPartBytes, name);
  if (!links) return links.error();
  const auto strings = part_of(archive, "xl/sharedStrings.xml", kMostPartBytes, name);
  if (!strings) return strings.error();
  const auto styles = part_of(archive, "xl/styles.xml", kMostPartBytes, name);
  if (!styles) return styles.error();
  Workbook workbook;
  const pugi::xml_node root = book.value().document_element();
  if (child(root, "workbookPr").attribute("date1904").as_bool()) workbook.system = DateSystem::Since1904;
  for (const pugi::xml_node sheet : child(root, "sheets")) {
    const char* const id = sheet.attribute("r:id").value();
    const pugi::xml_node link = links.value().document_element().find_child_by_attribute("Id", id);
    const std::string target = link.attribute("Target").value();
    const std::string path = target.starts_with('/') ? target.substr(1) : "xl/" + target;
    const ZipMember* const member = archive.find(path);
    if (member != nullptr) workbook.sheets.push_back({sheet.attribute("name").value(), path, member->unpacked});
  }
  for (const pugi::xml_node string : strings.value().document_element()) workbook.strings.push_back(text_below(string));
  workbook.styles = styles_of(styles.value());
  return workbook;
}

/// 0-based column of "BC12"; `next` without a reference.
std::size_t column_of(const char* reference, std::size_t next) {
  std::size_t column = 0;
  const char* p = reference;
  for (; *p >= 'A' && *p <= 'Z' && column < kMostColumns; ++p)
    column = column * 26 + static_cast<std::size_t>(*p - 'A' + 1);
  return p == reference ? next : column - 1;
}

std::string cell_text(const pugi::xml_node& cell, const Workbook& workbook) {
  const std::string_view type = cell.attribute("t").value();
  if (type == "inlineStr") return csv_cell(text_below(child(cell, "is")));
  const char* const value = child(cell, "v").text().get();
  if (type == "s") {
    const auto at = static_cast<std::size_t>(std::strtoul(value, nullptr, 10));
    return at < workbook.strings.size() ? csv_cell(workbook.strings[at]) : std::string();
  }
  const std::size_t style = cell.attribute("s").as_uint();
  const DateStyle date = type.empty() || type == "n"
                             ? (style < workbook.styles.size() ? workbook.styles[style] : DateStyle::None)
                             : DateStyle::None;
  if (date == DateStyle::None) return csv_cell(value);
  return date_text(std::strtod(value, nullptr), date, workbook.system);
}

Result<std::string> sheet_text(const pugi::xml_document& sheet, const Workbook& workbook, const std::string& name) {
  std::string text;
  std::size_t width = 0;
  for (const pugi::xml_node row : child(sheet.document_element(), "sheetData")) {
    for (std::size_t next = 0; const pugi::xml_node cell : row) {
      next = column_of(cell.attribute("r").value(), next) + 1;
      width = std::max(width, next);
    }
  }
  if (width > kMostColumns) return damaged(name, "a cell of the sheet lies beyond the last column");
  std::vector<std::string> cells(width);
  for (const pugi::xml_node row : child(sheet.document_element(), "sheetData")) {
    std::size_t used = 0;
    for (std::size_t next = 0; const pugi::xml_node cell : row) {
      next = column_of(cell.attribute("r").value(), next) + 1;
      cells[next - 1] = cell_text(cell, workbook);
      used = std::max(used, next);
    }
    for (std::size_t c = 0; c < width; ++c) {
      if (c > 0) text += ',';
      if (c < used) text += cells[c];
      cells[c].clear();
    }
    text += '\n';
    if (text.size() > kMostSheetBytes) return too_large(name);
  }
  return text;
}

}  // namespace

Result<TextStream> open_workbook(const ZipArchive& archive, const std::string& name, const ContainerChoice& choice) {
  const auto workbook = read_workbook(archive, name);
  if (!workbook) return workbook.error();
  const std::vector<Sheet>& sheets = workbook.value().sheets;
  if (sheets.empty()) return damaged(name, "the workbook holds no sheet");
  std::vector<std::string> names;
  names.reserve(sheets.size());
  for (const Sheet& sheet : sheets) names.push_back(sheet.name);
  const auto largest =
      std::ranges::max_element(sheets, [](const Sheet& a, const Sheet& b) { return a.bytes < b.bytes; });
  const auto at = choice.sheet ? find_named(names, *choice.sheet, name)
                               : Result<std::size_t>(static_cast<std::size_t>(largest - sheets.begin()));
  if (!at) return at.error();
  const Sheet& chosen = sheets[at.value()];
  const auto document = part_of(archive, chosen.path, kMostSheetBytes, name);
  if (!document) return document.error();
  auto text = sheet_text(document.value(), workbook.value(), name);
  if (!text) return text.error();
  TextStream stream;
  stream.size = text.value().size();
  stream.bytes = text_of(std::move(text).value());
  stream.assumed.push_back(
      sheets.size() == 1 ? fmt::format("Sheet '{}' of the workbook was read.", printable(chosen.name))
                         : fmt::format("Sheet '{}' of {} in the workbook was read{}.", printable(chosen.name),
                                       sheets.size(), choice.sheet ? "" : " (the largest; --sheet takes another)"));
  return stream;
}

#else

Result<TextStream> open_workbook(const ZipArchive& /*archive*/, const std::string& name,
                                 const ContainerChoice& /*choice*/) {
  return not_built_in(name, "a workbook (.xlsx)", "libpugixml-dev");
}

#endif

}  // namespace slipfit::reading
