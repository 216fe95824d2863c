/// \file
/// Runs work in a child process.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <functional>

namespace ahm::test {

/// The exit status of the child, which is the value of `work`; 128 plus the signal if a signal ended it.
inline int status_of_child(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work());
  int status = 0;
  if (::waitpid(child, &status, 0) != child) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace ahm::test
