// What a bad cloud gets: an error that names the culprit, or a result with a status per point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"
#include "solved_cloud.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

using pointcloud::CloudOptions;
using pointcloud::PointCloudSurface;

template <class Exception>
void expect_error(const std::vector<Vec3>& points, const std::string& text, const CloudOptions& options = {},
                  const std::vector<Vec3>& normals = {}) {
  test::expect_error<Exception>([&] { PointCloudSurface::build(points, normals, options); }, text);
}

void expect_nan_exactly_where_not_ok(const RowLogMap& map) {
  for (std::size_t i = 0; i < map.status.size(); ++i)
    for (double x : {map.u[i], map.v[i], map.distance[i], map.angle[i]})
      ASSERT_EQ(std::isnan(x), map.status[i] != Status::ok);
}

TEST(CloudFaults, TooFewPoints) {
  expect_error<InvalidGeometry>({}, "0 points");
  expect_error<InvalidGeometry>({{0, 0, 0}, {1, 0, 0}}, "2 points");
  expect_error<InvalidGeometry>({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, "2 distinct");
}

TEST(CloudFaults, PointsThatAreNotFinite) {
  std::vector<Vec3> points = flat_cloud(100).points;
  points[42][1] = NAN;
  points[77][2] = INFINITY;
  expect_error<InvalidGeometry>(points, "point 42");
  CloudOptions drop;
  drop.drop_non_finite = true;
  const auto graph = PointCloudSurface::build(points, {}, drop);
  EXPECT_EQ(graph.details().non_finite, 2);
  const LogMapSolver solver(graph.graph());
  const RowLogMap map = graph.to_rows(solver.solve(graph.source(Row(0)).source));
  expect_nan_exactly_where_not_ok(map);
  EXPECT_EQ(map.status[42], Status::removed);
  EXPECT_EQ(map.status[77], Status::removed);
  EXPECT_EQ(map.status[43], Status::ok);
  EXPECT_THROW(graph.source(Row(42)), InvalidArgument);
  EXPECT_THROW(graph.source(Row(100)), InvalidArgument);
  EXPECT_THROW(graph.source(Row(-1)), InvalidArgument);
}

TEST(CloudFaults, DuplicatesAreMergedAndAllOfThemGetTheResult) {
  Cloud cloud = flat_cloud(400);
  const RowLogMap once = Solved(cloud).map(9);
  for (int copy = 0; copy < 40; ++copy)
    for (int i = 0; i < 20; ++i) cloud.points.push_back(cloud.points[i]);
  const Solved solved(cloud);
  EXPECT_EQ(solved.graph.details().duplicates, 800);
  const RowLogMap map = solved.map(409);  // a copy of point 9
  for (std::size_t i = 0; i < 400; ++i) ASSERT_NEAR(map.u[i], once.u[i], 1e-13);
  for (std::size_t i = 400; i < cloud.points.size(); ++i) ASSERT_EQ(map.u[i], map.u[(i - 400) % 20]);
}

TEST(CloudFaults, FewerPointsThanNeighboursAskedFor) {
  const Cloud cloud = flat_cloud(12);
  const Solved solved(cloud);
  EXPECT_EQ(solved.graph.details().k, 11);
  EXPECT_EQ(solved.graph.warnings().at(0).id, "k_reduced");
  EXPECT_EQ(solved.graph.warnings().at(0).numbers, (std::vector<double>{30, 11, 12}));
  const RowLogMap map = solved.map(0);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_NEAR(map.distance[i],
                std::hypot(cloud.plane[i][0] - cloud.plane[0][0], cloud.plane[i][1] - cloud.plane[0][1]), 1e-12);
}

TEST(CloudFaults, ThreePointsAreATriangle) {
  const Cloud cloud{{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {}, {}};
  const RowLogMap map = Solved(cloud).map(1);
  EXPECT_NEAR(map.distance[0], 3, 1e-12);
  EXPECT_NEAR(map.distance[2], 5, 1e-12);
}

TEST(CloudFaults, CollinearPoints) {
  std::vector<Vec3> line;
  for (int i = 0; i < 50; ++i) line.push_back({0.1 * i, 0.2 * i, 0.3 * i});
  expect_error<InvalidGeometry>(line, "line");
}

TEST(CloudFaults, ALineBesideASurfaceIsMaskedAndNamed) {
  Cloud cloud = flat_cloud(500);
  for (int i = 0; i < 200; ++i) cloud.points.push_back({100.0 + 0.01 * i, 0, 0});
  const Solved solved(cloud);
  EXPECT_EQ(solved.graph.details().degenerate, 200);
  std::vector<Row> named;
  for (const Warning& warning : solved.graph.warnings())
    if (warning.id == "degenerate") named = warning.rows;
  ASSERT_EQ(named.size(), 10U);
  EXPECT_EQ(named[0], Row(500));
  EXPECT_EQ(named[9], Row(509));
  const RowLogMap map = solved.map(3);
  expect_nan_exactly_where_not_ok(map);
  EXPECT_EQ(map.status[600], Status::removed);
  EXPECT_EQ(map.status[499], Status::ok);
}

TEST(CloudFaults, ScanLinesFarApartFindTheirPlanesInAWiderNeighbourhood) {
  // Points ten times denser along the lines than across: the 30 nearest of most points lie on one line.
  Cloud cloud;
  for (int line = 0; line < 12; ++line)
    for (int i = 0; i < 120; ++i) cloud.points.push_back({0.05 * i, 1.0 * line, 0.0});
  const Solved solved(cloud);
  EXPECT_EQ(solved.graph.details().degenerate, 0);
  EXPECT_EQ(solved.graph.rows().row_count(), solved.graph.details().vertices);
}

TEST(CloudFaults, SeparateClustersAreMasked) {
  Cloud cloud = random_sphere(1500);
  const std::size_t first = cloud.points.size();
  for (const Vec3& p : random_sphere(1500, 2).points) cloud.points.push_back({p[0] + 10, p[1], p[2]});
  const Solved solved(cloud);
  EXPECT_EQ(solved.graph.details().components, 2);
  const RowLogMap map = solved.map(3);
  expect_nan_exactly_where_not_ok(map);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    ASSERT_EQ(map.status[i], i < first ? Status::ok : Status::disconnected);
}

TEST(CloudFaults, IsolatedOutliersDoNotBendTheMap) {
  Cloud cloud = flat_cloud(2000);
  const std::size_t first = cloud.points.size();
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 20; ++i)
    cloud.points.push_back({3 + 3 * uniform(random), 3 * uniform(random), 4 + uniform(random)});
  const Solved solved(cloud);
  const RowLogMap map = solved.map(3);
  for (std::size_t i = first; i < cloud.points.size(); ++i) EXPECT_NE(map.status[i], Status::ok);
  for (std::size_t i = 0; i < first; ++i) {
    ASSERT_EQ(map.status[i], Status::ok);
    ASSERT_NEAR(map.distance[i],
                std::hypot(cloud.plane[i][0] - cloud.plane[3][0], cloud.plane[i][1] - cloud.plane[3][1]), 1e-11);
  }
}

TEST(CloudFaults, AStrayPointFarAwayCostsTheOthersNoDigit) {
  const Cloud cloud = flat_cloud(1000);
  for (double far : {1e6, 1e12, 1e20, 3.4e38}) {
    Cloud with_stray = cloud;
    with_stray.points.push_back({far, -far, far});
    const Solved solved(with_stray);
    const RowLogMap map = solved.map(3);
    EXPECT_NE(map.status.back(), Status::ok);
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
      ASSERT_NEAR(map.distance[i],
                  std::hypot(cloud.plane[i][0] - cloud.plane[3][0], cloud.plane[i][1] - cloud.plane[3][1]), 1e-11)
          << far;
  }
}

TEST(CloudFaults, APointTooFarAwayForSquaresOfLengthsIsRefused) {
  for (double far : {1e160, 1e300}) {
    Cloud cloud = flat_cloud(100);
    cloud.points.insert(cloud.points.begin() + 7, Vec3{0, -far, 0});
    expect_error<InvalidGeometry>(cloud.points, "point 7 has a coordinate ");
  }
}

TEST(CloudFaults, AMapOfAnotherGraphIsRefused) {
  const Solved one(flat_cloud(100)), two(flat_cloud(120));
  const LogMap map = one.solver.solve(one.graph.source(Row(0)).source);
  EXPECT_THROW(two.graph.to_rows(map), InvalidArgument);
}

TEST(CloudFaults, ASearchThatDoesNotSearchIsRefused) {
  struct Idle final : pointcloud::NeighborSearch {
    Index nearest(const Vec3&, std::span<Index> indices, std::span<double>) const override {
      indices[0] = 0;
      return 1;
    }
  };
  CloudOptions options;
  options.search = [](std::span<const Vec3>) { return std::make_unique<Idle>(); };
  expect_error<InvalidArgument>(flat_cloud(50).points, "options.search", options);
  options.search = [](std::span<const Vec3>) { return std::unique_ptr<pointcloud::NeighborSearch>(); };
  expect_error<InvalidArgument>(flat_cloud(50).points, "options.search", options);
  options.search = nullptr;
  expect_error<InvalidArgument>(flat_cloud(50).points, "options.search", options);
}

TEST(CloudFaults, DensityThatVariesAHundredfold) {
  // Spacing grows tenfold from the pole to the equator of the sphere.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Cloud cloud;
  while (cloud.points.size() < 20000) {
    const Vec3 p = random_sphere(1, static_cast<unsigned>(random())).points[0];
    if (uniform(random) < std::pow(0.01, std::acos(p[2]) / 3.14159)) cloud.points.push_back(p);
  }
  cloud.normals = cloud.points;
  const Solved solved(cloud);
  EXPECT_EQ(solved.graph.details().components, 1);
  EXPECT_LT(sphere_error(cloud, solved.graph, solved.map(5), 5).angle, 0.11);  // measured 0.095
}

TEST(CloudFaults, NoiseDegradesGracefully) {
  const Cloud clean = even_sphere(10000);
  const double h = 0.035;
  double clean_error = 0;
  for (double share : {0.0, 0.1, 0.3}) {
    Cloud noisy = clean;
    std::mt19937_64 random(6);
    std::normal_distribution<double> normal;
    for (Vec3& p : noisy.points) {
      const double factor = 1 + share * h * normal(random);
      for (double& c : p) c *= factor;
    }
    const Solved solved(noisy);
    const SphereError error = sphere_error(clean, solved.graph, solved.map(5), 5);
    if (share == 0) clean_error = error.rms;
    EXPECT_LE(error.rms, (1 + share) * clean_error);  // noise of a share of h adds less than that share
  }
  EXPECT_LT(clean_error, 1.6 * h);
}

TEST(CloudFaults, ArgumentsOutOfRange) {
  const std::vector<Vec3> points = flat_cloud(50).points;
  CloudOptions options;
  options.k = 2;
  expect_error<InvalidArgument>(points, "k is 2", options);
  options = {};
  options.max_edge_ratio = NAN;
  expect_error<InvalidArgument>(points, "max_edge_ratio", options);
  expect_error<InvalidArgument>(points, "'normals' has 1 entries", {}, {{0, 0, 1}});
  const auto graph = PointCloudSurface::build(points);
  EXPECT_THROW(graph.nearest_row({NAN, 0, 0}), InvalidArgument);
  EXPECT_THROW(graph.source(Row(3), Vec3{0, 0, 0}), InvalidArgument);
  EXPECT_THROW(graph.source(Row(3), graph.graph().frame(graph.vertex(Row(3)).index)->normal), InvalidArgument);
  EXPECT_EQ(graph.nearest_row(points[17]).index, 17);
}

// Beside another part its triangles are smaller than any number.
TEST(CloudFaults, PartsWithoutAreaBesideOthersAreRemoved) {
  std::vector<Vec3> points = flat_cloud(100).points;
  for (std::size_t i = 0; i < 100; ++i) points.push_back(0x1p-700 * points[i]);
  const auto surface = PointCloudSurface::build(points);
  const RowLogMap map = surface.to_rows(LogMapSolver(surface.graph()).solve(surface.source(Row(7)).source));
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(map.status[i], Status::ok) << i;
  EXPECT_GT(std::count(map.status.begin(), map.status.end(), Status::removed), 90);
}

TEST(CloudFaults, CancellationStopsTheBuild) {
  std::stop_source stop;
  stop.request_stop();
  CloudOptions options;
  options.progress.stop = stop.get_token();
  expect_error<Cancelled>(flat_cloud(5000).points, "cancelled", options);
}

}  // namespace
}  // namespace ahm::test
