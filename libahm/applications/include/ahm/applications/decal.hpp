/// \file
/// Decals: a rectangle of the (u, v) plane, and the image on it, carried to the surface (Fig. 17).
///
/// \code
/// ahm::InverseMap inverse = ahm::inverse_map(graph, solver.solve(source, {.frames = true}));
/// ahm::Decal decal = ahm::make_decal(inverse, {.width = 0.2, .height = 0.1});
/// // a small mesh of its own: decal.points, .face_begin, .face_vertices, and .image_coordinates as its uv
/// \endcode
#pragma once

#include <limits>
#include <vector>

#include "ahm/applications/inverse_map.hpp"
#include "ahm/image.hpp"

namespace ahm {

/// Where an image lies in the (u, v) plane: its middle at the source.
struct DecalOptions {
  double width = 0;       ///< world units, > 0
  double height = 0;      ///< world units, > 0
  double angle = 0;       ///< radians from the u axis, counter-clockwise, to the image's direction from left to right
  bool mirrored = false;  ///< left and right exchanged
  /// What is farther from the source is cut off, along a polygon of 64 corners on the circle; world units, > 0.
  double radius = std::numeric_limits<double>::infinity();
  double lift = 0;  ///< along the normals, so that the decal lies above the surface; world units
};

/// Of an image whose longer side is that long, world units; above the surface by .002 of it.
DecalOptions decal_of(const Image& image, double longer_side);

/// A piece of the surface under an image.
struct Decal {
  std::vector<Vec3> points, normals;
  std::vector<Offset> face_begin;         ///< faces + 1: triangles of the surface, cut along the borders of the image
  std::vector<Index> face_vertices;       ///< counter-clockwise as seen from the side of the normals
  std::vector<double> image_coordinates;  ///< points x 2 in [0, 1]: (0, 0) the lower left corner of the image
  Index hidden =
      0;  ///< triangles left out, since another sheet of the map, nearer to the source, lies over the same place
};

/// From the source to the farthest point of the image, world units.
double reach(const DecalOptions& options);
/// Of the map that a decal takes: a few edges more, so that triangles at its border are whole; world units.
double map_radius(const DecalOptions& options, const TangentGraph& graph);

/// The triangles of the inverse map that lie under the image, cut at its borders: none that are turned over, stretched
/// or not trusted (`InverseMap`), one sheet where the map folds, and only what hangs together with the one nearest to
/// the source.
/// @throws InvalidArgument (values not finite or out of range)
Decal make_decal(const InverseMap& inverse, const DecalOptions& options);

/// For clouds and whatever else is painted per vertex: where each vertex lies in the image, n x 2 in [0, 1]; NaN where
/// the vertex is not under the image, or belongs to no triangle of the decal.
/// @throws InvalidArgument as `make_decal`
std::vector<double> image_coordinates_of_vertices(const InverseMap& inverse, const DecalOptions& options);

}  // namespace ahm
