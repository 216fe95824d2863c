/// \file
/// Python exceptions for the library's exceptions, and errors that name an argument.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace ahm::python {

namespace py = pybind11;

/// Adds the exception classes to the module, and registers their translation.
void add_errors(py::module_& module);

/// Calls `body`. Prepends `where`, for example "sources[3]", to the message of an `InvalidArgument`.
template <class Body>
auto naming(const std::string& where, const Body& body) -> decltype(body());

/// Rethrows the current exception. Prepends `where` to the message of an `InvalidArgument`.
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
