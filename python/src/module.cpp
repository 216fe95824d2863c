// The extension module ahm._core: thin functions on arrays. The public interface is in python/ahm.
#include <pybind11/pybind11.h>

#include "compute.hpp"
#include "errors.hpp"
#include "parts.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  module.doc() = "The C++ part of the package ahm. Not for direct use: its functions do not check their arguments.";
  module.def("end", &ahm::python::end);
  ahm::python::add_errors(module);
  ahm::python::add_surfaces(module);
  ahm::python::add_files(module);
  ahm::python::add_maps(module);
  ahm::python::add_local_maps(module);
  ahm::python::add_fields(module);
  ahm::python::add_geodesics(module);
  ahm::python::add_geodesic_derivatives(module);
  ahm::python::add_applications(module);
  ahm::python::add_textures(module);
  ahm::python::add_tool_paths(module);
}
