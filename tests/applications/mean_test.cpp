// Means and medians: exact where the surface is flat, on every backend, and near the truth on the sphere.
#include "ahm/applications/mean.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/error.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/util/vec.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

struct Points {
  std::vector<Vertex> vertices;
  std::vector<double> weights;
  double total() const { return std::accumulate(weights.begin(), weights.end(), 0.0); }
};

Points random_points(Index n, std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> weight(0.1, 3.0);
  Points points;
  for (std::size_t k = 0; k < count; ++k) {
    points.vertices.emplace_back(static_cast<Index>(random() % static_cast<std::uint64_t>(n)));
    points.weights.push_back(weight(random));
  }
  return points;
}

/// sum w_k (z_k - offset) of a flat graph: zero at the mean. `power` -1: of unit vectors, zero at the median.
std::vector<double> imbalance(const FlatGraph& flat, const Points& points, const Center& center, int power) {
  std::vector<double> sum(center.offset.size(), 0.0);
  for (std::size_t k = 0; k < points.vertices.size(); ++k) {
    std::vector<double> z = flat.exact(center.vertex.index, points.vertices[k].index);
    double r = 0;
    for (std::size_t a = 0; a < z.size(); ++a) r = std::hypot(r, z[a] -= center.offset[a]);
    if (power < 0 && r < 1e-12) continue;
    for (std::size_t a = 0; a < z.size(); ++a) sum[a] += points.weights[k] * (power < 0 ? z[a] / r : z[a]);
  }
  return sum;
}

double norm(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum = std::hypot(sum, x);
  return sum;
}

std::vector<FlatGraph> flat_graphs() {
  return {planar_triangulation(14), planar_triangulation(14, TransportKind::block, true), lattice3(6), line_graph(40)};
}

TEST(KarcherMean, IsExactOnFlatGraphsOfAnyDimension) {
  for (const FlatGraph& flat : flat_graphs()) {
    const CsrGraph graph(flat.data);
    const LogMapSolver solver(graph);
    for (unsigned seed = 1; seed < 6; ++seed) {
      const Points points = random_points(flat.size(), 1 + 3 * seed, seed);
      const Center mean = karcher_mean(solver, points.vertices, points.weights);
      EXPECT_TRUE(mean.converged);
      EXPECT_LE(mean.maps, 4);
      EXPECT_LT(norm(imbalance(flat, points, mean, 1)), 1e-11 * points.total() * flat.diameter());
    }
  }
}

TEST(GeometricMedian, BalancesTheUnitVectorsOnFlatGraphsOfAnyDimension) {
  for (const FlatGraph& flat : flat_graphs()) {
    const CsrGraph graph(flat.data);
    const LogMapSolver solver(graph);
    for (unsigned seed = 1; seed < 9; ++seed) {
      const Points points = random_points(flat.size(), 1 + 3 * seed, seed);
      const Center median = geometric_median(solver, points.vertices, points.weights);
      EXPECT_TRUE(median.converged);
      // Either no point is there and all is balanced, or the points there hold it.
      double holding = 0, nearest = 1e300;
      for (std::size_t k = 0; k < points.vertices.size(); ++k) {
        std::vector<double> z = flat.exact(median.vertex.index, points.vertices[k].index);
        for (std::size_t a = 0; a < z.size(); ++a) z[a] -= median.offset[a];
        const double r = norm(z);
        r < 1e-12 ? holding += points.weights[k] : nearest = std::min(nearest, r);
      }
      // The log maps are exact to 1e-11 of the diameter; directions suffer from that by the nearest point.
      const double rounding = points.total() * 1e-11 * flat.diameter() / std::min(nearest, flat.diameter());
      EXPECT_LT(norm(imbalance(flat, points, median, -1)), holding + rounding) << "seed " << seed;
    }
  }
}

