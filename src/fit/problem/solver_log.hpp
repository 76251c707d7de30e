#pragma once

#include <glog/logging.h>

#include <mutex>

namespace slipfit::fit {

/// A start outside the model is an ordinary answer here; Ceres reports it on standard error, and this library never
/// prints. GLOG_v and GLOG_vmodule in the environment would let its solvers write into standard output.
inline void silence_solver_log() {
#if __has_include(<glog/vlog_is_on.h>)  // not so of the miniature of glog that Ceres may be built with
  static std::once_flag once;
  std::call_once(once, [] {
    FLAGS_minloglevel = google::GLOG_FATAL;
    FLAGS_v = 0;
    FLAGS_vmodule.clear();
  });
#endif
}

}  // namespace slipfit::fit
