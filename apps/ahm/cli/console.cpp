#include "cli/console.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "ahm/error.hpp"

namespace ahm::app {

void say(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void warn(std::string_view text) { say("ahm: warning: " + std::string(text) + "\n"); }

void print(std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return;
  if (errno == EPIPE) throw BrokenPipe{};
  throw IoError("cannot write to standard output: " + std::generic_category().message(errno));
}

bool is_terminal() { return isatty(STDERR_FILENO) == 1; }

}  // namespace ahm::app
