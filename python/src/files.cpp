// Reads files of meshes and clouds as arrays.
#include "ahm/io/read.hpp"
#include "arrays.hpp"
#include "compute.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

/// @param name  the encoded file name
py::dict read_file(const py::bytes& name) {
  const std::string path = name;
  using namespace py::literals;
  io::Geometry g = compute(py::none(), py::none(), [=](const Progress&) { return io::read(path); });
  py::list warnings;
  for (const Warning& w : g.warnings) warnings.append(warning(w));
  const auto optional = [](auto&& values) {
    return values.empty() ? py::object(py::none()) : py::object(owned(std::move(values)));
  };
  const auto n = static_cast<py::ssize_t>(g.colors.size());
  return py::dict(
      "points"_a = owned(std::move(g.points)), "normals"_a = optional(std::move(g.normals)),
      "colors"_a = n == 0 ? py::object(py::none())
                          : py::object(owned<std::array<std::uint8_t, 3>, std::uint8_t>(std::move(g.colors), {n, 3})),
      "face_begin"_a = optional(std::move(g.face_begin)), "face_vertices"_a = optional(std::move(g.face_vertices)),
      "format"_a = g.format, "warnings"_a = warnings);
}

}  // namespace

void add_files(py::module_& module) { module.def("read_file", &read_file); }

}  // namespace ahm::python
