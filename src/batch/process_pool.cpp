#include "batch/process_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/parallel.hpp"
#include "core/platform.hpp"

namespace slipfit::batch {
namespace {

/// Jobs that wait for each process: a fork costs about a millisecond and what a first fit sets up, so that it should
/// serve for many.
constexpr std::size_t kWaitingEach = 256;

constexpr double kLongest_s = 1e9;  // what the clock can hold

// A child receives the number of a job as 8 bytes; its reply is a line.
using JobNumber = std::uint64_t;

bool send_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), platform::kSendFlags);
    if (sent < 0 && errno != EINTR) return false;
    if (sent > 0) bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

std::string describe_end(int status) {
  if (!WIFSIGNALED(status)) return fmt::format("exit code {}", WEXITSTATUS(status));
  return fmt::format("signal {}, {}", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
}

/// Kills a child with the programs that it has started, and returns how it ended; it may have ended by itself before.
int end_group(pid_t pid) {
  int status = 0;
  (void)::kill(-pid, SIGKILL);
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

bool ProcessPool::wants_more() const {
  return waiting_.size() < kWaitingEach * most_;
}

std::size_t ProcessPool::add(Job job, double limit_s) {
  waiting_.push_back({std::move(job), limit_s});
  return first_ + waiting_.size() - 1;
}

std::vector<Answer> ProcessPool::wait(std::chrono::milliseconds longest) {
  std::vector<Answer> answers;
  begin_jobs(answers);
  std::vector<pollfd> polled;
  for (const Child& child : children_) polled.push_back({child.socket.get(), POLLIN, 0});
  const bool has_answers = !answers.empty();
  const Clock::time_point begin = Clock::now();
  (void)::poll(polled.data(), polled.size(), has_answers ? 0 : static_cast<int>(longest.count()));
  // Not what passed while this process was suspended.
  const Clock::duration waited = std::min<Clock::duration>(Clock::now() - begin, longest);
  std::size_t place = 0;
  for (auto child = children_.begin(); child != children_.end(); ++place) {
    if (polled[place].revents != 0) receive(*child, answers);
    child->left -= waited;
    if (child->pid != 0 && child->job && child->left <= Clock::duration::zero()) {
      answers.push_back({*child->job, Answer::End::TimedOut, {}});
      end_child(*child);
    }
    child = child->pid == 0 ? children_.erase(child) : std::next(child);
  }
  return answers;
}

std::vector<std::size_t> ProcessPool::drop_waiting() {
  first_ += waiting_.size();
  waiting_.clear();
  std::vector<std::size_t> begun;
  for (const Child& child : children_) {
    if (child.job) begun.push_back(*child.job);
  }
  return begun;
}

void ProcessPool::kill_all() {
  for (Child& child : children_) end_child(child);
  children_.clear();
}

void ProcessPool::suspend() {
  for (const Child& child : children_) (void)::kill(-child.pid, SIGSTOP);
  (void)::raise(SIGSTOP);
  for (const Child& child : children_) (void)::kill(-child.pid, SIGCONT);
}

void ProcessPool::begin_jobs(std::vector<Answer>& answers) {
  while (!waiting_.empty()) {
    Child* const child = child_for(first_);
    if (child == nullptr && !children_.empty()) return;  // all are busy
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    const std::size_t job = first_++;
    if (child == nullptr) {  // no process can be started
      try {
        answers.push_back({job, Answer::End::Replied, waiting.job()});
      } catch (...) {
        answers.push_back({job, Answer::End::Died, "not enough memory"});
      }
      return;
    }
    child->job = job;
    child->left = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(std::min(waiting.limit_s, kLongest_s)));
    const JobNumber number = job;  // a child that is gone is noticed by poll
    (void)::send(child->socket.get(), &number, sizeof(number), platform::kSendFlags);
  }
}

ProcessPool::Child* ProcessPool::child_for(std::size_t job) {
  for (auto child = children_.begin(); child != children_.end();) {
    if (!child->job && child->known_end > job) return &*child;
    if (!child->job) end_child(*child);
    child = child->pid == 0 ? children_.erase(child) : std::next(child);
  }
  return children_.size() < most_ ? start_child() : nullptr;
}

ProcessPool::Child* ProcessPool::start_child() {
  const pid_t parent = ::getpid();
  const std::array<int, 2> sockets = platform::connected_sockets();
  FileHandle ours(sockets[0]);
  FileHandle theirs(sockets[1]);
  const pid_t pid = ours ? ::fork() : -1;
  if (pid == 0) {
    for (Child& sibling : children_) sibling.socket = {};  // else they would outlive the parent: no end of file
    ours = {};
    (void)::setpgid(0, 0);
    share_processors(std::min(most_, children_.size() + waiting_.size()));
    serve(theirs.get(), parent);
  }
  if (pid < 0) {
    most_ = std::max<std::size_t>(1, children_.size());
    return nullptr;
  }
  (void)::setpgid(pid, pid);  // the child does it, too: whoever is first
  Child& child = children_.emplace_back();
  child.pid = pid;
  child.socket = std::move(ours);
  child.known_end = first_ + waiting_.size();
  return &child;
}

/// Ends without writing the parent's buffers or running its destructors.
void ProcessPool::serve(int socket, pid_t parent) const {
  for (const int signal : {SIGINT, SIGTERM}) (void)std::signal(signal, SIG_IGN);  // the parent handles them
  platform::end_with_parent();
  if (::getppid() != parent) ::_exit(1);
  try {
    JobNumber job = 0;
    while (::recv(socket, &job, sizeof(job), MSG_WAITALL) == static_cast<ssize_t>(sizeof(job))) {
      std::string reply = waiting_.at(job - first_).job();
      std::ranges::replace(reply, '\n', ' ');
      if (!send_all(socket, reply + "\n")) break;
    }
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

void ProcessPool::receive(Child& child, std::vector<Answer>& answers) {
  std::array<char, std::size_t{64} * 1024> chunk{};
  const ssize_t count = ::recv(child.socket.get(), chunk.data(), chunk.size(), MSG_DONTWAIT);
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (count > 0) {
    child.received.append(chunk.data(), static_cast<std::size_t>(count));
    if (child.received.back() != '\n') return;
    child.received.pop_back();
    answers.push_back({*child.job, Answer::End::Replied, std::move(child.received)});
    child.received.clear();
    child.job.reset();
    return;
  }
  const int status = end_group(child.pid);
  child.pid = 0;
  if (child.job) answers.push_back({*child.job, Answer::End::Died, describe_end(status)});
}

void ProcessPool::end_child(Child& child) {
  (void)end_group(child.pid);
  child.pid = 0;
}

}  // namespace slipfit::batch
