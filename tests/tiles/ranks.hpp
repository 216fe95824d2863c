/// \file
/// Ranks of an MPI run.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#ifndef AHM_MPIRUN
#define AHM_MPIRUN ""
#endif

namespace ahm::test {

inline std::string text_of(const std::filesystem::path& name) {
  std::ifstream file(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Ranks of which none is left when the object goes.
class Ranks {
 public:
  /// @param words  what follows `mpirun`; all that is said goes to a file
  Ranks(const std::vector<std::string>& words, std::filesystem::path log) : log_(std::move(log)) {
    process_ = ::fork();
    if (process_ != 0) return;
    ::setpgid(0, 0);
    const int file = ::open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(file, STDOUT_FILENO), ::dup2(file, STDERR_FILENO);
    // As root; more ranks than cores, which leave the cores to each other; by shared memory that any container grants.
    const std::pair<const char*, const char*> settings[] = {{"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                                                            {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                                                            {"OMPI_MCA_rmaps_base_oversubscribe", "1"},
                                                            {"OMPI_MCA_mpi_yield_when_idle", "1"},
                                                            {"OMPI_MCA_hwloc_base_binding_policy", "none"},
                                                            {"OMPI_MCA_btl", "self,vader"},
                                                            {"OMPI_MCA_btl_vader_single_copy_mechanism", "none"}};
    for (const auto& [name, value] : settings) ::setenv(name, value, 1);
    ::setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // MPI's own
    std::vector<char*> arguments{const_cast<char*>(AHM_MPIRUN)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(AHM_MPIRUN, arguments.data());
    ::_exit(127);
  }
  ~Ranks() {
    if (process_ > 0 && !is_over_) ::kill(-process_, SIGKILL), ::waitpid(process_, nullptr, 0);
  }
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  /// @return what mpirun returns; -1 for a run that had to be ended
  int wait(std::chrono::seconds most = std::chrono::seconds(300)) {
    const auto end = std::chrono::steady_clock::now() + most;
    int status = 0;
    while (::waitpid(process_, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > end) return -1;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    is_over_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  std::string log() const { return text_of(log_); }
  /// Processes whose parent is mpirun.
  std::vector<pid_t> children() const {
    std::vector<pid_t> found;
    const auto tasks = std::filesystem::path("/proc") / std::to_string(process_) / "task";
    for (const auto& task : std::filesystem::directory_iterator(tasks)) {
      std::ifstream file(task.path() / "children");
      std::copy(std::istream_iterator<pid_t>(file), {}, std::back_inserter(found));
    }
    return found;
  }

 private:
  std::filesystem::path log_;
  pid_t process_ = -1;
  bool is_over_ = false;
};

}  // namespace ahm::test
