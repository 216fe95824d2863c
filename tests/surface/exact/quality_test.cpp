// The quality of maps of heat, judged by exact ones.
#include "ahm/maps/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

using trimesh::TriangleMeshSurface;

// Behind a hole shortest paths come around it, so directions of heat are wrong there, also on a flat sheet, where they are straight.
TEST(MapQuality, SeesDirectionsTurnedByHoles) {
  for (const double depth : {0.0, 0.5}) {
    const Index side = 41;
    std::vector<Vec3> positions;
    std::vector<Triangle> faces;
    for (Index i = 0; i < side * side; ++i) {
      const double x = (i % side) / 20.0 - 1, y = (i / side) / 20.0 - 1;
      positions.push_back({x, y, depth * (x * x + y * y)});
    }
    for (Index y = 0; y + 1 < side; ++y)
      for (Index x = 0; x + 1 < side; ++x) {
        if (std::hypot(x - 19.5, y - 12.5) < 5) continue;
        const Index i = y * side + x;
        faces.push_back({i, i + 1, i + side + 1});
        faces.push_back({i, i + side + 1, i + side});
      }
    const auto surface = TriangleMeshSurface::build(positions, faces);
    const SurfacePoint source = Row(2 * side + side / 2);
    const LogMap heat = LogMapSolver(surface.graph()).solve(surface.source(source).source);
    const LogMap exact = ExactGeodesics(surface).log_map(source);
    const std::vector<double> quality = map_quality(surface.graph(), heat);
    double trusted = 0, right = 0, turned = 0;  // turned: wrong, but not by its length
    for (Index v = 0; v < heat.size(); ++v) {
      const std::span<const double> phi = heat.coordinates(Vertex(v)), expected = exact.coordinates(Vertex(v));
      const double d = exact.distance(Vertex(v));
      const bool is_right = std::hypot(phi[0] - expected[0], phi[1] - expected[1]) <= 0.1 * d;
      turned += !is_right && std::abs(std::hypot(phi[0], phi[1]) - d) < 0.1 * d;
      trusted += quality[v] >= trusted_quality;
      right += is_right && quality[v] >= trusted_quality;
    }
    EXPECT_GT(turned, 0.15 * heat.size());
    EXPECT_GT(right / trusted, 0.97);
    EXPECT_GT(trusted, 0.4 * heat.size());
  }
}

// Where edges are much shorter than in the mean, vectors as short count by their own edges.
TEST(MapQuality, TrustsNoRoughPlacesOfFineEdges) {
  constexpr Index side = 24;
  Mesh mesh;
  const auto along = [](Index k) { return std::pow(k / (side - 1.0), 4); };
  for (Index i = 0; i < side; ++i)
    for (Index j = 0; j < side; ++j) {
      const Index least = std::max<Index>(std::min(i, j), 1);
      const double edge = along(least) - along(least - 1);
      mesh.positions.push_back({along(i), along(j), 0.7 * edge * std::sin(12.9898 * i + 78.233 * j)});
      const Index a = i * side + j, b = a + side;
      if (i + 1 < side && j + 1 < side) mesh.faces.insert(mesh.faces.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
    }
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Row source(3 * side + 3);
  const LogMap exact = ExactGeodesics(surface).log_map(source);
  const double edge = surface.graph().mean_edge_length() * surface.graph().length_unit();
  for (Variant variant : all_variants) {
    const LogMap heat = LogMapSolver(surface.graph(), {.variant = variant}).solve(surface.source(source).source);
    const std::vector<double> quality = map_quality(surface.graph(), heat);
    Index near = 0, wrong = 0;
    for (Index i = 0; i < surface.graph().size(); ++i) {
      const Vertex v(i);
      const double d = exact.distance(v);
      if (!(d > 0 && d < edge)) continue;
      const auto is = heat.coordinates(v), should = exact.coordinates(v);
      ++near;
      wrong += quality[i] >= trusted_quality && std::hypot(is[0] - should[0], is[1] - should[1]) > 0.1 * d;
    }
    EXPECT_GT(near, 50);
    EXPECT_LT(wrong, 0.05 * near) << to_string(variant);
  }
}

}  // namespace
}  // namespace ahm::test
