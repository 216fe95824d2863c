#include "compute.hpp"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace ahm::python {
namespace {

using namespace std::chrono_literals;

constexpr auto between_signals = 20ms;  ///< how long a signal waits for its handler
constexpr auto grace = 60ms;            ///< how long a stopped computation may take to notice

/// One computation. Made, looked at and destroyed with the interpreter lock; only `thread` works without.
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
      perform();  // no thread to be had: on this one
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
  /// Without the interpreter lock. @return whether it is done
  bool wait(std::chrono::milliseconds time) {
    const py::gil_scoped_release release;
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

/// Computations that were given up and have not ended yet. A forked child has none of their threads: it forgets them.
std::vector<std::unique_ptr<Job>>& background() {
  static auto* jobs = new std::vector<std::unique_ptr<Job>>;
  static pid_t process = getpid();
  if (process != getpid()) {
    process = getpid();
    jobs = new std::vector<std::unique_ptr<Job>>;
  }
  return *jobs;
}

void give_up(std::unique_ptr<Job> job) {
  job->request_stop();
  if (!job->wait(grace)) background().push_back(std::move(job));
}

}  // namespace

void run(const py::object& report, py::object keep, std::function<void(const Progress&)> work) {
  std::erase_if(background(), [](const auto& job) { return job->done(); });
  auto job = std::make_unique<Job>(std::move(keep), std::move(work), !report.is_none());
  try {
    for (bool done = false; !done;) {
      done = job->wait(between_signals);
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!report.is_none()) job->report_to(report);
    }
  } catch (...) {
    give_up(std::move(job));
    throw;
  }
  job->rethrow();
}

void wait_for_background() {
  for (auto& job : background())
    while (!job->wait(1s)) continue;
  background().clear();
}

}  // namespace ahm::python
