// Local maps in compressed rows, by rows of the input.
#include "ahm/maps/local_maps.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "body.hpp"
#include "compute.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

bool has_virtual(const Body& body) {
  for (Vertex v(0); v.index < body.graph().size(); ++v.index)
    if (!body.row(v)) return true;
  return false;
}

/// Vertices become rows; entries on virtual vertices are left out, and what is more than `most` (0: all) per source.
/// Empty lists stay for rows without a vertex: source s of the maps is source `place[s]` of the result.
void keep_rows(LocalMaps& maps, const Body& body, Index most, const std::vector<std::size_t>& place,
               std::size_t sources) {
  const auto d = static_cast<std::size_t>(maps.dimension);
  const std::size_t width = maps.transport_width();
  std::vector<Offset> counts(sources + 1, 0);
  std::size_t kept = 0;
  const auto move = [&](std::vector<double>& values, std::size_t w, std::size_t from) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(w * from), w,
                values.begin() + static_cast<std::ptrdiff_t>(w * kept));
  };
  for (std::size_t s = 0; s < place.size(); ++s) {
    Offset& taken = counts[place[s] + 1];
    for (auto e = static_cast<std::size_t>(maps.indptr[s]); e < static_cast<std::size_t>(maps.indptr[s + 1]); ++e) {
      const auto row = body.row(Vertex(maps.indices[e]));
      if (!row || (most > 0 && taken == most)) continue;
      maps.indices[kept] = row->index;
      move(maps.distances, 1, e), move(maps.weights, 1, e), move(maps.logs, d, e), move(maps.transports, width, e);
      ++kept, ++taken;
    }
  }
  for (std::size_t s = 0; s < sources; ++s) counts[s + 1] += counts[s];
  maps.indptr = std::move(counts);
  maps.indices.resize(kept), maps.distances.resize(kept), maps.weights.resize(kept);
  maps.logs.resize(d * kept), maps.transports.resize(width * kept);
}

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
  const Index most = options.nearest;
  const bool all_on_rows = !has_virtual(body);
  if (!all_on_rows && options.radius > 0) options.nearest = 0;
  while (true) {
    LocalMaps maps = local_maps(body.graph(), vertices, options);
    const std::vector<Offset> found = maps.indptr;
    keep_rows(maps, body, most, place, sources);
    if (all_on_rows || options.radius > 0 || options.nearest >= body.graph().size()) return maps;
    // Of the nearest some were virtual: it takes more of them, where there are more.
    bool enough = true;
    for (std::size_t s = 0; s < place.size() && enough; ++s)
      enough = maps.indptr[place[s] + 1] - maps.indptr[place[s]] == most || found[s + 1] - found[s] < options.nearest;
    if (enough) return maps;
    options.nearest = std::min(2 * options.nearest, body.graph().size());
  }
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
