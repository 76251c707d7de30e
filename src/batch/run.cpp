#include "batch/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "batch/pages.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit::batch {
namespace {

constexpr std::chrono::seconds kSyncInterval{1};
constexpr std::chrono::milliseconds kWatchInterval{100};
constexpr std::chrono::seconds kGrace{1};     // for the fits that run at a stop
constexpr std::size_t kGroupsAtATime = 1000;  // whose entries are in memory: a few megabytes
constexpr unsigned kMostTries = 3;

Error crashed(const WorkItem& item, const std::string& end) {
  return Error{"crashed",
               fmt::format("{}: the process that fitted it ended {} times ({}); if the reason was lack of memory, fit "
                           "a part of it (window) or use fewer --jobs; otherwise please report it with the recording",
                           name_of(item), kMostTries, end)};
}

}  // namespace

Run::Run(const BatchOptions& options, const BatchHooks& hooks, const WorkList& list, ResultLog& log)
    : options_(options), hooks_(hooks), list_(list), log_(log), pool_(options.jobs) {
  for (std::size_t slot = 0; slot < list.is_mine.size(); ++slot) {
    if (!list.is_mine[slot]) continue;
    ++counts_.total;
    if (log_.has_result(slot)) ++counts_.before;
  }
}

void Run::fit_all() {
  try {
    fit_recordings();
    for (std::size_t first = 0; first < list_.groups.size() && !stopped_; first += kGroupsAtATime) {
      fit_groups(first, std::min(kGroupsAtATime, list_.groups.size() - first));
    }
  } catch (const ThrownError&) {
    notify_of_replaced();
    throw;
  }
  notify_of_replaced();
}

void Run::fit_recordings() {
  Entries entries(options_.manifest);
  while (const auto entry = stopped_ ? std::nullopt : entries.next()) {
    const bool is_mine = entry->row <= list_.rows && list_.is_mine[entry->row - 1];  // the file may have grown
    if (!is_mine) continue;
    offer({{entry->row - 1, entry->id}, 1, input_files_of({&*entry, 1}), [this, entry] {
             return fit_recording_of(*entry, options_, kept_);
           }});
  }
  finish();
}

void Run::fit_groups(std::size_t first_group, std::size_t count) {
  const std::vector<Members> members = members_of(first_group, count);
  for (std::size_t i = 0; i < count && !stopped_; ++i) {
    const std::size_t slot = list_.slot_of_group(first_group + i);
    if (!list_.is_mine[slot]) continue;
    const Members& group = members[i];
    const std::string id = id_of_group(list_.groups[first_group + i].name);
    offer({{slot, id}, group.size(), input_files_of(group), [this, id, &group] {
             return options_.fit_group(id, group);
           }});
  }
  finish();
}

std::vector<Run::Members> Run::members_of(std::size_t first_group, std::size_t count) const {
  std::unordered_map<std::string, std::size_t> wanted;
  for (std::size_t i = 0; i < count; ++i) wanted.emplace(list_.groups[first_group + i].name, i);
  std::vector<Members> members(count);
  Entries entries(options_.manifest);
  while (auto entry = entries.next()) {
    const auto place = wanted.find(entry->group);
    if (place != wanted.end()) members[place->second].push_back(*std::move(entry));
  }
  return members;
}

void Run::notify_of_replaced() const {
  if (!hooks_.notify) return;
  const auto notify = [this](const std::vector<std::string>& ids, const char* what) {
    if (!ids.empty()) hooks_.notify(fmt::format("{} {} ('{}' first)", ids.size(), what, printable(ids.front())));
  };
  notify(replaced_, "results belonged to files that have changed since, and were fitted again");
  notify(gone_, "recordings cannot be read now; their results are kept");
}

BatchProgress Run::progress() const {
  BatchProgress progress = counts_;
  progress.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  return progress;
}

/// Waits until the pool takes the item, which may be until others are done. An item whose process died in a run before
/// waits until nothing else runs.
void Run::offer(WorkItem item) {
  while (!stopped_ && !pool_.wants_more()) wait_and_watch();
  if (stopped_) return;
  const unsigned tries = log_.tries_of(item.key.slot);
  if (tries >= kMostTries) {
    take_failure(item, crashed(item, "in runs before"));
  } else if (tries > 0) {
    suspects_.push_back(std::move(item));
  } else {
    begin(std::move(item));
  }
}

