#include "slipfit/core/stop.hpp"

#include <utility>

namespace slipfit {
namespace {

/// The token of this thread. Functions far below a caller read it, as boost::this_thread::interruption_point does.
StopToken& token_of_thread() {
  thread_local StopToken token;
  return token;
}

}  // namespace

StopScope::StopScope(StopToken token) : before_(std::exchange(token_of_thread(), std::move(token))) {}

StopScope::~StopScope() {
  token_of_thread() = std::move(before_);
}

StopToken stop_token() {
  return token_of_thread();
}

void throw_if_stopped() {
  const StopToken& token = token_of_thread();
  if (token && *token) throw Stopped{};
}

}  // namespace slipfit
