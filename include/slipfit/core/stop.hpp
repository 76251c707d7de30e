#pragma once

#include <atomic>
#include <memory>

namespace slipfit {

/// Thrown out of the library's functions where a caller asked for it by a StopScope, and never otherwise.
struct Stopped {};

/// Shared by who asks for the end of a piece of work and who does the work; true: it is to end.
using StopToken = std::shared_ptr<const std::atomic<bool>>;

/// While it exists, the library's work in this thread, and in threads that it starts for that work, ends with Stopped
/// soon after the token has become true: fits within a second.
class StopScope {
 public:
  explicit StopScope(StopToken token);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;
  StopScope(StopScope&&) = delete;
  StopScope& operator=(StopScope&&) = delete;

 private:
  StopToken before_;
};

/// The token of the innermost StopScope of this thread; empty where there is none.
[[nodiscard]] StopToken stop_token();

/// Throws Stopped where the work of this thread is to end.
void throw_if_stopped();

}  // namespace slipfit
