#include "ahm/io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "files.hpp"
#include "support/child_process.hpp"
#include "support/expect_error.hpp"

namespace ahm::io::test {
namespace {

using ahm::test::status_of_child;

class AtomicFiles : public Files {
 protected:
  static void write(const std::filesystem::path& path, std::string_view bytes = "new") {
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
  }
};

const std::string large(4 << 20, 'x');  // more than the buffer

TEST_F(AtomicFiles, AppearOnCommitOnly) {
  AtomicFile file(path("a.txt"));
  file.write("hello");
  EXPECT_FALSE(std::filesystem::exists(path("a.txt")));
  file.commit();
  EXPECT_EQ(contents(path("a.txt")), "hello");
  EXPECT_EQ(files_left(), 1u);
}

TEST_F(AtomicFiles, LeaveNothingWithoutCommit) {
  make("a.txt", "old");
  AtomicFile(path("a.txt")).write(large);
  EXPECT_EQ(contents(path("a.txt")), "old");
  EXPECT_EQ(files_left(), 1u);
}

TEST_F(AtomicFiles, KeepPermissionsAndFollowLinks) {
  constexpr auto permissions = std::filesystem::perms::owner_read | std::filesystem::perms::owner_write;
  std::filesystem::permissions(make("real.txt", "old"), permissions);
  std::filesystem::create_symlink("real.txt", path("link.txt"));
  write(path("link.txt"));
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.txt")));
  EXPECT_EQ(contents(path("real.txt")), "new");
  EXPECT_EQ(std::filesystem::status(path("real.txt")).permissions(), permissions);
}

TEST_F(AtomicFiles, CreateTheTargetOfLinks) {
  std::filesystem::create_directory(path("folder"));
  std::filesystem::create_symlink("folder/new.txt", path("first.txt"));
  std::filesystem::create_symlink("first.txt", path("link.txt"));
  write(path("link.txt"));
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.txt")) && std::filesystem::is_symlink(path("first.txt")));
  EXPECT_EQ(contents(path("folder/new.txt")), "new");
}

TEST_F(AtomicFiles, RefuseFoldersAndMissingFolders) {
  EXPECT_THROW(AtomicFile{directory_}, IoError);
  EXPECT_THROW(AtomicFile{path("absent/a.txt")}, IoError);
  EXPECT_EQ(files_left(), 0u);
}

TEST_F(AtomicFiles, ReportAFullDisk) {
  ahm::test::expect_error<IoError>([] { write("/dev/full"); }, "No space left");
}

TEST_F(AtomicFiles, LeaveNothingWhereFilesMayNotGrow) {
  EXPECT_EQ(status_of_child([&] {
              const rlimit limit{1 << 16, 1 << 16};
              ::setrlimit(RLIMIT_FSIZE, &limit);
              std::signal(SIGXFSZ, SIG_IGN);
              try {
                write(path("big.txt"), large);
                return 1;
              } catch (const IoError&) {
                return files_left() == 0 ? 0 : 2;
              }
            }),
            0);
}

TEST_F(AtomicFiles, WriteToPipesAndReportClosedOnes) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  write(path("pipe"), "through");
  std::array<char, 16> text{};
  EXPECT_EQ(::read(reader, text.data(), text.size()), 7);
  EXPECT_STREQ(text.data(), "through");
  AtomicFile file(path("pipe"));
  ::close(reader);
  file.write("x");
  EXPECT_THROW(file.commit(), IoError);
}

TEST_F(AtomicFiles, AreRemovedByASignalHandler) {
  EXPECT_EQ(status_of_child([&] {
              std::signal(SIGTERM, [](int) {
                remove_unfinished_files();
                ::_exit(0);
              });
              write(path("committed.txt"));
              AtomicFile file(path("a.txt"));
              file.write(large);
              ::raise(SIGTERM);
              return 1;
            }),
            0);
  EXPECT_EQ(contents(path("committed.txt")), "new");
  EXPECT_EQ(files_left(), 1u);
}

TEST_F(AtomicFiles, AreRemovedWhileOtherThreadsWrite) {
  for (int tries = 0; tries < 20; ++tries) {
    EXPECT_EQ(status_of_child([&] {
                std::atomic<int> begun{0};
                for (const char* name : {"a", "b", "c"})
                  std::thread([&, name] {
                    for (;;) {
                      AtomicFile file(path(name));
                      ++begun;
                      file.commit();
                    }
                  }).detach();
                while (begun < 100) std::this_thread::yield();
                remove_unfinished_files();
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
                ::_exit(0);  // without destructors of what the threads use
                return 0;
              }),
              0);
    for (const auto& entry : std::filesystem::directory_iterator(path("")))
      EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
  }
}

/// The beginning of the names of unfinished files of a process that has ended.
std::string dead_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return ".ahm-" + std::to_string(child);
}