TEST(GeometricMedian, OfAQuadrilateralIsWhereItsDiagonalsCross) {
  const FlatGraph flat = planar_triangulation(15);
  const CsrGraph graph(flat.data);
  const std::array corners{Vertex{17}, Vertex{27}, Vertex{15 * 12 + 11}, Vertex{15 * 9 + 2}};  // in order round it
  const Center median = geometric_median(LogMapSolver(graph), corners);
  for (int pair : {0, 1}) {
    const auto a = flat.exact(median.vertex.index, corners[pair].index),
               b = flat.exact(median.vertex.index, corners[pair + 2].index);
    const double off = (b[0] - a[0]) * (median.offset[1] - a[1]) - (b[1] - a[1]) * (median.offset[0] - a[0]);
    EXPECT_NEAR(off, 0, 1e-11);
  }
}

TEST(GeometricMedian, IsThePointThatOutweighsTheRest) {
  const CsrGraph graph(sphere_graph(600));
  const LogMapSolver solver(graph);
  const std::array points{Vertex{10}, Vertex{200}, Vertex{333}, Vertex{451}};
  const Center median = geometric_median(solver, points, std::array{1.0, 1.0, 3.1, 1.0}, {.start = Vertex{10}});
  EXPECT_EQ(median.vertex, Vertex{333});
  EXPECT_NEAR(std::hypot(median.offset[0], median.offset[1]), 0, 1e-14);
}

TEST(GeometricMedian, OfPointsOnALineIsTheirMedian) {
  const FlatGraph flat = line_graph(60);
  const CsrGraph graph(flat.data);
  const Center median =
      geometric_median(LogMapSolver(graph), std::array{Vertex{3}, Vertex{7}, Vertex{20}, Vertex{50}, Vertex{58}});
  EXPECT_EQ(median.vertex, Vertex{20});
  EXPECT_NEAR(median.offset[0], 0, 1e-11);
  EXPECT_NEAR(median.spread, (17 + 13 + 0 + 30 + 38) / 5.0, 1e-10);
}

/// A center as a point of space.
Vec3 in_space(const TangentGraph& graph, const Center& center) {
  const Frame frame = *graph.frame(center.vertex.index);
  Vec3 p;
  for (int a = 0; a < 3; ++a) p[a] = frame.origin[a] + center.offset[0] * frame.x[a] + center.offset[1] * frame.y[a];
  return p;
}

void expect_exact_mean(const TangentGraph& flat, double size) {
  const LogMapSolver solver(flat);
  const Points points = random_points(flat.size(), 9, 3);
  Vec3 expected{};
  for (std::size_t k = 0; k < points.vertices.size(); ++k)
    for (int a = 0; a < 3; ++a)
      expected[a] += points.weights[k] / points.total() * flat.frame(points.vertices[k].index)->origin[a];
  const Center mean = karcher_mean(solver, points.vertices, points.weights);
  EXPECT_LT(distance(in_space(flat, mean), expected), 1e-11 * size);
  // The surface seen from the mean.
  const LogMap map = solver.solve(source_at(mean));
  for (Index i = 0; i < flat.size(); ++i)
    EXPECT_NEAR(map.distance(Vertex(i)), distance(flat.frame(i)->origin, expected), 1e-11 * size);
}

TEST(KarcherMean, IsExactOnFlatGeometryOfEveryBackend) {
  expect_exact_mean(grid::GridGraph({.shape = {21, 17}, .spacing = {0.1, 0.07}}), 3);
  const Mesh mesh = sliver_square(150);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  expect_exact_mean(surface.graph(), 5);
  const auto cloud = pointcloud::PointCloudSurface::build(mesh.positions);
  expect_exact_mean(cloud.graph(), 5);
  std::vector<Offset> begin{0};  // rows of quads
  std::vector<Index> corners;
  std::vector<Vec3> positions;
  for (Index i = 0; i < 9 * 9; ++i) {
    const double x = i % 9 + 0.2 * std::sin(i), y = i / 9 + 0.2 * std::cos(7 * i);
    positions.push_back({x, 0.6 * y, 0.8 * y});
    if (i % 9 == 8 || i / 9 == 8) continue;
    for (Index corner : {i, i + 1, i + 10, i + 9}) corners.push_back(corner);
    begin.push_back(static_cast<Offset>(corners.size()));
  }
  const auto polygons = polymesh::PolygonMeshSurface::build(positions, begin, corners,
                                                            {.discretization = polymesh::Discretization::polygons});
  expect_exact_mean(polygons.graph(), 12);
}

