/// \file
/// What each source adds to the module.
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
void add_applications(py::module_& module);
void add_textures(py::module_& module);

/// {"id", "numbers", "rows", "name"}
py::dict warning(const Warning& warning);

}  // namespace ahm::python
