/// \file
/// The shapes of the kernels. The last one of each kind is kept.
#pragma once

#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "shapes.hpp"

namespace ahm::bench {

/// A jittered torus of about n vertices, with quads cut at random.
const Mesh& torus_mesh(Index n);
/// n random points of the unit sphere.
const std::vector<Vec3>& sphere_points(Index n);

enum class Shape {
  mesh,   ///< torus_mesh
  cloud,  ///< sphere_points
};

/// The graph of a shape, built on one thread.
const CsrGraph& graph_of(Shape shape, Index n);

}  // namespace ahm::bench
