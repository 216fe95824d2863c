/// \file
/// Generated clouds whose log maps are known.
#pragma once

#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"

namespace ahm::test {

struct Cloud {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;  ///< exact, outward
  /// Position in the plane, for flat clouds and clouds rolled up from the plane.
  std::vector<std::array<double, 2>> plane;
};

double dot(const Vec3& a, const Vec3& b);

/// Random points of a tilted unit square far from regular: density varies, and a round hole is cut out.
Cloud flat_cloud(Index n, unsigned seed = 1);
/// The unit sphere, evenly (a golden spiral) or at random.
Cloud even_sphere(Index n);
Cloud random_sphere(Index n, unsigned seed = 1);
/// A jittered grid of `rows` points a side on the unit square, rolled to a cylinder of radius `radius` about the x
/// axis.
Cloud rolled_cloud(Index rows, double radius);
/// A Moebius band of unit radius and half-width 0.4.
Cloud moebius_cloud(Index n, unsigned seed = 1);

/// Log map of the unit sphere from point p in the frame given by tangent axes x, y.
std::array<double, 2> sphere_log(const Vec3& p, const Vec3& x, const Vec3& y, const Vec3& q);

struct SphereError {
  double rms, angle_rms, hemisphere_max;
};
/// Errors against the closed form from input point p, over d < 0.9 pi; all points must be ok.
SphereError sphere_error(const Cloud& sphere, const pointcloud::PointCloudSurface& graph, const RowLogMap& map,
                         Index p);

/// Builds, factors and solves in one go.
struct Solved {
  explicit Solved(const Cloud& cloud, bool with_normals = false, pointcloud::CloudOptions options = {});
  RowLogMap map(Index point, Variant variant = Variant::adaptive) const;
  pointcloud::PointCloudSurface graph;
  LogMapSolver solver;
};

}  // namespace ahm::test
