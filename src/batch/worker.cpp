#include "batch/worker.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include "batch/files.hpp"
#include "batch/pages.hpp"
#include "io/message.hpp"
#include "report/batch_html.hpp"
#include "slipfit/background.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/io/manifest.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/sweep_html.hpp"
#include "slipfit/surface/comparison.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit::batch {
namespace {

using DocumentJson = nlohmann::json;

/// A reply as one line: the letter of its kind, then a document, or code, blank and message.
std::string reply_text(Reply::Kind kind, std::string_view content = {}) {
  return static_cast<char>(kind) + std::string(content);
}

std::string reply_text(Reply::Kind kind, const Error& error) {
  return reply_text(kind, error.code + " " + error.message);
}

/// An exception is the failure of this recording alone.
Result<BatchFit> fit_without_exceptions(const WorkItem& item) {
  const std::string bug = name_of(item) + ": internal error, please report it with the recording";
  try {
    return item.fit();
  } catch (const std::bad_alloc&) {
    return Error{"out_of_memory", name_of(item) + ": not enough memory; fit a part of it (window) or use fewer --jobs"};
  } catch (const std::exception& error) {
    return Error{"internal_error", bug + ": " + printable(error.what())};
  } catch (...) {
    return Error{"internal_error", bug};
  }
}

std::string fit_reply(const WorkItem& item, const BatchOptions& options, const ResultLog& log, Reply::Kind kind) {
  try {
    log.begin(item.key.slot);
    const auto fit = fit_without_exceptions(item);
    if (!fit) return reply_text(Reply::Kind::Failed, fit.error());
    if (options.report && !fit.value().page.empty()) write_page(*options.report, item.key, fit.value());
    return reply_text(kind, fit.value().document);
  } catch (const ThrownError& cause) {
    return reply_text(Reply::Kind::Stop, cause.error());
  }
}

/// Gone: a file cannot be read, and none is known to have changed.
enum class InputState { Same, Changed, Gone };

/// `input`: what the document says of the file.
InputState compare_input(const DocumentJson& input, const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return InputState::Gone;
  const DocumentJson digest = input.value("input_digest", DocumentJson());
  if (!digest.is_string() || input.value("input_bytes", DocumentJson()) != size) return InputState::Changed;
  const auto now = digest_of_file(file.string());
  if (!now) return InputState::Gone;
  return digest == now->text() ? InputState::Same : InputState::Changed;
}

/// Returns `file`, `input_digest` and `input_bytes` of the files that were read for a document, each file once.
std::vector<DocumentJson> inputs_of(const DocumentJson& document) {
  std::vector<DocumentJson> inputs;
  std::set<DocumentJson> names;
  const auto add = [&](const DocumentJson& input) {
    if (input.is_object() && names.insert(input.value("file", DocumentJson())).second) inputs.push_back(input);
  };
  const DocumentJson none = DocumentJson::array();
  for (const DocumentJson& one : document.value("recordings", DocumentJson::array({document}))) {
    const DocumentJson recording = one.is_object() ? one.value("recording", DocumentJson()) : DocumentJson();
    add(recording);
    for (const DocumentJson& other : recording.is_object() ? recording.value("other_inputs", none) : none) add(other);
  }
  return inputs;
}

/// States whether the files of a recording, or of the recordings of a group, are those of the document, by sizes and
/// digests.
InputState compare_inputs(const std::string& document, const WorkItem& item) {
  const DocumentJson json = DocumentJson::parse(document, nullptr, false);
  if (!json.is_object()) return InputState::Changed;
  const std::vector<DocumentJson> inputs = inputs_of(json);
  if (inputs.size() != item.inputs.size()) return InputState::Changed;
  InputState state = InputState::Same;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const InputState found = compare_input(inputs[i], item.inputs[i]);
    if (found == InputState::Changed) return found;
    if (found == InputState::Gone) state = found;
  }
  return state;
}

JsonOptions layout_of(const std::string& id) {
  JsonOptions layout;
  layout.id = id;
  layout.layout = JsonLayout::OneLine;
  return layout;
}

}  // namespace

