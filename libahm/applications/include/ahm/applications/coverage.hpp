/// \file
/// Paths that cover a surface: lines of equal spacing in log coordinates, carried to space.
///
/// \code
/// ahm::CoveragePath path = ahm::coverage_path(surface, inverse, {.radius = 0.1, .spacing = 0.01});
/// for (const ahm::CoveragePoint& p : path.points) move_to(p.position, p.normal, p.heading);   // p.piece: lift between
/// \endcode
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ahm/applications/inverse_map.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"

namespace ahm {

enum class CoveragePattern {
  raster,  ///< parallel lines, alternating direction, one through the source
  spiral,  ///< r = spacing * angle / 2 pi, outwards, counter-clockwise
};

struct CoverageOptions {
  double radius = 0;   ///< of the disc about the source that is to be covered; world units, > 0
  double spacing = 0;  ///< between lines, or turns of the spiral; world units, > 0
  CoveragePattern pattern = CoveragePattern::raster;
  double step = 0;   ///< longest distance between points along the path in the plane; 0: half of the spacing
  double angle = 0;  ///< radians from the u axis: direction of the first line, or of the spiral's first ray
};

struct CoveragePoint {
  Vec3 position, normal;  ///< of the surface, normal unit
  Vec3 heading;           ///< where the path goes: unit, perpendicular to the normal
  Vec2 coordinates;       ///< (u, v)
  Index piece;            ///< from 0; a tool must lift between pieces
  Index line;             ///< of the raster, from 0; 0 on a spiral
  double arclength;       ///< from the start of the piece along the path
  /// Distance in space, across the path, to what lies `spacing` to the left of it in the plane, or to the right where
  /// that is not valid or on another sheet; NaN where both fail. Equal to `spacing` but for curvature and the map's
  /// error: on hills the lines come closer, on saddles they part, and the path leaves gaps.
  double spacing;
  /// Not of the pattern: here the shortest way between two of its points bends where it crosses an edge. Coordinates are
  /// between theirs.
  bool between = false;
};

struct CoveragePath {
  std::vector<CoveragePoint> points;  ///< in order of travel
  Index pieces = 0;
  Offset planned = 0;  ///< points of the pattern in the plane; those missing lie outside the valid region
  /// Why points are joined by straight lines though the surface has faces: the message of `Surface::flat_triangles`.
  std::string straight_reason;
};

/// Lays the pattern over the disc and carries it to the surface. A piece ends where its line ends, where the inverse
/// map has no answer, and where the path would jump in space further than the map's `max_stretch` allows for. Points
/// without a neighbour in their piece are left out.
///
/// The spiral keeps its pitch where |phi| is the distance from the source, as it is where the map is to be trusted; raster lines keep theirs near
/// the source and on flat or rolled surfaces (`CoveragePoint::spacing`).
/// @throws InvalidArgument (values not finite or out of range, more than 2^30 points), ResourceExhausted (more than memory holds)
CoveragePath coverage_path(const InverseMap& inverse, const CoverageOptions& options);

/// The same with the points of a piece joined by shortest paths over flat faces (`exact::locally_shortest_path`), which lie
/// on the surface as a whole: where they bend they have points of their own (`CoveragePoint::between`), and where the way is
/// longer than the map's `max_stretch` allows for, as through a thin wall, the piece ends. Flat parts are as above, and so
/// are surfaces without faces and twisted polygons (`CoveragePath::straight_reason`).
/// @param surface  that the map is of
/// @throws InvalidArgument (as above)
CoveragePath coverage_path(const Surface& surface, const InverseMap& inverse, const CoverageOptions& options);
/// The same on faces that are laid out already, for many paths of one surface.
CoveragePath coverage_path(const ExactGeodesics& geodesics, const InverseMap& inverse, const CoverageOptions& options);

}  // namespace ahm
