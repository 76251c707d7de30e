#include "batch/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

constexpr std::chrono::seconds kSyncInterval{1};
constexpr std::chrono::milliseconds kWatchInterval{100};
constexpr std::chrono::seconds kGrace{1};     // for what is at work at a stop
constexpr std::size_t kGroupsAtATime = 1000;  // whose entries are in memory: a few megabytes
constexpr unsigned kMostTries = 3;

Error crashed(const WorkItem& item, const std::string& end) {
  return Error{"crashed",
               fmt::format("{}: the process that fitted it ended {} times ({}); where that was for lack of memory "
                           "give a part of it as window, or fewer --jobs; else please report it with the recording",
                           name_of(item), kMostTries, end)};
}

}  // namespace

Run::Run(const BatchOptions& options, const BatchHooks& hooks, const WorkList& list, ResultLog& log)
    : options_(options), hooks_(hooks), list_(list), log_(log), pool_(options.jobs) {
  for (std::size_t slot = 0; slot < list.is_mine.size(); ++slot) {
    if (!list.is_mine[slot]) continue;
    ++counts_.total;
    if (log_.kind_of(slot) == ResultLog::Kind::Result) ++counts_.before;
  }
}

std::optional<Error> Run::fit_recordings() {
  auto opened = ManifestReader::open(options_.manifest);
  if (!opened) return opened.error();
  ManifestReader reader = std::move(opened).value();
  return work_through([&]() -> Result<std::optional<WorkItem>> {
    for (;;) {
      auto next = reader.next();
      if (!next) return next.error();
      if (!next.value() || next.value()->row > list_.rows) return std::optional<WorkItem>();
      if (!list_.is_mine[next.value()->row - 1]) continue;
      const ManifestEntry entry = *std::move(next).value();
      return std::optional(WorkItem{
          {entry.row - 1, entry.id}, {entry.file}, [this, entry] { return fit_recording_of(entry, options_); }});
    }
  });
}

std::optional<Error> Run::fit_groups() {
  for (std::size_t first = 0; first < list_.groups.size() && !stopped_; first += kGroupsAtATime) {
    const std::size_t count = std::min(kGroupsAtATime, list_.groups.size() - first);
    const auto members = members_of(first, count);
    if (!members) return members.error();
    std::size_t next = 0;
    auto error = work_through([&]() -> Result<std::optional<WorkItem>> {
      while (next < count && !list_.is_mine[list_.slot_of_group(first + next)]) ++next;
      if (next == count) return std::optional<WorkItem>();
      const Members& group = members.value()[next];
      WorkItem item{{list_.slot_of_group(first + next), id_of_group(list_.groups[first + next].name)}, {}, {}};
      for (const ManifestEntry& member : group) item.inputs.push_back(member.file);
      item.fit = [this, id = item.key.id, &group] { return options_.fit_group(id, group); };
      ++next;
      return std::optional(std::move(item));
    });
    if (error) return error;
  }
  return std::nullopt;
}

void Run::tell_replaced() const {
  if (!hooks_.tell) return;
  const auto tell = [this](const std::vector<std::string>& ids, const char* what) {
    if (!ids.empty()) hooks_.tell(fmt::format("{} {} ('{}' first)", ids.size(), what, one_line(ids.front())));
  };
  tell(replaced_, "of the results were of other bytes than their files hold now, and were fitted again");
  tell(gone_, "recordings cannot be read now; their results are kept");
}

BatchProgress Run::progress() const {
  BatchProgress progress = counts_;
  progress.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  return progress;
}

std::optional<Error> Run::work_through(const Next& next) {
  has_more_ = true;
  auto error = take_all(next);
  if (stopped_ && !error) error = wait_for_begun();
  pool_.kill_all();
  if (options_.report && !in_hand_.empty()) remove_page_leftovers(*options_.report, list_);
  for (const auto& [job, item] : in_hand_) {
    auto not_noted = log_.add_end(item.key.slot);
    if (not_noted && !error) error = std::move(not_noted);
  }
  in_hand_.clear();
  return error;
}

std::optional<Error> Run::take_all(const Next& next) {
  for (;;) {
    if (auto error = hand_out(next)) return error;
    if (in_hand_.empty()) return watch();
    if (auto error = take_answers()) return error;
    if (auto error = watch()) return error;
    if (stopped_) return std::nullopt;
  }
}

