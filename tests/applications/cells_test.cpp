// Voronoi cells and farthest points by geodesic distance.
#include "ahm/applications/cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "cells.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

/// A square of side 1 whose points crowd at x = 0 and y = 0 as the given power.
std::vector<Vec3> graded_square(Index side, double power) {
  std::vector<Vec3> points;
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < side; ++x)
      points.push_back({std::pow(x / (side - 1.0), power), std::pow(y / (side - 1.0), power), 0});
  return points;
}

std::vector<Triangle> square_faces(Index side) {
  std::vector<Triangle> faces;
  for (Index y = 0; y + 1 < side; ++y)
    for (Index x = 0; x + 1 < side; ++x) {
      const Index a = y * side + x;
      faces.push_back({a, a + 1, a + side + 1});
      faces.push_back({a, a + side + 1, a + side});
    }
  return faces;
}

/// Every label is that of the nearest source, but for ties, and every distance is the straight line.
void expect_cells_of_the_plane(const Surface& surface, Index count, double tolerance) {
  const std::span<const Vec3> points = surface.positions();
  const std::vector<Vertex> sources = farthest_points(surface.graph(), Vertex{7}, count);
  const VoronoiCells cells = voronoi_cells(surface.graph(), sources);
  for (Index i = 0; i < surface.graph().size(); ++i) {
    const auto away = [&](Vertex source) {
      const Vec3 &p = points[surface.rows().row(source)->index], &q = points[surface.rows().row(Vertex(i))->index];
      return std::hypot(p[0] - q[0], p[1] - q[1]);
    };
    double least = std::numeric_limits<double>::infinity();
    for (Vertex source : sources) least = std::min(least, away(source));
    ASSERT_NEAR(away(sources[cells.labels[i]]), least, tolerance) << "vertex " << i;
    ASSERT_NEAR(cells.distances[i], least, tolerance) << "vertex " << i;
  }
}

TEST(Cells, AreThoseOfDistanceOnGradedPlanes) {
  for (double power : {1.0, 2.0, 3.0})
    for (Index count : {1, 2, 5, 40})
      // Where triangles are thinner than 1e-3 the sides no longer tell all digits of where a source lies.
      expect_cells_of_the_plane(trimesh::TriangleMeshSurface::build(graded_square(40, power), square_faces(40)), count,
                                power < 2   ? 1e-11
                                : power < 3 ? 1e-8
                                            : 1e-6);
}

TEST(Cells, AreThoseOfDistanceOnCloudsWithASparseBoundary) {
  std::vector<Vec3> points;
  for (Index y = 0; y < 41; ++y)
    for (Index x = 0; x < 41; ++x) {
      const bool dense = x > 8 && x < 32 && y > 8 && y < 32;
      if (dense || (x % 4 == 0 && y % 4 == 0))
        points.push_back({x + 0.1 * std::sin(7.0 * x + 3 * y), y + 0.1 * std::cos(5.0 * x - y), 0});
    }
  // Points lie 1 and 4 apart; where the two meet, the stars of a cloud are not those of one triangulation.
  expect_cells_of_the_plane(pointcloud::PointCloudSurface::build(points), 12, 2e-2);
}

// As the distances of maps by row.
TEST(Cells, AreNoNearerThanTheStraightLine) {
  std::vector<Vec3> points = random_sphere(2000).points;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (double& x : points[i]) x *= i % 3 == 0 ? 1.04 : 1;
  const auto cloud = pointcloud::PointCloudSurface::build(points);
  const auto place = [&](Vertex v) { return cloud.graph().frame(v.index)->origin; };
  const auto sources = farthest_points(cloud.graph(), Vertex(0), 10);
  const VoronoiCells cells = voronoi_cells(cloud.graph(), sources);
  Wavefront front(cloud.graph());
  for (Vertex source : sources) front.add(Source::at_vertex(source));
  front.run();
  Index raised = 0;
  for (Index i = 0; i < cloud.graph().size(); ++i) {
    const Vec3 here = place(Vertex(i)), there = place(sources[cells.labels[i]]);
    const double line = std::hypot(here[0] - there[0], here[1] - there[1], here[2] - there[2]);
    ASSERT_GE(cells.distances[i], line * (1 - 1e-11));
    ASSERT_GE(cells.distances[i], front.distance(Vertex(i)));
    raised += cells.distances[i] > front.distance(Vertex(i));
  }
  EXPECT_GT(raised, 50);
}

