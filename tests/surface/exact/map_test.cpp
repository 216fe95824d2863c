#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::ExactMap;
using exact::ExactOptions;
using exact::MeshPoint;

/// The logs of the edges about a vertex, as the graph of the triangle backend has them.
TEST(ExactMap, HasTheAxesOfTheTriangleBackend) {
  for (const Mesh& mesh : {icosphere(5), cone_patch(9, 4.0), moebius_mesh(30, 5)}) {
    const Polyhedron solid(mesh);
    trimesh::MeshOptions options;
    options.intrinsic_delaunay = false;
    const auto graph = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, options);
    for (Index v = 0; v < solid.surface.vertex_count(); v += 7) {
      const ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(v)));
      const Star star = graph.graph().star(v);
      for (std::size_t k = 0; k < star.neighbors.size(); ++k) {
        const Vec2 uv = map.coordinates(Vertex(star.neighbors[k]));
        EXPECT_NEAR(uv[0], star.logs[2 * k], 1e-12);
        EXPECT_NEAR(uv[1], star.logs[2 * k + 1], 1e-12);
      }
    }
  }
}

TEST(ExactMap, TakesTheNearestOfSeveralSources) {
  const Polyhedron solid(icosphere(8));
  std::mt19937_64 random(2);
  std::vector<MeshPoint> sources{solid.surface.vertex_point(Vertex(3)), {10, {0.5, 0.5, 0}}};
  for (int k = 0; k < 3; ++k) sources.push_back(random_point(solid.surface, random));
  const ExactMap all = exact::exact_map(solid.surface, sources);
  const std::vector<ExactMap> each = exact::exact_maps(solid.surface, sources);
  for (Index v = 0; v < all.size(); ++v) {
    const auto nearest = std::min_element(each.begin(), each.end(), [v](const ExactMap& a, const ExactMap& b) {
      return a.distance(Vertex(v)) < b.distance(Vertex(v));
    });
    EXPECT_NEAR(all.distance(Vertex(v)), nearest->distance(Vertex(v)), 1e-13);
    const ExactMap& own = each[static_cast<std::size_t>(all.source(Vertex(v)))];
    EXPECT_NEAR(own.distance(Vertex(v)), nearest->distance(Vertex(v)), 1e-13);
    EXPECT_NEAR(std::remainder(all.direction(Vertex(v)) - own.direction(Vertex(v)), 6.283185307179586), 0, 1e-11);
  }
}

/// In needles, rays of one source pass close by the others.
TEST(ExactMap, TakesTheNearestOfSeveralSourcesInNeedles) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Mesh mesh = sliver_square(150, seed);
    const Polyhedron solid(mesh);
    std::mt19937_64 random(seed);
    std::vector<MeshPoint> sources;
    for (int k = 0; k < 12; ++k) sources.push_back(random_point(solid.surface, random));
    const ExactMap map = exact::exact_map(solid.surface, sources);
    for (Index v = 0; v < map.size(); ++v) {
      double nearest = 2;
      for (const MeshPoint& s : sources) {
        const Vec2 p = mesh.plane_point(s.face, s.barycentric);
        nearest = std::min(nearest, std::hypot(p[0] - mesh.plane[v][0], p[1] - mesh.plane[v][1]));
      }
      EXPECT_NEAR(map.distance(Vertex(v)) * solid.mesh.length_unit(), nearest, 1e-12) << seed << ' ' << v;
    }
  }
}

TEST(ExactMap, IsTheSameBitForBitOnAnyNumberOfThreads) {
  const Polyhedron solid(icosphere(7));
  std::vector<MeshPoint> sources;
  for (Index v = 0; v < 40; ++v) sources.push_back(solid.surface.vertex_point(Vertex(5 * v)));
  const auto one = exact::exact_maps(solid.surface, sources, {}, 1),
             four = exact::exact_maps(solid.surface, sources, {}, 4);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_TRUE(std::ranges::equal(one[k].distances(), four[k].distances()));
    EXPECT_TRUE(std::ranges::equal(one[k].directions(), four[k].directions()));
  }
}

