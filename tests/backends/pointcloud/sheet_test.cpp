// The manifold triangulation of a cloud, and exact and polar maps over it.
#include <map>
#include <set>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "clouds.hpp"

namespace ahm::test {
namespace {

/// The triangulation of a cloud and figures of its topology.
struct Sheet {
  explicit Sheet(const std::vector<Vec3>& points, unsigned threads = 0)
      : flat(PointCloudSurface::build(points, {}, {.threads = threads}).flat_approximation()) {
    std::map<std::array<Index, 2>, int> edges;
    std::map<Index, std::map<Index, std::vector<Index>>> links;  // of each vertex, the edges opposite to it
    for (Index f = 0; f < flat.surface.face_count(); ++f) {
      const auto r = flat.surface.record(3 * f);
      area += 0.5 * r.length * r.apex_y * flat.length_unit * flat.length_unit;
      std::array<Index, 3> t{r.tail, r.head, r.apex};
      std::sort(t.begin(), t.end());
      triangles.push_back(t);
      for (int c = 0; c < 3; ++c) {
        const Index a = t[(c + 1) % 3], b = t[(c + 2) % 3];
        ++edges[{std::min(a, b), std::max(a, b)}];
        links[t[c]][a].push_back(b);
        links[t[c]][b].push_back(a);
      }
    }
    for (const auto& [edge, count] : edges) {
      is_manifold &= count <= 2;
      open_edges += count == 1;
    }
    for (const auto& [vertex, link] : links) is_manifold &= is_connected(link);
    vertices = links.size();
    euler = static_cast<int>(vertices) - static_cast<int>(edges.size()) + static_cast<int>(triangles.size());
  }

  FlatTriangles flat;
  std::vector<std::array<Index, 3>> triangles;  ///< corners in ascending order
  std::size_t vertices = 0;
  int open_edges = 0;  ///< edges of one triangle
  int euler = 0;
  double area = 0;
  bool is_manifold = true;  ///< at most two triangles at an edge, and one fan of triangles at a vertex

 private:
  static bool is_connected(const std::map<Index, std::vector<Index>>& graph) {
    std::set<Index> reached{graph.begin()->first};
    std::vector<Index> queue(reached.begin(), reached.end());
    while (!queue.empty()) {
      const Index at = queue.back();
      queue.pop_back();
      for (const Index next : graph.at(at))
        if (reached.insert(next).second) queue.push_back(next);
    }
    return reached.size() == graph.size();
  }
};

std::vector<Vec3> random_torus(Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vec3> points;
  while (static_cast<Index>(points.size()) < n) {
    const double a = 2 * std::numbers::pi * uniform(random), b = 2 * std::numbers::pi * uniform(random);
    const double r = 1 + 0.4 * std::cos(b);
    if (1.4 * uniform(random) < r) points.push_back({r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b)});
  }
  return points;
}

std::vector<Vec3> rough_sphere(Index n) { return with_noise(random_sphere(n), 0.5 / std::sqrt(n)).points; }

TEST(Sheet, IsAManifold) {
  for (const auto& points : {random_sphere(2000).points, rough_sphere(2000), random_torus(2000, 1),
                             moebius_cloud(900).points, flat_cloud(1000).points, rolled_cloud(20, 0.3).points})
    EXPECT_TRUE(Sheet(points).is_manifold);
}

TEST(Sheet, OfCleanClosedCloudsHasTheirEulerCharacteristic) {
  const auto expect_closed = [](const std::vector<Vec3>& points, int euler) {
    const Sheet sheet(points);
    EXPECT_EQ(sheet.euler, euler);
    EXPECT_EQ(sheet.open_edges, 0);
    return sheet.vertices;
  };
  EXPECT_EQ(expect_closed(random_sphere(3000).points, 2), 3000U);
  EXPECT_EQ(expect_closed(even_sphere(3000).points, 2), 3000U);
  for (const unsigned seed : {1u, 2u}) expect_closed(random_torus(4000, seed), 0);
}

TEST(Sheet, OfAFlatCloudCoversItsConvexHull) {
  const Sheet sheet(flat_square(41).positions);
  EXPECT_NEAR(sheet.area, 1, 1e-9);
  EXPECT_EQ(sheet.euler, 1);
  EXPECT_EQ(sheet.open_edges, 4 * 40);
}

TEST(Sheet, DoesNotDependOnTheOrderOfTheRowsAndOnThreads) {
  const std::vector<Vec3> points = rough_sphere(3000);
  std::vector<Vec3> shuffled = points;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(2));
  const Sheet one(points, 1), many(points, 5), other(shuffled);
  EXPECT_EQ(one.triangles, many.triangles);
  EXPECT_EQ(one.triangles, other.triangles);
  EXPECT_EQ(one.flat.positions, other.flat.positions);
}

TEST(Sheet, HasExactMapsOfAFlatCloud) {
  const std::vector<Vec3> points = flat_square(41).positions;
  const auto cloud = PointCloudSurface::build(points);
  const PolarMapSolver solver(cloud);
  for (const Index row : {41 * 20 + 20, 0, 3 * 41 + 7}) {
    const Frame frame = *cloud.graph().frame(cloud.vertex(Row(row)).index);
    EXPECT_LT(flat_error(cloud.to_rows(solver.log_map(Row(row))), points, points[row], frame.x, frame.y), 1e-9);
  }
  const ExactGeodesics geodesics(cloud, cloud.flat_approximation());
  const Vec3 between = 0.5 * points[700] + 0.2 * points[701] + 0.3 * points[741],
             normal = cloud.graph().frame(0)->normal;
  const SurfacePoint source = cloud.closest_point(between + 0.005 * normal).point;
  for (const Index towards : {0, 1600}) {
    const Vec3 x = normalized(points[towards] - between);
    EXPECT_LT(flat_error(cloud.to_rows(geodesics.log_map(source, x)), points, between, x, cross(normal, x)), 5e-10);
  }
}

TEST(Sheet, KeepsTheFramesOfTheGraphWhereTheSurfaceIsOneSided) {
  const auto cloud = PointCloudSurface::build(moebius_cloud(1500).points);
  const ExactGeodesics geodesics(cloud, cloud.flat_approximation());
  for (Index v = 0; v < cloud.graph().size(); v += 101) {
    const LogMap map = geodesics.log_map(Vertex(v), {.radius = 0.3});
    const Star star = cloud.graph().star(v);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Vertex w(star.neighbors[e]);
      if (map.status(w) != Status::ok) continue;
      const Vec2 log{star.log(e)[0], star.log(e)[1]}, found{map.coordinates(w)[0], map.coordinates(w)[1]};
      EXPECT_LT(length(1 / cloud.graph().length_unit() * found - log), 0.3 * length(log)) << v << " to " << w.index;
    }
  }
}

TEST(Sheet, HasPolarMapsOfASphereThatConverge) {
  std::vector<double> errors;
  for (const Index n : {1000, 4000, 16000}) {
    const Cloud sphere = random_sphere(n);
    const auto cloud = PointCloudSurface::build(sphere.points);
    const PolarMapSolver solver(cloud);
    errors.push_back(0);
    for (const Index source : {0, n / 3, n / 2})
      errors.back() += sphere_error(sphere, cloud, cloud.to_rows(solver.log_map(Row(source))), source).angle / 3;
  }
  EXPECT_LT(errors[0], 0.05);
  EXPECT_LT(errors[1], 0.7 * errors[0]);
  EXPECT_LT(errors[2], 0.7 * errors[1]);
}

}  // namespace
}  // namespace ahm::test
