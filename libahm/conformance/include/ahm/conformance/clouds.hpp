/// \file
/// Generated clouds with known log maps.
#pragma once

#include <vector>

#include "ahm/types.hpp"

namespace ahm::test {

struct Cloud {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;  ///< exact, outward
  /// Position of each point in the plane, for flat clouds and for clouds rolled up from the plane.
  std::vector<Vec2> plane;
};

/// Random points of a tilted unit square, far from regular: the density varies, and a round hole is cut out.
Cloud flat_cloud(Index n, unsigned seed = 1);
/// The unit sphere: `even_sphere` on a golden spiral from the north pole to the south pole, `random_sphere` at random.
Cloud even_sphere(Index n);
Cloud random_sphere(Index n, unsigned seed = 1);
/// A jittered grid of `rows` x `rows` points on the unit square, rolled to a cylinder of this radius about the x axis.
Cloud rolled_cloud(Index rows, double radius);
/// A Moebius band of unit radius and half-width 0.4.
Cloud moebius_cloud(Index n, unsigned seed = 1);

}  // namespace ahm::test
