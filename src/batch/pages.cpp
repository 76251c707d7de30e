#include "batch/pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "batch/files.hpp"
#include "batch/folder.hpp"
#include "batch/tables.hpp"
#include "report/batch_html.hpp"

namespace slipfit::batch {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "recordings";
constexpr std::string_view kBegin = "<!DOCTYPE html>";
constexpr std::string_view kMarkEnd = " -->";

/// The slot makes it unique (in a folder that shards share, too), the id's harmless letters make it readable.
std::string page_name(const SlotKey& key) {
  constexpr std::size_t kLongestName = 80;
  std::string name = key.id.substr(0, kLongestName);
  for (char& c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    if (!is_plain) c = '_';
  }
  return fmt::format("{:05}-{}.html", key.slot + 1, name);
}

fs::path page_file(const BatchReport& report, const SlotKey& key) {
  return report.file.parent_path() / kFolder / page_name(key);
}

std::string mark_of(std::string_view document) {
  return fmt::format("<!-- slipfit.page/1 {} ", digest_of(document).text());
}

/// Only a page is replaced: an input that was named by mistake stays as it is.
void check_replaceable(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return;
  std::string begin(kBegin.size(), '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (begin == kBegin) return;
  throw file_error("not_a_page", file, "is not a page of slipfit and is not replaced; choose another --report");
}

void replace_page(const fs::path& file, std::string_view content) {
  check_replaceable(file);
  replace_file(file, content);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directory(folder, error);  // another shard may make it at the same moment
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) throw cannot_write(folder, error ? error.value() : ENOTDIR);
}

std::string last_line_of(const fs::path& file) {
  constexpr std::streamoff kLongest = 4096;
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) return {};
  const std::streamoff count = std::min<std::streamoff>(stream.tellg(), kLongest);
  std::string end(static_cast<std::size_t>(count), '\0');
  stream.seekg(-count, std::ios::end);
  stream.read(end.data(), count);
  if (!stream || !end.ends_with('\n')) return {};
  end.pop_back();
  return end.substr(end.rfind('\n') + 1);
}

}  // namespace

void prepare_pages(const BatchReport& report) {
  const fs::path folder = report.file.parent_path();
  make_folder(folder.empty() ? "." : folder);
  make_folder(folder / kFolder);
  check_replaceable(report.file);
}

void write_page(const BatchReport& report, const SlotKey& key, const BatchFit& fit) {
  replace_page(page_file(report, key),
               fmt::format("{}{}{}{}\n", fit.page, mark_of(fit.document), fit.sparkline, kMarkEnd));
}

void remove_unfinished_page(const BatchReport& report, const SlotKey& key) {
  remove_unfinished(page_file(report, key));
}

std::optional<std::string> sparkline_on_page(const BatchReport& report, const SlotKey& key, std::string_view document) {
  const std::string line = last_line_of(page_file(report, key));
  const std::string mark = mark_of(document);
  const std::size_t around = mark.size() + kMarkEnd.size();
  if (!line.starts_with(mark) || !line.ends_with(kMarkEnd) || line.size() < around) return std::nullopt;
  return line.substr(mark.size(), line.size() - around);
}

void write_index(const BatchReport& report, const fs::path& manifest, const WorkList& list, const ResultLog& log) {
  BatchPage page{manifest.filename().string(), {}, {}};
  for_each_result(manifest, list, log, [&](const LoggedResult& result) {
    if (result.has_failed) {
      page.failures.push_back(failure_from(result.line));
      return;
    }
    BatchPageRow& row = page.rows.emplace_back(value_or_throw(batch_page_row(result.line)));
    const SlotKey key{result.slot, result.key.id};
    if (auto sparkline = sparkline_on_page(report, key, result.line)) {
      row.report_file = std::string(kFolder) + "/" + page_name(key);
      row.sparkline = *std::move(sparkline);
    }
  });
  replace_page(report.file, to_html(page));
}

}  // namespace slipfit::batch
