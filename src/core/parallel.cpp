#include "core/parallel.hpp"

#include "core/platform.hpp"

namespace slipfit {
namespace {

/// Returns the number of processes that share the machine, one value for the whole process.
std::atomic<std::size_t>& processes_sharing() {
  static std::atomic<std::size_t> processes = 1;
  return processes;
}

}  // namespace

std::size_t usable_processors() {
  static const std::size_t present = platform::processors();
  return std::max<std::size_t>(1, present / processes_sharing());
}

void share_processors(std::size_t processes) {
  processes_sharing() = std::max<std::size_t>(1, processes);
}

}  // namespace slipfit
