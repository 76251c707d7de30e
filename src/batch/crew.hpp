#pragma once

#include <cstddef>
#include <functional>
#include <optional>

namespace slipfit::batch {

using Task = std::function<void()>;

enum class Watch { GoOn, Stop };

/// Runs tasks on `jobs` threads until `next` has no more, or `watch` says stop; what has begun is finished. `next` is
/// called by one thread at a time, `watch` ten times a second and once at the end, by the calling thread. Tasks must
/// not throw.
void run_crew(std::size_t jobs, const std::function<std::optional<Task>()>& next, const std::function<Watch()>& watch);

}  // namespace slipfit::batch
