/// \file
/// Axes of tangent planes.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/util/unset_vector.hpp"
#include "ahm/util/vec.hpp"
#include "clean_points.hpp"

namespace ahm::pointcloud {

/// Dropping neighbours shrinks a neighbourhood, which may drop others; what is left after these rounds is not joined either.
inline constexpr int reach_rounds = 3;

/// Neighbours are as thick as wide when their third principal variance is above this share of the second.
inline constexpr double thick_ratio = 0.25;

struct Neighborhoods {
  Index k = 0;                         ///< neighbours per point, but for points that needed more or reach fewer
  std::vector<Offset> begin;           ///< n + 1
  detail::UnsetVector<Index> indices;  ///< of each point: nearest first, the point itself left out
  std::vector<double> radius;          ///< distance to the last of them
  Offset unreachable = 0;              ///< neighbours found but left out, too far away to be joined
  std::span<const Index> of(Index i) const {
    return std::span(indices).subspan(static_cast<std::size_t>(begin[i]),
                                      static_cast<std::size_t>(begin[i + 1] - begin[i]));
  }
};

struct TangentPlanes {
  std::vector<Vec3> normals;  ///< unit length, signs as given or arbitrary; zero where there is no plane
  Index estimated = 0;        ///< normals that came from PCA because none was given
  Index contradicted = 0;     ///< given normals of which only the side was taken
  Index thick = 0;            ///< points whose neighbours lie about as far across the plane as within it
  bool has_plane(Index i) const { return normals[i] != Vec3{0, 0, 0}; }
};

/// The k nearest, less those beyond a gap (a step to more than `max_edge_ratio` times the distance behind half of them),
/// and those whose own neighbourhood is so much smaller that they will not be joined: planes are made of what the surface
/// is made of, and an island takes nothing from the next one.
Neighborhoods find_neighborhoods(const CleanPoints& cloud, const NeighborSearch& search, Index k,
                                 const CloudOptions& options);

/// Searches again the neighbors of some points, ascending; those of the others stay.
void refill_neighborhoods(const CleanPoints& cloud, const NeighborSearch& search, std::span<const Index> points,
                          const CloudOptions& options, Neighborhoods& neighborhoods);

/// Distance of neighbours on an even surface of the density at a point: the root of the area per point ...
double spacing_at(const Neighborhoods& neighborhoods, Index i);
/// ... and its median, over all or some.
double spacing(const Neighborhoods& neighborhoods);
double spacing(const Neighborhoods& neighborhoods, std::span<const Index> points);

/// Normals as given, where the points bear them out (zero and non-finite ones are estimated, and turned to the side of
/// their neighbours), or by
/// principal component analysis of the neighbours. Points whose neighbours lie almost on a line, as on one line of a
/// scanner, get two or four times as many neighbours.
TangentPlanes find_tangent_planes(const CleanPoints& cloud, std::span<const Vec3> given, const NeighborSearch& search,
                                  Neighborhoods& neighborhoods, const CloudOptions& options);

/// Orthonormal axes of the plane with a unit normal: x is the projected first coordinate axis of space (the second
/// where the normal is close to the first), y = normal x x.
struct PlaneAxes {
  explicit PlaneAxes(const Vec3& normal) {
    const Vec3 axis = std::abs(normal[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    x = normalized(axis - dot(axis, normal) * normal);
    y = cross(normal, x);
  }
  Vec3 x, y;
};

/// Puts the given planes (zero where there are none) in place of the fitted ones of `planes`, except where the points
/// contradict them: there the fitted plane stays, on the given side. Fills the counts of `planes`.
/// @return for every point, whether neither plane nor side was given
std::vector<char> take_given_planes(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                    std::span<const Vec3> given, unsigned threads, TangentPlanes& planes);

}  // namespace ahm::pointcloud
