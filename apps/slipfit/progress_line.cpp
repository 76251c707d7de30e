#include "progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "output.hpp"

namespace {

constexpr std::chrono::seconds kLineInterval{10};
constexpr std::size_t kBarWidth = 30;

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 120) return fmt::format("{} s", whole);
  if (whole < 7200) return fmt::format("{} min", whole / 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

/// "1234 of 2000, 3 failed, 410/s, 2 s left"
std::string text_of(const slipfit::BatchProgress& progress) {
  const std::size_t now = progress.fitted + progress.failed;
  const std::size_t done = progress.before + now;
  std::string text = fmt::format("{} of {}, {} failed", done, progress.total, progress.failed);
  if (now == 0 || !(progress.seconds > 0.0)) return text;
  const double per_second = static_cast<double>(now) / progress.seconds;
  text += fmt::format(", {:.3g}/s", per_second);
  if (done < progress.total) {
    text += fmt::format(", {} left", duration_text(static_cast<double>(progress.total - done) / per_second));
  }
  return text;
}

std::string bar_of(const slipfit::BatchProgress& progress) {
  const std::size_t done = progress.before + progress.fitted + progress.failed;
  const std::size_t filled = progress.total == 0 ? kBarWidth : kBarWidth * done / progress.total;
  return "[" + std::string(filled, '=') + std::string(kBarWidth - filled, ' ') + "] ";
}

void write_error_stream(const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

}  // namespace

ProgressLine::ProgressLine()
    : on_terminal_(::isatty(STDERR_FILENO) == 1), last_line_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() {
  if (shown_) write_error_stream("\r\x1b[K");
}

void ProgressLine::show(const std::string& text) {
  if (!on_terminal_) return;
  write_error_stream("\r" + text + "\x1b[K");
  shown_ = true;
}

void ProgressLine::show(const slipfit::BatchProgress& progress) {
  if (on_terminal_) return show(bar_of(progress) + text_of(progress));
  const auto now = std::chrono::steady_clock::now();
  if (now - last_line_ < kLineInterval) return;
  last_line_ = now;
  say(text_of(progress));
}
