/// \file
/// Runs long computations for Python: without the interpreter lock, with progress reports, and interruptible by Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "ahm/progress.hpp"

namespace ahm::python {

namespace py = pybind11;

/// Runs `work` on a new thread. The calling thread releases the interpreter lock, and takes it regularly to run Python's
/// signal handlers and to call `report(stage, fraction)`. If one of these raises an exception, the work is requested to stop
/// and the exception is raised at once. Work that cannot be stopped continues in the background until its end.
/// @param report  a callable, or None
/// @param keep    objects that must live as long as the work, such as the arrays it reads
/// @param work    must not contain Python objects
void run(const py::object& report, py::object keep, std::function<void(const Progress&)> work);

/// Returns the result of `work(progress)`, computed by `run`.
template <class Work>
auto compute(const py::object& report, py::object keep, Work work) {
  using Result = decltype(work(std::declval<const Progress&>()));
  auto result = std::make_shared<std::optional<Result>>();
  run(report, std::move(keep),
      [result, work = std::move(work)](const Progress& progress) mutable { result->emplace(work(progress)); });
  return std::move(**result);
}

/// Returns the result of `work()` and reports it as a stage of one step. For work that does not report progress itself.
template <class Work>
auto in_one_step(const Progress& progress, std::string_view stage, const Work& work) {
  progress.step(stage, 0);
  auto result = work();
  progress.step(stage, 1);
  return result;
}

/// Returns the result of `work()`, computed by `run`. For work that cannot be stopped and does not report progress.
template <class Work>
auto compute(Work work) {
  return compute(py::none(), py::none(), [work = std::move(work)](const Progress&) mutable { return work(); });
}

/// Releases the interpreter lock during its lifetime. If another thread ends the interpreter, the destructor never returns.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

/// Stops all computations that still run. Python calls this before the interpreter ends (atexit). With the GNU C library, the
/// process exit ends computations that cannot be stopped; otherwise `end` waits for them.
void end();

}  // namespace ahm::python