std::optional<Error> Run::take_answers() {
  for (const Answer& answer : pool_.wait(kWatchInterval)) {
    const auto place = in_hand_.find(answer.job);
    const WorkItem item = std::move(place->second);
    in_hand_.erase(place);
    if (auto error = take_in(item, answer)) return error;
  }
  return std::nullopt;
}

/// At a stop: what has not begun is dropped, what has may still come to its end.
std::optional<Error> Run::wait_for_begun() {
  const std::vector<std::size_t> begun = pool_.drop_waiting();
  std::erase_if(in_hand_,
                [&](const auto& job) { return std::find(begun.begin(), begun.end(), job.first) == begun.end(); });
  const Clock::time_point end = Clock::now() + kGrace;
  while (!in_hand_.empty() && Clock::now() < end) {
    if (auto error = take_answers()) return error;
  }
  return std::nullopt;
}

/// Keeps the pool busy. What took its process with it before waits until it is alone.
std::optional<Error> Run::hand_out(const Next& next) {
  while (has_more_ && pool_.wants_more()) {
    auto found = next();
    if (!found) return found.error();
    has_more_ = found.value().has_value();
    if (!has_more_) break;
    WorkItem item = *std::move(found).value();
    const unsigned tries = log_.tries_of(item.key.slot);
    if (tries >= kMostTries) {
      if (auto error = take_failure(item, crashed(item, "in runs before"))) return error;
    } else if (tries > 0) {
      alone_.push_back(std::move(item));
    } else {
      begin(std::move(item));
    }
  }
  if (has_more_ || !in_hand_.empty() || alone_.empty()) return std::nullopt;
  WorkItem item = std::move(alone_.back());
  alone_.pop_back();
  begin(std::move(item));
  return std::nullopt;
}

void Run::begin(WorkItem item) {
  const std::size_t job = pool_.add([this, item] { return work_on(item, options_, log_); }, limit_of(item));
  in_hand_.emplace(job, std::move(item));
}

/// A group has as long as its recordings one after the other.
double Run::limit_of(const WorkItem& item) const {
  return options_.timeout_s * static_cast<double>(std::max<std::size_t>(1, item.inputs.size()));
}

std::optional<Error> Run::take_in(const WorkItem& item, const Answer& answer) {
  if (answer.end == Answer::End::TimedOut) {
    return take_failure(item,
                        Error{"timed_out", fmt::format("{}: no result after {} s; give a part of it as window, or more "
                                                       "time with --timeout",
                                                       name_of(item), limit_of(item))});
  }
  if (answer.end == Answer::End::Died) {
    const unsigned tries = log_.tries_of(item.key.slot) + ++deaths_[item.key.slot];
    if (tries >= kMostTries) return take_failure(item, crashed(item, answer.text));
    alone_.push_back(item);
    return std::nullopt;
  }
  const Reply reply = read_reply(answer.text);
  if (reply.kind == Reply::Kind::Stop) return reply.error;
  if (reply.kind == Reply::Kind::Failed) return take_failure(item, reply.error);
  if (reply.kind == Reply::Kind::KeptUnread) gone_.push_back(item.key.id);
  if (reply.kind == Reply::Kind::FittedAnew) replaced_.push_back(item.key.id);
  return reply.document.empty() ? std::nullopt : take_result(item.key.slot, reply.document);
}

std::optional<Error> Run::take_result(std::size_t slot, std::string_view document) {
  const bool had_result = log_.kind_of(slot) == ResultLog::Kind::Result;
  const auto line = had_result ? log_.line_of(slot) : Error{};
  if (line && line.value() == document) return log_.add_end(slot);  // its page alone was missing
  if (had_result) --counts_.before;
  ++counts_.fitted;
  return log_.add_result(slot, document);
}

std::optional<Error> Run::take_failure(const WorkItem& item, const Error& failure) {
  if (log_.kind_of(item.key.slot) == ResultLog::Kind::Result) --counts_.before;
  ++counts_.failed;
  return log_.add_failure(item.key.slot, item.key.id, failure);
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

std::optional<Error> Run::watch() {
  if (hooks_.show_progress) hooks_.show_progress(progress());
  stopped_ = stopped_ || (hooks_.should_stop && hooks_.should_stop());
  if (Clock::now() - last_sync_ < kSyncInterval) return std::nullopt;
  last_sync_ = Clock::now();
  return log_.sync();
}

}  // namespace slipfit::batch