/// The center on the unit sphere by exact logarithms, from `x` on.
Vec3 sphere_center(const std::vector<Vec3>& points, Vec3 x, bool median) {
  for (int pass = 0; pass < 3000; ++pass) {
    Vec3 step{};
    double total = 0;
    for (const Vec3& p : points) {
      const double cosine = dot(x, p);
      Vec3 side;
      for (int a = 0; a < 3; ++a) side[a] = p[a] - cosine * x[a];
      const double sine = std::sqrt(dot(side, side)), d = std::atan2(sine, cosine), w = median ? 1 / d : 1;
      for (int a = 0; a < 3; ++a) step[a] += w * d / sine * side[a];
      total += w;
    }
    for (int a = 0; a < 3; ++a) x[a] += step[a] / total;
    const double r = std::sqrt(dot(x, x));
    for (double& c : x) c /= r;
  }
  return x;
}

using FindCenter = std::function<Center(const LogMapSolver&, std::span<const Vertex>, const CenterOptions&)>;
const FindCenter find_mean = [](const LogMapSolver& solver, std::span<const Vertex> points, const CenterOptions& o) {
  return karcher_mean(solver, points, {}, o);
};
const FindCenter find_median = [](const LogMapSolver& solver, std::span<const Vertex> points, const CenterOptions& o) {
  return geometric_median(solver, points, {}, o);
};

TEST(Center, OfThreeCornersOfAnIcosahedronIsTheMiddleOfTheirFace) {
  const Index parts = 20;
  const Mesh mesh = icosphere(parts);
  const SolvedMesh sphere(mesh);
  // The vertices made first for face (0, 11, 5): its three corners are the first, the last of the first row, the last.
  std::vector<Index> corners;
  for (Index i = 0; i < mesh.vertices() && corners.size() < 3; ++i) {
    const Vec3 p = mesh.positions[i];
    const double g = (1 + std::sqrt(5.0)) / 2, unit = std::hypot(1.0, g);
    for (const Vec3& c : {Vec3{-1, g, 0}, Vec3{-g, 0, 1}, Vec3{0, 1, g}})
      if (distance(p, {c[0] / unit, c[1] / unit, c[2] / unit}) < 1e-9) corners.push_back(i);
  }
  ASSERT_EQ(corners.size(), 3);
  Vec3 middle{};
  for (Index i : corners)
    for (int a = 0; a < 3; ++a) middle[a] += mesh.positions[i][a];
  const double r = std::sqrt(dot(middle, middle));
  for (double& c : middle) c /= r;
  const auto& graph = sphere.surface.graph();
  const double h = graph.mean_edge_length() * graph.length_unit();
  for (const FindCenter& find : {find_mean, find_median}) {
    const Center center = find(sphere.solver, std::vector<Vertex>(corners.begin(), corners.end()), {});
    EXPECT_TRUE(center.converged);
    EXPECT_LT(distance(in_space(graph, center), middle), h);
  }
}

