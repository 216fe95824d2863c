/// \file
/// Neighborhoods and tangent planes of the points of a cloud.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/util/unset_vector.hpp"
#include "ahm/util/vec.hpp"
#include "clean_points.hpp"

namespace ahm::pointcloud {

/// Dropping neighbors shrinks a neighborhood, which may require dropping others. After these rounds the triangulation rejects
/// the rest.
inline constexpr int reach_rounds = 3;

/// A neighborhood is as thick as wide if its third principal variance is above this fraction of the second.
inline constexpr double thick_ratio = 0.25;

/// The neighbors of all points.
struct Neighborhoods {
  Index k = 0;                         ///< neighbors per point; some points need more or reach fewer
  std::vector<Offset> begin;           ///< start of each point's neighbors in `indices`; n + 1
  detail::UnsetVector<Index> indices;  ///< neighbors of each point, nearest first, without the point itself
  std::vector<double> radius;          ///< distance of each point to its last neighbor
  Offset unreachable = 0;              ///< neighbors found but dropped, too far away to be joined
  std::span<const Index> of(Index i) const {
    return std::span(indices).subspan(static_cast<std::size_t>(begin[i]),
                                      static_cast<std::size_t>(begin[i + 1] - begin[i]));
  }
};

/// The tangent planes of all points.
struct TangentPlanes {
  std::vector<Vec3> normals;  ///< unit length, signs as in the input or arbitrary; zero: no plane
  Index estimated = 0;        ///< normals computed by PCA, because the input has none
  Index contradicted = 0;     ///< input normals of which only the sign is used
  Index thick = 0;            ///< points with neighbors about as far across the plane as within it
  bool has_plane(Index i) const { return normals[i] != Vec3{0, 0, 0}; }
};

/// The k nearest neighbors of each point, without neighbors beyond a gap and neighbors that will not be joined. A gap is a step
/// by a factor of more than `max_edge_ratio`, after at least half of the neighbors. A neighbor will not be joined if its own
/// neighborhood is much smaller. So planes are fitted to points of one surface, and islands do not affect each other.
Neighborhoods find_neighborhoods(const CleanPoints& cloud, const NeighborSearch& search, Index k,
                                 const CloudOptions& options);

/// Finds the neighbors of some points, ascending, again. Those of other points do not change.
void refill_neighborhoods(const CleanPoints& cloud, const NeighborSearch& search, std::span<const Index> points,
                          const CloudOptions& options, Neighborhoods& neighborhoods);

/// Distance of neighbors on a surface sampled evenly at the density of point i: the square root of the area per point.
double spacing_at(const Neighborhoods& neighborhoods, Index i);
/// Median of `spacing_at` over all points.
double spacing(const Neighborhoods& neighborhoods);
/// Median of `spacing_at` over some points.
double spacing(const Neighborhoods& neighborhoods, std::span<const Index> points);

/// Tangent planes from input normals that agree with the points, or else by principal component analysis of the neighbors.
/// Input normals that are zero or not finite are estimated and turned to the side of their neighbors. Points with neighbors
/// almost on a line, as on one scan line, get two or four times as many neighbors.
TangentPlanes find_tangent_planes(const CleanPoints& cloud, std::span<const Vec3> given, const NeighborSearch& search,
                                  Neighborhoods& neighborhoods, const CloudOptions& options);

/// Orthonormal axes of the plane with a unit normal: x is the projection of the first coordinate axis (the second where the
/// normal is close to the first), y = normal x x.
struct PlaneAxes {
  explicit PlaneAxes(const Vec3& normal) {
    const Vec3 axis = std::abs(normal[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    x = normalized(axis - dot(axis, normal) * normal);
    y = cross(normal, x);
  }
  Vec3 x, y;
};

/// Replaces the fitted planes of `planes` by input planes (zero: none), except where the points contradict them or they meet in
/// a sharp crease. There the fitted plane stays, on the side of the input normal. Fills the counts of `planes`.
/// @return for each point, whether the input has neither plane nor side
std::vector<char> apply_input_planes(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                     std::span<const Vec3> given, unsigned threads, TangentPlanes& planes);

}  // namespace ahm::pointcloud
