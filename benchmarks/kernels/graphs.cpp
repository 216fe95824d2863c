#include "graphs.hpp"

#include <optional>

namespace ahm::bench {
namespace {

/// Keeps the last result, since Google Benchmark calls every function several times.
template <class Value>
class Last {
 public:
  template <class Make>
  const Value& get(Index n, const Make& make) {
    if (n != n_) value_.emplace(make());
    n_ = n;
    return *value_;
  }

 private:
  Index n_ = -1;
  std::optional<Value> value_;
};

}  // namespace

const Mesh& torus_mesh(Index n) {
  static Last<Mesh> last;
  return last.get(n, [n] { return torus(n); });
}

const std::vector<Vec3>& sphere_points(Index n) {
  static Last<std::vector<Vec3>> last;
  return last.get(n, [n] { return test::random_sphere(n).points; });
}

const CsrGraph& graph_of(Shape shape, Index n) {
  static Last<trimesh::TriangleMeshSurface> meshes;
  static Last<pointcloud::PointCloudSurface> clouds;
  if (shape == Shape::mesh)
    return meshes
        .get(n,
             [n] {
               const Mesh& mesh = torus_mesh(n);
               return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 1});
             })
        .graph();
  return clouds.get(n, [n] { return pointcloud::PointCloudSurface::build(sphere_points(n), {}, {.threads = 1}); })
      .graph();
}

}  // namespace ahm::bench
