#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

/// Results of `function` for 0, 1, ..., count - 1, in that order whatever the number of threads.
template <class Function>
auto in_parallel(std::size_t count, unsigned jobs, const Function& function) {
  std::vector<decltype(function(count))> results(count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) results[i] = function(i);
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1U, jobs); ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  return results;
}
