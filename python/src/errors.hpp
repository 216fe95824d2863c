/// \file
/// The library's exceptions as Python's, and errors that name an argument.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace ahm::python {

namespace py = pybind11;

/// Adds the classes to the module, and translates.
void add_errors(py::module_& module);

/// Calls `body`; an `InvalidArgument` of the library gets `where` (as "sources[3]") in front of its text.
template <class Body>
auto naming(const std::string& where, const Body& body) -> decltype(body());

[[noreturn]] void rethrow_naming(const std::string& where);

template <class Body>
auto naming(const std::string& where, const Body& body) -> decltype(body()) {
  try {
    return body();
  } catch (...) {
    rethrow_naming(where);
  }
}

}  // namespace ahm::python
