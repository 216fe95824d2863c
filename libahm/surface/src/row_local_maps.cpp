#include "ahm/surface/row_local_maps.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace ahm {
namespace {

bool has_virtual_vertices(const RowMap& rows) {
  for (Vertex v(0); v.index < rows.vertex_count(); ++v.index)
    if (!rows.row(v)) return true;
  return false;
}

/// Entries on rows of the input, at most `most` per source (0: all): those on virtual vertices are left out.
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
      ++kept;
    }
  }
  maps.indptr.back() = static_cast<Offset>(kept);
  neighbors.resize(kept), maps.distances.resize(kept), maps.weights.resize(kept);
  maps.logs.resize(d * kept), maps.transports.resize(width * kept);
  return std::move(maps).renamed(std::move(neighbors));
}

/// @param sources  vertices, or sources
template <class From>
RowLocalMaps on_rows(const Surface& surface, std::span<const From> sources, const LocalMapOptions& options) {
  const RowMap& rows = surface.rows();
  const bool all_on_rows = !has_virtual_vertices(rows);
  LocalMapOptions wanted = options;
  wanted.no_shorter_than_line = true;
  if (!all_on_rows && options.radius > 0) wanted.nearest = 0;
  while (true) {
    LocalMaps all = local_maps(surface.graph(), sources, wanted);
    const std::vector<Offset> found = all.indptr;
    RowLocalMaps maps = keep_rows(std::move(all), rows, options.nearest);
    if (all_on_rows || options.radius > 0 || wanted.nearest >= rows.vertex_count()) return maps;
    // Of the nearest some may have been virtual; then it takes more of them, where there are more.
    bool enough = true;
    for (std::size_t s = 0; s < sources.size() && enough; ++s)
      enough = maps.indptr[s + 1] - maps.indptr[s] == options.nearest || found[s + 1] - found[s] < wanted.nearest;
    if (enough) return maps;
    wanted.nearest = std::min(2 * wanted.nearest, rows.vertex_count());
  }
}

}  // namespace

RowLocalMaps local_maps_on_rows(const Surface& surface, std::span<const Vertex> sources,
                                const LocalMapOptions& options) {
  return on_rows(surface, sources, options);
}

RowLocalMaps local_maps_on_rows(const Surface& surface, std::span<const Source> sources,
                                const LocalMapOptions& options) {
  return on_rows(surface, sources, options);
}

}  // namespace ahm
