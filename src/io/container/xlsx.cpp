#include "io/container/formats.hpp"
#include "io/container/zip_archive.hpp"

#ifdef SLIPFIT_HAS_XLSX
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <pugixml.hpp>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "io/container/table_text.hpp"
#include "io/container/xml.hpp"
#include "io/message.hpp"
#endif

namespace slipfit::reading {

#ifdef SLIPFIT_HAS_XLSX
namespace {

constexpr std::size_t kMostSheetBytes = std::size_t{160} << 20U;
constexpr std::size_t kMostPartBytes = std::size_t{32} << 20U;
constexpr std::size_t kMostColumns = 16384;  // of Excel
constexpr std::size_t kMostRows = 1048576;   // of Excel
constexpr std::size_t kMostSheets = 4096;

/// The meaning of a number according to the style of its cell.
enum class DateStyle { None, Date, Clock };

/// The day that number 0 represents.
enum class DateSystem { Since1900, Since1904 };

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
pugi::xml_document part_of(const ZipArchive& archive, const std::string& path, std::size_t most,
                           const std::string& name) {
  if (archive.find(path) == nullptr) return {};
  auto document = parse_xml(archive.content(path, most), pugi::parse_minimal, name);
  if (!document) throw damaged(name, fmt::format("'{}' of the workbook is damaged", path));
  return *std::move(document);
}

/// Returns the style of one of Excel's own formats by its number (ECMA-376 part 1, 18.8.30).
DateStyle built_in_date_style(unsigned format) {
  if ((format >= 18 && format <= 21) || (format >= 45 && format <= 47)) return DateStyle::Clock;
  return format >= 14 && format <= 22 ? DateStyle::Date : DateStyle::None;
}

/// Returns the style of a format such as "yyyy-mm-dd hh:mm" or "[h]:mm:ss.000".
DateStyle date_style(std::string_view format) {
  bool has_clock = false;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] == '"') {
      i = std::min(format.find('"', i + 1), format.size());
      continue;
    }
    if (format[i] == '\\') {
      ++i;
      continue;
    }
    if (format[i] == '[' && format.substr(i + 1, 1).find_first_of("hHmMsS") == std::string_view::npos) {
      i = std::min(format.find(']', i), format.size());  // a colour or a locale
      continue;
    }
    const char letter = static_cast<char>(std::tolower(static_cast<unsigned char>(format[i])));
    if (letter == 'y' || letter == 'd') return DateStyle::Date;
    has_clock = has_clock || letter == 'h' || letter == 's';
  }
  return has_clock ? DateStyle::Clock : DateStyle::None;
}

