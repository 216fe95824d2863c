#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/surface/row_local_maps.hpp"
#include "ahm/surface/row_map.hpp"

namespace ahm {
namespace {

void check(const char* what, Index index, Index count) {
  if (index < 0 || index >= count)
    throw InvalidArgument(
        "row_out_of_range",
        std::string(what) + " " + std::to_string(index) + " is outside [0, " + std::to_string(count) + ")",
        "numbers start at 0");
}

}  // namespace

RowMap::RowMap(Index rows, Index vertices, std::span<const RowVertex> pairs)
    : begin_(static_cast<std::size_t>(rows) + 1, 0),
      vertices_(pairs.size()),
      row_of_vertex_(static_cast<std::size_t>(vertices), -1) {
  for (const auto& [row, vertex] : pairs) {
    check("row", row.index, rows);
    check("vertex", vertex.index, vertices);
    ++begin_[row.index + 1];
  }
  for (std::size_t r = 1; r < begin_.size(); ++r) begin_[r] += begin_[r - 1];
  std::vector<Offset> fill(begin_.begin(), begin_.end() - 1);
  for (const auto& [row, vertex] : pairs) {
    vertices_[fill[row.index]++] = vertex;
    Index& first = row_of_vertex_[vertex.index];
    if (first < 0 || row.index < first) first = row.index;
  }
}

std::span<const Vertex> RowMap::vertices(Row row) const {
  check("row", row.index, row_count());
  const auto first = static_cast<std::size_t>(begin_[row.index]);
  return std::span(vertices_).subspan(first, static_cast<std::size_t>(begin_[row.index + 1]) - first);
}

std::optional<Vertex> RowMap::vertex(Row row) const {
  const std::span<const Vertex> all = vertices(row);
  return all.empty() ? std::nullopt : std::optional(all.front());
}

std::optional<Row> RowMap::row(Vertex vertex) const {
  check("vertex", vertex.index, vertex_count());
  const Index row = row_of_vertex_[vertex.index];
  return row < 0 ? std::nullopt : std::optional(Row(row));
}

Vertex first_vertex(const RowMap& rows) {
  for (Row row(0); row.index < rows.row_count(); ++row.index)
    if (const auto vertex = rows.vertex(row)) return *vertex;
  throw InvalidArgument("no row has a vertex");
}

std::vector<Vertex> vertices_with_rows(const RowMap& rows) {
  std::vector<Vertex> result;
  for (Vertex vertex(0); vertex.index < rows.vertex_count(); ++vertex.index)
    if (rows.row(vertex)) result.push_back(vertex);
  return result;
}

namespace {

bool has_virtual_vertices(const RowMap& rows) {
  for (Vertex v(0); v.index < rows.vertex_count(); ++v.index)
    if (!rows.row(v)) return true;
  return false;
}

/// Keeps the entries on rows of the input, at most `most` per source (0: all). Drops those on virtual vertices.
RowLocalMaps keep_rows(LocalMaps&& maps, const RowMap& rows, Index most) {
  const auto d = static_cast<std::size_t>(maps.dimension);
  const std::size_t width = maps.transport_width();
  std::size_t kept = 0;
  std::vector<Row> neighbors(maps.neighbors.size());
  const auto move = [&](std::vector<double>& values, std::size_t w, std::size_t from) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(w * from), w,
                values.begin() + static_cast<std::ptrdiff_t>(w * kept));
  };
  for (std::size_t s = 0; s + 1 < maps.indptr.size(); ++s) {
    const auto begin = static_cast<std::size_t>(maps.indptr[s]), end = static_cast<std::size_t>(maps.indptr[s + 1]);
    maps.indptr[s] = static_cast<Offset>(kept);
    for (std::size_t e = begin; e < end; ++e) {
      const std::optional<Row> row = rows.row(maps.neighbors[e]);
      const auto taken = static_cast<Offset>(kept) - maps.indptr[s];
      if (!row || (most > 0 && taken == most)) continue;
      neighbors[kept] = *row;
      move(maps.distances, 1, e), move(maps.weights, 1, e), move(maps.logs, d, e), move(maps.transports, width, e);
      if (!maps.quality.empty()) move(maps.quality, 1, e);
      ++kept;
    }
  }
  maps.indptr.back() = static_cast<Offset>(kept);
  neighbors.resize(kept), maps.distances.resize(kept), maps.weights.resize(kept);
  maps.logs.resize(d * kept), maps.transports.resize(width * kept);
  if (!maps.quality.empty()) maps.quality.resize(kept);
  return std::move(maps).renamed(std::move(neighbors));
}

