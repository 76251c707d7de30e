#include "batch/worker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string_view>

#include "batch/inputs.hpp"
#include "report/batch_html.hpp"
#include "slipfit/background.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

// A reply as text: the letter of its kind, then a document, or code and message on two lines.

std::string text_of(Reply::Kind kind, std::string_view content = {}) {
  return static_cast<char>(kind) + std::string(content);
}

std::string text_of(Reply::Kind kind, const Error& error) {
  return text_of(kind, error.code + "\n" + error.message);
}

/// One recording's trouble stays its own.
Result<BatchFit> guarded(const WorkItem& item) {
  const std::string name = name_of(item);
  constexpr const char* kReport = ": internal error, please report it with the recording";
  try {
    return item.fit();
  } catch (const std::bad_alloc&) {
    return Error{"out_of_memory", name + ": not enough memory; give a part of it as window, or fewer --jobs"};
  } catch (const std::exception& error) {
    return Error{"internal_error", name + kReport + ": " + one_line(error.what())};
  } catch (...) {
    return Error{"internal_error", name + kReport};
  }
}

std::string fit_reply(const WorkItem& item, const BatchOptions& options, ResultLog& log, Reply::Kind kind) {
  if (const auto error = log.begin(item.key.slot)) return text_of(Reply::Kind::Stop, *error);
  const auto fit = guarded(item);
  if (!fit) return text_of(Reply::Kind::Failed, fit.error());
  const BatchFit& kept = fit.value();
  if (options.report && !kept.page.empty()) {
    const auto error = write_page(*options.report, item.key, kept.document, kept.page, kept.sparkline);
    if (error) return text_of(Reply::Kind::Stop, *error);
  }
  return text_of(kind, kept.document);
}

}  // namespace

std::string name_of(const WorkItem& item) {
  return one_line(item.inputs.size() == 1 ? item.inputs.front().string() : item.key.id);
}

Result<BatchFit> fit_recording_of(const ManifestEntry& entry, const BatchOptions& options) {
  const auto read = read_recording(entry.file, entry.conditions, entry.options);
  if (!read) return in_words_of_manifest(read.error());
  const Recording& recording = read.value();
  FitOptions fit = options.fit;
  fit.curve = options.report.has_value();
  const Analysis analysis = analyze_and_fit(recording, fit);
  JsonOptions layout;
  layout.id = entry.id;
  layout.layout = JsonLayout::OneLine;
  BatchFit result{to_json(recording, analysis, layout), {}, {}};
  if (!options.report) return result;
  const ReportOrigin origin{fmt::format("{}  # row {}: {}", options.report->command_line, entry.row, entry.id)};
  result.page = to_html(recording, analysis, gather_background(recording, analysis), origin);
  result.sparkline = sparkline_of(recording);
  return result;
}

std::string work_on(const WorkItem& item, const BatchOptions& options, ResultLog& log) {
  const std::size_t slot = item.key.slot;
  const auto line = log.kind_of(slot) == ResultLog::Kind::Result ? log.line_of(slot) : Error{};
  if (!line) return fit_reply(item, options, log, Reply::Kind::Fitted);
  const InputState inputs = compare_inputs(line.value(), item.inputs);
  if (inputs == InputState::Changed) return fit_reply(item, options, log, Reply::Kind::FittedAnew);
  if (inputs == InputState::Gone) return text_of(Reply::Kind::KeptUnread);
  const bool has_page = !options.report || sparkline_on_page(*options.report, item.key, line.value());
  return has_page ? text_of(Reply::Kind::Kept) : fit_reply(item, options, log, Reply::Kind::Fitted);
}

Reply read_reply(const std::string& text) {
  const auto kind = static_cast<Reply::Kind>(text.front());
  std::string content = text.substr(1);
  if (kind != Reply::Kind::Failed && kind != Reply::Kind::Stop) return {kind, std::move(content), {}};
  const std::size_t end = std::min(content.find('\n'), content.size());
  return {kind, {}, {content.substr(0, end), content.substr(std::min(end + 1, content.size()))}};
}

}  // namespace slipfit::batch
