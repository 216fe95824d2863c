// The manifold triangulation of a cloud, and exact and polar maps over it.
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/clouds.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/util/vec.hpp"
#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

using pointcloud::PointCloudSurface;

/// Corners of a triangle in ascending order.
using Corners = std::array<Index, 3>;

std::vector<Corners> triangles_of(const FlatTriangles& flat) {
  std::vector<Corners> result;
  for (Index f = 0; f < flat.surface.face_count(); ++f) {
    const auto r = flat.surface.record(3 * f);
    result.push_back({r.tail, r.head, r.apex});
    std::sort(result.back().begin(), result.back().end());
  }
  return result;
}

struct Counts {
  std::map<std::array<Index, 2>, int> edges;  ///< triangles of each edge
  std::set<Index> vertices;
  int faces = 0, most = 0, open = 0;  ///< most triangles of an edge, edges with one
  int euler() const { return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + faces; }
};

Counts count(const FlatTriangles& flat) {
  Counts result;
  for (const Corners& t : triangles_of(flat)) {
    ++result.faces;
    for (int c = 0; c < 3; ++c) {
      result.vertices.insert(t[c]);
      ++result.edges[{std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])}];
    }
  }
  for (const auto& [edge, triangles] : result.edges) {
    result.most = std::max(result.most, triangles);
    result.open += triangles == 1;
  }
  return result;
}

/// Whether the triangles at each vertex are joined along edges at the vertex.
bool have_one_fan(const std::vector<Corners>& triangles) {
  std::map<Index, std::map<Index, std::vector<Index>>> links;
  for (const Corners& t : triangles)
    for (int c = 0; c < 3; ++c) {
      links[t[c]][t[(c + 1) % 3]].push_back(t[(c + 2) % 3]);
      links[t[c]][t[(c + 2) % 3]].push_back(t[(c + 1) % 3]);
    }
  return std::all_of(links.begin(), links.end(), [](const auto& of_vertex) {
    const auto& link = of_vertex.second;
    std::set<Index> met{link.begin()->first};
    std::vector<Index> queue(met.begin(), met.end());
    while (!queue.empty()) {
      const Index at = queue.back();
      queue.pop_back();
      for (const Index next : link.at(at))
        if (met.insert(next).second) queue.push_back(next);
    }
    return met.size() == link.size();
  });
}

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

std::vector<Vec3> jittered_square(int side, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  std::vector<Vec3> points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const bool rim_i = i == 0 || i == side - 1, rim_j = j == 0 || j == side - 1;
      points.push_back({i + (rim_i ? 0 : jitter(random)), j + (rim_j ? 0 : jitter(random)), 0});
    }
  return points;
}

std::vector<Vec3> noisy_sphere(Index n) {
  Cloud sphere = random_sphere(n);
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 0.5 / std::sqrt(n));
  for (Vec3& p : sphere.points) p = (1 + normal(random)) * p;
  return sphere.points;
}

double area(const FlatTriangles& flat) {
  double sum = 0;
  for (Index f = 0; f < flat.surface.face_count(); ++f) {
    const auto r = flat.surface.record(3 * f);
    sum += 0.5 * r.length * r.apex_y * flat.length_unit * flat.length_unit;
  }
  return sum;
}

TEST(Sheet, HasAtMostTwoTrianglesAtAnEdgeAndOneFanAtAVertex) {
  for (const auto& points : {random_sphere(2000).points, noisy_sphere(2000), random_torus(2000, 1),
                             moebius_cloud(900).points, flat_cloud(1000).points, rolled_cloud(20, 0.3).points}) {
    const auto cloud = PointCloudSurface::build(points);
    const FlatTriangles flat = cloud.flat_approximation();
    EXPECT_LE(count(flat).most, 2);
    EXPECT_TRUE(have_one_fan(triangles_of(flat)));
  }
}

TEST(Sheet, OfCleanClosedCloudsHasTheirEulerCharacteristic) {
  for (const auto& sphere : {random_sphere(3000), even_sphere(3000)}) {
    const Counts counts = count(PointCloudSurface::build(sphere.points).flat_approximation());
    EXPECT_EQ(counts.euler(), 2);
    EXPECT_EQ(counts.open, 0);
    EXPECT_EQ(counts.vertices.size(), sphere.points.size());
  }
  for (const unsigned seed : {1u, 2u}) {
    const Counts counts = count(PointCloudSurface::build(random_torus(4000, seed)).flat_approximation());
    EXPECT_EQ(counts.euler(), 0);
    EXPECT_EQ(counts.open, 0);
  }
}

