// Interrupts, closed pipes, full disks and scarce memory: the program ends soon with a status, and no output is incomplete.
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

class Interrupt : public InFolder, public testing::WithParamInterface<int> {};

TEST_P(Interrupt, EndsTheRunInAnyStage) {
  write("sphere.xyz", xyz(sphere(60000)));
  int interrupted = 0;
  for (const char* stage : {"read", "graph", "factor", "solve"}) {
    const Running running = start("logmap sphere.xyz --source 0 --method heat -o map.csv --json map.json --verbose");
    EXPECT_TRUE(has(read_until(running, stage), stage));  // This stage has ended, the next one runs.
    kill(running.pid, GetParam());
    const auto outcome = finish(running);
    if (outcome.status != 0) {  // not finished before the signal
      EXPECT_EQ(outcome.status, 128 + GetParam()) << outcome.err;
      EXPECT_TRUE(has(outcome.err, "interrupted"));
      ++interrupted;
    }
    for (const std::string& file : files()) {  // A file with its final name is complete.
      EXPECT_TRUE(file == "sphere.xyz" || file == "map.csv" || file == "map.json") << file;
      if (file == "map.csv") {
        EXPECT_EQ(read_csv(file).size(), 60000U);
      }
      if (file == "map.json") {
        EXPECT_EQ(read_json(file).at("n"), 60000);
      }
      if (file != "sphere.xyz") std::filesystem::remove(file);
    }
  }
  EXPECT_GT(interrupted, 0);
}

INSTANTIATE_TEST_SUITE_P(BySignal, Interrupt, testing::Values(SIGINT, SIGTERM, SIGHUP));

using Killed = InFolder;

TEST_F(Killed, LeavesFilesThatTheNextRunRemoves) {
  write("sphere.xyz", xyz(sphere(2000)));
  const Running running = start("logmap sphere.xyz --source 0 -o map.csv --verbose");
  read_until(running, "read");
  kill(running.pid, SIGKILL);
  finish(running);
  write(".ahm-" + std::to_string(running.pid) + "-0.tmp", "index,x,");
  run_ok("logmap sphere.xyz --source 0 -o map.csv");
  EXPECT_EQ(files(), (Words{"map.csv", "sphere.xyz"}));
}

/// The moments are seeded. The stage of the run at a moment is not, but the law holds in every stage.
TEST_F(Killed, AtRandomMomentsLeavesTheOldFileOrTheCompleteNewOne) {
  write("sphere.xyz", xyz(sphere(2000)));
  const std::string command = "logmap sphere.xyz --source 0 -o map.csv";
  const auto start_of_run = std::chrono::steady_clock::now();
  run_ok(command);
  const std::chrono::duration<double> length = std::chrono::steady_clock::now() - start_of_run;
  const std::string complete = read_text("map.csv");
  std::mt19937 random(4);
  std::uniform_real_distribution<double> moment(0, 1.2);
  for (const int signal : {SIGKILL, SIGINT, SIGTERM})
    for (int times = 0; times < 8; ++times) {
      write("map.csv", "precious\n");
      const Running running = start(command);
      std::this_thread::sleep_for(moment(random) * length);
      kill(running.pid, signal);
      const int status = finish(running).status;
      const std::string text = read_text("map.csv");
      EXPECT_TRUE(text == complete || (text == "precious\n" && status != 0)) << status << text.substr(0, 80);
    }
  run_ok(command);
  EXPECT_EQ(files(), (Words{"map.csv", "sphere.xyz"}));
  EXPECT_EQ(read_text("map.csv"), complete);
}

using Scarce = InFolder;

TEST_F(Scarce, ReadersOfAPipeEndTheRunWithoutAMessage) {
  write("sphere.xyz", xyz(sphere(500)));
  for (const char* command : {"logmap sphere.xyz --source 0 -o map.csv --json -", "info sphere.xyz", "--help"}) {
    Running running = start(command);
    close(running.out);
    running.out = -1;
    const auto outcome = finish(running);
    EXPECT_TRUE(outcome.status > 0 && outcome.status < 128) << outcome.status;
    EXPECT_FALSE(has(outcome.err, "error"));
  }
}

/// Starts a command with a limit on a resource, which this process has only until the program runs.
Outcome run_within(decltype(RLIMIT_AS) resource, rlim_t most, const std::string& command) {
  rlimit before{};
  getrlimit(resource, &before);
  const rlimit small{most, before.rlim_max};
  setrlimit(resource, &small);
  Running running;
  try {
    running = start(command);
  } catch (...) {
    setrlimit(resource, &before);
    throw;
  }
  setrlimit(resource, &before);
  return finish(running);
}

TEST_F(Scarce, DiskIsReported) {
  write("sphere.xyz", xyz(sphere(2000)));
  const auto outcome = run_within(RLIMIT_FSIZE, 20000, "logmap sphere.xyz --source 0 -o map.csv");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "map.csv"));
  EXPECT_EQ(files(), Words{"sphere.xyz"});
}

// The libraries use 110 MB of address space, each buffer of CHOLMOD's BLAS 128 MB.
TEST_F(Scarce, MemoryIsReported) {
  write("sphere.xyz", xyz(sphere(2000)));
  int refused = 0, done = 0;
  for (const rlim_t megabytes : {250, 400, 700})
    for (const char* command :
         {"logmap sphere.xyz --source 0 -o map.csv", "local-maps sphere.xyz --radius 100 -o maps.npz"}) {
      const auto outcome = run_within(RLIMIT_AS, megabytes << 20, command);
      ASSERT_TRUE(outcome.status == 0 || outcome.status == 1) << megabytes << " MB: " << outcome.status << outcome.err;
      EXPECT_TRUE(outcome.status == 0 || has(outcome.err, "memory")) << megabytes << " MB: " << outcome.err;
      ++(outcome.status == 0 ? done : refused);
      for (const std::string& file : files()) EXPECT_FALSE(file.ends_with(".tmp")) << file;
    }
  EXPECT_GT(refused, 0);
  EXPECT_GT(done, 0);
}

TEST_F(Scarce, MemoryIsNotFilledByAnEndlessStream) {
  std::system("yes 1 2 3 | (ulimit -v 1500000; '" AHM_PROGRAM "' info - 2> errors; echo $? > status)");
  EXPECT_EQ(read_text("status"), "1\n");
  EXPECT_TRUE(has(read_text("errors"), "a third of the free memory"));
}

// Threads need address space. Where it is sufficient for one thread, two threads do not fail.
TEST_F(Scarce, MemoryForOneThreadIsSufficientForTwo) {
  write("sphere.xyz", xyz(sphere(20000)));
  const auto status = [](rlim_t megabytes, const std::string& threads) {
    const std::string command = "logmap sphere.xyz --source 0 --strategy march -o map.csv --threads ";
    return run_within(RLIMIT_AS, megabytes << 20, command + threads).status;
  };
  rlim_t enough = 250;
  while (enough < 3000 && status(enough, "1") != 0) enough += 25;
  EXPECT_EQ(status(enough + 25, "2"), 0) << enough << " MB";
}

}  // namespace
}  // namespace ahm::test