std::vector<std::filesystem::path> input_files_of(std::span<const ManifestEntry> entries) {
  std::vector<std::filesystem::path> inputs;
  std::set<std::string> names;
  for (const ManifestEntry& entry : entries) {
    for (const std::filesystem::path* const file : {&entry.file, &entry.surface}) {
      if (!file->empty() && names.insert(reading::name_of_file(*file)).second) inputs.push_back(*file);
    }
  }
  return inputs;
}

std::string name_of(const WorkItem& item) {
  return printable(item.recordings == 1 ? item.inputs.front().string() : item.key.id);
}

/// Fits all strokes or segments of a row together, like a group.
Result<BatchFit> fit_pieces_of(const ManifestEntry& entry, const BatchOptions& options) {
  auto fit = group_fit(options.fit, options.report)(entry.id, {entry});
  if (!fit) return fit;
  BatchFit result = std::move(fit).value();
  if (!options.report) return result;
  const auto pieces = read_pieces(entry.file, entry.conditions, entry.options);
  if (pieces) result.sparkline = sparkline_of(pieces.value().front().recording);
  return result;
}

Result<BatchFit> fit_recording_of(const ManifestEntry& entry, const BatchOptions& options, reading::KeptFile& kept) {
  if (entry.options.pieces != Pieces::One) return fit_pieces_of(entry, options);
  const auto conditions = with_worn_track(entry.conditions, entry.surface);
  if (!conditions) return in_words_of_manifest(conditions.error());
  const auto read = with_data(reading::read_recording(kept, entry.file, conditions.value(), entry.options));
  if (!read) return in_words_of_manifest(read.error());
  const Recording& recording = read.value();
  FitOptions fit = options.fit;
  fit.curve = options.report.has_value();
  const Analysis analysis = analyze_and_fit(recording, fit);
  BatchFit result{to_json(recording, analysis, layout_of(entry.id)), {}, {}};
  if (!options.report) return result;
  const ReportOrigin origin{options.report->command_line + "  # row " + std::to_string(entry.row) + ": " + entry.id};
  result.page = to_html(recording, analysis, gather_background(recording, analysis), origin);
  result.sparkline = sparkline_of(recording);
  return result;
}

std::string work_on(const WorkItem& item, const BatchOptions& options, const ResultLog& log) {
  const std::size_t slot = item.key.slot;
  const auto line = log.has_result(slot) ? log.line_of(slot) : Error{};
  if (!line) return fit_reply(item, options, log, Reply::Kind::Fitted);
  const InputState inputs = compare_inputs(line.value(), item);
  if (inputs == InputState::Changed) return fit_reply(item, options, log, Reply::Kind::FittedAnew);
  if (inputs == InputState::Gone) return reply_text(Reply::Kind::KeptUnread);
  const bool has_page = !options.report || sparkline_on_page(*options.report, item.key, line.value());
  return has_page ? reply_text(Reply::Kind::Kept) : fit_reply(item, options, log, Reply::Kind::Fitted);
}

Reply read_reply(const std::string& text) {
  const auto kind = static_cast<Reply::Kind>(text.front());
  const std::string content = text.substr(1);
  if (kind != Reply::Kind::Failed && kind != Reply::Kind::Stop) return {kind, content, {}};
  const std::size_t end = content.find(' ');  // codes hold none
  return {kind, {}, {content.substr(0, end), content.substr(end + 1)}};
}

}  // namespace slipfit::batch

namespace slipfit {

GroupFit group_fit(const FitOptions& options, const std::optional<BatchReport>& report) {
  return [options, report](const std::string& id, const std::vector<ManifestEntry>& members) -> Result<BatchFit> {
    const auto entries = read_sweep(members);
    if (!entries) return entries.error();
    const SweepAnalysis sweep = analyze_sweep(entries.value(), options);
    BatchFit fit{to_json(entries.value(), sweep, batch::layout_of(id)), {}, {}};
    if (report) {
      fit.page = to_html(entries.value(), sweep, predict_around(entries.value(), sweep),
                         SweepOrigin{id, report->command_line + "  # " + id});
    }
    return fit;
  };
}

}  // namespace slipfit
