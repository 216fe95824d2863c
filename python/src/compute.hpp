/// \file
/// Long computations under Python: without the interpreter lock, reporting, and ended by Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <optional>
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

/// What `work()` returns, without the interpreter lock, on this thread: for what takes no longer than a copy.
template <class Work>
auto released(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

/// Waits for work in the background: before the interpreter ends.
void wait_for_background();

}  // namespace ahm::python