TEST(Sheet, OfAFlatCloudCoversItsConvexHull) {
  constexpr int side = 40;
  const FlatTriangles flat = PointCloudSurface::build(jittered_square(side)).flat_approximation();
  EXPECT_NEAR(area(flat), (side - 1.0) * (side - 1.0), 1e-9 * side * side);
  EXPECT_EQ(count(flat).euler(), 1);
  EXPECT_EQ(count(flat).open, 4 * (side - 1));
}

TEST(Sheet, DoesNotDependOnTheOrderOfTheRows) {
  const std::vector<Vec3> points = noisy_sphere(1500);
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(2));
  std::vector<Vec3> shuffled;
  for (const Index i : order) shuffled.push_back(points[i]);
  const auto a = PointCloudSurface::build(points), b = PointCloudSurface::build(shuffled);
  const FlatTriangles one = a.flat_approximation(), other = b.flat_approximation();
  EXPECT_EQ(one.positions, other.positions);
  EXPECT_EQ(triangles_of(one), triangles_of(other));
}

TEST(Sheet, DoesNotDependOnThreads) {
  const std::vector<Vec3> points = noisy_sphere(3000);
  const auto a = PointCloudSurface::build(points, {}, {.threads = 1}),
             b = PointCloudSurface::build(points, {}, {.threads = 5});
  EXPECT_EQ(triangles_of(a.flat_approximation()), triangles_of(b.flat_approximation()));
}

TEST(Sheet, GivesExactPolarMapsOfAFlatCloud) {
  constexpr int side = 40;
  const std::vector<Vec3> points = jittered_square(side);
  const auto cloud = PointCloudSurface::build(points);
  const PolarMapSolver solver(cloud);
  for (const Index source : {side * side / 2 + side / 2, 0, 3 * side + 7}) {
    const RowLogMap map = cloud.to_rows(solver.log_map(Row(source)));
    const Frame frame = *cloud.graph().frame(cloud.vertex(Row(source)).index);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(map.u[i], dot(points[i] - points[source], frame.x), 1e-9 * side);
      EXPECT_NEAR(map.v[i], dot(points[i] - points[source], frame.y), 1e-9 * side);
    }
  }
}

TEST(Sheet, GivesExactMapsFromPointsBetweenTheRows) {
  constexpr int side = 20;
  const std::vector<Vec3> points = jittered_square(side);
  const auto cloud = PointCloudSurface::build(points);
  const ExactGeodesics geodesics(cloud, cloud.flat_approximation());
  const Vec3 at{9.3, 8.2, 0};
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{-0.6, 0.8, 0}}) {
    const auto source = cloud.closest_point(at + Vec3{0, 0, 0.1});
    const RowLogMap map = cloud.to_rows(geodesics.log_map(source.point, axis));
    const Vec3 normal = cloud.graph().frame(0)->normal, across = cross(normal, axis);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(map.u[i], dot(points[i] - at, axis), 1e-8);
      EXPECT_NEAR(map.v[i], dot(points[i] - at, across), 1e-8);
    }
  }
}

TEST(Sheet, KeepsTheFramesOfTheGraphWhereTheSurfaceIsOneSided) {
  const auto cloud = PointCloudSurface::build(moebius_cloud(1500).points);
  const ExactGeodesics geodesics(cloud, cloud.flat_approximation());
  for (Index v = 0; v < cloud.graph().size(); v += 101) {
    const LogMap map = geodesics.log_map(Vertex(v), {.radius = 0.3});
    const Star star = cloud.graph().star(v);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Vec2 log{star.log(e)[0], star.log(e)[1]};
      const Vertex w(star.neighbors[e]);
      if (map.status(w) != Status::ok) continue;
      const double unit = cloud.graph().length_unit();
      const Vec2 found{map.coordinates(w)[0] / unit, map.coordinates(w)[1] / unit};
      EXPECT_LT(std::hypot(found[0] - log[0], found[1] - log[1]), 0.3 * std::hypot(log[0], log[1]))
          << v << " to " << w.index;
    }
  }
}

TEST(Sheet, GivesPolarMapsOfASphereThatConverge) {
  std::vector<double> errors;
  for (const Index n : {1000, 4000, 16000}) {
    const Cloud sphere = random_sphere(n);
    const auto cloud = PointCloudSurface::build(sphere.points);
    const PolarMapSolver solver(cloud);
    double sum = 0;
    for (const Index source : {0, n / 3, n / 2})
      sum += sphere_error(sphere, cloud, cloud.to_rows(solver.log_map(Row(source))), source).angle / 3;
    errors.push_back(sum);
    RecordProperty("angle_rms_" + std::to_string(n), std::to_string(sum));
  }
  EXPECT_LT(errors[0], 0.05);
  EXPECT_LT(errors[1], 0.7 * errors[0]);
  EXPECT_LT(errors[2], 0.7 * errors[1]);
}

}  // namespace
}  // namespace ahm::test
