#include "batch/pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "batch/files.hpp"
#include "io/csv_fields.hpp"
#include "report/batch_html.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "recordings";
constexpr std::string_view kBegin = "<!DOCTYPE html>";
constexpr std::size_t kLongestLastLine = 4096;

/// The slot makes it unique (in a folder that shards share, too), the id's harmless letters make it readable.
std::string page_name(const PageKey& key) {
  constexpr std::size_t kLongestName = 80;
  std::string name = key.id.substr(0, kLongestName);
  for (char& c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    if (!is_plain) c = '_';
  }
  return fmt::format("{:05}-{}.html", key.slot + 1, name);
}

/// Of a page's name; beyond all slots where it is none.
std::size_t slot_of(std::string_view name) {
  std::size_t number = 0;
  const auto read = std::from_chars(name.data(), name.data() + name.size(), number);
  return read.ec == std::errc() ? number - 1 : std::numeric_limits<std::size_t>::max();
}

fs::path page_file(const BatchReport& report, const PageKey& key) {
  return report.file.parent_path() / kFolder / page_name(key);
}

std::string mark_of(std::string_view document) {
  return fmt::format("<!-- slipfit.page/1 {} ", digest_of(document).text());
}

/// Nothing but a page is replaced: an input stays as it is.
std::optional<Error> check_replaceable(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  std::string begin(kBegin.size(), '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (begin == kBegin) return std::nullopt;
  return Error{"not_a_page",
               one_line(file.string()) + ": is no page of slipfit and is not replaced; choose another --report"};
}

std::optional<Error> replace_page(const fs::path& file, std::string_view content) {
  auto error = check_replaceable(file);
  return error ? error : replace_file(file, content);
}

std::optional<Error> make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directory(folder, error);  // another shard may make it at the same moment
  std::error_code ignored;
  if (fs::is_directory(folder, ignored)) return std::nullopt;
  return cannot_write(folder, error ? error.value() : ENOTDIR);
}

std::string last_line_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) return {};
  const std::streamoff size = stream.tellg();
  const std::streamoff count = std::min(size, static_cast<std::streamoff>(kLongestLastLine));
  std::string end(static_cast<std::size_t>(count), '\0');
  stream.seekg(size - count);
  stream.read(end.data(), count);
  if (!stream || !end.ends_with('\n')) return {};
  end.pop_back();
  return end.substr(end.rfind('\n') + 1);
}

BatchPageFailure failure_of(const std::string& line) {
  auto cells = reading::csv_fields(line, ',').value_or(std::vector<std::string>());
  cells.resize(3);
  return {cells[0], cells[1], cells[2]};
}

std::optional<Error> add_slot(BatchPage& page, const BatchReport& report, const ResultLog& log, const PageKey& key) {
  const ResultLog::Kind kind = log.kind_of(key.slot);
  if (kind == ResultLog::Kind::Nothing) return std::nullopt;
  const auto line = log.line_of(key.slot);
  if (!line) return line.error();
  if (kind == ResultLog::Kind::Failure) {
    page.failures.push_back(failure_of(line.value()));
    return std::nullopt;
  }
  auto read = batch_page_row(line.value());
  if (!read) return read.error();
  BatchPageRow row = std::move(read).value();
  if (auto sparkline = sparkline_on_page(report, key, line.value())) {
    row.report_file = std::string(kFolder) + "/" + page_name(key);
    row.sparkline = *std::move(sparkline);
  }
  page.rows.push_back(std::move(row));
  return std::nullopt;
}

}  // namespace

void remove_page_leftovers(const BatchReport& report, const WorkList& list) {
  remove_leftovers(report.file.parent_path() / kFolder, [&](std::string_view name) {
    const std::size_t slot = slot_of(name);
    return slot < list.is_mine.size() && list.is_mine[slot];  // another shard may be at work beside this one
  });
}

std::optional<Error> prepare_pages(const BatchReport& report, const WorkList& list) {
  const fs::path folder = report.file.parent_path();
  if (auto error = make_folder(folder.empty() ? "." : folder)) return error;
  if (auto error = make_folder(folder / kFolder)) return error;
  remove_page_leftovers(report, list);
  remove_leftovers(folder.empty() ? "." : folder,
                   [&](std::string_view name) { return name == report.file.filename(); });
  return check_replaceable(report.file);
}

std::optional<Error> write_page(const BatchReport& report, const PageKey& key, std::string_view document,
                                std::string_view page, std::string_view sparkline) {
  return replace_page(page_file(report, key), fmt::format("{}{}{} -->\n", page, mark_of(document), sparkline));
}

std::optional<std::string> sparkline_on_page(const BatchReport& report, const PageKey& key, std::string_view document) {
  constexpr std::string_view kEnd = " -->";
  const std::string line = last_line_of(page_file(report, key));
  const std::string mark = mark_of(document);
  if (!line.starts_with(mark) || !line.ends_with(kEnd) || line.size() < mark.size() + kEnd.size()) return std::nullopt;
  return line.substr(mark.size(), line.size() - mark.size() - kEnd.size());
}

std::optional<Error> write_index(const BatchReport& report, const fs::path& manifest, const WorkList& list,
                                 const ResultLog& log) {
  BatchPage page{manifest.filename().string(), {}, {}};
  const auto add_entry = [&](const ManifestEntry& entry) {
    return add_slot(page, report, log, {entry.row - 1, entry.id});
  };
  const auto add_group = [&](std::size_t group) {
    return add_slot(page, report, log, {list.slot_of_group(group), id_of_group(list.groups[group].name)});
  };
  auto failed = for_each_result(manifest, list, add_entry, add_group);
  return failed ? failed : replace_page(report.file, to_html(page));
}

}  // namespace slipfit::batch
