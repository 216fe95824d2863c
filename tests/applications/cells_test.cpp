// Voronoi cells and farthest points by geodesic distance.
#include "ahm/applications/cells.hpp"

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "cells.hpp"
#include "mapped_surfaces.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

/// A square of side 1 whose points are concentrated at x = 0 and y = 0 by a power.
trimesh::TriangleMeshSurface graded_square(Index side, double power) {
  Mesh mesh = flat_square(side, 0);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] = {std::pow(mesh.plane[i][0], power), std::pow(mesh.plane[i][1], power), 0};
  return mesh_surface(mesh);
}

Vec3 vertex_position(const Surface& surface, Vertex v) { return surface.positions()[surface.rows().row(v)->index]; }

/// Expects the label of the nearest source, except for ties, and the straight-line distance.
void expect_cells_of_the_plane(const Surface& surface, Index count, double tolerance) {
  const std::vector<Vertex> sources = farthest_points(surface.graph(), Vertex{7}, count);
  const VoronoiCells cells = voronoi_cells(surface.graph(), sources);
  for (Index i = 0; i < surface.graph().size(); ++i) {
    const auto to = [&](Vertex source) {
      return distance(vertex_position(surface, source), vertex_position(surface, Vertex(i)));
    };
    double least = INFINITY;
    for (Vertex source : sources) least = std::min(least, to(source));
    ASSERT_NEAR(to(sources[cells.labels[i]]), least, tolerance) << "vertex " << i;
    ASSERT_NEAR(cells.distances[i], least, tolerance) << "vertex " << i;
  }
}

TEST(Cells, AreThoseOfStraightLinesOnPlanes) {
  // If triangles are thinner than 1e-3, the side lengths determine the position of a source with fewer digits.
  for (const auto& [power, tolerance] : {Vec2{1, 1e-11}, {2, 1e-8}, {3, 1e-6}})
    for (Index count : {1, 2, 5, 40}) expect_cells_of_the_plane(graded_square(40, power), count, tolerance);
  std::vector<Vec3> points;
  for (Index y = 0; y < 41; ++y)
    for (Index x = 0; x < 41; ++x) {
      const bool dense = x > 8 && x < 32 && y > 8 && y < 32;
      if (dense || (x % 4 == 0 && y % 4 == 0))
        points.push_back({x + 0.1 * std::sin(7.0 * x + 3 * y), y + 0.1 * std::cos(5.0 * x - y), 0});
    }
  // At the border between spacings of 1 and 4 the stars of a cloud are not those of one triangulation.
  expect_cells_of_the_plane(pointcloud::PointCloudSurface::build(points), 12, 2e-2);
}

TEST(Cells, HaveDistancesOfAtLeastTheStraightLine) {
  std::vector<Vec3> points = random_sphere(2000).points;
  for (std::size_t i = 0; i < points.size(); i += 3) points[i] = 1.04 * points[i];
  const auto cloud = pointcloud::PointCloudSurface::build(points);
  const auto sources = farthest_points(cloud.graph(), Vertex(0), 10);
  const VoronoiCells cells = voronoi_cells(cloud.graph(), sources);
  Wavefront front(cloud.graph());
  for (Vertex source : sources) front.add(Source::at_vertex(source));
  front.run();
  Index raised = 0;
  for (Index i = 0; i < cloud.graph().size(); ++i) {
    const Vec3 source = cloud.graph().frame(sources[cells.labels[i]].index)->origin;
    ASSERT_GE(cells.distances[i], distance(cloud.graph().frame(i)->origin, source) * (1 - 1e-11));
    ASSERT_GE(cells.distances[i], front.distance(Vertex(i)));
    raised += cells.distances[i] > front.distance(Vertex(i));
  }
  EXPECT_GT(raised, 50);
}

TEST(Cells, ContainTheirSourcesAndAreConnected) {
  const CsrGraph graph(planar_triangulation(30).data);
  const std::vector<Vertex> sources = farthest_points(graph, Vertex{17}, 12);
  std::vector<Index> label = voronoi_cells(graph, sources).labels;
  for (std::size_t k = 0; k < sources.size(); ++k) {
    EXPECT_EQ(label[sources[k].index], static_cast<Index>(k));
    for (std::vector<Index> stack{sources[k].index}; !stack.empty();) {  // erase what is connected to the source
      const Index i = stack.back();
      stack.pop_back();
      label[i] = -1;
      for (Index j : graph.star(i).neighbors)
        if (label[j] == static_cast<Index>(k)) stack.push_back(j);
    }
  }
  EXPECT_EQ(std::ranges::count(label, -1), graph.size());
}

