// With AHM_WITH_FILES=OFF, memory_files.cpp replaces this file.
#include "ahm/io/atomic_file.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <memory>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include "ahm/io/temporary_folder.hpp"
#include "read/bytes.hpp"
#include "read/input.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

/// Path of an existing temporary file. The registry has a fixed size and no locks because a signal handler reads it.
struct Slot {
  enum State { free, filling, used };
  std::atomic<int> state{free};
  std::array<char, 4096> name{};
};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);
std::array<Slot, 16> unfinished;
std::atomic<bool> is_ending{false};  // true after `remove_unfinished_files`

/// Blocks forever when the process is ending: its temporary files are gone, and any error report would be wrong.
void wait_if_ending() {
  while (is_ending) ::pause();
}

sigset_t all_signals() {
  sigset_t all;
  ::sigfillset(&all);
  return all;
}

sigset_t pipe_signal() {
  sigset_t pipe;
  ::sigemptyset(&pipe);
  ::sigaddset(&pipe, SIGPIPE);
  return pipe;
}

/// Blocks signals of this thread during its lifetime.
class BlockedSignals {
 public:
  explicit BlockedSignals(const sigset_t& signals) { ::pthread_sigmask(SIG_BLOCK, &signals, &before_); }
  ~BlockedSignals() {
    const int error = errno;
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    errno = error;
  }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_{};
};

/// Reserves a slot for a path. @return -1 when all are in use: then the destructor removes the file, but a signal handler does not
int fill_slot(const std::filesystem::path& path) {
  const std::string& name = path.native();
  for (std::size_t k = 0; k < unfinished.size() && name.size() < unfinished[k].name.size(); ++k) {
    int expected = Slot::free;
    if (!unfinished[k].state.compare_exchange_strong(expected, Slot::filling)) continue;
    std::memcpy(unfinished[k].name.data(), name.c_str(), name.size() + 1);
    return static_cast<int>(k);
  }
  return -1;
}

void forget(int& slot) noexcept {
  if (slot >= 0) unfinished[slot].state.store(Slot::free);
  slot = -1;
}

/// Creates a file and registers its path. @return -1 and errno if it cannot be created. A signal handler may run in another thread at
/// the same time. It waits while a slot is being filled, so this thread blocks signals until the slot is filled. Calls that begin
/// after the handler wait for the end of the process.
int create(const std::filesystem::path& path, int& slot) {
  const BlockedSignals undisturbed(all_signals());
  slot = fill_slot(path);
  if (is_ending) forget(slot);
  wait_if_ending();
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) forget(slot);
  if (slot >= 0) unfinished[slot].state.store(Slot::used);
  return file;
}

/// Suppresses SIGPIPE in this thread during its lifetime; a write to a closed pipe then fails with EPIPE.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    sigset_t pending;
    ::sigpending(&pending);
    was_pending_ = ::sigismember(&pending, SIGPIPE) == 1;
  }
  ~NoPipeSignal() {
    const int error = errno;
    const timespec now{};
    const sigset_t pipe = pipe_signal();
    while (!was_pending_ && ::sigtimedwait(&pipe, nullptr, &now) == -1 && errno == EINTR) {
    }
    errno = error;
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

 private:
  BlockedSignals blocked_{pipe_signal()};  // unblocks after the destructor has consumed the signal
  bool was_pending_ = false;
};

constexpr std::string_view prefix = ".ahm-", suffix = ".tmp";

/// A unique name: process and running number. The caller retries if a leftover file has this name.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> running{0};
  std::string name(prefix);
  name += std::to_string(::getpid()) + "-" + std::to_string(running++);
  return target.parent_path() / name.append(suffix);
}

/// Whether `temporary_name` could have returned this file name.
bool is_temporary_name(std::string_view name) {
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return false;
  name.remove_prefix(prefix.size());
  pid_t process = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
  return error == std::errc() && *end == '-' && process > 0;
}

bool are_same(const struct stat& a, const struct stat& b) { return a.st_ino == b.st_ino && a.st_dev == b.st_dev; }

/// Removes the temporary files of killed processes from a directory: those that are not locked. Process numbers do not identify
/// them, because processes on other machines or in other containers may have the same number. After locking, the name is checked
/// again: another process may have removed the file, and a third may have created a new one with this name.
void remove_leftovers(const std::filesystem::path& directory) {
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(::opendir(directory.empty() ? "." : directory.c_str()), ::closedir);
  if (!entries) return;
  const int folder = ::dirfd(entries.get());
  while (const dirent* entry = ::readdir(entries.get())) {
    if (!is_temporary_name(entry->d_name)) continue;
    const int file = ::openat(folder, entry->d_name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) continue;
    struct stat info {
    }, named{};
    if (::fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == ::geteuid() &&
        ::flock(file, LOCK_EX | LOCK_NB) == 0 && ::fstatat(folder, entry->d_name, &named, AT_SYMLINK_NOFOLLOW) == 0 &&
        are_same(info, named))
      ::unlinkat(folder, entry->d_name, 0);
    ::close(file);
  }
}

