#pragma once

#include <atomic>
#include <memory>

namespace slipfit {

/// Thrown by functions of the library if a caller requested it with a StopScope, and never otherwise.
struct Stopped {};

/// A flag that is shared by the caller who requests the end of some work and the code that does it; true requests the
/// end.
using StopToken = std::shared_ptr<const std::atomic<bool>>;

/// While it exists, the work of the library in this thread, and in threads that it starts for that work, ends with
/// Stopped soon after the token becomes true: fits within a second.
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

/// Returns the token of the innermost StopScope of this thread; empty without one.
[[nodiscard]] StopToken stop_token();

/// Throws Stopped if the work of this thread was requested to end.
void throw_if_stopped();

}  // namespace slipfit
