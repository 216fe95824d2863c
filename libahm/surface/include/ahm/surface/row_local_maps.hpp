/// \file
/// Local maps whose neighbors are rows of the input: the log map of the neighborhood of each row.
///
/// \code
/// const ahm::RowLocalMaps all = ahm::row_local_maps(surface, {.k = 12});        // the twelve nearest rows of every row
/// const ahm::Vertex here = surface.vertex(ahm::Row{42});
/// const ahm::RowLocalMaps maps = ahm::row_local_maps(surface, {&here, 1}, {.radius = 0.02});
/// for (ahm::Row row : maps.neighbors) use(row);
/// \endcode
#pragma once

#include <optional>
#include <span>

#include "ahm/maps/local_maps.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

using RowLocalMaps = LocalMapsOf<Row>;

/// The method of local maps by options that name none: polar for at most 16 neighbors on a surface of dimension 2, where polar maps are as
/// accurate as heat on noisy clouds, too (docs/results/local_maps.md), and ten times faster; otherwise `Surface::suggested_method`.
Method suggested_method(const Surface& surface, const LocalMapOptions& options);

/// Local maps with rows as neighbors: each vertex is replaced by its rows. Rows that share a vertex, as merged points, each have an entry,
/// with an equal part of the weight. A source that is a row is its own first neighbor. Vertices without a row, as inside refined
/// polygons, are omitted; `LocalMapOptions::k` counts the rows. Distances are at least the straight-line
/// distance, as in `RowLogMap`.
///
/// The method is that of the options, or `suggested_method`. Polar maps are ten to hundreds of times faster; heat is smoother on noisy clouds. These functions prepare the surface for polar maps in each call; with a
/// `PolarMapSolver` this is done once.
/// @throws InvalidArgument (the method exact); as `local_maps`, `PolarMapSolver::local_maps`
RowLocalMaps row_local_maps(const Surface& surface, std::span<const Vertex> sources, const LocalMapOptions& options);
/// Local maps of points of the surface. @param u_axis  as in `Surface::source`
RowLocalMaps row_local_maps(const Surface& surface, std::span<const SurfacePoint> sources,
                            const LocalMapOptions& options, const std::optional<Vec3>& u_axis = {});
/// Local maps of every row: source s is row s. Rows without a vertex have no entries.
RowLocalMaps row_local_maps(const Surface& surface, const LocalMapOptions& options);
/// Local maps of any sources, such as curves, by heat.
RowLocalMaps row_local_maps(const Surface& surface, std::span<const Source> sources, const LocalMapOptions& options);

/// Polar local maps.
/// @param solver  of a surface
/// @throws InvalidArgument (a solver of a graph; another method), as `PolarMapSolver::local_maps`
RowLocalMaps row_local_maps(const PolarMapSolver& solver, std::span<const Vertex> sources,
                            const LocalMapOptions& options);
RowLocalMaps row_local_maps(const PolarMapSolver& solver, std::span<const SurfacePoint> sources,
                            const LocalMapOptions& options, const std::optional<Vec3>& u_axis = {});
RowLocalMaps row_local_maps(const PolarMapSolver& solver, const LocalMapOptions& options);

}  // namespace ahm
