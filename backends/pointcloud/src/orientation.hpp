/// \file
/// Consistent signs for the normals of a cloud.
#pragma once

#include <cmath>
#include <vector>

#include "ahm/util/vec.hpp"
#include "tangent_planes.hpp"
#include "tufted_cover.hpp"

namespace ahm::pointcloud {

/// For each part, whether neighbors with opposed normals are the two sheets of thin walls: they lie consistently behind, or in
/// front of, each other. Normals with wrong signs, or turned to a viewpoint, show no such pattern. Curvature affects both
/// points of a pair in opposite directions, and noise has no direction.
std::vector<char> have_thin_walls(const CleanPoints& cloud, const TangentPlanes& planes,
                                  const Neighborhoods& neighborhoods, const CloudParts& parts);

/// Union-find over vertices. Stores the sign of each vertex relative to its root, the lowest vertex of its set.
class SignedForest {
 public:
  explicit SignedForest(Index n);

  struct Root {
    Index vertex;
    signed char sign;
  };
  Root find(Index v);
  /// Joins the sets of a and b.
  /// @param relative  sign of a relative to b
  /// @return whether the sets were different
  bool join(Index a, Index b, signed char relative);

 private:
  std::vector<Index> parent_;
  std::vector<signed char> sign_;
};

/// Bend between two planes. Edges enter the spanning tree in ascending order of it.
inline float bend(const Vec3& normal, const Vec3& other) {
  return static_cast<float>(1.0 - std::abs(dot(normal, other)));
}

/// Evidence for the overall sign of a component, in order of precedence.
struct Evidence {
  Vec3 centroid{0, 0, 0};  ///< sum of the points
  Index points = 0;
  double given = 0;    ///< number of points that keep their input sign minus number of points that lose it
  double outward = 0;  ///< sum of (p - centroid) . n
  double spread = 0;   ///< sum of |p - centroid|
  Vec3 normal_sum{0, 0, 0};

  /// First pass: adds a point of the component.
  void count(const Vec3& point);
  /// Second pass over the same points: adds a normal with its sign relative to the root.
  void weigh(const Vec3& point, const Vec3& normal, signed char sign);
  /// Negative: the component must be flipped.
  double sign(bool signs_given) const;
};

/// Flips normals so that they agree along a spanning tree of the flattest edges [HDDMS92], per connected component. A component
/// as a whole keeps the majority of its input signs. Without them, its normals point away from its centroid. On flat clouds the
/// largest coordinate of their sum is positive.
/// @param kept  parts with normals that do not change
/// @return for each part, the number of normals flipped against the majority of their component
std::vector<Index> orient_normals(const CleanPoints& cloud, const WeightedEdges& edges, bool signs_given,
                                  const CloudParts& parts, const std::vector<char>& kept, unsigned threads,
                                  TangentPlanes& planes);

}  // namespace ahm::pointcloud
