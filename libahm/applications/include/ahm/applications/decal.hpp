/// \file
/// Decals: a rectangle of the (u, v) plane, and the image on it, mapped to the surface (Fig. 17).
///
/// \code
/// ahm::InverseMap inverse = ahm::inverse_map(graph, solver.solve(source, {.frames = true}));
/// ahm::Decal decal = ahm::make_decal(inverse, {.width = 0.2, .height = 0.1});
/// // a separate small mesh: decal.points, .face_begin, .face_vertices, and .image_coordinates as its uv
/// \endcode
#pragma once

#include <limits>
#include <vector>

#include "ahm/applications/inverse_map.hpp"
#include "ahm/image.hpp"

namespace ahm {

/// Position of an image in the (u, v) plane; its center lies at the source.
struct DecalOptions {
  double width = 0;       ///< world units, > 0
  double height = 0;      ///< world units, > 0
  double angle = 0;       ///< counter-clockwise from the u axis to the image's left-to-right direction, radians
  bool mirrored = false;  ///< exchanges left and right
  /// Everything farther from the source is cut off, along a polygon of 64 corners on the circle; world units, > 0.
  double radius = std::numeric_limits<double>::infinity();
  double lift = 0;  ///< offset along the normals, which puts the decal above the surface; world units
};

/// Options for an image whose longer side has this length, world units; the lift is 0.002 of it.
DecalOptions decal_of(const Image& image, double longer_side);

/// The piece of the surface under an image.
struct Decal {
  std::vector<Vec3> points, normals;
  std::vector<Offset> face_begin;         ///< faces + 1; faces are triangles of the surface, cut along the borders of
                                          ///< the image
  std::vector<Index> face_vertices;       ///< counter-clockwise as seen from the side of the normals
  std::vector<double> image_coordinates;  ///< points x 2 in [0, 1]; (0, 0) is the lower left corner of the image
  /// Number of triangles left out: under another sheet of the map that is nearer to the source, or not connected to the rest.
  Index hidden = 0;
};

/// Distance from the source to the farthest point of the image, world units.
double reach(const DecalOptions& options);
/// Radius of the map that a decal requires, world units: a few edges more than `reach`, so that triangles at its border are
/// complete.
double map_radius(const DecalOptions& options, const TangentGraph& graph);

/// The triangles of the inverse map under the image, cut at its borders. The inverse map contains no triangles that are
/// flipped, too stretched or of low quality (`InverseMap`). Where the map folds, only one sheet is used. Only triangles
/// connected to the one nearest to the source are used.
/// @throws InvalidArgument (values not finite or out of range)
Decal make_decal(const InverseMap& inverse, const DecalOptions& options);

/// Image coordinates of each vertex, n x 2 in [0, 1], for clouds and other data painted per vertex. NaN where the vertex is
/// not under the image or belongs to no triangle of the decal.
/// @throws InvalidArgument as `make_decal`
std::vector<double> image_coordinates_of_vertices(const InverseMap& inverse, const DecalOptions& options);

}  // namespace ahm
