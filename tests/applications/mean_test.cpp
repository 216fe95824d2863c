// Means and medians: exact where the surface is flat, for every backend, and accurate on the sphere.
#include "ahm/applications/mean.hpp"

#include <numeric>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "mapped_surfaces.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

struct WeightedPoints {
  std::vector<Vertex> vertices;
  std::vector<double> weights;
  double total() const { return std::accumulate(weights.begin(), weights.end(), 0.0); }
};

WeightedPoints random_points(Index n, std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> weight(0.1, 3.0);
  WeightedPoints points;
  for (std::size_t k = 0; k < count; ++k) {
    points.vertices.emplace_back(static_cast<Index>(random() % static_cast<std::uint64_t>(n)));
    points.weights.push_back(weight(random));
  }
  return points;
}

/// A kind of center: the Karcher mean or the geometric median.
struct Kind {
  bool is_median;
  Center operator()(const AnySolver& maps, std::span<const Vertex> points, std::span<const double> weights = {},
                    const CenterOptions& options = {}) const {
    return (is_median ? geometric_median : karcher_mean)(maps, points, weights, options);
  }
};
constexpr Kind kinds[] = {{false}, {true}};

TEST(Center, IsBalancedOnFlatGraphsOfAnyDimension) {
  for (const FlatGraph& flat :
       {planar_triangulation(14), planar_triangulation(14, TransportKind::block, true), lattice3(6), line_graph(40)}) {
    const CsrGraph graph(flat.data);
    const LogMapSolver solver(graph);
    for (const Kind& find : kinds)
      for (unsigned seed = 1; seed < (find.is_median ? 9 : 6); ++seed) {
        const WeightedPoints points = random_points(flat.size(), 1 + 3 * seed, seed);
        const Center center = find(solver, points.vertices, points.weights);
        EXPECT_TRUE(center.converged);
        // The mean: the sum of w_k z_k is zero. The median: that of unit vectors, unless the points at the center outweigh it.
        double at_center = 0, nearest = 1e300;
        std::vector<double> sum(center.offset.size(), 0.0);
        for (std::size_t k = 0; k < points.vertices.size(); ++k) {
          std::vector<double> z = flat.exact(center.vertex.index, points.vertices[k].index);
          for (std::size_t a = 0; a < z.size(); ++a) z[a] -= center.offset[a];
          const double r = length(z);
          r < 1e-12 ? at_center += points.weights[k] : nearest = std::min(nearest, r);
          if (find.is_median && r < 1e-12) continue;
          for (std::size_t a = 0; a < z.size(); ++a) sum[a] += points.weights[k] * z[a] / (find.is_median ? r : 1);
        }
        const double rounding = points.total() * 1e-11 * flat.diameter();
        if (!find.is_median) {
          EXPECT_LE(center.maps, 4);
          EXPECT_LT(length(sum), rounding);
        } else {  // the error of a direction is inversely proportional to the distance
          EXPECT_LT(length(sum), at_center + rounding / std::min(nearest, flat.diameter())) << "seed " << seed;
        }
      }
  }
}

TEST(GeometricMedian, IsThePointThatOutweighsTheRest) {
  const CsrGraph graph(sphere_graph(600));
  const std::array points{Vertex{10}, Vertex{200}, Vertex{333}, Vertex{451}};
  const Center median =
      geometric_median(LogMapSolver(graph), points, std::array{1.0, 1.0, 3.1, 1.0}, {.start = Vertex{10}});
  EXPECT_EQ(median.vertex, Vertex{333});
  EXPECT_NEAR(length(median.offset), 0, 1e-14);
}

/// Position of a center in the tangent plane of its vertex.
Vec3 in_space(const TangentGraph& graph, const Center& center) {
  const Frame frame = *graph.frame(center.vertex.index);
  return frame.origin + center.offset[0] * frame.x + center.offset[1] * frame.y;
}

