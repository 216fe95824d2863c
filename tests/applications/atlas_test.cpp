#include "ahm/applications/atlas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "ahm/applications/cells.hpp"
#include "ahm/applications/inverse_map.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/error.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/util/small_math.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

/// A mesh, its solver, and its faces as the atlas wants them.
struct MeshAndFaces {
  explicit MeshAndFaces(const Mesh& mesh) : positions(mesh.positions), solved(mesh) {
    for (const Triangle& t : mesh.faces) {
      begin.push_back(static_cast<Offset>(vertices.size()));
      vertices.insert(vertices.end(), t.begin(), t.end());
    }
    begin.push_back(static_cast<Offset>(vertices.size()));
  }
  FaceList faces() const { return {begin, vertices}; }
  const LogMapSolver& solver() const { return solved.solver; }

  std::vector<Vec3> positions;
  SolvedMesh solved;
  std::vector<Offset> begin;
  std::vector<Index> vertices;
};

/// A tube of unit radius, open at both ends.
Mesh tube_mesh(Index rings, Index around) {
  Mesh mesh;
  const double step = 2 * std::numbers::pi / around;
  for (Index r = 0; r < rings; ++r)
    for (Index a = 0; a < around; ++a)
      mesh.positions.push_back({step * r, std::cos(step * (a + 0.5 * r)), std::sin(step * (a + 0.5 * r))});
  for (Index r = 0; r + 1 < rings; ++r)
    for (Index a = 0; a < around; ++a) {
      const Index i = r * around + a, j = r * around + (a + 1) % around;
      mesh.faces.push_back({i, i + around, j});
      mesh.faces.push_back({j, i + around, j + around});
    }
  return mesh;
}

/// Every face in exactly one chart, as `chart_of_face` says; charts are connected through sides.
void expect_partition(const Atlas& atlas, const FaceList& faces) {
  std::vector<int> taken(faces.size(), 0);
  for (std::size_t k = 0; k < atlas.charts.size(); ++k) {
    const Chart& chart = atlas.charts[k];
    ASSERT_FALSE(chart.faces.empty());
    ASSERT_TRUE(std::is_sorted(chart.faces.begin(), chart.faces.end()));
    std::map<std::pair<Index, Index>, std::vector<Index>> sides;
    for (Index f : chart.faces) {
      ++taken[f];
      EXPECT_EQ(atlas.chart_of_face[f], static_cast<Index>(k));
      const auto face = faces[f];
      for (std::size_t c = 0; c < face.size(); ++c)
        sides[std::minmax(face[c], face[(c + 1) % face.size()])].push_back(f);
    }
    std::map<Index, std::vector<Index>> neighbors;
    for (const auto& [side, of] : sides)
      for (Index f : of) neighbors[f].insert(neighbors[f].end(), of.begin(), of.end());
    std::set<Index> reached{chart.faces.front()};
    std::vector<Index> stack{chart.faces.front()};
    while (!stack.empty()) {
      const Index f = stack.back();
      stack.pop_back();
      for (Index g : neighbors[f])
        if (reached.insert(g).second) stack.push_back(g);
    }
    EXPECT_EQ(reached.size(), chart.faces.size()) << "chart " << k << " falls apart";
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    EXPECT_EQ(taken[f], atlas.chart_of_face[f] >= 0);
    for (Offset c = faces.begin[f]; c < faces.begin[f + 1]; ++c)
      EXPECT_EQ(std::isfinite(atlas.corner(c)[0]), atlas.chart_of_face[f] >= 0);
  }
}

TEST(Atlas, OfAPlaneIsIsometricWhateverTheTriangles) {
  const MeshAndFaces surface(sliver_square(500));
  for (Index count : {1, 7}) {
    const Atlas atlas =
        make_atlas(surface.solver(), farthest_points(surface.solver().graph(), Vertex{3}, count), surface.faces());
    expect_partition(atlas, surface.faces());
    EXPECT_EQ(std::count(atlas.chart_of_face.begin(), atlas.chart_of_face.end(), -1), 0);
    const AtlasDistortion d = distortion(atlas, surface.faces(), surface.positions);
    EXPECT_NEAR(d.all.percentile_95, 1, 1e-9);
    EXPECT_EQ(d.all.flipped_area, 0);
  }
}