TEST(Cells, ContainTheirSourcesAndAreConnected) {
  const CsrGraph graph(planar_triangulation(30).data);
  const std::vector<Vertex> sources = farthest_points(graph, Vertex{17}, 12);
  const std::vector<Index> label = voronoi_cells(graph, sources).labels;
  for (std::size_t k = 0; k < sources.size(); ++k) {
    std::vector<Index> stack{sources[k].index};
    std::vector<bool> seen(label.size(), false);
    seen[sources[k].index] = true;
    std::ptrdiff_t size = 0;
    while (!stack.empty()) {
      const Index i = stack.back();
      stack.pop_back(), ++size;
      for (Index j : graph.star(i).neighbors)
        if (!seen[j] && label[j] == static_cast<Index>(k)) seen[j] = true, stack.push_back(j);
    }
    EXPECT_EQ(label[sources[k].index], static_cast<Index>(k));
    EXPECT_EQ(size, std::count(label.begin(), label.end(), static_cast<Index>(k)));
  }
}

/// By a front that goes on as by a new one.
void expect_fresh_cells(Wavefront& front, std::span<const Vertex> sources) {
  const VoronoiCells fresh = voronoi_cells(front.graph(), sources), cells = voronoi_cells(front, sources);
  EXPECT_EQ(cells.labels, fresh.labels) << sources.size();
  for (std::size_t i = 0; i < fresh.distances.size(); ++i)
    ASSERT_NEAR(cells.distances[i], fresh.distances[i], 1e-13) << sources.size();
}

TEST(Cells, AreTheSameByAFrontThatGoesOn) {
  const CsrGraph graph(planar_triangulation(30).data);
  const std::vector<Vertex> sources = farthest_points(graph, Vertex{17}, 24);
  Wavefront front(graph);
  for (std::size_t count : {1, 2, 7, 24}) {
    expect_fresh_cells(front, std::span(sources).first(count));
  }
  expect_error<InvalidArgument>([&] { voronoi_cells(front, std::span(sources).first(5)); }, "24 points, more than");
}

TEST(Cells, LeaveComponentsWithoutASourceUnlabelled) {
  const FlatGraph flat = planar_triangulation(8);
  const CsrGraph graph(doubled(flat.data));
  const auto label = voronoi_cells(graph, std::array{Vertex{3}}).labels;
  for (Index i = 0; i < graph.size(); ++i) EXPECT_EQ(label[i], i < flat.size() ? 0 : -1);
}

TEST(Cells, OfALineOfAnyLengthMeetHalfWay) {
  const Index n = 6001;
  const CsrGraph graph(line_graph(n).data);
  const auto label = voronoi_cells(graph, std::array{Vertex{0}, Vertex(n - 1)}).labels;
  for (Index i = 0; i < n; ++i)
    if (i != n / 2) EXPECT_EQ(label[i], i < n / 2 ? 0 : 1);
}

TEST(FarthestPoints, AreExactlyTheFarthestOverFlatFaces) {
  // Two components, so that some are infinitely far at first.
  Mesh mesh = torus(300);
  const Mesh ball = icosphere(4);
  const Index n = mesh.vertices();
  for (const Vec3& p : ball.positions) mesh.positions.push_back({p[0] + 5, p[1], p[2]});
  for (const Triangle& f : ball.faces) mesh.faces.push_back({f[0] + n, f[1] + n, f[2] + n});
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const ExactGeodesics geodesics(surface);
  const auto chosen = farthest_points(geodesics, Vertex{5}, 15);
  ASSERT_EQ(chosen.size(), 15U);
  EXPECT_EQ(chosen[0], Vertex{5});
  EXPECT_GE(chosen[1].index, n);
  for (std::size_t k = 2; k < chosen.size(); ++k) {
    const VoronoiCells before = voronoi_cells(geodesics, std::span(chosen).first(k));
    EXPECT_EQ(before.distances[chosen[k].index], *std::max_element(before.distances.begin(), before.distances.end()));
  }
  EXPECT_THROW(farthest_points(geodesics, Vertex{-1}, 2), InvalidArgument);
  EXPECT_THROW(farthest_points(geodesics, Vertex{0}, surface.graph().size() + 1), InvalidArgument);
}

