// The intrinsic triangulation is Delaunay, has the same surface, and its history finds every point of the input.
#include <map>

#include "meshes.hpp"

namespace ahm::test {
namespace {

double area(const TriangleMeshSurface& surface) {
  double sum = 0;
  for (Index i = 0; i < surface.graph().size(); ++i) sum += surface.graph().mass(i);
  return sum * surface.graph().length_unit() * surface.graph().length_unit();
}

/// A sphere with vertices moved along the surface until many edges are not Delaunay.
Mesh rough_sphere(Index parts) {
  Mesh mesh = icosphere(parts);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.35 / parts, 0.35 / parts);
  for (Vec3& p : mesh.positions) {
    for (double& x : p) x += shift(random);
    p = normalized(p);
  }
  return mesh;
}

TEST(Flips, PreserveTheArea) {
  for (const Mesh& mesh : {sliver_square(800), holed_square(30), rough_sphere(12), moebius_mesh(60, 5)}) {
    const auto flipped = build(mesh), plain = build(mesh, {.intrinsic_delaunay = false});
    EXPECT_GT(flipped.details().flips, 10);
    EXPECT_EQ(flipped.details().edges, plain.details().edges);
    EXPECT_NEAR(area(flipped), area(plain), 1e-12 * area(plain));
  }
}

TEST(Flips, LeaveOnlyWeightsOfDelaunayEdges) {
  for (const Mesh& mesh : {sliver_square(800), rough_sphere(12), moebius_mesh(60, 5)}) {
    // Unclamped, interior edges have weights >= 0 up to rounding; boundary edges may not. Flips do not change boundary edges.
    const auto surface = build(mesh, {.clamp_weights = false});
    std::map<std::pair<Index, Index>, int> face_count;
    for (const Triangle& t : mesh.faces)
      for (int s = 0; s < 3; ++s) ++face_count[std::minmax(t[s], t[(s + 1) % 3])];
    for (Index i = 0; i < surface.graph().size(); ++i) {
      const Star star = surface.graph().star(i);
      for (std::size_t e = 0; e < star.degree(); ++e) {
        const auto found = face_count.find(std::minmax(i, star.neighbors[e]));
        const bool on_boundary = found != face_count.end() && found->second == 1;
        EXPECT_TRUE(star.weights[e] >= -1e-9 || on_boundary) << i << " to " << star.neighbors[e];
      }
    }
  }
}

TEST(Flips, AreFewAndTheirHistoryIsShallow) {
  for (Index side : {40, 80, 160}) {
    const Mesh mesh = holed_square(side);
    const auto surface = build(mesh);
    EXPECT_LT(surface.details().flips, 1.5 * static_cast<double>(mesh.faces.size()));
    std::mt19937_64 random(1);
    double depth = 0;
    for (int trial = 0; trial < 2000; ++trial) depth += surface.locate(random_point(mesh, random)).depth / 2000.0;
    EXPECT_LT(depth, 4) << side;
  }
}

/// Distance in the plane between a point and the point that the history finds for it.
double location_error(const Mesh& mesh, const TriangleMeshSurface& surface, const FacePoint& point) {
  const auto found = surface.locate(point);
  Vec2 p{0, 0};
  for (int s = 0; s < 3; ++s) {
    EXPECT_GE(found.barycentric[s], 0);
    p = p + found.barycentric[s] * mesh.plane[surface.mesh().input_of_vertex()[found.vertices[s]]];
  }
  return length(p - plane_point(mesh, point));
}

TEST(History, FindsEveryPointOfThePlane) {
  std::mt19937_64 random(2);
  for (const Mesh& mesh :
       {sliver_square(500), sliver_square(4000, 5), holed_square(40), holed_square(40, 2, 1e-4), maze(10)}) {
    const auto surface = build(mesh);
    EXPECT_GT(surface.details().flips, 0);
    for (int trial = 0; trial < 20000; ++trial)
      ASSERT_LT(location_error(mesh, surface, random_point(mesh, random)), 1e-11);
  }
  const Mesh mesh = sliver_square(1500, 3);
  const auto surface = build(mesh);
  for (Index f = 0; f < static_cast<Index>(mesh.faces.size()); ++f)
    for (int s = 0; s < 3; ++s) {
      FacePoint corner{f, {0, 0, 0}}, middle{f, {0.5, 0.5, 0.5}};
      corner.barycentric[s] = 1;
      middle.barycentric[s] = 0;
      ASSERT_LT(location_error(mesh, surface, corner), 1e-12);
      ASSERT_LT(location_error(mesh, surface, middle), 1e-12);
    }
}

}  // namespace
}  // namespace ahm::test