TEST(Atlas, CoordinatesAreTheLogMapsOfTheirSources) {
  const MeshAndFaces surface(icosphere(12));
  const auto sources = farthest_points(surface.solver().graph(), Vertex{0}, 9);
  const Atlas atlas = make_atlas(surface.solver(), sources, surface.faces());
  expect_partition(atlas, surface.faces());
  EXPECT_EQ(atlas.sources, sources);
  for (const Chart& chart : atlas.charts) {
    const LogMap map = surface.solver().solve(Source::at_vertex(Vertex(sources[chart.source])));
    for (Index f : chart.faces)
      for (Offset c = surface.begin[f]; c < surface.begin[to_size(f) + 1]; ++c)
        for (std::size_t a : {0, 1})
          EXPECT_NEAR(atlas.corner(c)[a], map.coordinates(Vertex(surface.vertices[c]))[a], 1e-9);
  }
}

TEST(Atlas, GivesFacesToTheSourceNearestToTheirMiddle) {
  const MeshAndFaces surface(icosphere(16));
  const auto sources = farthest_points(surface.solver().graph(), Vertex{5}, 12);
  const Atlas atlas = make_atlas(surface.solver(), sources, surface.faces());
  std::vector<LogMap> maps;
  for (Vertex s : sources) maps.push_back(surface.solver().solve(Source::at_vertex(s)));
  const auto sum = [&](std::size_t source, std::size_t f) {
    double total = 0;
    for (Index v : surface.faces()[f]) total += maps[source].distance(Vertex(v));
    return total;
  };
  const double h = surface.solver().graph().mean_edge_length() * surface.solver().graph().length_unit();
  std::size_t differ = 0;
  for (std::size_t f = 0; f < surface.faces().size(); ++f) {
    std::size_t best = 0;
    for (std::size_t s = 1; s < sources.size(); ++s)
      if (sum(s, f) < sum(best, f)) best = s;
    const auto own = to_size(atlas.charts[atlas.chart_of_face[f]].source);
    differ += own != best;
    EXPECT_LT(sum(own, f) / 3, sum(best, f) / 3 + h);  // heat decides which sources are asked at all
  }
  EXPECT_LT(differ, surface.faces().size() / 50);
}

TEST(Atlas, OfASphereIsAsGoodAsItsCellsAreSmall) {
  const MeshAndFaces surface(icosphere(20));
  double before = std::numeric_limits<double>::infinity();
  for (Index count : {4, 12, 40}) {
    const auto sources = farthest_points(surface.solver().graph(), Vertex{0}, count);
    const Atlas atlas = make_atlas(surface.solver(), sources, surface.faces());
    double radius = 0;
    for (std::size_t c = 0; c < surface.vertices.size(); ++c)
      radius = std::max(radius,
                        std::hypot(atlas.corner(static_cast<Offset>(c))[0], atlas.corner(static_cast<Offset>(c))[1]));
    const AtlasDistortion d = distortion(atlas, surface.faces(), surface.positions);
    EXPECT_EQ(d.all.flipped, 0);
    EXPECT_LT(d.all.percentile_95, 1.05 * radius / std::sin(radius));  // that of the exact map at the rim
    EXPECT_LT(d.all.mean, before);
    before = d.all.mean;
  }
}

TEST(Atlas, ChartsAreCounterClockwiseAlsoWhereFramesAreMirrored) {
  const FlatGraph flat = planar_triangulation(20, TransportKind::block, true);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  const LogMap map = solver.solve(Source::at_vertex(Vertex{0}), {.frames = true});
  std::vector<Offset> begin{0};
  std::vector<Index> vertices;
  for (const Triangle& t : star_triangles(graph, map)) {
    vertices.insert(vertices.end(), t.begin(), t.end());
    begin.push_back(begin.back() + 3);
  }
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < to_size(graph.size()); ++i)
    positions.push_back({flat.positions[2 * i], flat.positions[2 * i + 1], 0});
  const auto sources = farthest_points(solver.graph(), Vertex{0}, 10);
  const Atlas atlas = make_atlas(solver, sources, {begin, vertices});
  expect_partition(atlas, {begin, vertices});
  const AtlasDistortion d = distortion(atlas, {begin, vertices}, positions);
  EXPECT_EQ(d.all.flipped, 0);
  EXPECT_NEAR(d.all.largest, 1, 1e-9);
}

