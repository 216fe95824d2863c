/// \file
/// Long computations under Python: without the interpreter lock, reporting, and ended by Ctrl-C.
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

/// Runs `work` on a thread of its own. This thread lets go of the interpreter lock, and now and then takes it to run
/// Python's signal handlers and to call `report(stage, fraction)`. An exception of either asks the work to stop and is
/// raised at once; work that does not heed that goes on in the background, unseen, until its end.
/// @param report  a callable, or None
/// @param keep    what must live as long as the work does: the arrays it reads
/// @param work    holds no Python object
void run(const py::object& report, py::object keep, std::function<void(const Progress&)> work);

/// What `work(progress)` returns, as of `run`.
template <class Work>
auto compute(const py::object& report, py::object keep, Work work) {
  using Result = decltype(work(std::declval<const Progress&>()));
  auto result = std::make_shared<std::optional<Result>>();
  run(report, std::move(keep),
      [result, work = std::move(work)](const Progress& progress) mutable { result->emplace(work(progress)); });
  return std::move(**result);
}

/// What `work()` returns, reported as a stage of one step: for work that reports nothing itself.
template <class Work>
auto in_one_step(const Progress& progress, std::string_view stage, const Work& work) {
  progress.step(stage, 0);
  auto result = work();
  progress.step(stage, 1);
  return result;
}

/// As `compute`, of what cannot be told to stop.
template <class Work>
auto compute(Work work) {
  return compute(py::none(), py::none(), [work = std::move(work)](const Progress&) mutable { return work(); });
}

/// Without the interpreter lock while it lives. Threads that would take it from an interpreter that ends sleep for ever.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

/// Before the interpreter ends: stops whatever still works, in the background and for threads that nobody waits for. What
/// does not heed that is cut off when the process exits (with the GNU library; else it is waited for).
void end();

}  // namespace ahm::python
