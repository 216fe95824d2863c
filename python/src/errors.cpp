#include "errors.hpp"

#include "ahm/error.hpp"

namespace ahm::python {
namespace {

/// Never freed: Python's classes outlive the module.
struct Classes {
  PyObject *error, *argument, *graph, *geometry, *definite, *exhausted, *io, *cancelled;
};
Classes classes;

PyObject* add(py::module_& module, const char* name, PyObject* parent, PyObject* also, const char* text) {
  const py::tuple bases =
      also == nullptr ? py::make_tuple(py::handle(parent)) : py::make_tuple(py::handle(parent), py::handle(also));
  const std::string full = std::string("ahm.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc(full.c_str(), text, bases.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  module.attr(name) = py::handle(made);
  return made;
}

void raise(PyObject* type, const Error& error) {
  const py::object made = py::reinterpret_steal<py::object>(PyObject_CallFunction(type, "s", error.what()));
  if (!made) return;
  made.attr("fault") = std::string(error.fault());
  PyErr_SetObject(type, made.ptr());
}

void translate(std::exception_ptr thrown) {
  if (!thrown) return;
  try {
    std::rethrow_exception(thrown);
  } catch (const InvalidArgument& e) {
    raise(classes.argument, e);
  } catch (const InvalidGraph& e) {
    raise(classes.graph, e);
  } catch (const InvalidGeometry& e) {
    raise(classes.geometry, e);
  } catch (const NotPositiveDefinite& e) {
    raise(classes.definite, e);
  } catch (const ResourceExhausted& e) {
    raise(classes.exhausted, e);
  } catch (const IoError& e) {
    raise(classes.io, e);
  } catch (const Cancelled& e) {
    raise(classes.cancelled, e);
  } catch (const Error& e) {
    raise(classes.error, e);
  }
}

}  // namespace

void add_errors(py::module_& module) {
  PyObject* error = add(module, "Error", PyExc_Exception, nullptr,
                        "Base of all exceptions of this package. `fault` names some of them, for programs.");
  py::handle(error).attr("fault") = "";
  classes = {error,
             add(module, "InvalidArgument", error, PyExc_ValueError, "An argument outside its documented range."),
             add(module, "InvalidGraph", error, PyExc_ValueError, "A graph breaks one of its laws."),
             add(module, "InvalidGeometry", error, PyExc_ValueError,
                 "Geometry (mesh, cloud, grid) that no graph can be built from."),
             add(module, "NotPositiveDefinite", error, PyExc_RuntimeError,
                 "An operator is not positive definite, or its factorization failed its own check."),
             add(module, "ResourceExhausted", error, PyExc_MemoryError,
                 "Memory or an index range does not suffice for the request."),
             add(module, "IoError", error, PyExc_OSError, "A file cannot be read or written."),
             add(module, "Cancelled", error, PyExc_RuntimeError, "A computation was stopped.")};
  py::register_exception_translator(translate);
}

void rethrow_naming(const std::string& where) {
  try {
    throw;
  } catch (const InvalidArgument& e) {
    const std::string text = e.what();
    const auto problem = e.problem().size();
    if (e.fault().empty()) throw InvalidArgument(where + ": " + text);
    throw InvalidArgument(e.fault(), where + ": " + text.substr(0, problem), text.substr(problem + 2));
  }
}

}  // namespace ahm::python