TEST(Atlas, OfPolygonsKeepsThemWhole) {
  std::vector<Vec3> positions;
  std::vector<Offset> begin{0};
  std::vector<Index> vertices;
  const Index side = 15;
  for (Index y = 0; y <= side; ++y)
    for (Index x = 0; x <= side; ++x) positions.push_back({0.6 * x, 1.0 * y, 0.8 * x});
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < side; ++x) {
      const Index i = y * (side + 1) + x;
      vertices.insert(vertices.end(), {i, i + 1, i + side + 2, i + side + 1});
      begin.push_back(begin.back() + 4);
    }
  const auto mesh = polymesh::PolygonMeshSurface::build(positions, begin, vertices,
                                                        {.discretization = polymesh::Discretization::polygons});
  const LogMapSolver solver(mesh.graph());
  const Atlas atlas = make_atlas(solver, farthest_points(solver.graph(), Vertex{0}, 6), {begin, vertices});
  expect_partition(atlas, {begin, vertices});
  const AtlasDistortion d = distortion(atlas, {begin, vertices}, positions);
  EXPECT_NEAR(d.all.largest, 1, 1e-9);
  EXPECT_EQ(d.all.measured, 2 * side * side);
}

TEST(Atlas, LeavesOutComponentsWithoutASource) {
  Mesh two = icosphere(4);
  const Index n = two.vertices();
  const auto faces = two.faces;
  for (Index i = 0; i < n; ++i) {
    const Vec3 p = two.positions[i];
    two.positions.push_back({p[0] + 3, p[1], p[2]});
  }
  for (const Triangle& t : faces) two.faces.push_back({t[0] + n, t[1] + n, t[2] + n});
  const MeshAndFaces surface(two);
  const Atlas atlas = make_atlas(surface.solver(), std::array{Vertex{0}, Vertex{7}}, surface.faces());
  expect_partition(atlas, surface.faces());
  for (std::size_t f = 0; f < two.faces.size(); ++f) EXPECT_EQ(atlas.chart_of_face[f] >= 0, f < faces.size());
  EXPECT_EQ(distortion(atlas, surface.faces(), surface.positions).all.unmeasured, static_cast<Offset>(faces.size()));
  // Refinement gives them sources.
  const Atlas whole = make_atlas(surface.solver(), std::array{Vertex{0}, Vertex{7}}, surface.faces(), surface.positions,
                                 RefineOptions{});
  expect_partition(whole, surface.faces());
  EXPECT_EQ(std::count(whole.chart_of_face.begin(), whole.chart_of_face.end(), -1), 0);
}

TEST(AtlasRefinement, OpensATubeAndKeepsTheSourcesGiven) {
  const MeshAndFaces surface(tube_mesh(60, 24));
  const std::array source{Vertex{24 * 30}};
  const Atlas closed = make_atlas(surface.solver(), source, surface.faces());
  const AtlasDistortion bad = distortion(closed, surface.faces(), surface.positions);
  EXPECT_GT(bad.all.flipped, 0);  // behind the source the map closes around the tube
  const Atlas open =
      make_atlas(surface.solver(), source, surface.faces(), surface.positions, RefineOptions{.max_distortion = 1.5});
  expect_partition(open, surface.faces());
  EXPECT_EQ(open.sources.front(), source[0]);
  EXPECT_LT(open.sources.size(), 40U);
  for (const DistortionSummary& chart : distortion(open, surface.faces(), surface.positions).charts) {
    EXPECT_LE(chart.flipped_area, 0.01);
    EXPECT_LE(chart.percentile_95, 1.5);
  }
  // The maps kept on the way are those of a fresh start.
  const Atlas fresh = make_atlas(surface.solver(), open.sources, surface.faces());
  EXPECT_EQ(fresh.chart_of_face, open.chart_of_face);
  for (std::size_t k = 0; k < open.coordinates.size(); ++k)
    EXPECT_NEAR(fresh.coordinates[k], open.coordinates[k], 1e-9);
}

