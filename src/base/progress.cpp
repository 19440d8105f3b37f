#include "base/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>

#include "base/clock.h"

namespace plisse {
namespace {

// fps and time left; the latter in h:mm:ss, hours only where there are any. Nothing before there is anything
// to go by.
std::string rates(int done, int total, double seconds) {
  if (done < 1 || !(seconds >= 0.01)) return "";
  const auto left = static_cast<long long>(std::ceil(seconds / done * std::max(total - done, 0)));
  const std::string clock = left < 3600
                                ? fmt::format("{}:{:02}", left / 60, left % 60)
                                : fmt::format("{}:{:02}:{:02}", left / 3600, left / 60 % 60, left % 60);
  return fmt::format("  {:.1f} fps  eta {}", done / seconds, clock);
}

int terminal_columns() {
  winsize window{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0 ? window.ws_col : 80;
}

// There is one terminal, so there is one bar.
std::mutex bar_mutex;
bool bar_on_screen = false;

// A closed stderr must not stop a run, so the result is ignored.
void say(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

std::string progress_bar(int done, int total, double seconds, int columns) {
  const std::string numbers = fmt::format(" {}/{}{}", done, total, rates(done, total, seconds));
  const int cells = std::clamp(columns - static_cast<int>(numbers.size()) - 2, 0, 40);
  std::string text;
  if (cells >= 5) {
    const long long all = std::max(total, 1);
    const auto full = static_cast<int>(cells * std::clamp<long long>(done, 0, all) / all);
    text = fmt::format("[{}{}{}]", std::string(static_cast<std::size_t>(full), '='), full < cells ? ">" : "",
                       std::string(static_cast<std::size_t>(std::max(cells - full - 1, 0)), ' '));
  }
  return (text + numbers).substr(0, static_cast<std::size_t>(std::max(columns, 0)));
}

std::string progress_line(int done, int total, double seconds, std::string_view what) {
  return fmt::format("{}/{}  {}{}", done, total, what, rates(done, total, seconds));
}

Progress::Style Progress::style_for_stderr(bool quiet) {
  if (quiet) return Style::none;
  return isatty(STDERR_FILENO) == 1 ? Style::bar : Style::lines;
}

Progress::Progress(Style style) : style_(style), start_(wall_seconds()) {}

Progress::~Progress() {
  if (style_ != Style::bar) return;
  const std::lock_guard lock(bar_mutex);
  if (bar_on_screen) say("\n");
  bar_on_screen = false;
}

void Progress::wipe() {
  const std::lock_guard lock(bar_mutex);
  if (bar_on_screen) say("\r\x1b[K");
  bar_on_screen = false;
}

void Progress::update(int done, int total, std::string_view what) {
  if (style_ == Style::none) return;
  const double now = wall_seconds(), seconds = now - start_;
  if (style_ == Style::lines) {
    say(fmt::format("{}\n", progress_line(done, total, seconds, what)));
    return;
  }
  const std::lock_guard lock(bar_mutex);
  if (bar_on_screen && done < total && now - drawn_ < 0.05) return;  // 20 updates a second are enough
  // One column stays free: some terminals wrap when the last one is written. "\x1b[K" clears what a longer
  // bar left.
  say(fmt::format("\r{}\x1b[K", progress_bar(done, total, seconds, terminal_columns() - 1)));
  drawn_ = now;
  bar_on_screen = true;
}

}  // namespace plisse
