/// \file
/// Consistent signs for the normals of a cloud.
#pragma once

#include <cmath>
#include <vector>

#include "ahm/util/vec.hpp"
#include "tangent_planes.hpp"
#include "tufted_cover.hpp"

namespace ahm::pointcloud {

/// Of each part, whether neighbours of opposite normals are the two sheets of thin walls: they lie consistently behind, or
/// before, each other. Normals whose signs are wrong, or turned to a viewpoint, show no such thing: what curvature does to one side of
/// a pair it undoes on the other, and noise has no direction.
std::vector<char> have_thin_walls(const CleanPoints& cloud, const TangentPlanes& planes,
                                  const Neighborhoods& neighborhoods, const CloudParts& parts);

/// Union-find over vertices that also keeps the relative sign of each vertex to its root, the smallest of its set.
class SignedForest {
 public:
  explicit SignedForest(Index n);

  struct Root {
    Index vertex;
    signed char sign;
  };
  Root find(Index v);
  /// @return whether they were apart
  bool join(Index a, Index b, signed char relative);

 private:
  std::vector<Index> parent_;
  std::vector<signed char> sign_;
};

/// How much two planes bend: the order in which edges are taken into the spanning tree.
inline float bend(const Vec3& normal, const Vec3& other) {
  return static_cast<float>(1.0 - std::abs(dot(normal, other)));
}

/// What the points of a component say about its overall sign, in the order of precedence.
struct Evidence {
  Vec3 centroid{0, 0, 0};  ///< their sum
  Index points = 0;
  double given = 0;    ///< points that keep their given sign minus points that lose it
  double outward = 0;  ///< sum of (p - centroid) . n
  double spread = 0;   ///< sum of |p - centroid|
  Vec3 normal_sum{0, 0, 0};

  /// First of all points of the component ...
  void count(const Vec3& point);
  /// ... then of all of them again: the normal with the sign that it has relative to the root.
  void weigh(const Vec3& point, const Vec3& normal, signed char sign);
  /// Negative: the component is to be turned over.
  double sign(bool signs_given) const;
};

/// Flips normals so that they agree along a spanning tree of the flattest edges [HDDMS92], per connected component.
/// The component as a whole keeps the majority of the signs that were given, else points away from its centroid, else
/// (flat clouds) along its largest coordinate.
/// @param kept  parts whose normals stay as they are
/// @return of each part, the number of normals that are flipped against the majority of their component
std::vector<Index> orient_normals(const CleanPoints& cloud, const WeightedEdges& edges, bool signs_given,
                                  const CloudParts& parts, const std::vector<char>& kept, unsigned threads,
                                  TangentPlanes& planes);

}  // namespace ahm::pointcloud