TEST(Center, IsThatOfTheExactLogarithmsOnTheSphereFromAnyStart) {
  const Mesh mesh = icosphere(20);
  const SolvedMesh sphere(mesh);
  const auto& graph = sphere.surface.graph();
  const double h = graph.mean_edge_length() * graph.length_unit();
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 4; ++trial) {
    // Points within a quarter of pi of one of them: all of them within the convex ball of that one.
    const auto middle = mesh.positions[random() % mesh.positions.size()];
    std::vector<Vertex> points;
    std::vector<Vec3> positions;
    while (points.size() < 6) {
      const auto i = static_cast<Index>(random() % mesh.positions.size());
      if (dot(mesh.positions[i], middle) < std::sqrt(0.5)) continue;
      points.emplace_back(i);
      positions.push_back(mesh.positions[i]);
    }
    for (const bool median : {false, true}) {
      const Vec3 exact = sphere_center(positions, middle, median);
      for (Vertex start : {points[0], points[5]}) {
        const Center center = (median ? find_median : find_mean)(sphere.solver, points, {.start = start});
        EXPECT_TRUE(center.converged);
        EXPECT_LT(distance(in_space(graph, center), exact), h) << (median ? "median " : "mean ") << trial;
      }
    }
  }
}

// Of the distances, as long as the coordinates are not: behind the hole of a torus these are too short.
TEST(Center, HasTheSpreadOfTheDistances) {
  const Mesh mesh = torus(2000);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const ExactGeodesics geodesics(surface);
  const std::array points{Vertex{10}, Vertex{700}, Vertex{1100}, Vertex{1550}, Vertex{1900}};
  for (Variant variant : all_variants) {
    const LogMapSolver solver(surface.graph(), {.variant = variant});
    for (const bool median : {false, true}) {
      const Center center = median ? geometric_median(solver, points) : karcher_mean(solver, points);
      const LogMap exact = geodesics.log_map(center.vertex, {});
      double sum = 0;
      for (const Vertex p : points) sum += std::pow(exact.distance(p), median ? 1 : 2) / points.size();
      EXPECT_NEAR(center.spread, median ? sum : std::sqrt(sum), 0.01 * center.spread);
    }
  }
}

TEST(Center, TurnsWithTheFrames) {
  const CsrGraphData data = sphere_graph(500);
  const TurnedGraph turned = with_frames_turned(data);
  const CsrGraph graph(data), other(turned.data);
  const LogMapSolver solver(graph), other_solver(other);
  const std::array points{Vertex{10}, Vertex{40}, Vertex{90}, Vertex{133}};
  for (const FindCenter& find : {find_mean, find_median}) {
    const Center a = find(solver, points, {}), b = find(other_solver, points, {});
    ASSERT_EQ(a.vertex, b.vertex);
    EXPECT_NEAR(a.spread, b.spread, 1e-11);
    const double* Q = turned.turns.data() + 4 * a.vertex.index;
    EXPECT_NEAR(b.offset[0], Q[0] * a.offset[0] + Q[1] * a.offset[1], 1e-11);
    EXPECT_NEAR(b.offset[1], Q[2] * a.offset[0] + Q[3] * a.offset[1], 1e-11);
  }
}

TEST(Center, ScalesWithTheSurfaceAndNotWithTheWeights) {
  const CsrGraphData data = sphere_graph(500);
  const CsrGraph graph(data), large(scaled(data, std::ldexp(1.0, 40)));
  CsrGraphData unit = data;
  unit.length_unit = std::ldexp(1.0, 900);  // squares overflow outside
  const CsrGraph huge(unit);
  const std::array points{Vertex{10}, Vertex{40}, Vertex{90}, Vertex{133}};
  const std::array weights{1.0, 2.0, 3.0, 4.0}, many{1e300, 2e300, 3e300, 4e300};
  for (auto find : {karcher_mean, geometric_median}) {
    const Center a = find(LogMapSolver(graph), points, weights, {});
    const Center b = find(LogMapSolver(large), points, many, {});
    const Center c = find(LogMapSolver(huge), points, weights, {});
    ASSERT_EQ(a.vertex, b.vertex);
    ASSERT_EQ(a.vertex, c.vertex);
    EXPECT_NEAR(std::ldexp(b.spread, -40), a.spread, 1e-12);
    EXPECT_EQ(std::ldexp(c.spread, -900), a.spread);
    for (int axis : {0, 1}) {
      EXPECT_NEAR(std::ldexp(b.offset[axis], -40), a.offset[axis], 1e-12);
      EXPECT_EQ(std::ldexp(c.offset[axis], -900), a.offset[axis]);
    }
  }
}

