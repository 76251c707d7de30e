#include "batch/crew.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace slipfit::batch {
namespace {

constexpr std::chrono::milliseconds kWatchInterval{100};

class Crew {
 public:
  explicit Crew(const std::function<std::optional<Task>()>& next) : next_(next) {}

  void work() {
    while (const auto task = take()) (*task)();
    const std::lock_guard lock(mutex_);
    ++gone_;
    someone_went_.notify_one();
  }

  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }

  /// Whether all `count` workers are through within a moment.
  bool wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    return someone_went_.wait_for(lock, kWatchInterval, [&] { return gone_ == count; });
  }

 private:
  std::optional<Task> take() {
    const std::lock_guard lock(mutex_);
    if (stopped_) return std::nullopt;
    return next_();
  }

  const std::function<std::optional<Task>()>& next_;
  std::mutex mutex_;
  std::condition_variable someone_went_;
  std::size_t gone_ = 0;
  bool stopped_ = false;
};

}  // namespace

void run_crew(std::size_t jobs, const std::function<std::optional<Task>()>& next, const std::function<Watch()>& watch) {
  Crew crew(next);
  std::vector<std::thread> workers;
  for (std::size_t i = 0; i < jobs; ++i) workers.emplace_back([&crew] { crew.work(); });
  while (!crew.wait_for(jobs)) {
    if (watch() == Watch::Stop) crew.stop();
  }
  for (std::thread& worker : workers) worker.join();
  (void)watch();
}

}  // namespace slipfit::batch
