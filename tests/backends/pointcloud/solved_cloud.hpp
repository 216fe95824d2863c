/// \file
/// A cloud taken all the way to maps, and its maps beside the sphere's closed form.
#pragma once

#include <gtest/gtest.h>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"

namespace ahm::test {

/// Builds, factors and solves in one go.
struct Solved {
  explicit Solved(const Cloud& cloud, bool with_normals = false, pointcloud::CloudOptions options = {})
      : graph(pointcloud::PointCloudSurface::build(
            cloud.points, with_normals ? std::span<const Vec3>(cloud.normals) : std::span<const Vec3>(), options)),
        solver(graph.graph()) {}

  RowLogMap map(Index point, Variant variant = Variant::adaptive) const {
    return graph.to_rows(solver.solve(graph.source(Row(point)).source, {.variant = variant}));
  }

  pointcloud::PointCloudSurface graph;
  LogMapSolver solver;
};

/// Errors from input point p, in the axes of the solver made tangent to the true sphere; all points must be ok.
inline SphereError sphere_error(const Cloud& sphere, const pointcloud::PointCloudSurface& graph, const RowLogMap& map,
                                Index p) {
  for (std::size_t i = 0; i < sphere.points.size(); ++i) EXPECT_EQ(map.status[i], Status::ok) << "point " << i;
  const Frame frame = *graph.graph().frame(graph.vertex(Row(p)).index);
  return sphere_error(sphere.normals, map.u, map.v, p, tangential(frame.x, sphere.normals[p]),
                      tangential(frame.y, sphere.normals[p]));
}

}  // namespace ahm::test