/// Calls `remove_leftovers` once per directory.
void tidy_up(const std::filesystem::path& directory) {
  static std::mutex mutex;
  static std::set<std::filesystem::path> done;
  const std::scoped_lock lock(mutex);
  if (done.insert(directory).second) remove_leftovers(directory);
}

}  // namespace

std::filesystem::path without_links(std::filesystem::path path) {
  std::error_code ignored;
  for (int links = 0; links < 40 && std::filesystem::is_symlink(path, ignored); ++links)
    path = path.parent_path() / std::filesystem::read_symlink(path, ignored);
  // weakly_canonical returns a relative path if its first folder does not exist.
  const auto real = std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
  return ignored || real.empty() ? path : real;
}

bool is_stream(const std::filesystem::path& path) {
  // The process's own output may be redirected to a file, which its creator holds open.
  const std::string& name = path.native();
  if (name == "/dev/stdout" || name == "/dev/stderr" || name.starts_with("/dev/fd/")) return true;
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), target_(without_links(path)) {
  struct stat info {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode)) fail(EISDIR);
  if (exists && ::access(path.c_str(), W_OK) != 0) fail(errno);
  if (is_stream(path)) {
    // Does not use target_: /dev/stdout may resolve to a name that is not a path ("pipe:[123]"). Appends, because redirected output
    // may already contain data. Duplicates the descriptor of stdout, because a socket cannot be opened by name.
    descriptor_ = path == "/dev/stdout" ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                                        : ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  tidy_up(target_.parent_path());
  for (int tries = 0; !create_temporary(); ++tries)
    if (tries == 100) fail(EEXIST);
  if (exists) ::fchmod(descriptor_, info.st_mode & 0777);
}

AtomicFile::~AtomicFile() { discard(); }

/// Creates and locks the temporary file (see remove_leftovers). @return false if the name is in use, or if another process removed
/// the file as a leftover before it was locked. On file systems without locks, leftovers are not removed.
bool AtomicFile::create_temporary() {
  temporary_ = temporary_name(target_);
  descriptor_ = create(temporary_, slot_);
  const int error = errno;
  struct stat own {
  }, named{};
  const bool is_mine = descriptor_ >= 0 && (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK);
  if (is_mine && ::fstat(descriptor_, &own) == 0 && ::stat(temporary_.c_str(), &named) == 0 && are_same(own, named))
    return true;
  temporary_.clear();
  if (descriptor_ < 0 && error != EEXIST) fail(error);
  discard();
  return false;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      buffer_(std::move(other.buffer_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      finished_(std::exchange(other.finished_, false)),
      slot_(std::exchange(other.slot_, -1)) {}

void AtomicFile::write(std::string_view bytes) {
  constexpr std::size_t block = std::size_t{1} << 20;
  while (!bytes.empty()) {
    const std::size_t part = std::min(bytes.size(), block - std::min(block, buffer_.size()));
    buffer_.append(bytes.substr(0, part));
    bytes.remove_prefix(part);
    if (buffer_.size() >= block) flush();
  }
}

void AtomicFile::flush() {
  if (descriptor_ < 0) fail(EBADF);
  const NoPipeSignal quiet;
  for (std::size_t done = 0; done < buffer_.size();) {
    const ssize_t put = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (put < 0 && errno != EINTR) fail(errno);
    if (put > 0) done += static_cast<std::size_t>(put);
  }
  buffer_.clear();
}

void AtomicFile::finish() {
  flush();
  // fsync fails with EINVAL on pipes and terminals. A regular file stays open, to stay locked.
  if (!temporary_.empty() && ::fsync(descriptor_) != 0) fail(errno);
  if (temporary_.empty() && ::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(errno);
  finished_ = true;
}

void AtomicFile::commit() {
  if (!finished_) finish();
  if (temporary_.empty())
    finished_ = false;
  else if (FileSet::innermost != nullptr)
    FileSet::innermost->files_.push_back(std::move(*this));
  else
    name();
}

void AtomicFile::name() {
  finished_ = false;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
  discard();
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  forget(slot_);
}

void AtomicFile::fail(int error) {
  wait_if_ending();
  discard();
  const std::string problem = "cannot write " + quoted_path(path_) + ": " + std::generic_category().message(error);
  if (error == EPIPE) throw IoError("pipe_closed", problem, "its reader has closed the pipe");
  throw IoError(problem);
}

std::string written_bytes(const std::string& name, const std::function<void(const std::filesystem::path&)>& write) {
  const TemporaryFolder folder("ahm-");
  const std::filesystem::path path = folder.directory() / name;
  write(path);
  const RegularFile file(path);
  std::string bytes(file.size(), '\0');
  bytes.resize(file.read(0, bytes));
  return bytes;
}

void remove_unfinished_files() noexcept {
  const int error = errno;
  is_ending = true;
  for (Slot& slot : unfinished) {
    while (slot.state.load() == Slot::filling) {
    }
    if (slot.state.load() == Slot::used) ::unlink(slot.name.data());
  }
  errno = error;
}

}  // namespace ahm::io
