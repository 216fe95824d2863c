// Applications of exact maps within a tolerance.
#include "ahm/applications/atlas.hpp"
#include "ahm/applications/cells.hpp"
#include "ahm/applications/mean.hpp"
#include "ahm/applications/stroke.hpp"
#include "mapped_surfaces.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

constexpr double tolerance = 1e-2;
const ExactMapOptions within{.tolerance = tolerance, .progress = {}};

class WithinATolerance : public testing::Test {
 protected:
  const trimesh::TriangleMeshSurface surface = mesh_surface(split_icosphere(640));
  const ExactGeodesics geodesics{surface};
  const std::array<Vertex, 3> sources{Vertex(3), Vertex(200), Vertex(411)};
  const SurfaceCurve curve = draw_curve(surface, std::array<CurvePoint, 3>{Row{3}, Row{150}, Row{411}});

  /// Expects distances near the exact ones, but not equal to them.
  static void expect_near(std::span<const double> found, std::span<const double> exact) {
    ASSERT_EQ(found.size(), exact.size());
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], exact[i], tolerance * exact[i] + 1e-12) << i;
    EXPECT_FALSE(std::ranges::equal(found, exact));
  }
};

TEST_F(WithinATolerance, CellsHaveDistancesAndLabelsOfNearSources) {
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

TEST_F(WithinATolerance, MapsAtlasesCentersAndCurvesAreComputed) {
  const AnySolver maps(geodesics, within), exact(geodesics);
  expect_near(maps.map(Vertex(5), INFINITY).distances(), exact.map(Vertex(5), INFINITY).distances());
  expect_near(maps.cells(sources).distances, exact.cells(sources).distances);
  expect_near(geodesics.log_map(curve.samples, within).map.distances(),
              geodesics.log_map(curve.samples).map.distances());
  const Atlas atlas = make_atlas(maps, sources, surface.faces()),
              exact_atlas = make_atlas(exact, sources, surface.faces());
  ASSERT_EQ(atlas.coordinates.size(), exact_atlas.coordinates.size());
  EXPECT_NE(atlas.coordinates, exact_atlas.coordinates);
  const Center center = karcher_mean(maps, sources), exact_center = karcher_mean(exact, sources);
  EXPECT_NEAR(center.spread, exact_center.spread, 2 * tolerance * exact_center.spread);
  EXPECT_NE(center.spread, exact_center.spread);
}

TEST_F(WithinATolerance, TolerancesOutsideOfTheRangeAreRefused) {
  for (double bad : {-1e-3, 0.11, static_cast<double>(NAN)}) {
    const ExactMapOptions options{.tolerance = bad, .progress = {}};
    const AnySolver maps(geodesics, options);
    const std::function<void()> calls[] = {
        [&] { voronoi_cells(geodesics, sources, options); }, [&] { farthest_points(geodesics, Vertex(0), 3, options); },
        [&] { geodesics.log_map(curve.samples, options); }, [&] { make_atlas(maps, sources, surface.faces()); },
        [&] { karcher_mean(maps, sources); }};
    for (const auto& call : calls) expect_error<InvalidArgument>(call, "'tolerance'");
  }
}

}  // namespace
}  // namespace ahm::test