void expect_exact_mean(const TangentGraph& flat, double size) {
  const LogMapSolver solver(flat);
  const WeightedPoints points = random_points(flat.size(), 9, 3);
  Vec3 expected{};
  for (std::size_t k = 0; k < points.vertices.size(); ++k)
    expected = expected + points.weights[k] / points.total() * flat.frame(points.vertices[k].index)->origin;
  const Center mean = karcher_mean(solver, points.vertices, points.weights);
  EXPECT_LT(distance(in_space(flat, mean), expected), 1e-11 * size);
  const LogMap map = solver.solve(source_at(mean));
  for (Index i = 0; i < flat.size(); ++i)
    EXPECT_NEAR(map.distance(Vertex(i)), distance(flat.frame(i)->origin, expected), 1e-11 * size);
}

TEST(KarcherMean, IsExactOnPlanesOfEveryBackend) {
  expect_exact_mean(grid::GridGraph({.shape = {21, 17}, .spacing = {0.1, 0.07}}), 3);
  const Mesh mesh = sliver_square(150);
  const auto surface = mesh_surface(mesh);
  expect_exact_mean(surface.graph(), 5);
  const auto cloud = pointcloud::PointCloudSurface::build(mesh.positions);
  expect_exact_mean(cloud.graph(), 5);
  const Polygons quads = quad_grid(8);
  const auto polygons = polymesh::PolygonMeshSurface::build(quads.positions, quads.begin, quads.corners,
                                                            {.discretization = polymesh::Discretization::polygons});
  expect_exact_mean(polygons.graph(), 1.5);
}

/// The center on the unit sphere by exact logarithms, iterated from x.
Vec3 sphere_center(const std::vector<Vec3>& points, Vec3 x, bool is_median) {
  for (int pass = 0; pass < 3000; ++pass) {
    Vec3 step{};
    double total = 0;
    for (const Vec3& p : points) {
      const Vec3 side = tangential(p, x);
      const double sine = norm(side), d = std::atan2(sine, dot(x, p)), w = is_median ? 1 / d : 1;
      step = step + w * d / sine * side;
      total += w;
    }
    x = unit(x + 1 / total * step);
  }
  return x;
}

TEST(Center, OnTheSphereIsThatOfTheExactLogarithmsFromAnyStart) {
  const Mesh mesh = icosphere(20);
  const SolvedMesh sphere(mesh);
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 4; ++trial) {
    SCOPED_TRACE(trial);
    // Points within pi / 4 of one of them: all of them are within its convex ball.
    const auto middle = mesh.positions[random() % mesh.positions.size()];
    std::vector<Vertex> points;
    std::vector<Vec3> positions;
    while (points.size() < 6) {
      const auto i = static_cast<Index>(random() % mesh.positions.size());
      if (dot(mesh.positions[i], middle) < std::sqrt(0.5)) continue;
      points.emplace_back(i);
      positions.push_back(mesh.positions[i]);
    }
    for (const Kind& find : kinds)
      for (Vertex start : {points[0], points[5]}) {
        const Center center = find(sphere.solver, points, {}, {.start = start});
        EXPECT_TRUE(center.converged);
        EXPECT_LT(distance(in_space(sphere.surface.graph(), center), sphere_center(positions, middle, find.is_median)),
                  edge_length(sphere.surface.graph()));
      }
  }
}

// On a torus coordinates behind the hole are too short, so the spread must be that of the distances.
TEST(Center, HasTheSpreadOfTheDistances) {
  const auto surface = mesh_surface(torus(2000));
  const ExactGeodesics geodesics(surface);
  const std::array points{Vertex{10}, Vertex{700}, Vertex{1100}, Vertex{1550}, Vertex{1900}};
  for (Variant variant : all_variants) {
    const LogMapSolver solver(surface.graph(), {.variant = variant});
    for (const Kind& find : kinds) {
      const Center center = find(solver, points);
      const LogMap exact = geodesics.log_map(center.vertex, {});
      double sum = 0;
      for (const Vertex p : points) sum += std::pow(exact.distance(p), find.is_median ? 1 : 2) / points.size();
      EXPECT_NEAR(center.spread, find.is_median ? sum : std::sqrt(sum), 0.01 * center.spread);
    }
  }
}

