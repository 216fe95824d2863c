#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>
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

/// The rows of the vertices that several rows share: merged points.
class SharedVertices {
 public:
  explicit SharedVertices(const RowMap& rows) {
    for (Row row(0); row.index < rows.row_count(); ++row.index)
      for (const Vertex vertex : rows.vertices(row))
        if (const Row first = *rows.row(vertex); first != row) {
          std::vector<Row>& all = rows_[vertex.index];
          if (all.empty()) all.push_back(first);
          all.push_back(row);
        }
  }
  bool empty() const noexcept { return rows_.empty(); }
  /// The rows of a vertex, in ascending order; empty if it has at most one.
  std::span<const Row> operator[](Vertex vertex) const {
    const auto found = rows_.find(vertex.index);
    return found == rows_.end() ? std::span<const Row>() : std::span<const Row>(found->second);
  }

 private:
  std::unordered_map<Index, std::vector<Row>> rows_;
};

/// The values of some entries. @param width  numbers per entry
std::vector<double> entries_of(std::vector<double> values, std::span<const std::size_t> entries, std::size_t width) {
  std::vector<double> result;
  result.reserve(values.empty() ? 0 : width * entries.size());
  for (std::size_t k = 0; k < entries.size() && !values.empty(); ++k)
    result.insert(result.end(), values.begin() + static_cast<std::ptrdiff_t>(width * entries[k]),
                  values.begin() + static_cast<std::ptrdiff_t>(width * (entries[k] + 1)));
  return result;
}

/// Replaces vertices by their rows, at most `most` per source (0: all). Of a shared vertex every row is an entry with an equal part of
/// its weight.
/// @param own  row of each source, which comes first among the rows of its vertex; empty: unknown
RowLocalMaps on_rows(LocalMaps&& maps, const RowMap& rows, const SharedVertices& shared, std::span<const Row> own,
                     Index most) {
  std::vector<Row> neighbors;
  neighbors.reserve(maps.neighbors.size());
  if (shared.empty()) {
    for (const Vertex vertex : maps.neighbors) neighbors.push_back(*rows.row(vertex));
    return std::move(maps).renamed(std::move(neighbors));
  }
  std::vector<std::size_t> entries;
  std::vector<std::pair<std::size_t, double>> parts;  // entries on shared vertices, and their part of the weight
  entries.reserve(maps.neighbors.size());
  for (std::size_t s = 0; s + 1 < maps.indptr.size(); ++s) {
    const auto begin = static_cast<std::size_t>(maps.indptr[s]), end = static_cast<std::size_t>(maps.indptr[s + 1]);
    const std::size_t first = neighbors.size();
    maps.indptr[s] = static_cast<Offset>(first);
    const auto add = [&](std::size_t e, Row row, std::size_t part) {
      if (most > 0 && neighbors.size() - first == static_cast<std::size_t>(most)) return;
      if (part > 1) parts.emplace_back(neighbors.size(), 1.0 / static_cast<double>(part));
      entries.push_back(e), neighbors.push_back(row);
    };
    for (std::size_t e = begin; e < end; ++e) {
      const std::span<const Row> all = shared[maps.neighbors[e]];
      if (all.empty()) {
        add(e, *rows.row(maps.neighbors[e]), 1);
        continue;
      }
      const bool is_source = e == begin && !own.empty() && std::ranges::find(all, own[s]) != all.end();
      if (is_source) add(e, own[s], all.size());
      for (const Row one : all)
        if (!is_source || one != own[s]) add(e, one, all.size());
    }
  }
  maps.indptr.back() = static_cast<Offset>(neighbors.size());
  const bool unchanged = parts.empty() && entries.size() == maps.neighbors.size();
  if (!unchanged) {
    maps.distances = entries_of(std::move(maps.distances), entries, 1);
    maps.weights = entries_of(std::move(maps.weights), entries, 1);
    maps.logs = entries_of(std::move(maps.logs), entries, static_cast<std::size_t>(maps.dimension));
    maps.transports = entries_of(std::move(maps.transports), entries, maps.transport_width());
    maps.quality = entries_of(std::move(maps.quality), entries, 1);
    for (const auto& [entry, part] : parts) maps.weights[entry] *= part;
  }
  return std::move(maps).renamed(std::move(neighbors));
}

