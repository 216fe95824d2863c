// Limits of the memory of maps: bytes, and number of allocations.
#include <gtest/gtest.h>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "failing_allocations.hpp"

namespace ahm::test {
namespace {

auto sphere(Index n) {
  const Mesh mesh = split_icosphere(n);
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
}

/// Bytes of the layout and a map, without the surface.
long exact_bytes(const Surface& surface) {
  const PeakBytes peak;
  const ExactGeodesics geodesics(surface);
  geodesics.log_map(Vertex(0));
  return peak();
}

long heat_bytes(const Surface& surface) {
  const PeakBytes peak;
  const LogMapSolver solver(surface.graph());
  solver.solve(Source::at_vertex(Vertex(0)));
  return peak();
}

/// A graph of a few hubs. All other vertices are neighbors of the hubs only.
CsrGraph hubs(Index n, Index count) {
  CsrGraphData g;
  g.masses.assign(static_cast<std::size_t>(n), 1.0);
  g.row_begin.push_back(0);
  for (Index i = 0; i < n; ++i) {
    for (Index j = i < count ? count : 0; j < (i < count ? n : count); ++j) {
      g.neighbors.push_back(j);
      g.weights.push_back(1.0);
      g.logs.insert(g.logs.end(), {i < j ? 1.0 : -1.0, 0.0});
      g.transports.insert(g.transports.end(), {1.0, 0.0});
    }
    g.row_begin.push_back(static_cast<Offset>(g.neighbors.size()));
  }
  return CsrGraph(std::move(g));
}

TEST(Factors, NeedMemoryInProportionToTheirSizeOnHubs) {
  const CsrGraph graph = hubs(5000, 60);
  const PeakBytes peak;
  const HeatOperators operators(graph, {.threads = 1});
  EXPECT_LT(peak(), 8 * static_cast<long>(operators.statistics().bytes));
}

TEST(ExactMaps, NeedLessThanAFifthOfTheMemoryOfHeat) {
  const auto surface = sphere(40000);
  const long heat = heat_bytes(surface);
  const long bytes = exact_bytes(surface);
  EXPECT_LT(5 * bytes, heat);
  EXPECT_LT(bytes, 550L * surface.graph().size());
}

/// Chunks of windows are reused, so the number of allocations depends on the windows that wait at a time.
TEST(ExactMaps, AllocateNothingPerWindow) {
  struct Count {
    Offset windows;
    long allocations;
  };
  const auto count = [](Index n) {
    const auto built = sphere(n);
    const ExactGeodesics geodesics(built);
    const auto& triangles = geodesics.triangles().surface;
    const long before = allocations();
    const exact::ExactMap map = exact::exact_map(triangles, triangles.vertex_point(Vertex(0)));
    return Count{map.statistics().windows, allocations() - before};
  };
  const Count small = count(2500), large = count(10000);
  EXPECT_LT(100 * large.allocations, large.windows);
  EXPECT_LT(100 * (large.allocations - small.allocations), large.windows - small.windows);
}

}  // namespace
}  // namespace ahm::test
