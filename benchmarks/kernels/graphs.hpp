/// \file
/// The shapes the kernels run on, each made once: the last of each kind is kept.
#pragma once

#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "shapes.hpp"

namespace ahm::bench {

/// A torus of about n vertices, jittered, its quads cut at random.
const Mesh& torus_mesh(Index n);
/// The unit sphere, n points at random.
const std::vector<Vec3>& sphere_points(Index n);

enum class Shape {
  mesh,   ///< torus_mesh
  cloud,  ///< sphere_points
};

/// Its graph, on one thread.
const CsrGraph& graph_of(Shape shape, Index n);

}  // namespace ahm::bench