TEST(Center, TurnsWithTheFramesAndScalesWithTheSurfaceButNotWithTheWeights) {
  const CsrGraphData data = sphere_graph(500);
  const TurnedGraph turned = with_frames_turned(data);
  CsrGraphData in_units = data;
  in_units.length_unit = std::ldexp(1.0, 900);  // squares overflow in world units
  const CsrGraph graph(data), other(turned.data), large(scaled(data, std::ldexp(1.0, 40))), huge(in_units);
  const std::array points{Vertex{10}, Vertex{40}, Vertex{90}, Vertex{133}};
  const std::array weights{1.0, 2.0, 3.0, 4.0}, many{1e300, 2e300, 3e300, 4e300};
  for (const Kind& find : kinds) {
    const Center a = find(LogMapSolver(graph), points, weights), b = find(LogMapSolver(other), points, weights),
                 c = find(LogMapSolver(large), points, many), d = find(LogMapSolver(huge), points, weights);
    for (const Center& center : {b, c, d}) ASSERT_EQ(center.vertex, a.vertex);
    EXPECT_NEAR(a.spread, b.spread, 1e-11);
    EXPECT_NEAR(std::ldexp(c.spread, -40), a.spread, 1e-12);
    EXPECT_EQ(std::ldexp(d.spread, -900), a.spread);
    const double* Q = turned.turns.data() + 4 * a.vertex.index;
    for (int axis : {0, 1}) {
      EXPECT_NEAR(b.offset[axis], Q[2 * axis] * a.offset[0] + Q[2 * axis + 1] * a.offset[1], 1e-11);
      EXPECT_NEAR(std::ldexp(c.offset[axis], -40), a.offset[axis], 1e-12);
      EXPECT_EQ(std::ldexp(d.offset[axis], -900), a.offset[axis]);
    }
  }
}

TEST(Center, IsFoundInFewMapsFromEveryStart) {
  const CsrGraph graph(sphere_graph(300));
  const LogMapSolver solver(graph);
  for (Index start = 0; start < graph.size(); start += 7)
    for (const Kind& find : kinds) {
      const auto points = random_points(graph.size(), 5, static_cast<unsigned>(start)).vertices;
      const Center center = find(solver, points, {}, {.start = Vertex{start}});
      EXPECT_TRUE(center.converged) << "start " << start;
      EXPECT_LE(center.maps, 30) << "start " << start;
    }
}

TEST(Center, OfPointsBetweenVerticesIsExactOnThePlane) {
  const FlatGraph flat = planar_triangulation(10);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  const Index vertices[] = {3, 40, 77};
  const Vec2 offsets[] = {{0.01, 0.02}, {-0.03, 0.0}, {0.0, 0.015}};
  const std::array weights{1.0, 2.0, 5.0};
  std::vector<Source> points;
  for (std::size_t k = 0; k < 3; ++k) points.push_back(Source(2).add(Vertex(vertices[k]), 1.0, -offsets[k]));
  const Center mean = karcher_mean_of_points(solver, points, weights);
  Vec2 sum{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto z = flat.exact(mean.vertex.index, vertices[k]),
               b = flat.carried(vertices[k], mean.vertex.index, {offsets[k][0], offsets[k][1]});
    sum = sum + weights[k] / 8 * Vec2{z[0] + b[0], z[1] + b[1]};
  }
  const Center median = geometric_median_of_points(solver, points, std::array{1.0, 9.0, 1.0});
  EXPECT_EQ(median.vertex, Vertex{40});
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_NEAR(mean.offset[a], sum[a], 1e-10);
    EXPECT_NEAR(median.offset[a], offsets[1][a], 1e-10);
  }
}

