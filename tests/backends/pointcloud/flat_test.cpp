// On flat clouds the map is the identity up to rounding. On clouds rolled up from the plane it converges to the identity.
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/maps/wavefront.hpp"
#include "clouds.hpp"

namespace ahm::test {
namespace {

/// Largest difference between (u, v) and the position relative to a row along the axes of its frame; infinite unless all rows
/// are mapped.
double flat_error(const std::vector<Vec3>& points, const SolvedCloud& solved, Index row,
                  Variant variant = Variant::adaptive) {
  const Frame frame = *solved.surface.graph().frame(solved.surface.vertex(Row(row)).index);
  const RowLogMap map = solved.map(row, variant);
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 offset = points[i] - points[row];
    const double error = std::hypot(map.u[i] - dot(frame.x, offset), map.v[i] - dot(frame.y, offset));
    worst = map.status[i] == Status::ok ? std::max(worst, error) : INFINITY;
  }
  return worst;
}

TEST(FlatCloud, IsTheIdentityFromInteriorAndBoundary) {
  const Cloud cloud = flat_cloud(4000);
  const SolvedCloud solved(cloud.points);
  // The interior, the four corners of the square and the rim of the hole.
  std::vector<Index> sources{17, 2000};
  for (const Vec2& place : {Vec2{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0.65, 0.5}}) {
    const auto away = [&](const Vec2& p) { return length(p - place); };
    sources.push_back(static_cast<Index>(std::ranges::min_element(cloud.plane, {}, away) - cloud.plane.begin()));
  }
  for (Index row : sources)
    for (Variant variant : all_variants)
      EXPECT_LT(flat_error(cloud.points, solved, row, variant), 1e-11 * std::sqrt(2.0)) << "source " << row;
}

TEST(FlatCloud, IsTheIdentityOnARegularGrid) {
  // The corners of every cell lie on a circle: the hardest case for Delaunay triangulations.
  std::vector<Vec3> grid;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) grid.push_back({x * 1.0, y * 1.0, 0.0});
  const SolvedCloud solved(grid);
  for (Index row : {0, 820, 1599}) EXPECT_LT(flat_error(grid, solved, row), 1e-11 * 56);
}

TEST(FlatCloud, IsAsGoodFarFromTheOriginAsItsDigitsAllow) {
  for (double far : {1e6, 1e8}) {
    const std::vector<Vec3> points = joined({}, flat_cloud(1500).points, {far, far, far});
    EXPECT_LT(flat_error(points, SolvedCloud(points), 10), 100 * far * 2.3e-16);
  }
}

TEST(FlatCloud, ScalesWithItsPoints) {
  const std::vector<Vec3> points = flat_cloud(500).points;
  const RowLogMap map = SolvedCloud(points).map(3);
  for (double factor : {0x1p-990, 0x1p-20, 0x1p30, 0x1p1000, 1e-300, 1e-12, 1e12, 1e300}) {
    int exponent;
    const double tolerance = std::frexp(factor, &exponent) == 0.5 ? 0 : 1e-11;  // powers of two: the same bits
    const RowLogMap other = SolvedCloud(scaled(factor, points)).map(3);
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_NEAR(other.u[i], factor * map.u[i], factor * tolerance) << factor;
  }
}

TEST(FlatCloud, DoesNotDependOnTheOrderOfPoints) {
  const std::vector<Vec3> points = flat_cloud(1000).points;
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(2));
  std::vector<Vec3> shuffled(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) shuffled[order[i]] = points[i];
  const RowLogMap map = SolvedCloud(points).map(3), other = SolvedCloud(shuffled).map(order[3]);
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(other.u[order[i]], map.u[i]);
}

