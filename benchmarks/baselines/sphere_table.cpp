// Every method on the same graphs of the unit sphere, against the closed form. The rows are Markdown.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "baselines/signed_heat.hpp"
#include "measure.hpp"
#include "shapes.hpp"

namespace {

using ahm::Index;
using ahm::Vec3;
using ahm::baselines::Method;
using ahm::baselines::Result;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Root mean square errors over the vertices within 0.9 pi of the sources.
class Errors {
 public:
  void add(const ahm::TangentGraph& graph, Index source, const Result& result) {
    const ahm::Frame frame = *graph.frame(source);
    for (Index i = 0; i < graph.size(); ++i) {
      const Vec3 q = graph.frame(i)->origin;
      const double x = dot(frame.x, q), y = dot(frame.y, q), r = std::hypot(x, y);
      const double exact = std::atan2(r, dot(frame.origin, q));
      if (i == source || exact > 0.9 * std::numbers::pi) continue;
      ++count_;
      distance_ += std::pow(result.distance[i] - exact, 2);
      has_map_ = !result.coordinates.empty();
      if (!has_map_) continue;
      const double u = result.coordinates[2 * i], v = result.coordinates[2 * i + 1];
      map_ += std::pow(u - x / r * exact, 2) + std::pow(v - y / r * exact, 2);
      angle_ += std::pow(std::atan2(v * x - u * y, u * x + v * y), 2);
    }
  }

  void print() const {
    std::printf(" %.4f |", std::sqrt(distance_ / count_));
    has_map_ ? std::printf(" %.4f | %.4f |", std::sqrt(angle_ / count_), std::sqrt(map_ / count_))
             : std::printf(" | |");
  }

 private:
  double distance_ = 0, angle_ = 0, map_ = 0;
  int count_ = 0;
  bool has_map_ = false;
};

/// @param make  makes the method
template <class Make>
void row(const char* shape, const char* name, const ahm::TangentGraph& graph, const Make& make) {
  Method method;
  const double first = ahm::bench::seconds([&] { method = make(); });
  Errors errors;
  double further = 0;
  const Index n = graph.size(), sources[] = {n / 7, n / 3, n / 2 + 7};
  for (Index source : sources) {
    Result result;
    further += ahm::bench::seconds([&] { result = method->solve(source); }) / 3;
    errors.add(graph, source, result);
  }
  std::printf("| %s | %s |", shape, name);
  errors.print();
  std::printf(" %.2f / %.3f |\n", first, further);
}

void rows(const char* shape, const ahm::TangentGraph& graph) {
  using namespace ahm::baselines;
  using ahm::Variant;
  row(shape, "AHM_a", graph, [&] { return affine_heat(graph, Variant::adaptive); });
  row(shape, "AHM_l", graph, [&] { return affine_heat(graph, Variant::localized); });
  row(shape, "AHM_a, order 2", graph, [&] { return affine_heat(graph, Variant::adaptive, 1.0, 2); });
  row(shape, "VHM_log", graph, [&] { return vector_heat_log(graph); });
  row(shape, "VHM_log, radial at the source", graph,
      [&] { return vector_heat_log(graph, {.radial_at_source = true}); });
  row(shape, "SEM", graph, [&] { return smoothed_exponential(graph); });
  row(shape, "SEM, t_coef 1", graph, [&] { return smoothed_exponential(graph, 1.0); });
  row(shape, "DEM", graph, [&] { return discrete_exponential(graph); });
  row(shape, "DEM, turned in space", graph, [&] { return discrete_exponential(graph, {.turn = FrameTurn::in_space}); });
  row(shape, "HM (graph)", graph, [&] { return heat_distance(graph); });
  row(shape, "SHM", graph, [&]() -> Method { return std::make_unique<SignedHeat>(graph); });
}

void mesh_rows(const char* shape, Index n) {
  const ahm::bench::Mesh mesh = ahm::bench::icosphere(n);
  const auto surface = ahm::trimesh::TriangleMeshSurface::build(mesh.points, mesh.faces);
  rows(shape, surface.graph());
  row(shape, "HM (faces)", surface.graph(), [&] { return ahm::baselines::heat_distance(surface.mesh()); });
}

}  // namespace

int main() {
  std::printf("| shape | method | distance | angle | map | s: made / per source |\n|---|---|---|---|---|---|\n");
  mesh_rows("icosphere, 10,242", 10242);
  mesh_rows("icosphere, 40,962", 40962);
  const auto cloud = ahm::pointcloud::PointCloudSurface::build(ahm::bench::random_sphere(10000));
  rows("random cloud, 10,000", cloud.graph());
}
