#include "compute.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace ahm::python {
namespace {

using namespace std::chrono_literals;

constexpr auto between_signals = 20ms;  ///< interval at which signal handlers run
constexpr auto grace = 60ms;            ///< how long a computation may run after a request to stop

/// The thread that ends the interpreter; none until `end` is called.
std::atomic<std::thread::id> ender;

/// Number of threads that are about to take the interpreter lock again; `end` waits for them. A forked child has none of them.
std::atomic<int> returning = 0;
[[maybe_unused]] const int at_fork = pthread_atfork(nullptr, nullptr, [] { returning = 0; });

/// One computation. All members are called with the interpreter lock held; only `thread_` runs without it.
class Job {
 public:
  Job(py::object keep, std::function<void(const Progress&)> work, bool reports)
      : keep_(std::move(keep)), work_(std::move(work)) {
    progress_.stop = stop_.get_token();
    if (reports)
      progress_.report = [this](std::string_view stage, double fraction) {
        const std::scoped_lock lock(mutex_);
        if (news_.empty() || news_.back().first != stage) news_.emplace_back(stage, fraction);
        news_.back().second = fraction;
      };
    try {
      thread_ = std::thread([this] { perform(); });
    } catch (const std::system_error&) {
      perform();  // no thread is available: run on this one
    }
  }
  ~Job() {
    if (thread_.joinable()) thread_.join();
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  void request_stop() { stop_.request_stop(); }
  bool done() {
    const std::scoped_lock lock(mutex_);
    return done_;
  }
  /// Waits without the interpreter lock. @return whether the job is done
  bool wait(std::chrono::milliseconds time) {
    const Unlocked unlocked;
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, time, [this] { return done_; });
  }
  void report_to(const py::object& callable) {
    std::vector<std::pair<std::string, double>> news;
    {
      const std::scoped_lock lock(mutex_);
      news.swap(news_);
    }
    for (const auto& [stage, fraction] : news) callable(stage, fraction);
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void perform() {
    try {
      work_(progress_);
    } catch (...) {
      error_ = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    done_ = true;
    ended_.notify_all();
  }

  py::object keep_;
  std::function<void(const Progress&)> work_;
  std::stop_source stop_;
  Progress progress_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool done_ = false;
  std::exception_ptr error_;
  std::vector<std::pair<std::string, double>> news_;
  std::thread thread_;
};

/// Jobs of this process. A forked child has none of its parent's threads, so it discards their jobs.
struct Jobs {
  std::vector<std::shared_ptr<Job>> background;  ///< abandoned jobs that still run
  std::vector<std::shared_ptr<Job>> waited_for;  ///< jobs that a thread waits for
  pid_t process = getpid();
};
Jobs& jobs() {
  static auto* all = new Jobs;
  if (all->process != getpid()) all = new Jobs;
  return *all;
}

void give_up(const std::shared_ptr<Job>& job) {
  job->request_stop();
  if (!job->wait(grace)) jobs().background.push_back(job);
}

/// Lists a job in `Jobs::waited_for` while a thread waits for it.
class ListedAsWaiting {
 public:
  explicit ListedAsWaiting(const std::shared_ptr<Job>& job) : job_(job) { jobs().waited_for.push_back(job); }
  ~ListedAsWaiting() { std::erase(jobs().waited_for, job_); }
  ListedAsWaiting(const ListedAsWaiting&) = delete;
  ListedAsWaiting& operator=(const ListedAsWaiting&) = delete;

 private:
  const std::shared_ptr<Job>& job_;
};

}  // namespace

void run(const py::object& report, py::object keep, std::function<void(const Progress&)> work) {
  std::erase_if(jobs().background, [](const auto& job) { return job->done(); });
  const auto job = std::make_shared<Job>(std::move(keep), std::move(work), !report.is_none());
  try {
    const ListedAsWaiting listed(job);
    for (bool done = false; !done;) {
      done = job->wait(between_signals);
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!report.is_none()) job->report_to(report);
    }
  } catch (...) {
    give_up(job);
    throw;
  }
  job->rethrow();
}

Unlocked::Unlocked() : state_(PyEval_SaveThread()) {}

Unlocked::~Unlocked() {
  // Python ends a thread that takes the lock of an ended interpreter, in the middle of C++ code. Such threads sleep instead.
  ++returning;
  if (const std::thread::id ending = ender; ending != std::thread::id() && ending != std::this_thread::get_id()) {
    --returning;
    while (true) std::this_thread::sleep_for(1h);
  }
  PyEval_RestoreThread(state_);
  --returning;
}

void end() {
  ender = std::this_thread::get_id();
  while (returning > 0) {
    const py::gil_scoped_release unlocked;
    std::this_thread::sleep_for(1ms);
  }
  std::vector<std::shared_ptr<Job>> all = jobs().waited_for;
  std::ranges::copy(jobs().background, std::back_inserter(all));
  for (const auto& job : all) job->request_stop();
  const auto until = std::chrono::steady_clock::now() + grace;
  for (const auto& job : all) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    job->wait(std::max(left, 0ms));
  }
  if (std::ranges::all_of(all, [](const auto& job) { return job->done(); })) return;
#ifdef __GLIBC__
  // Jobs that still run must not use destroyed static objects, so the process exits without destroying them.
  on_exit(
      [](int status, void*) {
        std::fflush(nullptr);
        _exit(status);
      },
      nullptr);
#else
  for (const auto& job : all)
    while (!job->wait(1s)) continue;
#endif
}

}  // namespace ahm::python