TEST(Center, IgnoresWeightZeroAndRefusesInvalidArguments) {
  const FlatGraph flat = planar_triangulation(8);
  const CsrGraph two(doubled(flat.data));
  const LogMapSolver solver(two);
  const Center mean =
      karcher_mean(solver, std::array{Vertex{3}, Vertex{40}, Vertex{flat.size() + 5}}, std::array{1.0, 3.0, 0.0});
  const auto a = flat.exact(mean.vertex.index, 3), b = flat.exact(mean.vertex.index, 40);
  for (int axis : {0, 1}) EXPECT_NEAR(mean.offset[axis], (a[axis] + 3 * b[axis]) / 4, 1e-11);

  const std::array separate{Vertex{3}, Vertex{flat.size() + 3}}, pair{Vertex{3}, Vertex{60}};
  const std::array<double, 2> weights{1, 1}, negative{1, -1}, zeros{0, 0};
  for (const Kind& find : kinds) EXPECT_THROW(find(solver, separate), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, {}), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, std::array{Vertex(two.size())}), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, std::span(weights).first(1)), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, negative), InvalidArgument);
  EXPECT_THROW(karcher_mean(solver, pair, zeros), InvalidArgument);
  for (const CenterOptions& options :
       {CenterOptions{.start = Vertex{-1}}, {.start = Vertex{flat.size()}}, {.max_maps = 0}, {.radius = 0.01}})
    EXPECT_THROW(karcher_mean(solver, pair, weights, options), InvalidArgument);
}

TEST(CenterPosition, IsAtTheOffsetOnTheFaces) {
  const auto surface = mesh_surface(split_icosphere(640));
  const ExactGeodesics geodesics(surface);
  const auto& flat = geodesics.triangles();
  for (Index first : {0, 17, 300}) {
    const Center center = karcher_mean(geodesics, std::array{Vertex(first), Vertex(first + 41), Vertex(first + 160)});
    ASSERT_GT(length(center.offset), 1e-3);
    const ClosestPoint there = surface.closest_point(center_position(surface, center));
    EXPECT_LT(there.distance, 1e-13);
    exact::ExactOptions options;
    options.targets = {geodesics.point(there.point)};
    const exact::ExactMap map = exact::exact_map(flat.surface, flat.surface.vertex_point(center.vertex), options);
    for (std::size_t a : {0, 1}) EXPECT_NEAR(flat.length_unit * map.target_coordinates(0)[a], center.offset[a], 1e-12);
  }
}

TEST(CenterPosition, EndsAtTheBoundary) {
  const Mesh mesh = flat_square(5, 0);
  const auto surface = mesh_surface(mesh);
  const auto corner = std::ranges::min_element(mesh.positions);
  const Vertex vertex = surface.vertex(Row(static_cast<Index>(corner - mesh.positions.begin())));
  const Frame frame = surface.graph().frame(vertex.index).value();
  const struct {
    Vec3 offset, expected;  // from the corner
  } cases[] = {{{0.1, 0.05, 0}, {0.1, 0.05, 0}},
               {{0.1, -0.05, 0}, {0.1, 0, 0}},
               {{-0.05, 0.1, 0}, {0, 0.1, 0}},
               {{-0.1, -0.05, 0}, {0, 0, 0}},
               {{-1e-17, 1e-18, 0}, {0, 0, 0}}};
  for (const auto& [offset, expected] : cases) {
    const Center center{.vertex = vertex, .offset = {dot(offset, frame.x), dot(offset, frame.y)}};
    EXPECT_LT(distance(center_position(surface, center), *corner + expected), 1e-15);
  }
  EXPECT_THROW(center_position(surface, {.vertex = Vertex(99), .offset = {0, 0}}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
