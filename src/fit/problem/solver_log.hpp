#pragma once

#include <glog/logging.h>

#include <mutex>

namespace slipfit::fit {

/// A start outside the model is an ordinary answer here; Ceres reports it on standard error, and this library never
/// prints.
inline void silence_solver_log() {
  static std::once_flag once;
  std::call_once(once, [] { FLAGS_minloglevel = google::GLOG_FATAL; });
}

}  // namespace slipfit::fit
