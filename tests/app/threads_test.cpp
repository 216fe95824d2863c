// --threads bounds what runs at once.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "program.hpp"

namespace ahm::test {
namespace {

/// Threads of a process now; 0 once it has ended.
int thread_count(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("State:") && line.find('Z') != std::string::npos)
      return 0;
    else if (line.starts_with("Threads:"))
      return std::stoi(line.substr(8));
  return 0;
}

/// The most threads at once of a run that draws a picture, once its map is solved.
int most_threads(const std::string& threads) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(300)));
  setenv("OPENBLAS_NUM_THREADS", "1", 1);  // else a pool waits from the start
  const Running running = start({"logmap", input, "--source", "0", "--threads", threads, "-o", folder / "map.csv",
                                 "--view", folder / "map.png", "--size", "1600x1200", "--verbose"});
  unsetenv("OPENBLAS_NUM_THREADS");
  read_until(running, "solve ");
  int most = 0;
  for (int now = 1; (now = thread_count(running.pid)) > 0; std::this_thread::sleep_for(std::chrono::milliseconds(1)))
    most = std::max(most, now);
  const Outcome outcome = finish(running);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return most;
}

TEST(Threads, OfPicturesAreThoseAskedFor) {
  if (!std::filesystem::exists("/proc/self/status")) GTEST_SKIP() << "no /proc";
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(100)));
  if (run({"logmap", input, "-s", "0", "-o", folder / "a.csv", "--view", folder / "a.png"}).err.find("cannot write") !=
      std::string::npos)
    GTEST_SKIP() << "built without pictures";
  EXPECT_LE(most_threads("1"), 1);  // none is seen where this process is kept from looking until the run has ended
  EXPECT_LE(most_threads("4"), 4);  // a busy machine may be done before the last one starts
}

}  // namespace
}  // namespace ahm::test
