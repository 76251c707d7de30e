#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "batch/files.hpp"

namespace slipfit::batch {

/// The outcome of a job.
struct Answer {
  enum class End { Replied, TimedOut, Died };
  std::size_t job = 0;
  End end = End::Replied;
  std::string text;  ///< the reply, or how the process died ("signal 9, Killed")
};

/// Runs jobs in child processes: one that crashes, hangs or takes all memory ends alone. A child has a process group of
/// its own, which is killed as a whole: a job may have started programs. A child does many jobs; it
/// knows those that were waiting when it was forked. Where the system starts no more processes, fewer do the work, and
/// without any the calling process, which must have no other threads.
class ProcessPool {
 public:
  using Job = std::function<std::string()>;  ///< called in the child; replies with one line

  explicit ProcessPool(std::size_t most) : most_(most) {}
  ~ProcessPool() { kill_all(); }
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;
  ProcessPool(ProcessPool&&) = delete;
  ProcessPool& operator=(ProcessPool&&) = delete;

  [[nodiscard]] bool wants_more() const;
  /// The number of the job. After `limit_s` seconds in `wait` its process is killed.
  std::size_t add(Job job, double limit_s);
  /// Begins what can be begun and waits for a moment at most.
  std::vector<Answer> wait(std::chrono::milliseconds longest);
  /// Drops the jobs that have not begun, and returns which ones have.
  std::vector<std::size_t> drop_waiting();
  void kill_all();
  /// Stops the children and the calling process until that is continued (SIGCONT).
  void suspend();

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    Job job;
    double limit_s = 0.0;
  };
  struct Child {
    pid_t pid = 0;
    FileHandle socket;
    std::size_t known_end = 0;  ///< it knows the jobs with numbers below
    std::optional<std::size_t> job;
    Clock::duration left{};  ///< of the job's time
    std::string received;
  };

  void begin_jobs(std::vector<Answer>& answers);
  Child* child_for(std::size_t job);
  Child* start_child();
  [[noreturn]] void serve(int socket, pid_t parent) const;
  static void receive(Child& child, std::vector<Answer>& answers);
  static void end_child(Child& child);

  std::size_t most_;
  std::size_t first_ = 0;  ///< number of the first waiting job
  std::deque<Waiting> waiting_;
  std::list<Child> children_;
};

}  // namespace slipfit::batch
