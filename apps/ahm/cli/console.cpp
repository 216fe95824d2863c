#include "cli/console.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <system_error>
#include <thread>

#include "ahm/error.hpp"

namespace ahm::app {
namespace {

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && std::string_view(value) != "";
}

}  // namespace

bool open_browser(const std::string& address) {
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) return false;
  std::string program = "xdg-open", argument = address;
  char* arguments[] = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_RDWR, 0);
  pid_t process = 0;
  const int failure = posix_spawnp(&process, program.c_str(), &quiet, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&quiet);
  return failure == 0;
}

void print_to_stderr(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void warn(std::string_view text) { print_to_stderr("ahm: warning: " + std::string(text) + "\n"); }

void print(std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return;
  if (errno == EPIPE) throw BrokenPipe{};
  throw IoError("cannot write to standard output: " + std::generic_category().message(errno));
}

bool is_terminal() { return isatty(STDERR_FILENO) == 1; }

namespace {

constexpr std::string_view clear_line = "\r\x1b[K";

/// A progress bar. For a stage that does not report its progress, a block that moves back and forth.
std::string bar(double fraction, double seconds) {
  constexpr int width = 30, block = 4;
  if (fraction > 0) {
    const int filled = static_cast<int>(std::lround(fraction * width));
    return fmt::format("{:#<{}}{:.<{}}", "", filled, "", width - filled);
  }
  constexpr int travel = width - block;
  const int step = static_cast<int>(seconds * 10) % (2 * travel);
  const int left = step < travel ? step : 2 * travel - step;
  return fmt::format("{:.<{}}{:#<{}}{:.<{}}", "", left, "", block, "", travel - left);
}

}  // namespace

struct ProgressDisplay::Painter {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  std::string stage;
  double fraction = 0;
  bool is_drawn = false;
  // Draws in a thread of its own: the longest stage, the factorization, reports no progress, so only the clock changes.
  std::jthread thread{[this](const std::stop_token& stop) { run(stop); }};  // last: it uses the members above

  ~Painter() {
    thread.request_stop();
    thread.join();
    clear();
  }

  void clear() {
    const std::scoped_lock lock(mutex);
    if (is_drawn) print_to_stderr(clear_line);
    is_drawn = false;
    stage.clear();
  }

  void run(const std::stop_token& stop) {
    std::unique_lock lock(mutex);
    while (!stop.stop_requested()) {
      wake.wait_for(lock, stop, std::chrono::milliseconds(200), [] { return false; });
      if (!stop.stop_requested() && !stage.empty()) draw();
    }
  }

  void draw() {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (seconds < 1.0) return;
    print_to_stderr(fmt::format("{}[{}] {:.0f} s  {}", clear_line, bar(fraction, seconds), std::floor(seconds),
                                stage.substr(0, 32)));
    is_drawn = true;
  }
};

ProgressDisplay::ProgressDisplay(bool shown) {
  if (shown && is_terminal()) painter_ = std::make_unique<Painter>();
}

ProgressDisplay::~ProgressDisplay() = default;

void ProgressDisplay::update(std::string_view stage, double fraction) {
  if (!painter_) return;
  const std::scoped_lock lock(painter_->mutex);
  painter_->stage = stage;
  painter_->fraction = std::clamp(std::isfinite(fraction) ? fraction : 0.0, 0.0, 1.0);
}

Progress ProgressDisplay::progress() {
  if (!painter_) return {};
  return {[this](std::string_view stage, double fraction) { update(stage, fraction); }, {}};
}

void ProgressDisplay::clear() {
  if (painter_) painter_->clear();
}

}  // namespace ahm::app