TEST_F(AtomicFiles, RemoveTheFilesOfKilledProcesses) {
  const std::string dead = dead_process();
  // In a container, every process may have the number of the one that was killed.
  for (const std::string& name :
       {dead + "-0", dead + "-17", ".ahm-" + std::to_string(::getpid()) + "-900", std::string(".ahm-1-0")})
    make(name + ".tmp", "half");
  write(path("a.txt"));
  EXPECT_EQ(files_left(), 1u);
}

TEST_F(AtomicFiles, LeaveOtherFilesAlone) {
  const std::string dead = dead_process(), locked = dead + "-0.tmp";  // as by a process on another machine
  const std::vector<std::string> names{locked,         ".ahm-0-0.tmp", ".ahm--5-0.tmp", dead + "-0.x",
                                       ".ahm-x-0.tmp", "ahm-2-0.tmp",  ".ahm-.tmp",     ".ahm-99999999999999-0.tmp"};
  for (const std::string& name : names) make(name, "precious");
  std::filesystem::create_directory(path(dead + "-3.tmp"));
  const int descriptor = ::open(path(locked).c_str(), O_RDONLY);
  ASSERT_EQ(::flock(descriptor, LOCK_EX | LOCK_NB), 0);
  write(path("a.txt"));
  ::close(descriptor);
  for (const std::string& name : names) EXPECT_EQ(contents(path(name)), "precious") << name;
  EXPECT_EQ(files_left(), names.size() + 2);
}

/// Each process removes old files when it opens its first file. The files of other processes may not be locked yet.
TEST_F(AtomicFiles, OfProcessesThatBeginTogetherAreKept) {
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
      if (::read(start[0], &at_once, 1) != 0) ::_exit(1);
      try {
        for (int time = 0; time < 10; ++time) write(path(std::to_string(k)));
      } catch (const IoError&) {
        ::_exit(2);
      }
      ::_exit(0);
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

TEST_F(AtomicFiles, AreLockedUntilTheyAreNamed) {
  AtomicFile one(path("a.txt")), two(path("b.txt"));
  one.write("one");
  one.finish();
  status_of_child([&] {  // another process that removes files without locks
    const std::string files = path("").string() + "/.ahm-*";
    return ::execlp("/bin/sh", "sh", "-c", ("for f in " + files + "; do flock -n \"$f\" rm \"$f\"; done").c_str(),
                    nullptr);
  });
  one.commit();
  two.commit();
  EXPECT_EQ(contents(path("a.txt")), "one");
  EXPECT_EQ(files_left(), 2u);
}

TEST_F(AtomicFiles, OfASetAreNamedTogether) {
  make("a.txt", "old");
  {
    const FileSet set;
    write(path("a.txt")), write(path("b.txt"));
    EXPECT_EQ(contents(path("a.txt")), "old");
    EXPECT_FALSE(std::filesystem::exists(path("b.txt")));
  }
  EXPECT_EQ(contents(path("a.txt")), "old");
  EXPECT_EQ(files_left(), 1u);
  {
    const FileSet set;
    write(path("a.txt"));
    {
      const FileSet inner;
      write(path("c.txt"));
      FileSet::commit();
      EXPECT_EQ(contents(path("c.txt")), "new");
    }
    write(path("b.txt"));
    EXPECT_EQ(contents(path("a.txt")), "old");
    FileSet::commit();
  }
  for (const char* name : {"a.txt", "b.txt", "c.txt"}) EXPECT_EQ(contents(path(name)), "new");
  EXPECT_EQ(files_left(), 3u);
  FileSet::commit();  // there is no set
  write(path("d.txt"));
  EXPECT_EQ(contents(path("d.txt")), "new");
}

TEST_F(AtomicFiles, MayBeMoreThanTheRegistryHolds) {
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (int k = 0; k < 40; ++k) files.push_back(std::make_unique<AtomicFile>(path(std::to_string(k))));
  for (auto& file : files) file->commit();
  EXPECT_EQ(files_left(), 40u);
}

}  // namespace
}  // namespace ahm::io::test
