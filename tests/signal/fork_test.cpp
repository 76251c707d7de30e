#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cstddef>
#include <thread>
#include <vector>

#include "signal/transform.hpp"

using namespace slipfit;

namespace {

/// Plans for a length that was not planned before.
void plan_for(std::size_t length) {
  (void)signal::hann_power(std::vector<double>(length / 2, 1.0), length);
}

/// Whether the child plans and ends; one that waits for ever is ended by its alarm.
bool child_can_plan(std::size_t length) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(30);
    plan_for(length);
    _exit(0);
  }
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

TEST_CASE("a child that was forked while another thread plans can plan as well") {
  std::atomic<bool> done = false;
  std::thread planner([&done] {  // holds the planner's lock most of the time
    for (std::size_t length = 2000; !done; length += 2) plan_for(length);
  });
  std::size_t planned = 0;
  constexpr std::size_t kForks = 50;
  for (std::size_t i = 0; i < kForks; ++i) planned += child_can_plan(200000 + 2 * i) ? 1U : 0U;
  done = true;
  planner.join();
  CHECK(planned == kForks);
}