TEST(Center, IsFoundInFewMapsFromEveryStart) {
  const CsrGraph graph(sphere_graph(300));
  const LogMapSolver solver(graph);
  for (Index start = 0; start < graph.size(); start += 7) {
    const Points points = random_points(graph.size(), 5, static_cast<unsigned>(start));
    for (const FindCenter& find : {find_mean, find_median}) {
      const Center center = find(solver, points.vertices, {.start = Vertex{start}});
      EXPECT_TRUE(center.converged) << "start " << start;
      EXPECT_LE(center.maps, 30) << "start " << start;
    }
  }
}

TEST(Center, OfPointsBesideVerticesIsExactOnThePlane) {
  const FlatGraph flat = planar_triangulation(10);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  const std::array vertices{Vertex{3}, Vertex{40}, Vertex{77}};
  const std::array<std::array<double, 2>, 3> beside{{{0.01, 0.02}, {-0.03, 0.0}, {0.0, 0.015}}};
  const std::array weights{1.0, 2.0, 5.0};
  std::vector<Source> points;
  for (std::size_t k = 0; k < 3; ++k)
    points.push_back(Source(2).add(vertices[k], 1.0, std::array{-beside[k][0], -beside[k][1]}));
  const Center mean = karcher_mean_of_points(solver, points, weights);
  std::array<double, 2> sum{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto z = flat.exact(mean.vertex.index, vertices[k].index);
    const auto b = flat.carried(vertices[k].index, mean.vertex.index, {beside[k][0], beside[k][1]});
    for (std::size_t a = 0; a < 2; ++a) sum[a] += weights[k] * (z[a] + b[a]) / 8;
  }
  for (std::size_t a = 0; a < 2; ++a) EXPECT_NEAR(mean.offset[a], sum[a], 1e-10);
  const Center median = geometric_median_of_points(solver, points, std::array{1.0, 9.0, 1.0});
  EXPECT_EQ(median.vertex, Vertex{40});
  for (std::size_t a = 0; a < 2; ++a) EXPECT_NEAR(median.offset[a], beside[1][a], 1e-10);
}

TEST(Center, IgnoresPointsOfWeightZero) {
  const FlatGraph flat = planar_triangulation(8);
  const CsrGraph two(doubled(flat.data));
  const LogMapSolver solver(two);
  const std::array points{Vertex{3}, Vertex{40}, Vertex{flat.size() + 5}};
  const Center mean = karcher_mean(solver, points, std::array{1.0, 3.0, 0.0});
  const auto a = flat.exact(mean.vertex.index, 3), b = flat.exact(mean.vertex.index, 40);
  for (int axis : {0, 1}) EXPECT_NEAR(mean.offset[axis], (a[axis] + 3 * b[axis]) / 4, 1e-11);
}

TEST(Center, RefusesWhatHasNone) {
  const FlatGraph flat = planar_triangulation(8);
  const CsrGraph two(doubled(flat.data));
  const LogMapSolver solver(two);
  const std::array separate{Vertex{3}, Vertex{flat.size() + 3}}, pair{Vertex{3}, Vertex{60}};
  const std::array<double, 2> weights{1, 1}, negative{1, -1}, zero{0, 0};
  EXPECT_THROW(karcher_mean(solver, separate), InvalidArgument);
  EXPECT_THROW(geometric_median(solver, separate), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, {}), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, std::array{Vertex(two.size())}), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, std::span(weights).first(1)), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, negative), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, zero), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, weights, {.start = Vertex{-1}}), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, weights, {.start = Vertex{flat.size()}}), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, weights, {.max_maps = 0}), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, weights, {.radius = 0.01}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