TEST(FlatCloud, HasAboutTheAreaOfTheSquare) {
  // Where local triangulations disagree, they overlap.
  const auto surface = PointCloudSurface::build(flat_cloud(4000).points);
  const CsrGraphData& graph = surface.graph().data();
  const double area = std::accumulate(graph.masses.begin(), graph.masses.end(), 0.0) * std::pow(graph.length_unit, 2);
  EXPECT_NEAR(area, 1 - 0.15 * 0.15 * 3.14159, 0.1);
}

TEST(FlatCloud, PointsItsUAxisAlongTheGivenDirection) {
  const std::vector<Vec3> points = flat_cloud(800).points;
  const Vec3 direction = points[60] - points[5];
  const RowLogMap map = map_of(PointCloudSurface::build(points), Row(5), direction);
  EXPECT_NEAR(map.u[60], norm(direction), 1e-11);
  EXPECT_NEAR(map.v[60], 0, 1e-11);
}

// Heat diffuses around a hole in a straight line; the quality is low where the shortest path bends.
TEST(FlatCloud, HasLowQualityBehindAHole) {
  std::vector<Vec3> points;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  const int side = 60;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y) {
      const Vec3 p{(x + shift(random)) / side, (y + shift(random)) / side, 0};
      if (std::abs(p[0] - 0.5) > 0.3 || std::abs(p[1] - 0.5) > 0.06) points.push_back(p);
    }
  const SolvedCloud solved(points);
  const auto& surface = solved.surface;
  const LogMap map = solved.solver.solve(surface.source(surface.nearest_row({0.5, 0.3, 0})).source);
  const std::vector<double> quality = to_rows(surface.to_rows(map), map_quality(surface.graph(), map));
  int behind = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    if (p[1] < 0.42) EXPECT_GT(quality[i], 0.99) << p[0] << ", " << p[1];
    if (p[1] < 0.6 || std::abs(p[0] - 0.5) > 0.15) continue;
    EXPECT_LT(quality[i], trusted_quality) << p[0] << ", " << p[1];
    ++behind;
  }
  EXPECT_GT(behind, 300);
}

// A line along the diagonals of squares passes between triangles that bend away from it on either side.
TEST(RolledCloud, OfSquaresIsCrossedDiagonally) {
  const int around = 120, rows = 40;
  const double h = 2 * std::numbers::pi / around;
  for (const auto& [turn, shift] : {Vec2{0, 0}, {0.5, 0}, {0, 0.01}, {0.5, 10.5}}) {
    std::vector<Vec3> points;
    for (int y = 0; y < rows; ++y)
      for (int k = 0; k < around; ++k)
        points.push_back({std::cos(h * (k + turn)) + shift, std::sin(h * (k + turn)), h * y});
    const auto surface = PointCloudSurface::build(points);
    Wavefront front(surface.graph());
    front.add(surface.source(Row(0)).source);
    front.run();
    for (int row = 0; row < rows * around; ++row) {
      const int y = row / around, k = row % around;
      const double exact = h * std::hypot(y, std::min(k, around - k));
      ASSERT_NEAR(front.distance(surface.vertex(Row(row))), exact, 0.002 * exact) << y << ", " << k;
    }
  }
}

TEST(RolledCloud, ConvergesToThePlaneWithSecondOrder) {
  const auto error = [](Index rows, Variant variant) {
    const Cloud cloud = rolled_cloud(rows, 0.5);
    const SolvedCloud solved(cloud.points, cloud.normals);
    const Index source = (rows / 2) * rows + rows / 2;
    // u along the axis of the cylinder, which is the plane's u; v is the normal times u.
    const RowLogMap map = solved.surface.to_rows(
        solved.solver.solve(solved.surface.source(Row(source), Vec3{1, 0, 0}).source, {.variant = variant}));
    return plane_error(cloud.plane, map.u, map.v, cloud.plane[source], {1, 0});
  };
  for (Variant variant : all_variants) {
    const double coarse = error(30, variant), fine = error(60, variant);
    EXPECT_GE(std::log2(coarse / fine), 1.8) << coarse << " -> " << fine;
  }
}

}  // namespace
}  // namespace ahm::test
