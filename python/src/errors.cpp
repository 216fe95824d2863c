#include "errors.hpp"

#include <new>
#include <stdexcept>
#include <string_view>

#include "ahm/error.hpp"

namespace ahm::python {
namespace {

/// The exception classes. They are never freed, because Python's classes outlive the module.
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

struct Advice {
  std::string_view fault, remedy;
};

/// Remedies by fault, in terms of the Python package. They replace those of the C++ messages.
constexpr Advice advices[] = {
    {"collinear_faces", "remove such faces, or use method 'polar' or 'heat'"},
    {"diffusion_time_range", "use a t_coef near 1"},
    {"map_without_frames", "make it with frames=True"},
    {"map_without_spread", "make it with spread=True and distances=True"},
    {"no_flat_triangles", "use method 'heat'"},
    {"non_finite", "drop these points with drop_non_finite=True"},
    {"non_manifold_edges", "repair the mesh, or cut it there with non_manifold='split'"},
    {"non_manifold_vertices", "repair the mesh, or split it there with non_manifold='split'"},
    {"polygons_not_refined", "make the mesh with discretization='refined', or use method 'heat'"},
    {"polygons_too_large", "make the mesh with discretization='refined'"},
    {"twisted_faces", "make the mesh with discretization='polygons'"},
    {"windows_without_end", "repair the mesh, or use method 'heat'"},
    {"windows_lost", "repair the needle triangles there, or use method 'polar' or 'heat' (paths: fast=True)"},
};

std::string worded(const Error& error) {
  for (const auto& [fault, remedy] : advices)
    if (error.fault() == fault) return std::string(error.problem()) + "; " + std::string(remedy);
  return error.what();
}

void raise(PyObject* type, const Error& error) {
  const std::string words = worded(error);  // may contain a file name, which may be any bytes
  const py::object text = py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(words.data(), static_cast<py::ssize_t>(words.size()), "surrogateescape"));
  if (!text) return;
  const py::object made = py::reinterpret_steal<py::object>(PyObject_CallFunctionObjArgs(type, text.ptr(), nullptr));
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
  } catch (const std::bad_alloc&) {
    raise(classes.exhausted, ResourceExhausted("out of memory"));
  } catch (const std::length_error&) {
    raise(classes.exhausted, ResourceExhausted("out of memory: more than an array can hold"));
  }
}

}  // namespace

void add_errors(py::module_& module) {
  PyObject* error = add(module, "Error", PyExc_Exception, nullptr,
                        "Base class of all exceptions of this package. `fault` identifies some errors, for programs.");
  py::handle(error).attr("fault") = "";
  classes = {error,
             add(module, "InvalidArgument", error, PyExc_ValueError, "An argument outside its documented range."),
             add(module, "InvalidGraph", error, PyExc_ValueError, "A graph violates the graph contract."),
             add(module, "InvalidGeometry", error, PyExc_ValueError,
                 "No graph can be built from the geometry (mesh, cloud, grid)."),
             add(module, "NotPositiveDefinite", error, PyExc_RuntimeError,
                 "A matrix is not positive definite, or the check of its factorization failed."),
             add(module, "ResourceExhausted", error, PyExc_MemoryError,
                 "The request exceeds the memory or the range of indices."),
             add(module, "IoError", error, PyExc_OSError, "A file cannot be read or written."),
             add(module, "Cancelled", error, PyExc_RuntimeError, "A computation was canceled.")};
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