TEST(FarthestPoints, AreSpreadAsAGreedyCoverOfThePlane) {
  const auto surface = trimesh::TriangleMeshSurface::build(graded_square(24, 1.5), square_faces(24));
  const std::span<const Vec3> points = surface.positions();
  const auto chosen = farthest_points(surface.graph(), Vertex{5}, 20);
  const auto place = [&](Vertex v) { return points[surface.rows().row(v)->index]; };
  std::vector<double> away(points.size(), 1e300);
  for (std::size_t k = 0; k + 1 < chosen.size(); ++k) {
    for (Index i = 0; i < surface.graph().size(); ++i) {
      const Vec3 p = place(chosen[k]), q = place(Vertex(i));
      away[i] = std::min(away[i], std::hypot(p[0] - q[0], p[1] - q[1]));
    }
    EXPECT_NEAR(away[chosen[k + 1].index], *std::max_element(away.begin(), away.end()), 1e-10);
  }
}

/// As the definition says, by looking at all vertices each time.
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

TEST(FarthestPoints, LeaveAFrontFromWhichCellsGoOn) {
  const CsrGraph graph(planar_triangulation(30).data);
  for (Index count : {1, 2, 25}) {
    Wavefront front(graph);
    const std::vector<Vertex> points = farthest_points(front, Vertex{17}, count);
    EXPECT_EQ(points, farthest_points(graph, Vertex{17}, count));
    EXPECT_EQ(front.points(), count - 1);
    expect_fresh_cells(front, points);
    expect_error<InvalidArgument>([&] { farthest_points(front, Vertex{17}, 2); },
                                  "'front' already has points (" + std::to_string(count) + ")");
  }
}

// Of refined polygons each is the farthest of the rows, although vertices inside of faces lie farther.
TEST(FarthestPoints, AreTheFarthestOfThoseToChooseFrom) {
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
      const std::vector<double> distances =
          is_exact ? voronoi_cells(geodesics, before).distances : voronoi_cells(surface.graph(), before).distances;
      double farthest = 0;
      for (const Vertex v : rows) farthest = std::max(farthest, distances[v.index]);
      EXPECT_GE(distances[chosen[k].index], farthest - 1e-9) << k;
    }
  }
  EXPECT_THROW(farthest_points(surface.graph(), rows[0], static_cast<Index>(rows.size()) + 1, {}, rows),
               InvalidArgument);
}

/// n points of n: were all looked at for each, that would be n^2 times.
TEST(FarthestPoints, AreFoundWithoutLookingAtAllEachTime) {
  constexpr Index n = 1 << 12;
  std::vector<double> distance(n, std::numeric_limits<double>::infinity());
  std::vector<Vertex> all;
  for (Index i = 0; i < n; ++i) all.emplace_back(i);
  FarthestQueue farthest(all);
  Offset changes = 0, looks = 0;
  std::vector<bool> chosen(n, false);
  Vertex next{0};
  for (Index k = 0; k < n; ++k) {
    chosen[next.index] = true;
    // Around the chosen one, as far as it is nearer than those before: points of a line.
    for (int side : {-1, 1})
      for (Index i = side < 0 ? next.index : next.index + 1; i >= 0 && i < n; i += side) {
        const double away = std::abs(i - next.index);
        if (!(away < distance[i])) break;
        distance[i] = away, ++changes;
      }
    next = farthest.of([&](Vertex v) { return ++looks, distance[v.index]; });
  }
  EXPECT_EQ(std::count(chosen.begin(), chosen.end(), true), n);
  EXPECT_LE(looks, changes + n);  // each change once, and each answer
  EXPECT_LT(changes, n * 14);     // n log2 n and a little
}

TEST(FarthestPoints, VisitEveryComponentFirst) {
  const FlatGraph flat = planar_triangulation(6);
  const CsrGraph graph(doubled(flat.data));
  EXPECT_GE(farthest_points(graph, Vertex{0}, 2)[1], Vertex{flat.size()});
}

TEST(FarthestPoints, StopWhenAsked) {
  const CsrGraph graph(planar_triangulation(6).data);
  std::stop_source stop;
  int asked = 0;
  const auto report = [&](std::string_view, double) {
    if (++asked == 3) stop.request_stop();
  };
  EXPECT_THROW(farthest_points(graph, Vertex{0}, 20, {report, stop.get_token()}), Cancelled);
  EXPECT_EQ(asked, 3);
}

TEST(Cells, RefuseBadArguments) {
  const CsrGraph graph(planar_triangulation(5).data);
  EXPECT_THROW(voronoi_cells(graph, {}), InvalidArgument);
  EXPECT_THROW(voronoi_cells(graph, std::array{Vertex{1}, Vertex{1}}), InvalidArgument);
  EXPECT_THROW(voronoi_cells(graph, std::array{Vertex{25}}), InvalidArgument);
  EXPECT_THROW(farthest_points(graph, Vertex{-1}, 2), InvalidArgument);
  EXPECT_THROW(farthest_points(graph, Vertex{0}, 26), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