/// Waits until all that was offered is done. After a stop it ends early.
void Run::finish() {
  while (!stopped_ && !(at_work_.empty() && suspects_.empty())) {
    if (at_work_.empty()) {
      begin(std::move(suspects_.back()));
      suspects_.pop_back();
    }
    wait_and_watch();
  }
  if (stopped_) wait_for_begun();
  end();
  log_.throw_error();
}

void Run::end() {
  pool_.kill_all();
  for (const auto& [job, item] : at_work_) {
    log_.add_end(item.key.slot);
    if (options_.report) remove_unfinished_page(*options_.report, item.key);
  }
  at_work_.clear();
}

void Run::begin(WorkItem item) {
  const std::size_t job = pool_.add([this, item] { return work_on(item, options_, log_); }, limit_of(item));
  at_work_.emplace(job, std::move(item));
}

void Run::wait_and_watch() {
  take_answers();
  if (hooks_.show_progress) hooks_.show_progress(progress());
  if (hooks_.should_suspend && hooks_.should_suspend()) pool_.suspend();
  stopped_ = stopped_ || (hooks_.should_stop && hooks_.should_stop());
  if (Clock::now() - last_sync_ >= kSyncInterval) {
    last_sync_ = Clock::now();
    log_.sync();
  }
  log_.throw_error();
}

void Run::take_answers() {
  for (const Answer& answer : pool_.wait(kWatchInterval)) {
    take(at_work_.extract(answer.job).mapped(), answer);
  }
}

/// At a stop: what has not begun is dropped, what has may still come to its end.
void Run::wait_for_begun() {
  const std::vector<std::size_t> begun = pool_.drop_waiting();
  std::erase_if(at_work_, [&](const auto& job) { return std::ranges::find(begun, job.first) == begun.end(); });
  const Clock::time_point end = Clock::now() + kGrace;
  while (!at_work_.empty() && Clock::now() < end) take_answers();
}

/// A group has as long as its recordings one after the other.
double Run::limit_of(const WorkItem& item) const {
  return options_.timeout_s * static_cast<double>(std::max<std::size_t>(1, item.recordings));
}

void Run::take(const WorkItem& item, const Answer& answer) {
  if (answer.end != Answer::End::Replied && options_.report) remove_unfinished_page(*options_.report, item.key);
  if (answer.end == Answer::End::TimedOut) {
    take_failure(
        item,
        Error{"timed_out",
              fmt::format("{}: no result after {} s; fit a part of it (window), or allow more time with --timeout",
                          name_of(item), limit_of(item))});
    return;
  }
  if (answer.end == Answer::End::Died) {
    const unsigned tries = log_.tries_of(item.key.slot) + ++deaths_[item.key.slot];
    if (tries < kMostTries) {
      suspects_.push_back(item);
    } else {
      take_failure(item, crashed(item, answer.text));
    }
    return;
  }
  const Reply reply = read_reply(answer.text);
  if (reply.kind == Reply::Kind::Stop) throw ThrownError(reply.error);
  if (reply.kind == Reply::Kind::Failed) take_failure(item, reply.error);
  if (reply.kind == Reply::Kind::KeptUnread) gone_.push_back(item.key.id);
  if (reply.kind == Reply::Kind::FittedAnew) replaced_.push_back(item.key.id);
  if (!reply.document.empty()) take_result(item.key.slot, reply.document);
}

void Run::take_result(std::size_t slot, std::string_view document) {
  const bool had_result = log_.has_result(slot);
  const auto line = had_result ? log_.line_of(slot) : Error{};
  if (line && line.value() == document) return log_.add_end(slot);  // its page alone was missing
  if (had_result) --counts_.before;
  ++counts_.fitted;
  log_.add_result(slot, document);
}

void Run::take_failure(const WorkItem& item, const Error& failure) {
  if (log_.has_result(item.key.slot)) --counts_.before;
  ++counts_.failed;
  log_.add_failure(item.key.slot, item.key.id, failure);
}

}  // namespace slipfit::batch
