#include "core/parallel.hpp"

#include <catch2/catch.hpp>
#include <thread>

namespace {

/// Every processor for this process again, whatever a test leaves behind.
struct AllProcessors {
  AllProcessors() = default;
  AllProcessors(const AllProcessors&) = delete;
  AllProcessors& operator=(const AllProcessors&) = delete;
  AllProcessors(AllProcessors&&) = delete;
  AllProcessors& operator=(AllProcessors&&) = delete;
  ~AllProcessors() { slipfit::share_processors(1); }
};

}  // namespace

TEST_CASE("results of parallel work are in the order of the indices") {
  const std::vector<std::size_t> squares = slipfit::in_parallel(100, [](std::size_t i) { return i * i; });
  REQUIRE(squares.size() == 100);
  for (std::size_t i = 0; i < squares.size(); ++i) CHECK(squares[i] == i * i);
  CHECK(slipfit::in_parallel(0, [](std::size_t i) { return i; }).empty());
}

TEST_CASE("ranges of parallel work cover every index once") {
  const std::size_t grain = GENERATE(1U, 7U, 100U, 1000U);
  std::vector<int> visits(100, 0);
  slipfit::for_ranges(visits.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++visits[i];
  });
  CHECK(visits == std::vector<int>(100, 1));
  slipfit::for_ranges(0, grain, [](std::size_t, std::size_t) { FAIL("there is nothing to do"); });
}

TEST_CASE("a process that shares the machine with enough others stays on one thread") {
  const AllProcessors restored;
  slipfit::share_processors(100000);
  CHECK(slipfit::usable_processors() == 1);
  CHECK(slipfit::launch_policy() == std::launch::deferred);
  const auto self = std::this_thread::get_id();
  std::vector<std::thread::id> threads(50);
  slipfit::for_ranges(threads.size(), 1,
                      [&](std::size_t begin, std::size_t) { threads[begin] = std::this_thread::get_id(); });
  CHECK(threads == std::vector<std::thread::id>(50, self));
}

TEST_CASE("an exception of parallel work reaches the caller") {
  const auto fail_at_last = [](std::size_t begin, std::size_t) {
    if (begin == 99) throw std::runtime_error("no");
  };
  CHECK_THROWS_AS(slipfit::for_ranges(100, 1, fail_at_last), std::runtime_error);
}

TEST_CASE("work ends in all its threads where the caller asks for it") {
  const auto stop = std::make_shared<std::atomic<bool>>(false);
  const slipfit::StopScope scope(stop);
  std::atomic<int> calls = 0;
  const auto stop_at_tenth = [&](std::size_t) {
    if (++calls == 10) *stop = true;
    return 0;
  };
  CHECK_THROWS_AS(slipfit::in_parallel(100'000, stop_at_tenth), slipfit::Stopped);
  CHECK(calls < 1000);  // the other threads end with their next index
  CHECK_THROWS_AS(slipfit::for_ranges(10, 1, [](std::size_t, std::size_t) {}), slipfit::Stopped);
  {
    const slipfit::StopScope free({});
    CHECK(slipfit::in_parallel(10, [](std::size_t i) { return i; }).size() == 10);
  }
  *stop = false;
  CHECK(slipfit::in_parallel(10, [](std::size_t i) { return i; }).size() == 10);
}
