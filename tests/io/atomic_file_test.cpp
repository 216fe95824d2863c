#include "ahm/io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include "files.hpp"

namespace ahm::io::test {
namespace {

using AtomicFileTest = Files;

TEST_F(AtomicFileTest, AppearsOnlyOnCommit) {
  AtomicFile file(path("a.txt"));
  file.write("hello");
  EXPECT_FALSE(std::filesystem::exists(path("a.txt")));
  file.commit();
  EXPECT_EQ(contents(path("a.txt")), "hello");
  EXPECT_EQ(files_left(), 1u);
}

TEST_F(AtomicFileTest, LeavesNothingWithoutCommit) {
  make("a.txt", "old");
  {
    AtomicFile file(path("a.txt"));
    file.write(std::string(3 << 20, 'x'));
  }
  EXPECT_EQ(contents(path("a.txt")), "old");
  EXPECT_EQ(files_left(), 1u);
}

TEST_F(AtomicFileTest, KeepsThePermissionsAndFollowsLinks) {
  make("real.txt", "old");
  std::filesystem::permissions(path("real.txt"),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::filesystem::create_symlink("real.txt", path("link.txt"));
  AtomicFile file(path("link.txt"));
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.txt")));
  EXPECT_EQ(contents(path("real.txt")), "new");
  EXPECT_EQ(std::filesystem::status(path("real.txt")).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST_F(AtomicFileTest, MakesWhatALinkLeadsTo) {
  std::filesystem::create_directory(path("folder"));
  std::filesystem::create_symlink("folder/new.txt", path("first.txt"));
  std::filesystem::create_symlink("first.txt", path("link.txt"));
  AtomicFile file(path("link.txt"));
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.txt")) && std::filesystem::is_symlink(path("first.txt")));
  EXPECT_EQ(contents(path("folder/new.txt")), "new");
}

TEST_F(AtomicFileTest, RefusesDirectoriesAndMissingDirectories) {
  EXPECT_THROW(AtomicFile{directory_}, IoError);
  EXPECT_THROW(AtomicFile{path("absent/a.txt")}, IoError);
  EXPECT_EQ(files_left(), 0u);
}

TEST_F(AtomicFileTest, ReportsAFullDisk) {
  try {
    AtomicFile file("/dev/full");
    file.write("x");
    file.commit();
    FAIL() << "/dev/full took it";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
}

TEST_F(AtomicFileTest, LeavesNothingWhenTheFileMayNotGrow) {
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit{1 << 16, 1 << 16};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    try {
      AtomicFile file(path("big.txt"));
      file.write(std::string(4 << 20, 'x'));
      file.commit();
      ::_exit(1);
    } catch (const IoError&) {
      ::_exit(files_left() == 0 ? 0 : 2);
    }
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST_F(AtomicFileTest, ReportsAClosedPipeInsteadOfDying) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  AtomicFile file(path("pipe"));
  ::close(reader);
  file.write("x");
  EXPECT_THROW(file.commit(), IoError);
}

TEST_F(AtomicFileTest, WritesToAPipeThatIsRead) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  AtomicFile file(path("pipe"));
  file.write("through");
  file.commit();
  char text[16] = {};
  EXPECT_EQ(::read(reader, text, sizeof text), 7);
  EXPECT_STREQ(text, "through");
  ::close(reader);
}

TEST_F(AtomicFileTest, IsRemovedByASignalHandler) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGTERM, [](int) {
      remove_unfinished_files();
      ::_exit(0);
    });
    AtomicFile file(path("a.txt"));
    file.write(std::string(3 << 20, 'x'));
    ::raise(SIGTERM);
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(files_left(), 0u);
}

/// A process that has been and is no more.
pid_t dead_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST_F(AtomicFileTest, RemovesWhatKilledProcessesLeft) {
  const std::string dead = ".ahm-" + std::to_string(dead_process());
  make(dead + "-0.tmp", "half");
  make(dead + "-17.tmp", "half");
  AtomicFile file(path("a.txt"));
  file.commit();
  EXPECT_EQ(files_left(), 1u);
}

/// Some files of that name, one after the other.
bool writes(const std::filesystem::path& path) {
  try {
    for (int time = 0; time < 10; ++time) {
      AtomicFile file(path);
      file.write("whole");
      file.commit();
    }
    return true;
  } catch (const IoError&) {
    return false;
  }
}

// In a container every process may have the number of the one that was killed.
TEST_F(AtomicFileTest, RemovesThemWhoeverHasTheirNumberNow) {
  make(".ahm-" + std::to_string(::getpid()) + "-900.tmp", "half");
  make(".ahm-1-0.tmp", "half");
  AtomicFile file(path("a.txt"));
  file.commit();
  EXPECT_EQ(files_left(), 1u);
}

/// Each process tidies up when it makes its first file there: then another's may not be locked yet.
TEST_F(AtomicFileTest, ProcessesThatBeginTogetherKeepTheirFiles) {
  constexpr int processes = 8, rounds = 100;
  for (int round = 0; round < rounds; ++round) {
    std::array<int, 2> start{};
    ASSERT_EQ(::pipe(start.data()), 0);
    std::vector<pid_t> children;
    for (int k = 0; k < processes; ++k) {
      children.push_back(::fork());
      if (children.back() != 0) continue;
      char at_once = 0;
      ::close(start[1]);
      ::_exit(::read(start[0], &at_once, 1) == 0 && writes(path(std::to_string(k))) ? 0 : 1);
    }
    ::close(start[0]), ::close(start[1]);
    for (const pid_t child : children) {
      int status = 1;
      EXPECT_EQ(::waitpid(child, &status, 0), child);
      EXPECT_EQ(status, 0);
    }
  }
  EXPECT_EQ(files_left(), std::size_t{processes});
}

TEST_F(AtomicFileTest, KeepsItsOwnAndTheirLockUntilTheyAreNamed) {
  AtomicFile one(path("a.txt")), two(path("b.txt"));
  one.write("one");
  one.finish();
  const pid_t child = ::fork();  // another process that tidies up here
  if (child == 0) {
    const auto folder = path("").string();
    ::execlp("/bin/sh", "sh", "-c", ("for f in " + folder + "/.ahm-*; do flock -n \"$f\" rm \"$f\"; done").c_str(),
             nullptr);
    ::_exit(1);
  }
  ::waitpid(child, nullptr, 0);
  one.commit();
  two.commit();
  EXPECT_EQ(contents(path("a.txt")), "one");
  EXPECT_EQ(files_left(), 2u);
}

TEST_F(AtomicFileTest, AreNamedTogetherInASet) {
  make("a.txt", "old");
  const auto write = [&](const char* name) {
    AtomicFile file(path(name));
    file.write("new");
    file.commit();
  };
  {
    FileSet set;
    write("a.txt"), write("b.txt");
    EXPECT_EQ(contents(path("a.txt")), "old");
    EXPECT_FALSE(std::filesystem::exists(path("b.txt")));
  }
  EXPECT_EQ(contents(path("a.txt")), "old");
  EXPECT_EQ(files_left(), 1u);
  {
    FileSet set;
    write("a.txt");
    {
      FileSet inner;
      write("c.txt");
      FileSet::commit();
      EXPECT_EQ(contents(path("c.txt")), "new");
    }
    write("b.txt");
    EXPECT_EQ(contents(path("a.txt")), "old");
    FileSet::commit();
  }
  for (const char* name : {"a.txt", "b.txt", "c.txt"}) EXPECT_EQ(contents(path(name)), "new");
  EXPECT_EQ(files_left(), 3u);
  FileSet::commit();  // none: nothing to do
  write("d.txt");
  EXPECT_EQ(contents(path("d.txt")), "new");
}

TEST_F(AtomicFileTest, LeavesTheFilesOfOthersAlone) {
  const std::string dead = ".ahm-" + std::to_string(dead_process());
  const std::string locked = dead + "-0.tmp";  // as by a process on another machine
  const std::vector<std::string> names{locked,         ".ahm-0-0.tmp", ".ahm--5-0.tmp", dead + "-0.x",
                                       ".ahm-x-0.tmp", "ahm-2-0.tmp",  ".ahm-.tmp",     ".ahm-99999999999999-0.tmp"};
  for (const std::string& name : names) make(name, "precious");
  std::filesystem::create_directory(path(dead + "-3.tmp"));
  const int descriptor = ::open(path(locked).c_str(), O_RDONLY);
  ASSERT_EQ(::flock(descriptor, LOCK_EX | LOCK_NB), 0);
  AtomicFile file(path("a.txt"));
  file.commit();
  ::close(descriptor);
  for (const std::string& name : names) EXPECT_EQ(contents(path(name)), "precious") << name;
  EXPECT_EQ(files_left(), names.size() + 2);
}

TEST_F(AtomicFileTest, ForgetsCommittedFiles) {
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile file(path("a.txt"));
    file.commit();
    remove_unfinished_files();
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(std::filesystem::exists(path("a.txt")));
}

TEST_F(AtomicFileTest, IsRemovedWhileOtherThreadsWrite) {
  for (int tries = 0; tries < 20; ++tries) {
    const pid_t child = ::fork();
    if (child == 0) {
      std::atomic<int> begun{0};
      for (const char* name : {"a", "b", "c"}) {
        std::thread([&, name] {
          for (;;) {
            AtomicFile file(path(name));
            ++begun;
            file.commit();
          }
        }).detach();
      }
      while (begun < 100) std::this_thread::yield();
      remove_unfinished_files();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    for (const auto& entry : std::filesystem::directory_iterator(path("")))
      EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
  }
}

TEST_F(AtomicFileTest, WorksWithMoreFilesThanTheRegistryHolds) {
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (int k = 0; k < 40; ++k) files.push_back(std::make_unique<AtomicFile>(path(std::to_string(k))));
  for (auto& file : files) file->commit();
  EXPECT_EQ(files_left(), 40u);
}

}  // namespace
}  // namespace ahm::io::test