/// Local maps by rows.
/// @param maps_of  maps_of(options): local maps of the sources
/// @param own      row of each source; empty: unknown
template <class Maps>
RowLocalMaps to_rows(const Surface& surface, const LocalMapOptions& options, const Maps& maps_of,
                     std::span<const Row> own = {}) {
  const RowMap& rows = surface.rows();
  LocalMapOptions wanted = options;
  wanted.bound_by_straight_line = true;
  if (has_virtual_vertices(rows))
    wanted.is_neighbor = [&](Vertex vertex) {
      return rows.row(vertex) && (!options.is_neighbor || options.is_neighbor(vertex));
    };
  return on_rows(maps_of(wanted), rows, SharedVertices(rows), own, options.k);
}

/// The vertices of all rows that have one.
struct AllRows {
  std::vector<Vertex> vertices;
  std::vector<Row> rows;

  explicit AllRows(const RowMap& map) {
    for (Row row(0); row.index < map.row_count(); ++row.index)
      if (const auto vertex = map.vertex(row)) {
        vertices.push_back(*vertex);
        rows.push_back(row);
      }
  }

  /// Adds the rows without a vertex, which have no entries.
  RowLocalMaps spread(RowLocalMaps maps, Index row_count) const {
    std::vector<Offset> indptr(static_cast<std::size_t>(row_count) + 1, 0);
    for (std::size_t k = 0; k < rows.size(); ++k) indptr[rows[k].index + 1] = maps.indptr[k + 1] - maps.indptr[k];
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

namespace {

/// The rows of points; -1 where a point is not a row.
std::vector<Row> own_rows(std::span<const SurfacePoint> points) {
  std::vector<Row> rows;
  for (const SurfacePoint& point : points) {
    const auto* row = std::get_if<Row>(&point);
    rows.push_back(row ? *row : Row(-1));
  }
  return rows;
}

RowLocalMaps local_maps_of(const PolarMapSolver& solver, std::span<const Vertex> sources,
                           const LocalMapOptions& options, std::span<const Row> own) {
  return to_rows(
      surface_of(solver), options, [&](const LocalMapOptions& o) { return solver.local_maps(sources, o); }, own);
}

RowLocalMaps local_maps_of(const Surface& surface, std::span<const Vertex> sources, const LocalMapOptions& options,
                           std::span<const Row> own) {
  if (!is_heat(surface, options))
    return local_maps_of(PolarMapSolver(surface, {.threads = options.heat.threads}), sources, options, own);
  return to_rows(
      surface, with_heat(options), [&](const LocalMapOptions& o) { return local_maps(surface.graph(), sources, o); },
      own);
}

}  // namespace

RowLocalMaps row_local_maps(const PolarMapSolver& solver, std::span<const Vertex> sources,
                            const LocalMapOptions& options) {
  return local_maps_of(solver, sources, options, {});
}

RowLocalMaps row_local_maps(const PolarMapSolver& solver, std::span<const SurfacePoint> sources,
                            const LocalMapOptions& options, const std::optional<Vec3>& u_axis) {
  return to_rows(
      surface_of(solver), options, [&](const LocalMapOptions& o) { return solver.local_maps(sources, o, u_axis); },
      own_rows(sources));
}

RowLocalMaps row_local_maps(const PolarMapSolver& solver, const LocalMapOptions& options) {
  const RowMap& rows = surface_of(solver).rows();
  const AllRows all(rows);
  return all.spread(local_maps_of(solver, all.vertices, options, all.rows), rows.row_count());
}

RowLocalMaps row_local_maps(const Surface& surface, std::span<const Vertex> sources, const LocalMapOptions& options) {
  return local_maps_of(surface, sources, options, {});
}

RowLocalMaps row_local_maps(const Surface& surface, std::span<const SurfacePoint> sources,
                            const LocalMapOptions& options, const std::optional<Vec3>& u_axis) {
  if (!is_heat(surface, options))
    return row_local_maps(PolarMapSolver(surface, {.threads = options.heat.threads}), sources, options, u_axis);
  std::vector<Source> from;
  from.reserve(sources.size());
  for (const SurfacePoint& point : sources) from.push_back(surface.source(point, u_axis).source);
  return to_rows(
      surface, with_heat(options),
      [&](const LocalMapOptions& o) { return local_maps(surface.graph(), std::span<const Source>(from), o); },
      own_rows(sources));
}

RowLocalMaps row_local_maps(const Surface& surface, std::span<const Source> sources, const LocalMapOptions& options) {
  return to_rows(surface, options, [&](const LocalMapOptions& o) { return local_maps(surface.graph(), sources, o); });
}

RowLocalMaps row_local_maps(const Surface& surface, const LocalMapOptions& options) {
  const AllRows all(surface.rows());
  return all.spread(local_maps_of(surface, all.vertices, options, all.rows), surface.rows().row_count());
}

}  // namespace ahm
