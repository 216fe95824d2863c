// Interrupts, closed pipes, full disks: the program ends soon, with a status, and leaves nothing half done.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

class Interrupt : public testing::TestWithParam<int> {};

TEST_P(Interrupt, EndsTheRunInAnyStageAndLeavesNothingHalfDone) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(60000)));
  int interrupted = 0;
  for (const char* stage : {"read", "graph", "factor", "solve"}) {
    const Running running = start({"logmap", input, "--source", "0", "--method", "heat", "-o", folder / "map.csv",
                                   "--json", folder / "map.json", "--verbose"});
    const std::string said = read_until(running, stage);  // it has just ended, the next one runs
    EXPECT_NE(said.find(stage), std::string::npos) << said;
    kill(running.pid, GetParam());
    const auto outcome = finish(running);
    if (outcome.status != 0) {  // else it was done before
      EXPECT_EQ(outcome.status, 128 + GetParam()) << outcome.err;
      EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
      ++interrupted;
    }
    // Whatever has its name is complete.
    for (const std::string& file : folder.files()) {
      EXPECT_TRUE(file == "sphere.xyz" || file == "map.csv" || file == "map.json") << file;
      if (file == "map.csv") {
        EXPECT_EQ(read_csv(folder / file).size(), 60000U);
      }
      if (file == "map.json") {
        EXPECT_EQ(read_json(folder / file).at("n"), 60000);
      }
      if (file != "sphere.xyz") std::filesystem::remove(folder / file);
    }
  }
  EXPECT_GT(interrupted, 0);
}

INSTANTIATE_TEST_SUITE_P(BySignal, Interrupt, testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(Killed, LeavesWhatTheNextRunRemoves) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(2000)));
  const Running running = start({"logmap", input, "--source", "0", "-o", folder / "map.csv", "--verbose"});
  read_until(running, "read");
  kill(running.pid, SIGKILL);
  finish(running);
  folder.write(".ahm-" + std::to_string(running.pid) + "-0.tmp", "index,x,");
  EXPECT_EQ(run({"logmap", input, "--source", "0", "-o", folder / "map.csv"}).status, 0);
  EXPECT_EQ(folder.files(), (Words{"map.csv", "sphere.xyz"}));
}

/// The moments are seeded, where they fall is not: the same holds of each.
TEST(Killed, AtRandomMomentsLeavesTheOldFileOrTheWholeNewOne) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(2000)));
  const Words words{"logmap", input, "--source", "0", "-o", folder / "map.csv"};
  const auto start_of_run = std::chrono::steady_clock::now();
  ASSERT_EQ(run(words).status, 0);
  const std::chrono::duration<double> length = std::chrono::steady_clock::now() - start_of_run;
  const std::string whole = read_text(folder / "map.csv");
  std::mt19937 random(4);
  std::uniform_real_distribution<double> moment(0, 1.2);
  for (const int signal : {SIGKILL, SIGINT, SIGTERM})
    for (int times = 0; times < 8; ++times) {
      folder.write("map.csv", "precious\n");
      const Running running = start(words);
      std::this_thread::sleep_for(moment(random) * length);
      kill(running.pid, signal);
      const int status = finish(running).status;
      const std::string text = read_text(folder / "map.csv");
      EXPECT_TRUE(text == whole || text == "precious\n") << text.substr(0, 80);
      if (status == 0) {
        EXPECT_EQ(text, whole);
      }
    }
  EXPECT_EQ(run(words).status, 0);
  EXPECT_EQ(folder.files(), (Words{"map.csv", "sphere.xyz"}));
  EXPECT_EQ(read_text(folder / "map.csv"), whole);
}

TEST(ClosedPipe, IsNoSuccessAndNoNoise) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(500)));
  for (const Words& words : {Words{"logmap", input, "--source", "0", "-o", folder / "map.csv", "--json", "-"},
                             Words{"info", input}, Words{"--help"}}) {
    Running running = start(words);
    close(running.out);
    running.out = -1;
    const auto outcome = finish(running);
    EXPECT_NE(outcome.status, 0);
    EXPECT_LT(outcome.status, 128);
    EXPECT_EQ(outcome.err.find("error"), std::string::npos) << outcome.err;
  }
}

TEST(FullDisk, LeavesNothing) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(2000)));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{20000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const Running running = start({"logmap", input, "--source", "0", "-o", folder / "map.csv"});
  setrlimit(RLIMIT_FSIZE, &before);
  const auto outcome = finish(running);
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("map.csv"), std::string::npos) << outcome.err;
  EXPECT_EQ(folder.files(), Words{"sphere.xyz"});
}

/// A run with so little address space. The libraries alone take 110 MB, the BLAS buffers 128 MB each.
Outcome run_within(rlim_t megabytes, const Words& words) {
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit small{megabytes << 20, before.rlim_max};
  // The limit is for the child alone: this process is above it, and only keeps what it has until the child is there.
  setrlimit(RLIMIT_AS, &small);
  Running running;
  try {
    running = start(words);
  } catch (...) {
    setrlimit(RLIMIT_AS, &before);
    throw;
  }
  setrlimit(RLIMIT_AS, &before);
  return finish(running);
}

TEST(ScarceMemory, IsNamedAndEndsTheRun) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(4000)));
  int refused = 0, done = 0;
  for (const rlim_t megabytes : {250, 350, 500, 700, 1600}) {
    for (const Words& words : {Words{"logmap", input, "--source", "0", "-o", folder / "map.csv"},
                               Words{"local-maps", input, "--radius", "100", "-o", folder / "maps.npz"}}) {
      const auto outcome = run_within(megabytes, words);
      ASSERT_TRUE(outcome.status == 0 || outcome.status == 1) << megabytes << " MB: " << outcome.status << outcome.err;
      if (outcome.status == 1) {
        EXPECT_NE(outcome.err.find("memory"), std::string::npos) << megabytes << " MB: " << outcome.err;
      }
      ++(outcome.status == 0 ? done : refused);
      for (const std::string& file : folder.files()) EXPECT_FALSE(file.ends_with(".tmp")) << file;
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(done, 0);
}

TEST(ScarceMemory, IsNotFilledByAStreamWithoutEnd) {
  Folder folder;
  const std::string command = "yes 1 2 3 | (ulimit -v 1500000; '" AHM_PROGRAM "' info - 2> '" + (folder / "words") +
                              "'; echo $? > '" + (folder / "status") + "')";
  std::system(command.c_str());
  EXPECT_EQ(read_text(folder / "status"), "1\n");
  EXPECT_NE(read_text(folder / "words").find("a third of the free memory"), std::string::npos)
      << read_text(folder / "words");
}

// Threads take address space of their own: where one thread can march, two do not fail.
TEST(ScarceMemory, SufficesForTwoThreadsWhereItDoesForOne) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(20000)));
  const auto status = [&](rlim_t megabytes, const char* threads) {
    return run_within(megabytes, {"logmap", input, "--source", "0", "--strategy", "march", "--threads", threads, "-o",
                                  folder / "map.csv"})
        .status;
  };
  rlim_t enough = 250;
  while (enough < 3000 && status(enough, "1") != 0) enough += 25;
  EXPECT_EQ(status(enough + 25, "2"), 0) << enough << " MB";
}

}  // namespace
}  // namespace ahm::test
