#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace slipfit {

#ifdef SLIPFIT_SINGLE_PROCESS  // async would wait for ever for a thread that cannot begin
inline constexpr std::launch kLaunch = std::launch::deferred;
#else
inline constexpr std::launch kLaunch = std::launch::async | std::launch::deferred;
#endif

/// f(0) ... f(count - 1), in this order, worked out side by side on the processors that there are. `f` must not change
/// what another call reads: results are then the same on any number of processors.
template <class F>
auto in_parallel(std::size_t count, const F& f) {
  using Result = decltype(f(std::size_t{}));
  std::vector<std::optional<Result>> slots(count);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) slots[i].emplace(f(i));
  };
  const std::size_t workers = std::min<std::size_t>(count, std::max(1U, std::thread::hardware_concurrency()));
  std::vector<std::future<void>> others;
  others.reserve(workers);
  for (std::size_t i = 1; i < workers; ++i) others.push_back(std::async(kLaunch, std::cref(work)));
  work();
  for (std::future<void>& other : others) other.get();
  std::vector<Result> results;
  results.reserve(count);
  for (std::optional<Result>& slot : slots) results.push_back(*std::move(slot));
  return results;
}

}  // namespace slipfit