/// Days as "2024-05-12 12:22:17.581000", or as hours, minutes and seconds; to the microsecond, which is what a double
/// holds of a date.
std::string date_text(double days, DateStyle style, DateSystem system) {
  constexpr double kMostDays = 2958466.0;  // the year 9999
  constexpr long long kDay_us = 86400LL * 1000000;
  if (!(days >= 0.0 && days < kMostDays)) return "nan";
  const auto microseconds = std::llround(days * static_cast<double>(kDay_us));
  const auto clock = [](long long us) {
    return fmt::format("{:02}:{:02}:{:02}.{:06}", us / 3600000000, us / 60000000 % 60, us / 1000000 % 60, us % 1000000);
  };
  if (style == DateStyle::Clock) return clock(microseconds);
  using namespace std::chrono;
  const sys_days zero = system == DateSystem::Since1900 ? sys_days{year{1899} / 12 / 30} : sys_days{year{1904} / 1 / 1};
  const year_month_day day{zero + std::chrono::days{microseconds / kDay_us}};
  return fmt::format("{:04}-{:02}-{:02} {}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                     static_cast<unsigned>(day.day()), clock(microseconds % kDay_us));
}

std::vector<DateStyle> styles_of(const pugi::xml_document& document) {
  const pugi::xml_node root = document.document_element();
  std::unordered_map<unsigned, DateStyle> formats;
  for (const pugi::xml_node format : child(root, "numFmts")) {
    formats.emplace(format.attribute("numFmtId").as_uint(), date_style(format.attribute("formatCode").value()));
  }
  std::vector<DateStyle> styles;
  for (const pugi::xml_node style : child(root, "cellXfs")) {
    const unsigned id = style.attribute("numFmtId").as_uint();
    const auto own = formats.find(id);
    styles.push_back(own == formats.end() ? built_in_date_style(id) : own->second);
  }
  return styles;
}

/// The sheets that the workbook lists and the archive has. Error: damaged_container.
std::vector<Sheet> sheets_of(const ZipArchive& archive, const pugi::xml_document& book, const pugi::xml_document& links,
                             const std::string& name) {
  std::unordered_map<std::string_view, std::string> targets;  // by id
  for (const pugi::xml_node link : links.document_element()) {
    targets.emplace(link.attribute("Id").value(), link.attribute("Target").value());
  }
  std::vector<Sheet> sheets;
  std::size_t listed = 0;
  for (const pugi::xml_node sheet : child(book.document_element(), "sheets")) {
    if (++listed > kMostSheets) {
      throw damaged(name, fmt::format("the workbook lists more than {} sheets", kMostSheets));
    }
    const std::string& target = targets[sheet.attribute("r:id").value()];
    const std::string path = target.starts_with('/') ? target.substr(1) : "xl/" + target;
    const ZipMember* const member = archive.find(path);
    if (member != nullptr) sheets.push_back({sheet.attribute("name").value(), path, member->stated_bytes});
  }
  return sheets;
}

Workbook read_workbook(const ZipArchive& archive, const std::string& name) {
  const auto part = [&](const char* path) { return part_of(archive, path, kMostPartBytes, name); };
  const pugi::xml_document book = part("xl/workbook.xml");
  const pugi::xml_document links = part("xl/_rels/workbook.xml.rels");
  const pugi::xml_document strings = part("xl/sharedStrings.xml");
  Workbook workbook;
  const pugi::xml_node root = book.document_element();
  if (child(root, "workbookPr").attribute("date1904").as_bool()) workbook.system = DateSystem::Since1904;
  workbook.sheets = sheets_of(archive, book, links, name);
  for (const pugi::xml_node string : strings.document_element()) workbook.strings.push_back(text_below(string));
  workbook.styles = styles_of(part("xl/styles.xml"));
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

std::string sheet_text(const pugi::xml_document& sheet, const Workbook& workbook, const std::string& name) {
  std::string text;
  std::size_t width = 0;
  std::size_t rows = 0;
  for (const pugi::xml_node row : child(sheet.document_element(), "sheetData")) {
    if (++rows > kMostRows) throw damaged(name, fmt::format("the sheet has more than {} rows", kMostRows));
    for (std::size_t next = 0; const pugi::xml_node cell : row) {
      next = column_of(cell.attribute("r").value(), next) + 1;
      width = std::max(width, next);
    }
  }
  if (width > kMostColumns) throw damaged(name, "a cell of the sheet is outside the last column");
  std::vector<std::string> cells(width);
  std::size_t copied = 0;  // cells may repeat one long string
  for (const pugi::xml_node row : child(sheet.document_element(), "sheetData")) {
    std::size_t used = 0;
    for (std::size_t next = 0; const pugi::xml_node cell : row) {
      next = column_of(cell.attribute("r").value(), next) + 1;
      cells[next - 1] = cell_text(cell, workbook);
      used = std::max(used, next);
      copied += cells[next - 1].size();
      if (copied > kMostSheetBytes) throw too_large(name);
    }
    for (std::size_t c = 0; c < width; ++c) {
      if (c > 0) text += ',';
      if (c < used) text += cells[c];
      cells[c].clear();
    }
    text += '\n';
    if (text.size() > kMostSheetBytes) throw too_large(name);
  }
  return text;
}

std::vector<std::string> names_of(const std::vector<Sheet>& sheets, const std::string& name) {
  if (sheets.empty()) throw damaged(name, "the workbook contains no sheet");
  std::vector<std::string> names;
  names.reserve(sheets.size());
  for (const Sheet& sheet : sheets) names.push_back(sheet.name);
  return names;
}

TextStream text_of_sheet(const ZipArchive& archive, const Workbook& workbook, const Sheet& sheet,
                         const std::string& name) {
  std::string text = sheet_text(part_of(archive, sheet.path, kMostSheetBytes, name), workbook, name);
  TextStream stream;
  stream.size = text.size();
  stream.bytes = text_of(std::move(text));
  return stream;
}

}  // namespace

Container workbook_in(const std::shared_ptr<const ZipArchive>& archive, const std::string& name) {
  const auto workbook = std::make_shared<const Workbook>(read_workbook(*archive, name));
  const std::vector<std::string> names = names_of(workbook->sheets, name);
  const auto open = [=](const std::optional<std::string>& wanted) {
    const std::vector<Sheet>& sheets = workbook->sheets;
    const Sheet& chosen =
        wanted ? sheets[find_named(names, *wanted, name)] : *std::ranges::max_element(sheets, {}, &Sheet::bytes);
    TextStream stream = text_of_sheet(*archive, *workbook, chosen, name);
    stream.assumed.push_back(
        sheets.size() == 1 ? fmt::format("Sheet '{}' of the workbook was read.", printable_utf8(chosen.name))
                           : fmt::format("Sheet '{}' of {} in the workbook was read{}.", printable_utf8(chosen.name),
                                         sheets.size(), wanted ? "" : " (the largest; --sheet selects another)"));
    return stream;
  };
  return {open, [=] { return std::vector(names); }};
}

#else

Container workbook_in(const std::shared_ptr<const ZipArchive>& /*archive*/, const std::string& name) {
  throw not_built_in(name, "a workbook (.xlsx)", "libpugixml-dev");
}

#endif

}  // namespace slipfit::reading