TEST(AtlasRefinement, AddsNothingToAGoodAtlasAndNoMoreThanAllowed) {
  const MeshAndFaces plane(sliver_square(300)), tube(tube_mesh(60, 24));
  EXPECT_EQ(
      make_atlas(plane.solver(), std::array{Vertex{4}}, plane.faces(), plane.positions, RefineOptions{}).sources.size(),
      1U);
  EXPECT_EQ(
      make_atlas(tube.solver(), std::array{Vertex{4}}, tube.faces(), tube.positions, RefineOptions{.max_sources = 3})
          .sources.size(),
      3U);
}

TEST(ChartBoxes, AreRefusedForOtherFaces) {
  const MeshAndFaces surface(icosphere(4)), other(icosphere(3));
  const Atlas atlas = make_atlas(surface.solver(), std::array{Vertex{0}}, surface.faces());
  EXPECT_THROW(chart_boxes(atlas, other.faces()), InvalidArgument);
}

TEST(ChartBoxes, AreTheLeastOfAllTurns) {
  const MeshAndFaces surface(icosphere(10));
  const Atlas atlas =
      make_atlas(surface.solver(), farthest_points(surface.solver().graph(), Vertex{0}, 8), surface.faces());
  const auto boxes = chart_boxes(atlas, surface.faces());
  ASSERT_EQ(boxes.size(), atlas.charts.size());
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const ChartBox& box = boxes[k];
    const double width = box.high[0] - box.low[0], height = box.high[1] - box.low[1];
    EXPECT_NEAR(std::hypot(box.turn[0], box.turn[1]), 1, 1e-12);
    EXPECT_GE(width, height);
    for (int degree = 0; degree < 180; ++degree) {
      const double c = std::cos(degree * std::numbers::pi / 180), s = std::sin(degree * std::numbers::pi / 180);
      std::array<double, 2> low{1e9, 1e9}, high{-1e9, -1e9};
      for (Index f : atlas.charts[k].faces)
        for (Offset corner = surface.begin[f]; corner < surface.begin[to_size(f) + 1]; ++corner) {
          const auto [u, v] = atlas.corner(corner);
          const double x = box.turn[0] * u + box.turn[1] * v, y = box.turn[0] * v - box.turn[1] * u;
          EXPECT_GE(x, box.low[0] - 1e-12);
          EXPECT_LE(x, box.high[0] + 1e-12);
          EXPECT_GE(y, box.low[1] - 1e-12);
          EXPECT_LE(y, box.high[1] + 1e-12);
          const std::array<double, 2> q{c * u + s * v, c * v - s * u};
          for (std::size_t a : {0, 1}) low[a] = std::min(low[a], q[a]), high[a] = std::max(high[a], q[a]);
        }
      EXPECT_LE(width * height, (high[0] - low[0]) * (high[1] - low[1]) * (1 + 1e-12));
    }
  }
}

TEST(Atlas, RefusesBadArguments) {
  const MeshAndFaces surface(icosphere(2));
  const std::array source{Vertex{0}}, outside{Vertex{1000}};
  const auto refuse = [&](std::span<const Vertex> sources, const FaceList& faces) {
    EXPECT_THROW(make_atlas(surface.solver(), sources, faces), InvalidArgument);
  };
  refuse({}, surface.faces());
  refuse(outside, surface.faces());
  refuse(source, {std::span(surface.begin).first(3), surface.vertices});
  const std::vector<Offset> triangle{0, 3};
  const std::vector<Index> beyond{0, 1, 1000};
  refuse(source, {triangle, beyond});
  EXPECT_THROW(make_atlas(surface.solver(), source, surface.faces(), surface.positions, {.max_distortion = 1}),
               InvalidArgument);
  EXPECT_THROW(make_atlas(surface.solver(), source, surface.faces(), surface.positions, {.share = 1}), InvalidArgument);
  EXPECT_THROW(make_atlas(surface.solver(), source, surface.faces(), std::span(surface.positions).first(4), {}),
               InvalidArgument);
  const Atlas atlas = make_atlas(surface.solver(), source, surface.faces());
  EXPECT_THROW(distortion(atlas, {triangle, std::span(surface.vertices).first(3)}, surface.positions), InvalidArgument);
  const FlatGraph solid = lattice3(3);
  const CsrGraph graph(solid.data);
  EXPECT_THROW(make_atlas(LogMapSolver(graph), source, {triangle, std::span(surface.vertices).first(3)}),
               InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
