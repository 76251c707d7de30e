#include "batch/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <unordered_map>
#include <utility>

#include "report/batch_html.hpp"
#include "slipfit/background.hpp"
#include "slipfit/io/file_hash.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

constexpr std::chrono::seconds kSyncInterval{1};
constexpr std::size_t kGroupsAtATime = 1000;  // whose entries are in memory: a few megabytes

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
  const std::string command = fmt::format("{}  # row {}: {}", options.report->command_line, entry.row, entry.id);
  const ReportOrigin origin{command, sha256_of_file(entry.file.string())};
  result.page = to_html(recording, analysis, gather_background(recording, analysis), origin);
  result.sparkline = sparkline_of(recording);
  return result;
}

/// One recording's trouble stays its own.
Result<BatchFit> guarded(const std::string& name, const std::function<Result<BatchFit>()>& fit) {
  try {
    return fit();
  } catch (const std::bad_alloc&) {
    return Error{"out_of_memory", one_line(name) + ": not enough memory; give a part of it as window, or fewer --jobs"};
  } catch (const std::exception& error) {
    return Error{"internal_error",
                 one_line(name) + ": internal error, please report it with the recording: " + one_line(error.what())};
  }
}

}  // namespace

Run::Run(const BatchOptions& options, const BatchHooks& hooks, const WorkList& list, Ledger& ledger)
    : options_(options), hooks_(hooks), list_(list), ledger_(ledger) {
  for (std::size_t slot = 0; slot < list.is_mine.size(); ++slot) {
    if (!list.is_mine[slot]) continue;
    ++total_;
    if (ledger.kind_of(slot) == Ledger::Kind::Result) ++before_;
  }
}

std::optional<Error> Run::fit_recordings() {
  auto opened = ManifestReader::open(options_.manifest);
  if (!opened) return opened.error();
  ManifestReader reader = std::move(opened).value();
  run_crew(
      options_.jobs, [&] { return next_recording(reader); }, [this] { return watch(); });
  return first_error();
}

std::optional<Error> Run::fit_groups() {
  for (std::size_t first = 0; first < list_.groups.size() && !stopped_; first += kGroupsAtATime) {
    const std::size_t count = std::min(kGroupsAtATime, list_.groups.size() - first);
    const auto members = members_of(first, count);
    if (!members) return members.error();
    std::size_t next = 0;
    const auto next_group = [&]() -> std::optional<Task> {
      while (next < count && !first_error()) {
        const std::size_t group = next++;
        if (auto task = task_for_group(first + group, members.value()[group])) return task;
      }
      return std::nullopt;
    };
    run_crew(options_.jobs, next_group, [this] { return watch(); });
    if (auto error = first_error()) return error;
  }
  return std::nullopt;
}

BatchProgress Run::progress() const {
  return {total_, before_, fitted_, failed_, std::chrono::duration<double>(Clock::now() - start_).count()};
}

bool Run::is_to_do(const PageKey& key) const {
  if (!list_.is_mine[key.slot]) return false;
  const Ledger::Kind kind = ledger_.kind_of(key.slot);
  if (kind != Ledger::Kind::Result || !options_.report) return kind == Ledger::Kind::Nothing;
  const auto line = ledger_.line_of(key.slot);
  return line && !sparkline_on_page(*options_.report, key, line.value());
}

std::optional<Task> Run::next_recording(ManifestReader& reader) {
  while (!first_error()) {
    auto next = reader.next();
    if (!next) keep(next.error());
    if (!next || !next.value() || next.value()->row > list_.rows) return std::nullopt;
    if (!is_to_do({next.value()->row - 1, next.value()->id})) continue;
    return [this, entry = *std::move(next).value()] {
      take_in({entry.row - 1, entry.id},
              guarded(entry.file.string(), [&] { return fit_recording_of(entry, options_); }));
    };
  }
  return std::nullopt;
}

std::optional<Task> Run::task_for_group(std::size_t group, const Members& members) {
  const PageKey key{list_.slot_of_group(group), id_of_group(list_.groups[group].name)};
  if (!is_to_do(key)) return std::nullopt;
  return [this, key, &members] { take_in(key, guarded(key.id, [&] { return options_.fit_group(key.id, members); })); };
}

Result<std::vector<Run::Members>> Run::members_of(std::size_t first_group, std::size_t count) const {
  std::unordered_map<std::string, std::size_t> wanted;
  for (std::size_t i = 0; i < count; ++i) wanted.emplace(list_.groups[first_group + i].name, i);
  std::vector<Members> members(count);
  auto failed = for_each_entry(options_.manifest, [&](const ManifestEntry& entry) -> std::optional<Error> {
    const auto place = wanted.find(entry.group);
    if (place != wanted.end()) members[place->second].push_back(entry);
    return std::nullopt;
  });
  if (failed) return *failed;
  return members;
}

void Run::take_in(const PageKey& key, const Result<BatchFit>& fit) {
  const bool had_result = ledger_.kind_of(key.slot) == Ledger::Kind::Result;  // its page alone was missing
  if (fit && options_.report && !fit.value().page.empty()) {
    const BatchFit& kept = fit.value();
    if (auto error = write_page(*options_.report, key, kept.document, kept.page, kept.sparkline)) keep(*error);
  }
  if (had_result) return;
  auto error =
      fit ? ledger_.add_result(key.slot, fit.value().document) : ledger_.add_failure(key.slot, key.id, fit.error());
  if (error) return keep(*std::move(error));
  ++(fit ? fitted_ : failed_);
}

void Run::keep(Error error) {
  const std::lock_guard lock(error_mutex_);
  if (!error_) error_ = std::move(error);
}

std::optional<Error> Run::first_error() {
  const std::lock_guard lock(error_mutex_);
  return error_;
}

Watch Run::watch() {
  if (Clock::now() - last_sync_ >= kSyncInterval) {
    last_sync_ = Clock::now();
    if (auto error = ledger_.sync()) keep(*std::move(error));
  }
  if (hooks_.show_progress) hooks_.show_progress(progress());
  stopped_ = stopped_ || (hooks_.should_stop && hooks_.should_stop());
  return stopped_ ? Watch::Stop : Watch::GoOn;
}

}  // namespace slipfit::batch
