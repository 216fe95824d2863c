/// \file
/// Runs programs: alone, and as ranks of MPI.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "files.hpp"

#ifndef AHM_MPIRUN  // built without MPI
#define AHM_MPIRUN ""
#define AHM_MPI_PROGRAM ""
#endif

namespace ahm::test {

/// Runs a command of the shell, which must exit with `status`. @return its output on both streams
inline std::string output_of(const std::string& command, int status = 0) {
  std::FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  EXPECT_NE(pipe, nullptr);
  if (pipe == nullptr) return {};
  std::string text;
  for (std::array<char, 400> part{}; const std::size_t length = std::fread(part.data(), 1, part.size(), pipe);)
    text.append(part.data(), length);
  EXPECT_EQ(WEXITSTATUS(::pclose(pipe)), status) << text;
  return text;
}

/// A program that runs in the background, in a process group of its own. The end of the object ends the group.
class Background {
 public:
  /// @param words  the path of the program and its arguments
  /// @param log  file for the output on both streams
  Background(std::vector<std::string> words, path log) : log_(std::move(log)) {
    process_ = ::fork();
    ::setpgid(process_, process_);  // by both processes, so that the group exists before either continues
    if (process_ != 0) return;
    const int file = ::open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(file, STDOUT_FILENO), ::dup2(file, STDERR_FILENO);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  ~Background() {
    if (process_ > 0 && !has_ended_) ::kill(-process_, SIGKILL), ::waitpid(process_, nullptr, 0);
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// @return the exit status, or 128 and the number of the signal; -1: still running after `limit`
  int wait(std::chrono::milliseconds limit = std::chrono::seconds(300)) {
    const auto end = std::chrono::steady_clock::now() + limit;
    int status = 0;
    while (::waitpid(process_, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > end) return -1;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    has_ended_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// Waits for an event, at most a minute. The program must still run then.
  void wait_for(const std::function<bool()>& event) {
    for (int tries = 0; tries < 12'000 && !event(); ++tries)
      if (wait(std::chrono::milliseconds(5)) != -1) throw std::runtime_error("ended too early: " + log());
    if (!event()) throw std::runtime_error("no event within a minute: " + log());
  }
  std::string log() const { return read_file(log_); }
  pid_t process() const { return process_; }
  std::vector<pid_t> children() const {
    std::vector<pid_t> found;
    for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(process_) + "/task")) {
      std::ifstream file(task.path() / "children");
      std::copy(std::istream_iterator<pid_t>(file), {}, std::back_inserter(found));
    }
    return found;
  }

 private:
  path log_;
  pid_t process_ = -1;
  bool has_ended_ = false;
};

/// Starts ahm-mpi with this number of ranks. The folder of `log` gets the files of MPI too: runs at the same time that
/// share a folder can remove each other's.
inline Background start_mpi(int ranks, const std::vector<std::string>& arguments, const path& log) {
  // Allows root, more ranks than cores that share the cores, and shared memory as in any container. MPI itself leaks.
  const char* script =
      "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
      "OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_btl=self,vader "
      "OMPI_MCA_btl_vader_single_copy_mechanism=none ASAN_OPTIONS=detect_leaks=0 TMPDIR=\"$0\"; exec \"$@\"";
  std::vector<std::string> words{
      "/bin/sh", "-c", script, log.parent_path().string(), AHM_MPIRUN, "-n", std::to_string(ranks), AHM_MPI_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return {std::move(words), log};
}

/// Runs ahm-mpi, which must exit with `status`. @return its output
inline std::string mpi_output(int ranks, const std::vector<std::string>& arguments, const path& log, int status = 0) {
  Background run = start_mpi(ranks, arguments, log);
  EXPECT_EQ(run.wait(), status) << run.log();
  return run.log();
}

}  // namespace ahm::test
