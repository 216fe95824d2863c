// Second order: extrapolation keeps every law of the method (accuracy on curved surfaces: tests/trimesh, tests/grid).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/testing/curved_graphs.hpp"
#include "ahm/testing/flat_graphs.hpp"
#include "ahm/testing/graph_changes.hpp"
#include "ahm/testing/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm::test {
namespace {

const HeatOptions second_global{.order = 2, .strategy = Strategy::global},
    second_marching{.order = 2, .strategy = Strategy::march};

/// Largest difference of coordinates; the statuses must agree.
double difference(const LogMap& a, const LogMap& b) {
  double largest = 0;
  for (Index i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.status(Vertex(i)), b.status(Vertex(i))) << "vertex " << i;
    if (a.status(Vertex(i)) != Status::ok || b.status(Vertex(i)) != Status::ok) continue;
    for (int c = 0; c < a.dimension(); ++c)
      largest = std::max(largest, std::abs(a.coordinates(Vertex(i))[c] - b.coordinates(Vertex(i))[c]));
  }
  return largest;
}

// Two times (n^(1/d) < 100) and three, by either strategy.
TEST(SecondOrder, IsExactOnThePlaneAndKnowsIt) {
  for (Index side : {30, 120})
    for (const HeatOptions& options : {second_global, second_marching}) {
      const FlatGraph flat = planar_triangulation(side);
      const CsrGraph graph(flat.data);
      for (Variant variant : all_variants) {
        const LogMap map = LogMapSolver(graph, options).solve(Source::at_vertex(Vertex{77}), {.variant = variant});
        for (Index i = 0; i < flat.size(); ++i) {
          for (int a = 0; a < 2; ++a)
            ASSERT_NEAR(map.coordinates(Vertex(i))[a], flat.exact(77, i)[a], 1e-10 * flat.diameter()) << "vertex " << i;
          ASSERT_LT(map.error_estimate()[i], 1e-10 * flat.diameter());
        }
      }
    }
}

TEST(SecondOrder, IsExactInSpace) {
  const FlatGraph flat = lattice3(9);
  const CsrGraph graph(flat.data);
  const LogMap map = LogMapSolver(graph, second_global).solve(Source::at_vertex(Vertex{100}));
  for (Index i = 0; i < flat.size(); ++i)
    for (int a = 0; a < 3; ++a)
      ASSERT_NEAR(map.coordinates(Vertex(i))[a], flat.exact(100, i)[a], 1e-10 * flat.diameter());
}

TEST(SecondOrder, MarchesToTheSameMap) {
  for (const CsrGraphData& data : {sphere_graph(12000), as_blocks(sphere_graph(3000))}) {
    const CsrGraph graph(data);
    const LogMap expected = LogMapSolver(graph, second_global).solve(Source::at_vertex(Vertex{5}));
    const LogMap map = LogMapSolver(graph, second_marching).solve(Source::at_vertex(Vertex{5}));
    EXPECT_EQ(map.strategy(), Strategy::march);
    EXPECT_GT(map.march().bands, 0);
    EXPECT_LT(difference(expected, map), 1e-8);
  }
}

TEST(SecondOrder, ExtrapolatesTwoMapsOfTheFirst) {
  const CsrGraph graph(sphere_graph(2000));
  const LogMap one = LogMapSolver(graph, {.t_coef = 1}).solve(Source::at_vertex(Vertex{5}));
  const LogMap two = LogMapSolver(graph, {.t_coef = 2}).solve(Source::at_vertex(Vertex{5}));
  const LogMap map = LogMapSolver(graph, second_global).solve(Source::at_vertex(Vertex{5}));
  const double h = graph.mean_edge_length(), step = (std::sqrt(2.0) - 1) * h;
  Index smooth = 0, kept = 0;
  for (Index i = 0; i < map.size(); ++i) {
    const double change = std::hypot(two.coordinates(Vertex(i))[0] - one.coordinates(Vertex(i))[0],
                                     two.coordinates(Vertex(i))[1] - one.coordinates(Vertex(i))[1]) /
                          step;
    std::array<double, 2> limit;
    for (int a = 0; a < 2; ++a) {
      const double p = one.coordinates(Vertex(i))[a], q = two.coordinates(Vertex(i))[a];
      limit[a] = p + (p - q) / (std::sqrt(2.0) - 1);
    }
    for (int a = 0; a < 2; ++a) {
      if (change <= 3) {
        // Where that is longer than the distance it is shortened on the way to p.
        if (std::hypot(limit[0], limit[1]) <= map.distance(Vertex(i)))
          ASSERT_NEAR(map.coordinates(Vertex(i))[a], limit[a], 1e-12) << "vertex " << i;
        else
          ASSERT_LE(length(map.coordinates(Vertex(i))),
                    std::max(map.distance(Vertex(i)), length(one.coordinates(Vertex(i)))) * (1 + 1e-12));
        ++smooth;
      } else if (change >= 5) {
        ASSERT_NEAR(map.coordinates(Vertex(i))[a], one.coordinates(Vertex(i))[a], 1e-12)
            << "vertex " << i;  // near the antipode
        ++kept;
      }
    }
  }
  EXPECT_GT(smooth, map.size());
  EXPECT_GT(kept, 0);
}

