// Local maps in compressed rows, by rows of the input.
#include <numeric>
#include <optional>
#include <utility>

#include "ahm/surface/row_local_maps.hpp"
#include "body.hpp"
#include "compute.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

LocalMaps solve(const Body& body, const std::optional<std::vector<Index>>& rows, LocalMapOptions options) {
  std::vector<Vertex> vertices;
  std::vector<std::size_t> place;
  const std::size_t sources = rows ? rows->size() : static_cast<std::size_t>(body.rows());
  for (std::size_t s = 0; s < sources; ++s) {
    const Row row(rows ? (*rows)[s] : static_cast<Index>(s));
    // Of all rows those without a vertex have no neighbours; one that is asked for by its number has to have one.
    if (!rows && body.surface() != nullptr && !body.surface()->rows().vertex(row)) continue;
    vertices.push_back(body.vertex(row));
    place.push_back(s);
  }
  LocalMaps maps = body.surface() ? local_maps_on_rows(*body.surface(), vertices, options)
                                  : local_maps(body.graph(), vertices, options);
  // Rows without a vertex have empty lists.
  std::vector<Offset> indptr(sources + 1, 0);
  for (std::size_t k = 0; k < place.size(); ++k) indptr[place[k] + 1] = maps.indptr[k + 1] - maps.indptr[k];
  std::partial_sum(indptr.begin(), indptr.end(), indptr.begin());
  maps.indptr = std::move(indptr);
  return maps;
}

py::dict local_maps_of(const BodyPtr& body, const py::object& rows, const py::dict& options, const py::object& report) {
  using namespace py::literals;
  LocalMapOptions o;
  read(options, "radius", o.radius);
  read(options, "k", o.nearest);
  read(options, "margin", o.margin);
  o.heat = heat_options(options);
  std::optional<std::vector<Index>> wanted;
  if (!rows.is_none()) {
    const auto given = rows.cast<Indices>();
    wanted.emplace(numbers(given).begin(), numbers(given).end());
  }
  LocalMaps maps = compute(report, py::none(), [=](const Progress& progress) mutable {
    o.heat.progress = progress;
    return solve(*body, wanted, o);
  });
  const auto entries = static_cast<py::ssize_t>(maps.indices.size());
  const py::ssize_t d = maps.dimension;
  const bool complex = maps.kind == TransportKind::rotation2;
  return py::dict(
      "indptr"_a = owned(std::move(maps.indptr)), "indices"_a = owned(std::move(maps.indices)),
      "log"_a = owned<double>(std::move(maps.logs), {entries, d}), "distance"_a = owned(std::move(maps.distances)),
      "weight"_a = owned(std::move(maps.weights)),
      "transport"_a = owned<double>(std::move(maps.transports), complex ? Shape{entries, 2} : Shape{entries, d, d}));
}

}  // namespace

void add_local_maps(py::module_& module) { module.def("local_maps", &local_maps_of); }

}  // namespace ahm::python
