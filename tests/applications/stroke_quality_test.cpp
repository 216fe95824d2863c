// What maps from curves say of themselves: spread, quality and the nearest sample.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ahm/applications/stroke.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {
namespace {

/// Calls visit(surface) for a mesh and for its vertices as points.
template <class Visit>
void for_mesh_and_cloud(const Mesh& mesh, const Visit& visit) {
  visit(trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces));
  visit(pointcloud::PointCloudSurface::build(mesh.positions));
}

double edge_of(const Surface& surface) { return surface.graph().mean_edge_length() * surface.graph().length_unit(); }

/// A circle about the middle of the unit square, from its right end.
std::vector<CurvePoint> ring(double radius) {
  std::vector<CurvePoint> points;
  for (int k = 0; k < 90; ++k) {
    const double a = 2 * std::numbers::pi * k / 90;
    points.emplace_back(Vec3{0.5 + radius * std::cos(a), 0.5 + radius * std::sin(a), 0});
  }
  return points;
}

/// Expects that a map along the ring of radius 0.3 is trusted beside it, and neither in its middle nor where u jumps.
void expect_doubt_where_it_tears(const Surface& surface, const RowLogMap& rows, const std::vector<double>& quality) {
  const double edge = edge_of(surface);
  int beside = 0, trusted = 0;
  for (std::size_t r = 0; r < quality.size(); ++r) {
    const Vec3& p = surface.positions()[r];
    const double x = p[0] - 0.5, y = p[1] - 0.5, from_middle = std::hypot(x, y);
    if (from_middle < edge) EXPECT_LT(quality[r], trusted_quality) << p[0] << ' ' << p[1];
    if (x > 0.1 && x < 0.4 && std::abs(y) < 0.3 * edge) EXPECT_LT(quality[r], trusted_quality) << p[0] << ' ' << p[1];
    if (std::abs(from_middle - 0.3) > 0.1 || (x > 0 && std::abs(y) < 0.1)) continue;
    ++beside;
    trusted += quality[r] > trusted_quality;
    EXPECT_NEAR(rows.distance[r], std::abs(from_middle - 0.3), edge);
  }
  EXPECT_GT(trusted, 0.8 * beside);
}

TEST(StrokeQuality, IsThatOfThePlaneAlongAStraightLine) {
  for_mesh_and_cloud(flat_square(30), [](const Surface& surface) {
    const CurvePoint given[] = {Vec3{0.2, 0.33, 0}, Vec3{0.8, 0.47, 0}};
    const SurfaceCurve curve = draw_curve(surface, given);
    const LogMap map = LogMapSolver(surface.graph()).solve(curve.source);
    const RowLogMap rows = rows_from_curve(surface, map, curve);
    const std::vector<double> quality = to_rows(rows, map_quality(surface.graph(), map));
    for (std::size_t r = 0; r < quality.size(); ++r) {
      EXPECT_LT(rows.spread[r], 1e-6);
      EXPECT_GT(quality[r], 0.9);
    }
  });
}

TEST(StrokeQuality, KnowsTheNearestSample) {
  for_mesh_and_cloud(flat_square(20), [](const Surface& surface) {
    const SurfaceCurve curve = draw_curve(surface, ring(0.3), {.closed = true});
    const LogMap map = LogMapSolver(surface.graph()).solve(curve.source);
    ASSERT_EQ(map.nearest().size(), map.status().size());
    std::vector<Vec3> samples;
    for (const ExactSource& sample : curve.samples) samples.push_back(surface.position(sample.point));
    for (Index r = 0; r < static_cast<Index>(surface.positions().size()); ++r) {
      const auto vertex = surface.rows().vertex(Row(r));
      double least = HUGE_VAL;
      for (const Vec3& p : samples) least = std::min(least, distance(p, surface.positions()[r]));
      EXPECT_LT(distance(samples[map.nearest()[vertex->index]], surface.positions()[r]),
                least + 0.1 * edge_of(surface));
    }
  });
}

TEST(StrokeQuality, IsLowWhereTheMapTears) {
  for_mesh_and_cloud(flat_square(60), [](const Surface& surface) {
    const SurfaceCurve curve = draw_curve(surface, ring(0.3), {.closed = true});
    const LogMap map = LogMapSolver(surface.graph()).solve(curve.source);
    const RowLogMap rows = rows_from_curve(surface, map, curve);
    expect_doubt_where_it_tears(surface, rows, to_rows(rows, map_quality(surface.graph(), map)));
  });
}

TEST(StrokeQuality, OfExactMapsIsLowThereToo) {
  const Mesh mesh = flat_square(60);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const SurfaceCurve curve = draw_curve(surface, ring(0.3), {.closed = true});
  const LogMap map = ExactGeodesics(surface).log_map(curve.samples).map;
  const RowLogMap rows = rows_from_curve(surface, map, curve);
  expect_doubt_where_it_tears(surface, rows, to_rows(rows, map_quality(surface.graph(), map)));
}

// Right: off by less than a tenth of the distance, or an edge.
TEST(StrokeQuality, TellsRightRowsFromWrongOnes) {
  const Mesh mesh = torus(4000);
  const auto exact_surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const CurvePoint given[] = {Row(0), Row(mesh.vertices() / 7)};
  const SurfaceCurve drawn = draw_curve(exact_surface, given);
  const RowLogMap exact = exact_surface.to_rows(ExactGeodesics(exact_surface).log_map(drawn.samples).map);
  for_mesh_and_cloud(mesh, [&](const Surface& surface) {
    const SurfaceCurve curve = draw_curve(surface, std::vector<CurvePoint>(drawn.points.begin(), drawn.points.end()));
    const LogMap map = LogMapSolver(surface.graph()).solve(curve.source);
    const RowLogMap rows = rows_from_curve(surface, map, curve);
    const std::vector<double> quality = to_rows(rows, map_quality(surface.graph(), map));
    const double side = dot(curve.first->normal, drawn.first->normal) > 0 ? 1 : -1, edge = edge_of(surface);
    int trusted = 0, right = 0, right_and_trusted = 0;
    for (std::size_t r = 0; r < quality.size(); ++r) {
      const double error = std::hypot(rows.u[r] - exact.u[r], rows.v[r] - side * exact.v[r]);
      const bool is_right = error < std::max(0.1 * exact.distance[r], edge);
      right += is_right;
      trusted += quality[r] > trusted_quality;
      right_and_trusted += is_right && quality[r] > trusted_quality;
    }
    EXPECT_LT(right, 0.9 * static_cast<double>(quality.size()));  // else there is nothing to tell
    EXPECT_GT(right_and_trusted, 0.95 * trusted);
    EXPECT_GT(right_and_trusted, 0.75 * right);
  });
}

}  // namespace
}  // namespace ahm::test