/// Expects the cells of a continued front to be those of a new one.
void expect_fresh_cells(Wavefront& front, std::span<const Vertex> sources) {
  const VoronoiCells fresh = voronoi_cells(front.graph(), sources), cells = voronoi_cells(front, sources);
  EXPECT_EQ(cells.labels, fresh.labels) << sources.size();
  for (std::size_t i = 0; i < fresh.distances.size(); ++i)
    ASSERT_NEAR(cells.distances[i], fresh.distances[i], 1e-13) << sources.size();
}

TEST(Cells, AreTheSameByAContinuedFront) {
  const CsrGraph graph(planar_triangulation(30).data);
  const std::vector<Vertex> sources = farthest_points(graph, Vertex{17}, 24);
  Wavefront front(graph);
  for (std::size_t count : {1, 2, 7, 24}) expect_fresh_cells(front, std::span(sources).first(count));
  expect_error<InvalidArgument>([&] { voronoi_cells(front, std::span(sources).first(5)); }, "24 points");
  for (Index count : {1, 2, 25}) {  // from the front of farthest points
    Wavefront farthest_front(graph);
    const std::vector<Vertex> points = farthest_points(farthest_front, Vertex{17}, count);
    EXPECT_EQ(points, farthest_points(graph, Vertex{17}, count));
    EXPECT_EQ(farthest_front.points(), count - 1);
    expect_fresh_cells(farthest_front, points);
    expect_error<InvalidArgument>([&] { farthest_points(farthest_front, Vertex{17}, 2); },
                                  "(" + std::to_string(count) + ")");
  }
}

TEST(Cells, OfALineOfAnyLengthMeetInTheMiddleAndEndWithTheComponent) {
  const Index n = 6001;
  const CsrGraph two(doubled(line_graph(n).data));
  const auto label = voronoi_cells(two, std::array{Vertex{0}, Vertex(n - 1)}).labels;
  for (Index i = 0; i < 2 * n; ++i)
    if (i != n / 2) EXPECT_EQ(label[i], i >= n ? -1 : i < n / 2 ? 0 : 1);
  EXPECT_GE(farthest_points(two, Vertex{0}, 2)[1], Vertex{n});  // the other component first
}

TEST(Cells, EndAtTheRadiusOverFlatFaces) {
  const auto surface = mesh_surface(split_icosphere(640));
  const ExactGeodesics geodesics(surface);
  const std::array sources{Vertex(3), Vertex(200), Vertex(411)};
  const VoronoiCells whole = voronoi_cells(geodesics, sources),
                     cells = voronoi_cells(geodesics, sources, {.radius = 0.4, .progress = {}});
  for (std::size_t i = 0; i < cells.labels.size(); ++i) {
    EXPECT_EQ(cells.labels[i], whole.distances[i] <= 0.4 ? whole.labels[i] : -1);
    EXPECT_EQ(std::isnan(cells.distances[i]), whole.distances[i] > 0.4);
  }
}

TEST(FarthestPoints, AreExactlyTheFarthestOverFlatFaces) {
  const Mesh ring = torus(300);
  const auto surface =
      mesh_surface(joined(ring, icosphere(4), {5, 0, 0}));  // at first some vertices are infinitely far
  const ExactGeodesics geodesics(surface);
  const auto chosen = farthest_points(geodesics, Vertex{5}, 15);
  ASSERT_EQ(chosen.size(), 15U);
  EXPECT_EQ(chosen[0], Vertex{5});
  EXPECT_GE(chosen[1].index, ring.vertices());
  for (std::size_t k = 2; k < chosen.size(); ++k) {
    const VoronoiCells before = voronoi_cells(geodesics, std::span(chosen).first(k));
    EXPECT_EQ(before.distances[chosen[k].index], std::ranges::max(before.distances));
  }
  EXPECT_THROW(farthest_points(geodesics, Vertex{-1}, 2), InvalidArgument);
  EXPECT_THROW(farthest_points(geodesics, Vertex{0}, surface.graph().size() + 1), InvalidArgument);
}

