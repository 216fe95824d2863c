/// \file
/// The functions by which each source file adds its part to the module.
#pragma once

#include <pybind11/pybind11.h>

#include "ahm/report.hpp"

namespace ahm::python {

namespace py = pybind11;

void add_surfaces(py::module_& module);
void add_files(py::module_& module);
void add_maps(py::module_& module);
void add_local_maps(py::module_& module);
void add_fields(py::module_& module);
void add_geodesics(py::module_& module);
void add_geodesic_derivatives(py::module_& module);
void add_applications(py::module_& module);
void add_textures(py::module_& module);
void add_tool_paths(py::module_& module);

/// A warning as a dictionary with the keys "id", "numbers", "rows", "name" and "text".
py::dict warning(const Warning& warning);

}  // namespace ahm::python
