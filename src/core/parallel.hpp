#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slipfit/core/stop.hpp"

namespace slipfit {

#ifdef SLIPFIT_SINGLE_PROCESS  // async would wait without end for a thread that cannot begin
inline constexpr std::launch kLaunch = std::launch::deferred;
#else
inline constexpr std::launch kLaunch = std::launch::async | std::launch::deferred;
#endif

/// Processors that this process may use at a time, at least 1: those of the machine that it was
/// given, or fewer after share_processors.
[[nodiscard]] std::size_t usable_processors();

/// Limits a process that computes at the same time as others to its share of the processors, at least one. It must be
/// called before the process starts threads. `processes` is their number, at least 1.
void share_processors(std::size_t processes);

/// async or, where one processor is all there is, deferred: the caller then does it when it needs the result.
[[nodiscard]] inline std::launch launch_policy() {
  return usable_processors() > 1 ? kLaunch : std::launch::deferred;
}

/// Returns `work` for another thread, in which a StopScope of the calling thread is valid, too.
template <class Work>
[[nodiscard]] auto for_other_thread(const Work& work) {
  return [&work, token = stop_token()] {
    const StopScope scope(token);
    return work();
  };
}

/// Calls `work` once on each of as many threads as there are processors to use, at most `most`, and waits for them.
/// Threads that cannot be started are done without: `work` takes what there is to do until nothing is left.
template <class Work>
void on_processors(std::size_t most, const Work& work) {
  const std::size_t workers = std::min(most, usable_processors());
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < workers; ++i) others.push_back(std::async(kLaunch, for_other_thread(work)));
  work();
  for (std::future<void>& other : others) other.get();
}

/// f(0) ... f(count - 1), in this order, worked out side by side on the processors that there are. `f` must not change
/// what another call reads: results are then the same on any number of processors. `most`: so many threads, for work
/// that may be too little for several.
template <class F>
auto in_parallel(std::size_t count, const F& f, std::size_t most = std::numeric_limits<std::size_t>::max()) {
  using Result = decltype(f(std::size_t{}));
  std::vector<std::optional<Result>> slots(count);
  std::atomic<std::size_t> next = 0;
  on_processors(std::min(count, most), [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      throw_if_stopped();
      slots[i].emplace(f(i));
    }
  });
  std::vector<Result> results;
  results.reserve(count);
  for (std::optional<Result>& slot : slots) results.push_back(*std::move(slot));
  return results;
}

/// Calls f(begin, end) for neighbouring ranges of `grain` indices that together make [0, count), side by side on the
/// processors that there are. `grain`: at least 1; the work of so many indices should take longer than it takes to
/// start a thread, some 50 us. `f` must not change what another call reads or writes.
template <class F>
void for_ranges(std::size_t count, std::size_t grain, const F& f) {
  std::atomic<std::size_t> next = 0;
  on_processors((count + grain - 1) / grain, [&] {
    for (std::size_t begin = next.fetch_add(grain); begin < count; begin = next.fetch_add(grain)) {
      throw_if_stopped();
      f(begin, std::min(count, begin + grain));
    }
  });
}

/// Passes on the steps of parallel work, of one thread at a time. `notify` may be empty; it must outlive the notifier.
class Notifier {
 public:
  explicit Notifier(const std::function<void(const std::string&)>& notify) : notify_(notify) {}

  void operator()(const std::string& step) {
    if (!notify_) return;
    const std::lock_guard lock(notifying_);
    notify_(step);
  }

 private:
  const std::function<void(const std::string&)>& notify_;
  std::mutex notifying_;
};

}  // namespace slipfit