// The definition: the first vertex that is farthest from all points before.
TEST(FarthestPoints, AreTheFirstOfThoseFarthestFromAllBefore) {
  const CsrGraph graph(doubled(planar_triangulation(16).data));
  std::vector<Vertex> expected{Vertex{3}};
  Wavefront front(graph, Wavefront::one_rings(graph));
  while (expected.size() < 200) {
    front.add(Source::at_vertex(expected.back()));
    front.run();
    Vertex farthest{0};
    for (Index i = 1; i < graph.size(); ++i)
      if (front.distance(Vertex(i)) > front.distance(farthest)) farthest = Vertex(i);
    expected.push_back(farthest);
  }
  EXPECT_EQ(farthest_points(graph, Vertex{3}, 200), expected);
}

// On refined polygons vertices inside of faces are farther than the rows.
TEST(FarthestPoints, AreTheFarthestOfTheCandidates) {
  const Polygons mesh = cube_sphere(6);
  const auto surface = polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners);
  const std::vector<Vertex> rows = vertices_with_rows(surface.rows());
  ASSERT_LT(std::ssize(rows), surface.graph().size());
  const ExactGeodesics geodesics(surface);
  for (const bool is_exact : {false, true}) {
    const auto chosen = is_exact ? farthest_points(geodesics, rows[30], 12, {}, rows)
                                 : farthest_points(surface.graph(), rows[30], 12, {}, rows);
    for (std::size_t k = 1; k < chosen.size(); ++k) {
      const auto before = std::span(chosen).first(k);
      const auto distances =
          is_exact ? voronoi_cells(geodesics, before).distances : voronoi_cells(surface.graph(), before).distances;
      double farthest = 0;
      for (const Vertex v : rows) farthest = std::max(farthest, distances[v.index]);
      EXPECT_GE(distances[chosen[k].index], farthest - 1e-9) << k;
    }
  }
  EXPECT_THROW(farthest_points(surface.graph(), rows[0], static_cast<Index>(rows.size()) + 1, {}, rows),
               InvalidArgument);
}

// All n points of n. A comparison of all vertices for each point would need n^2 comparisons.
TEST(FarthestPoints, TakeFewerComparisonsThanAllPairs) {
  constexpr Index n = 1 << 12;
  std::vector<double> distance(n, INFINITY);
  std::vector<Vertex> all;
  for (Index i = 0; i < n; ++i) all.emplace_back(i);
  FarthestQueue farthest(all);
  Offset changes = 0, comparisons = 0;
  std::vector<bool> chosen(n, false);
  Vertex next{0};
  for (Index k = 0; k < n; ++k) {
    chosen[next.index] = true;
    // Points of a line: the new point changes its neighborhood as far as it is nearer than the points before.
    for (int side : {-1, 1})
      for (Index i = side < 0 ? next.index : next.index + 1; i >= 0 && i < n; i += side) {
        const double away = std::abs(i - next.index);
        if (!(away < distance[i])) break;
        distance[i] = away, ++changes;
      }
    next = farthest.of([&](Vertex v) { return ++comparisons, distance[v.index]; });
  }
  EXPECT_EQ(std::ranges::count(chosen, true), n);
  EXPECT_LE(comparisons, changes + n);  // one for each change and each result
  EXPECT_LT(changes, n * 14);           // n log2 n and a little
}

TEST(FarthestPoints, StopOnRequest) {
  const CsrGraph graph(planar_triangulation(6).data);
  std::stop_source stop;
  int reports = 0;
  const auto report = [&](std::string_view, double) {
    if (++reports == 3) stop.request_stop();
  };
  EXPECT_THROW(farthest_points(graph, Vertex{0}, 20, {report, stop.get_token()}), Cancelled);
  EXPECT_EQ(reports, 3);
}

TEST(Cells, RefuseInvalidArguments) {
  const CsrGraph graph(planar_triangulation(5).data);
  EXPECT_THROW(voronoi_cells(graph, {}), InvalidArgument);
  EXPECT_THROW(voronoi_cells(graph, std::array{Vertex{1}, Vertex{1}}), InvalidArgument);
  EXPECT_THROW(voronoi_cells(graph, std::array{Vertex{25}}), InvalidArgument);
  EXPECT_THROW(farthest_points(graph, Vertex{-1}, 2), InvalidArgument);
  EXPECT_THROW(farthest_points(graph, Vertex{0}, 26), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
