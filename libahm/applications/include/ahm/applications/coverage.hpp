/// \file
/// Tool paths that cover a surface: equally spaced lines in log coordinates, mapped to space.
///
/// \code
/// ahm::CoveragePath path = ahm::coverage_path(surface, inverse, {.radius = 0.1, .spacing = 0.01});
/// for (const ahm::CoveragePoint& p : path.points) move_to(p.position, p.normal, p.heading);   // lift where p.piece changes
/// \endcode
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ahm/applications/inverse_map.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"

namespace ahm {

enum class CoveragePattern {
  raster,  ///< parallel lines in alternating directions, one through the source
  spiral,  ///< r = spacing * angle / 2 pi, outwards, counter-clockwise
};

struct CoverageOptions {
  double radius = 0;   ///< radius of the disc around the source that is covered, world units; > 0
  double spacing = 0;  ///< distance between lines, or turns of the spiral, world units; > 0
  CoveragePattern pattern = CoveragePattern::raster;
  double step = 0;   ///< longest distance between consecutive points in the plane, world units; 0: half of the spacing
  double angle = 0;  ///< angle from the u axis to the first line, or to the spiral's first ray, radians
};

struct CoveragePoint {
  Vec3 position, normal;  ///< on the surface; the normal has unit length
  Vec3 heading;           ///< direction of travel: unit length, perpendicular to the normal
  Vec2 coordinates;       ///< (u, v)
  Index piece;            ///< index of the connected piece, from 0; a tool must lift between pieces
  Index line;             ///< index of the raster line, from 0; 0 on a spiral
  double arclength;       ///< distance from the start of the piece along the path, world units
  /// Distance in space, across the path, to the surface point that is `spacing` to the left of it in the plane. The right
  /// side is used where the left one is not valid or on another sheet; NaN where both fail. It differs from
  /// `CoverageOptions::spacing` by curvature and by the error of the map: on hills the lines come closer, on saddles they
  /// separate and leave gaps.
  double spacing;
  /// An additional point, not of the pattern: here the shortest path between two points of the pattern bends at an edge.
  /// Its coordinates are interpolated between theirs.
  bool between = false;
};

struct CoveragePath {
  std::vector<CoveragePoint> points;  ///< in order of travel
  Index pieces = 0;
  Offset planned = 0;  ///< number of points of the pattern in the plane; the missing ones lie outside the valid region
  /// Why points are joined by straight lines although the surface has faces: the message of `Surface::flat_triangles`.
  std::string straight_reason;
};

/// Lays the pattern over the disc and maps it to the surface. A piece ends where its line ends, where the inverse map is
/// undefined, and where the path would jump in space farther than the map's `max_stretch` allows. Points without a neighbor
/// in their piece are left out.
///
/// The spiral keeps its spacing where |phi| is the distance from the source, which holds where the map is reliable. Raster
/// lines keep theirs near the source and on flat or developable surfaces (`CoveragePoint::spacing`).
/// @throws InvalidArgument (values not finite or out of range, more than 2^30 points), ResourceExhausted (more points than
/// fit into memory)
CoveragePath coverage_path(const InverseMap& inverse, const CoverageOptions& options);

/// A coverage path whose points are joined by shortest paths over flat faces (`exact::locally_shortest_path`), so that all
/// of it lies on the surface. Where these paths bend they get additional points (`CoveragePoint::between`). A piece also
/// ends where such a path is longer than the map's `max_stretch` allows, for example across a thin wall. The result is the
/// same as from the overload above on flat parts, on surfaces without faces and on twisted polygons
/// (`CoveragePath::straight_reason`).
/// @param surface  the surface of the map
/// @throws InvalidArgument and ResourceExhausted as the overload above
CoveragePath coverage_path(const Surface& surface, const InverseMap& inverse, const CoverageOptions& options);
/// A coverage path joined by `geodesics`, which many paths on one surface can share.
CoveragePath coverage_path(const ExactGeodesics& geodesics, const InverseMap& inverse, const CoverageOptions& options);

}  // namespace ahm