TEST(SecondOrder, DoesNotDependOnUnitsOrOnTheBatch) {
  const CsrGraph graph(sphere_graph(3000)), large(scaled(sphere_graph(3000), 1024));
  const LogMapSolver solver(graph, second_global);
  const std::vector<Source> sources{Source::at_vertex(Vertex{5}), Source::at_vertex(Vertex{99}),
                                    Source::at_vertex(Vertex{1234})};
  const std::vector<LogMap> batch = solver.solve(sources);
  for (std::size_t s = 0; s < sources.size(); ++s) EXPECT_LT(difference(batch[s], solver.solve(sources[s])), 1e-11);
  const LogMap scaled_map = LogMapSolver(large, second_global).solve(sources[0]);
  for (Index i = 0; i < graph.size(); ++i)
    ASSERT_NEAR(scaled_map.distance(Vertex(i)), 1024 * batch[0].distance(Vertex(i)), 1e-9 * 1024);
}

TEST(SecondOrder, EndsAtTheRadius) {
  const FlatGraph flat = planar_triangulation(120);
  const CsrGraph graph(flat.data);
  for (const HeatOptions& options : {second_global, second_marching}) {
    const LogMap map = LogMapSolver(graph, options).solve(Source::at_vertex(Vertex{7300}), {.radius = 0.2});
    for (Index i = 0; i < flat.size(); ++i) {
      const double distance = std::hypot(flat.exact(7300, i)[0], flat.exact(7300, i)[1]);
      if (std::abs(distance - 0.2) < 1e-9) continue;
      ASSERT_EQ(map.status(Vertex(i)), distance < 0.2 ? Status::ok : Status::beyond_radius) << "vertex " << i;
      ASSERT_EQ(std::isnan(map.error_estimate()[i]), distance > 0.2);
    }
  }
}

TEST(SecondOrder, IsOneOfTwo) {
  const CsrGraph graph(sphere_graph(100));
  for (int order : {0, 3, -1}) EXPECT_THROW(LogMapSolver(graph, {.order = order}), InvalidArgument);
  EXPECT_TRUE(LogMapSolver(graph).solve(Source::at_vertex(Vertex{0})).error_estimate().empty());
}

/// Lengths of the shortest ways along edges.
std::vector<double> edge_paths(const TangentGraph& graph, Index source) {
  std::vector<double> lengths(static_cast<std::size_t>(graph.size()), INFINITY);
  lengths[source] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (Index i = 0; i < graph.size(); ++i) {
      const Star star = graph.star(i);
      for (std::size_t e = 0; e < star.degree(); ++e) {
        double& other = lengths[star.neighbors[e]];
        const double way = lengths[i] + std::hypot(star.log(e)[0], star.log(e)[1]);
        if (way < other) other = way, changed = true;
      }
    }
  }
  return lengths;
}

TEST(SecondOrder, LengthensNothingBeyondWhatIsPossible) {
  // Coarse and strongly bent, where extrapolation goes astray: without the bound up to a quarter of the vertices fail.
  const auto mesh = trimesh::TriangleMeshSurface::build(torus(400).positions, torus(400).faces);
  const CsrGraph cloud(sphere_graph(120));
  for (const TangentGraph* graph :
       {static_cast<const TangentGraph*>(&mesh.graph()), static_cast<const TangentGraph*>(&cloud)})
    for (Variant variant : all_variants)
      for (Index source : {0, 50, 100}) {
        const auto start = Source::at_vertex(Vertex{source});
        const LogMap one = LogMapSolver(*graph, {.variant = variant}).solve(start),
                     two = LogMapSolver(*graph, {.variant = variant, .order = 2}).solve(start);
        const std::vector<double> paths = edge_paths(*graph, source);
        const double rounding = 1 + 1e-12;
        for (Index i = 0; i < graph->size(); ++i) {
          const Vertex v(i);
          const double unit = graph->length_unit();
          const auto length = [&](const LogMap& map) {
            return std::hypot(map.coordinates(v)[0], map.coordinates(v)[1]);
          };
          ASSERT_LE(two.distance(v), std::max(one.distance(v), paths[i] * unit) * rounding);
          ASSERT_LE(length(two), std::max(length(one), two.distance(v)) * rounding);
        }
      }
}

// What is extrapolated of vectors is turned back in frames: the ways arrive as at the shortest time.
TEST(SecondOrder, KeepsTheWaysThatArrive) {
  for (const CsrGraphData& data : {sphere_graph(2500), as_blocks(sphere_graph(900))}) {
    const CsrGraph graph(data);
    const Source source = Source::at_vertex(Vertex{7});
    const LogMap first = LogMapSolver(graph).solve(source, {.frames = true});
    const LogMap second = LogMapSolver(graph, {.order = 2}).solve(source, {.frames = true});
    const auto arrives = [](const LogMap& map, Index i) {
      const auto U = map.frames().subspan(4 * static_cast<std::size_t>(i), 4);
      const auto phi = map.coordinates(Vertex(i));
      const double size = length(phi);
      return Vec2{(U[0] * phi[0] + U[1] * phi[1]) / size, (U[2] * phi[0] + U[3] * phi[1]) / size};
    };
    double turned = 0;
    for (Index i = 0; i < graph.size(); ++i) {
      if (i == 7) continue;
      const Vec2 a = arrives(first, i), b = arrives(second, i);
      ASSERT_NEAR(a[0], b[0], 1e-9) << i;
      ASSERT_NEAR(a[1], b[1], 1e-9) << i;
      turned = std::max(turned, std::abs(first.frames()[4 * static_cast<std::size_t>(i)] -
                                         second.frames()[4 * static_cast<std::size_t>(i)]));
    }
    EXPECT_GT(turned, 1e-4);
  }
}

}  // namespace
}  // namespace ahm::test