TEST(ExactMap, EndsAtTheRadius) {
  const Polyhedron solid(icosphere(10));
  const ExactMap whole = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(0)));
  ExactOptions options;
  options.radius = 0.4 * *std::ranges::max_element(whole.distances());
  const ExactMap part = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(0)), options);
  EXPECT_LT(part.statistics().windows, whole.statistics().windows / 2);
  for (Index v = 0; v < part.size(); ++v) {
    if (whole.distance(Vertex(v)) <= options.radius) {
      EXPECT_EQ(part.distance(Vertex(v)), whole.distance(Vertex(v)));
      EXPECT_EQ(part.direction(Vertex(v)), whole.direction(Vertex(v)));
    } else {
      EXPECT_EQ(part.status(Vertex(v)), Status::beyond_radius);
      EXPECT_TRUE(std::isnan(part.distance(Vertex(v))));
    }
  }
}

TEST(ExactMap, LeavesOtherComponentsOut) {
  Mesh two = icosphere(3);
  const Index n = two.vertices();
  const Mesh one = two;
  for (const Vec3& p : one.positions) two.positions.push_back({p[0] + 5, p[1], p[2]});
  for (const Triangle& t : one.faces) two.faces.push_back({t[0] + n, t[1] + n, t[2] + n});
  const Polyhedron solid(two);
  ExactOptions options;
  options.targets = {solid.surface.vertex_point(Vertex(n + 1)), {0, {0.2, 0.3, 0.5}}};
  const ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(n - 1)), options);
  for (Index v = 0; v < map.size(); ++v) EXPECT_EQ(map.status(Vertex(v)), v < n ? Status::ok : Status::disconnected);
  EXPECT_EQ(map.target_status(0), Status::disconnected);
  EXPECT_EQ(map.target_status(1), Status::ok);
  const auto path = exact::path_to_vertex(solid.surface, map, Vertex(n));
  EXPECT_EQ(path.status, Status::disconnected);
  EXPECT_TRUE(path.points.empty());
}

TEST(ExactMap, IsContinuousInItsSource) {
  const Polyhedron solid(icosphere(6));
  const ExactMap vertex = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(20)));
  const MeshPoint corner = solid.surface.vertex_point(Vertex(20));
  MeshPoint beside = corner;
  for (double& b : beside.barycentric) b = b > 0 ? 1 - 2e-9 : 1e-9;
  MeshPoint edge = corner;
  for (int s = 0; s < 3; ++s)
    if (corner.barycentric[s] > 0) edge.barycentric[s] = 1 - 1e-9, edge.barycentric[(s + 1) % 3] = 1e-9;
  for (const MeshPoint& near : {beside, edge}) {
    const ExactMap map = exact::exact_map(solid.surface, near);
    for (Index v = 0; v < map.size(); ++v) EXPECT_NEAR(map.distance(Vertex(v)), vertex.distance(Vertex(v)), 2e-9);
  }
}

TEST(ExactMap, DoesNotDependOnTheFaceThatNamesAPointOfAnEdge) {
  const Polyhedron solid(icosphere(6));
  const auto& surface = solid.surface;
  for (exact::Half h = 0; h < 120; h += 3) {
    // Side h + 2 of the face, the left side of h, in both faces.
    const exact::Half t = surface.record(h).beyond_left;
    MeshPoint here{h / 3, {0.3, 0, 0.7}}, there{t / 3, {0, 0, 0}};
    there.barycentric[t % 3] = 0.3;
    there.barycentric[exact::next(t) % 3] = 0.7;
    const ExactMap a = exact::exact_map(surface, here), b = exact::exact_map(surface, there);
    for (Index v = 0; v < a.size(); ++v) EXPECT_NEAR(a.distance(Vertex(v)), b.distance(Vertex(v)), 1e-13);
  }
}

}  // namespace
}  // namespace ahm::test
