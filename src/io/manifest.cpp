#include "slipfit/io/manifest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <exception>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/thrown_error.hpp"
#include "core/word_list.hpp"
#include "io/cells.hpp"
#include "io/manifest_fields.hpp"
#include "io/message.hpp"
#include "io/text_lines.hpp"
#include "io/text_source.hpp"

namespace slipfit {
namespace {

using namespace reading;

bool is_comment_or_blank(std::string_view line) {
  const std::string_view text = trim(line);
  return text.empty() || text.front() == '#';
}

/// Returns the delimiter of the header line: spreadsheets write semicolons if the comma is the decimal sign.
char delimiter_of(std::string_view names) {
  for (const char delimiter : {',', ';', '\t'}) {
    if (names.find(delimiter) != std::string_view::npos) return delimiter;
  }
  return ',';
}

}  // namespace

class ManifestReader::Implementation {
 public:
  Implementation(const std::filesystem::path& file, std::unique_ptr<TextSource> source)
      : name_(name_of_file(file)), folder_(file.parent_path()), lines_(std::move(source)) {}

  void read_names() {
    const std::string_view line = next_line();
    if (line.data() == nullptr) {
      throw ThrownError({"missing_column", name_ + ": contains only blank lines and comments; expected a header line "
                                                   "such as id,file,speed_m_per_s and a line for each recording"});
    }
    delimiter_ = delimiter_of(line);
    columns_ = value_or_throw(find_manifest_columns(fields_of(line), place()));
  }

  std::optional<ManifestEntry> next() {
    const std::string_view line = next_line();
    return line.data() == nullptr ? std::nullopt : std::optional(entry_from(line));
  }

  [[nodiscard]] const ManifestColumns& columns() const { return columns_; }

 private:
  [[nodiscard]] std::string place() const { return fmt::format("{}:{}", name_, lines_.number()); }

  [[nodiscard]] std::vector<std::string> fields_of(std::string_view line) const {
    auto fields = csv_fields(line, delimiter_);
    if (fields) return *std::move(fields);
    throw ThrownError({"open_quote", place() + ": a quote is not closed, or text follows a closing quote; expected "
                                               "\"...\" around a whole field, on one line"});
  }

  /// The next line that says something; without data at the end.
  std::string_view next_line() {
    try {
      for (;;) {
        const char* const line = lines_.next();
        if (line == nullptr) return {};
        if (!is_comment_or_blank(line)) return line;
      }
    } catch (const std::exception& error) {
      throw ThrownError(
          {"not_readable", fmt::format("{}: reading failed ({}); expected a text file with a line for each "
                                       "recording",
                                       place(), printable(error.what()))});
    }
  }

  ManifestEntry entry_from(std::string_view line) {
    ManifestEntry entry;
    entry.row = ++row_;
    entry.line = lines_.number();
    const std::vector<std::string> cells = fields_of(line);
    if (cells.size() != columns_.count) {
      throw ThrownError(
          {"wrong_field_count", fmt::format("{}: {} in '{}', expected {} as in the header line", place(),
                                            counted(cells.size(), "field"), printable(trim(line)), columns_.count)});
    }
    for (const ManifestColumn& column : columns_.read) {
      auto result = with_cell(std::move(entry), column, cells[column.index], delimiter_ == ';');
      if (!result) {
        throw ThrownError({result.error().code, fmt::format("{}: column '{}': {}", place(), column.name,
                                                            with_columns_for_options(result.error().message))});
      }
      entry = std::move(result).value();
    }
    entry.file = folder_ / entry.file;
    if (!entry.surface.empty()) entry.surface = folder_ / entry.surface;
    entry.group = entry.conditions.labels.group;
    return entry;
  }

  std::string name_;
  std::filesystem::path folder_;
  ParsedLines lines_;
  char delimiter_ = ',';
  ManifestColumns columns_;
  std::size_t row_ = 0;
};

ManifestReader::ManifestReader(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
ManifestReader::ManifestReader(ManifestReader&&) noexcept = default;
ManifestReader& ManifestReader::operator=(ManifestReader&&) noexcept = default;
ManifestReader::~ManifestReader() = default;

Result<ManifestReader> ManifestReader::open(const std::filesystem::path& file) {
  return result_of([&] {
    auto implementation = std::make_unique<Implementation>(file, TextSource::open(file));
    implementation->read_names();
    return ManifestReader(std::move(implementation));
  });
}

Result<std::optional<ManifestEntry>> ManifestReader::next() {
  return result_of([&] { return implementation_->next(); });
}

const std::vector<std::string>& ManifestReader::ignored_columns() const {
  return implementation_->columns().ignored;
}

Result<std::vector<ManifestEntry>> read_manifest_group(const std::filesystem::path& file,
                                                       const std::optional<std::string>& group) {
  const std::string name = name_of_file(file);
  auto reader = ManifestReader::open(file);
  if (!reader) return reader.error();
  ManifestReader rows = std::move(reader).value();
  std::vector<ManifestEntry> entries;
  std::unordered_map<std::string, std::size_t> line_of_id;
  std::set<std::string> groups;
  for (;;) {
    auto next = rows.next();
    if (!next) return next.error();
    std::optional<ManifestEntry> entry = std::move(next).value();
    if (!entry) break;
    if (!entry->group.empty()) groups.insert(entry->group);
    if (group && entry->group != *group) continue;
    const auto [first, is_new] = line_of_id.emplace(entry->id, entry->line);
    if (!is_new) return duplicate_id(name, *entry, first->second);
    entries.push_back(*std::move(entry));
  }
  if (!entries.empty()) return entries;
  if (!group) return empty_manifest(name);
  if (groups.empty()) {
    return Error{"unknown_group", name + ": no recording has a group; add a column 'group', or leave out --group"};
  }
  return Error{"unknown_group", fmt::format("{}: no recording of group '{}', expected one of: {}", name,
                                            printable(*group), fmt::join(groups, ", "))};
}

Error in_words_of_manifest(Error error) {
  error.message = with_columns_for_options(std::move(error.message));
  return error;
}

}  // namespace slipfit