/// Local maps by rows.
/// @param maps  maps(options): local maps of the sources
template <class Maps>
RowLocalMaps to_rows(const Surface& surface, const LocalMapOptions& options, const Maps& maps_of) {
  const RowMap& rows = surface.rows();
  const bool all_on_rows = !has_virtual_vertices(rows);
  LocalMapOptions wanted = options;
  wanted.bound_by_straight_line = true;
  if (!all_on_rows && options.radius > 0) wanted.k = 0;
  while (true) {
    LocalMaps all = maps_of(wanted);
    const std::vector<Offset> found = all.indptr;
    RowLocalMaps maps = keep_rows(std::move(all), rows, options.k);
    if (all_on_rows || options.radius > 0 || wanted.k >= rows.vertex_count()) return maps;
    // Some of the nearest vertices may be virtual. Then more are requested, as long as there are more.
    bool enough = true;
    for (std::size_t s = 0; s + 1 < found.size() && enough; ++s)
      enough = maps.indptr[s + 1] - maps.indptr[s] == options.k || found[s + 1] - found[s] < wanted.k;
    if (enough) return maps;
    wanted.k = std::min(2 * wanted.k, rows.vertex_count());
  }
}

/// The vertices of all rows that have one.
struct AllRows {
  std::vector<Vertex> vertices;
  std::vector<std::size_t> rows;

  explicit AllRows(const RowMap& map) {
    for (Row row(0); row.index < map.row_count(); ++row.index)
      if (const auto vertex = map.vertex(row)) {
        vertices.push_back(*vertex);
        rows.push_back(static_cast<std::size_t>(row.index));
      }
  }

  /// Adds the rows without a vertex, which have no entries.
  RowLocalMaps spread(RowLocalMaps maps, Index row_count) const {
    std::vector<Offset> indptr(static_cast<std::size_t>(row_count) + 1, 0);
    for (std::size_t k = 0; k < rows.size(); ++k) indptr[rows[k] + 1] = maps.indptr[k + 1] - maps.indptr[k];
    std::partial_sum(indptr.begin(), indptr.end(), indptr.begin());
    maps.indptr = std::move(indptr);
    return maps;
  }
};

bool is_heat(const Surface& surface, const LocalMapOptions& options) {
  const Method method = suggested_method(surface, options);
  if (method == Method::exact)
    throw InvalidArgument("method_not_local", "method is exact; local maps are polar or by heat",
                          "use polar: inside small radii its windows are exact");
  return method == Method::heat;
}

LocalMapOptions with_heat(LocalMapOptions options) {
  options.method = Method::heat;
  return options;
}

const Surface& surface_of(const PolarMapSolver& solver) {
  if (solver.surface() == nullptr)
    throw InvalidArgument("the solver was built for a graph, which has no rows; use PolarMapSolver::local_maps");
  return *solver.surface();
}

}  // namespace

Method suggested_method(const Surface& surface, const LocalMapOptions& options) {
  if (options.method) return *options.method;
  constexpr Index few_neighbors = 16;
  const bool is_small = options.k > 0 && options.k <= few_neighbors && surface.graph().dimension() == 2;
  return is_small ? Method::polar : surface.suggested_method();
}

RowLocalMaps row_local_maps(const PolarMapSolver& solver, std::span<const Vertex> sources,
                            const LocalMapOptions& options) {
  return to_rows(surface_of(solver), options, [&](const LocalMapOptions& o) { return solver.local_maps(sources, o); });
}

RowLocalMaps row_local_maps(const PolarMapSolver& solver, std::span<const SurfacePoint> sources,
                            const LocalMapOptions& options, const std::optional<Vec3>& u_axis) {
  return to_rows(surface_of(solver), options,
                 [&](const LocalMapOptions& o) { return solver.local_maps(sources, o, u_axis); });
}

RowLocalMaps row_local_maps(const PolarMapSolver& solver, const LocalMapOptions& options) {
  const RowMap& rows = surface_of(solver).rows();
  const AllRows all(rows);
  return all.spread(row_local_maps(solver, all.vertices, options), rows.row_count());
}

RowLocalMaps row_local_maps(const Surface& surface, std::span<const Vertex> sources, const LocalMapOptions& options) {
  if (!is_heat(surface, options))
    return row_local_maps(PolarMapSolver(surface, {.threads = options.heat.threads}), sources, options);
  return to_rows(surface, with_heat(options),
                 [&](const LocalMapOptions& o) { return local_maps(surface.graph(), sources, o); });
}

RowLocalMaps row_local_maps(const Surface& surface, std::span<const SurfacePoint> sources,
                            const LocalMapOptions& options, const std::optional<Vec3>& u_axis) {
  if (!is_heat(surface, options))
    return row_local_maps(PolarMapSolver(surface, {.threads = options.heat.threads}), sources, options, u_axis);
  std::vector<Source> from;
  from.reserve(sources.size());
  for (const SurfacePoint& point : sources) from.push_back(surface.source(point, u_axis).source);
  return row_local_maps(surface, std::span<const Source>(from), with_heat(options));
}

RowLocalMaps row_local_maps(const Surface& surface, std::span<const Source> sources, const LocalMapOptions& options) {
  return to_rows(surface, options, [&](const LocalMapOptions& o) { return local_maps(surface.graph(), sources, o); });
}

RowLocalMaps row_local_maps(const Surface& surface, const LocalMapOptions& options) {
  const AllRows all(surface.rows());
  return all.spread(row_local_maps(surface, all.vertices, options), surface.rows().row_count());
}

}  // namespace ahm
