// What is made by exact maps, within a tolerance.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ahm/applications/atlas.hpp"
#include "ahm/applications/cells.hpp"
#include "ahm/applications/mean.hpp"
#include "ahm/applications/stroke.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

constexpr double tolerance = 1e-2;
const ExactMapOptions within{.tolerance = tolerance, .progress = {}};

class WithinATolerance : public testing::Test {
 protected:
  const Mesh mesh = split_icosphere(640);
  const trimesh::TriangleMeshSurface surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const ExactGeodesics geodesics{surface};
  const std::array<Vertex, 3> sources{Vertex(3), Vertex(200), Vertex(411)};

  /// Near the exact distances, and not the same.
  static void expect_near(std::span<const double> found, std::span<const double> exact) {
    ASSERT_EQ(found.size(), exact.size());
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], exact[i], tolerance * exact[i] + 1e-12) << i;
    EXPECT_FALSE(std::ranges::equal(found, exact));
  }
};

TEST_F(WithinATolerance, CellsHaveDistancesAndLabelsOfSourcesAsNear) {
  const VoronoiCells cells = voronoi_cells(geodesics, sources, within), exact = voronoi_cells(geodesics, sources);
  expect_near(cells.distances, exact.distances);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const LogMap from = geodesics.log_map(sources[k]);
    for (std::size_t i = 0; i < cells.labels.size(); ++i)
      if (cells.labels[i] == static_cast<Index>(k))
        EXPECT_LE(from.distances()[i], (1 + 2.1 * tolerance) * exact.distances[i] + 1e-12);
  }
}

TEST_F(WithinATolerance, CellsEndAtTheRadius) {
  const VoronoiCells cells = voronoi_cells(geodesics, sources, {.radius = 0.4, .progress = {}});
  const VoronoiCells whole = voronoi_cells(geodesics, sources);
  for (std::size_t i = 0; i < cells.labels.size(); ++i) {
    EXPECT_EQ(cells.labels[i], whole.distances[i] <= 0.4 ? whole.labels[i] : -1);
    EXPECT_EQ(std::isnan(cells.distances[i]), whole.distances[i] > 0.4);
  }
}

TEST_F(WithinATolerance, FarthestPointsAreNearlyTheFarthest) {
  const std::vector<Vertex> chosen = farthest_points(geodesics, Vertex(0), 12, within);
  ASSERT_EQ(chosen.size(), 12U);
  for (std::size_t k = 1; k < chosen.size(); ++k) {
    const VoronoiCells before = voronoi_cells(geodesics, std::span(chosen).first(k));
    EXPECT_GE(before.distances[chosen[k].index], (1 - 2.1 * tolerance) * std::ranges::max(before.distances));
  }
}

TEST_F(WithinATolerance, MapsOfAtlasesAndCentersAre) {
  const AnySolver maps(geodesics, within), exact(geodesics);
  constexpr double everywhere = std::numeric_limits<double>::infinity();
  expect_near(maps.map(Vertex(5), everywhere).distances(), exact.map(Vertex(5), everywhere).distances());
  expect_near(maps.cells(sources).distances, exact.cells(sources).distances);

  const FaceList faces = surface.faces();
  const Atlas atlas = make_atlas(maps, sources, faces), sharp = make_atlas(exact, sources, faces);
  ASSERT_EQ(atlas.coordinates.size(), sharp.coordinates.size());
  EXPECT_NE(atlas.coordinates, sharp.coordinates);

  const Center center = karcher_mean(maps, sources), best = karcher_mean(exact, sources);
  EXPECT_NEAR(center.spread, best.spread, 2 * tolerance * best.spread);
  EXPECT_NE(center.spread, best.spread);
}

TEST_F(WithinATolerance, StrokesAre) {
  const CurvePoint given[] = {Row{3}, Row{150}, Row{411}};
  const SurfaceCurve curve = draw_curve(surface, given);
  expect_near(geodesics.log_map(curve.samples, within).map.distances(),
              geodesics.log_map(curve.samples).map.distances());
}

TEST_F(WithinATolerance, IsRefusedOutsideOfItsRange) {
  const CurvePoint given[] = {Row{3}, Row{4}};
  const SurfaceCurve curve = draw_curve(surface, given);
  for (double bad : {-1e-3, 0.11, std::numeric_limits<double>::quiet_NaN()}) {
    const ExactMapOptions options{.tolerance = bad, .progress = {}};
    const AnySolver maps(geodesics, options);
    expect_error<InvalidArgument>([&] { voronoi_cells(geodesics, sources, options); }, "'tolerance'");
    expect_error<InvalidArgument>([&] { farthest_points(geodesics, Vertex(0), 3, options); }, "'tolerance'");
    expect_error<InvalidArgument>([&] { geodesics.log_map(curve.samples, options); }, "'tolerance'");
    expect_error<InvalidArgument>([&] { make_atlas(maps, sources, surface.faces()); }, "'tolerance'");
    expect_error<InvalidArgument>([&] { karcher_mean(maps, sources); }, "'tolerance'");
  }
}

}  // namespace
}  // namespace ahm::test
