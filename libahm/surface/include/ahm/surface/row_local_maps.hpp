/// \file
/// Local maps whose neighbors are rows of the input.
///
/// \code
/// const ahm::Vertex here = surface.vertex(ahm::Row{42});
/// const ahm::RowLocalMaps maps = ahm::row_local_maps(surface, {&here, 1}, {.radius = 0.02});
/// for (ahm::Row row : maps.neighbors) use(row);
/// \endcode
#pragma once

#include <span>

#include "ahm/maps/local_maps.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

using RowLocalMaps = LocalMapsOf<Row>;

/// `local_maps` with rows as neighbors: each vertex is replaced by its first row. Vertices without a row, as inside refined
/// polygons, are omitted; `LocalMapOptions::k` counts the remaining ones. Distances are at least the straight-line
/// distance, as in `RowLogMap`.
/// @throws as `local_maps`
RowLocalMaps row_local_maps(const Surface& surface, std::span<const Vertex> sources, const LocalMapOptions& options);
/// Local maps of any sources: points in faces, curves.
RowLocalMaps row_local_maps(const Surface& surface, std::span<const Source> sources, const LocalMapOptions& options);

/// Local maps of every row: source s is row s. Rows without a vertex have no entries.
RowLocalMaps row_local_maps(const Surface& surface, const LocalMapOptions& options);

}  // namespace ahm
