// A bad cloud leads to an error that names the fault, or to a map with a status per row.
#include "ahm/error.hpp"
#include "clouds.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

template <class Exception>
void expect_error(const std::vector<Vec3>& points, const std::string& text, const CloudOptions& options = {},
                  const std::vector<Vec3>& normals = {}) {
  test::expect_error<Exception>([&] { PointCloudSurface::build(points, normals, options); }, text);
}

TEST(CloudFaults, OfPointsAreNamed) {
  const std::vector<Vec3> flat = flat_cloud(100).points;
  expect_error<InvalidGeometry>({}, "0 points");
  expect_error<InvalidGeometry>({{0, 0, 0}, {1, 0, 0}}, "2 points");
  expect_error<InvalidGeometry>({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, "2 distinct");
  std::vector<Vec3> line;
  for (int i = 0; i < 50; ++i) line.push_back({0.1 * i, 0.2 * i, 0.3 * i});
  expect_error<InvalidGeometry>(line, "line");
  for (double far : {1e160, 1e300}) {  // squares of lengths overflow
    std::vector<Vec3> points = flat;
    points.insert(points.begin() + 7, Vec3{0, -far, 0});
    expect_error<InvalidGeometry>(points, "point 7 has a coordinate ");
  }
  expect_error<InvalidArgument>(flat, "'normals' has 1", {}, {{0, 0, 1}});
}

TEST(CloudFaults, OfOptionsAreNamed) {
  struct Idle final : pointcloud::NeighborSearch {
    Index nearest(const Vec3&, std::span<Index> indices, std::span<double>) const override {
      indices[0] = 0;
      return 1;
    }
  };
  const std::vector<Vec3> points = flat_cloud(50).points;
  expect_error<InvalidArgument>(points, "k is 2", {.k = 2});
  expect_error<InvalidArgument>(points, "options.search",
                                {.search = [](std::span<const Vec3>) { return std::make_unique<Idle>(); }});
  expect_error<InvalidArgument>(points, "options.search", {.search = nullptr});
  expect_error<InvalidArgument>(points, "max_edge_ratio", {.max_edge_ratio = NAN});
  expect_error<InvalidArgument>(points, "smooth is -1", {.smooth = -1.0});
  expect_error<InvalidArgument>(points, "smooth is 1e+09, but the cloud is only ", {.smooth = 1e9});
  std::stop_source stop;
  stop.request_stop();
  CloudOptions stopped;
  stopped.progress.stop = stop.get_token();
  expect_error<Cancelled>(flat_cloud(5000).points, "cancelled", stopped);
}

TEST(CloudFaults, OfSourcesAndMapsAreRefused) {
  const std::vector<Vec3> points = flat_cloud(50).points;
  const SolvedCloud solved(points), other(flat_cloud(120).points);
  const auto& surface = solved.surface;
  EXPECT_THROW(surface.nearest_row({NAN, 0, 0}), InvalidArgument);
  EXPECT_THROW(surface.source(Row(50)), InvalidArgument);
  EXPECT_THROW(surface.source(Row(-1)), InvalidArgument);
  EXPECT_THROW(surface.source(Row(3), Vec3{0, 0, 0}), InvalidArgument);
  EXPECT_THROW(surface.source(Row(3), surface.graph().frame(surface.vertex(Row(3)).index)->normal), InvalidArgument);
  EXPECT_THROW(other.surface.to_rows(solved.solver.solve(surface.source(Row(0)).source)), InvalidArgument);
  EXPECT_EQ(surface.nearest_row(points[17]), Row(17));
}

TEST(CloudFaults, PointsThatAreNotFiniteAreRefusedOrRemoved) {
  std::vector<Vec3> points = flat_cloud(100).points;
  points[42][1] = NAN;
  points[77][2] = INFINITY;
  expect_error<InvalidGeometry>(points, "point 42");
  const auto surface = PointCloudSurface::build(points, {}, {.drop_non_finite = true});
  EXPECT_EQ(surface.details().non_finite, 2);
  const RowLogMap map = map_of(surface, Row(0));
  expect_nan_exactly_where_not_ok(map);
  for (std::size_t i = 0; i < 100; ++i)
    EXPECT_EQ(map.status[i], i == 42 || i == 77 ? Status::removed : Status::ok) << i;
  EXPECT_THROW(surface.source(Row(42)), InvalidArgument);
}

TEST(CloudFaults, DuplicatesAreMergedAndAllOfThemGetTheResult) {
  const std::vector<Vec3> points = flat_cloud(400).points, first(points.begin(), points.begin() + 20);
  std::vector<Vec3> copies = points;
  for (int copy = 0; copy < 40; ++copy) copies = joined(copies, first);
  const SolvedCloud solved(copies);
  EXPECT_EQ(solved.surface.details().duplicates, 800);
  const RowLogMap once = SolvedCloud(points).map(9), map = solved.map(409);  // a copy of point 9
  for (std::size_t i = 0; i < 400; ++i) ASSERT_NEAR(map.u[i], once.u[i], 1e-13);
  for (std::size_t i = 400; i < copies.size(); ++i) ASSERT_EQ(map.u[i], map.u[(i - 400) % 20]);
}

TEST(CloudFaults, FewPointsHaveExactMaps) {
  const Cloud cloud = flat_cloud(12);
  const SolvedCloud solved(cloud.points);
  EXPECT_EQ(solved.surface.details().k, 11);
  EXPECT_EQ(find_warning(solved.surface, "k_reduced").value().numbers, (std::vector<double>{30, 11, 12}));
  expect_plane_distances(solved.map(0), cloud.plane, 0, 1e-12);
  const std::vector<Vec2> triangle{{0, 0}, {3, 0}, {0, 4}};
  expect_plane_distances(SolvedCloud({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}).map(1), triangle, 1, 1e-12);
}

TEST(CloudFaults, ALineNextToASurfaceIsMaskedAndNamed) {
  std::vector<Vec3> points = flat_cloud(500).points;
  for (int i = 0; i < 200; ++i) points.push_back({100.0 + 0.01 * i, 0, 0});
  const SolvedCloud solved(points);
  EXPECT_EQ(solved.surface.details().degenerate, 200);
  const std::vector<Row> named = find_warning(solved.surface, "degenerate").value().rows;
  ASSERT_EQ(named.size(), 10U);
  EXPECT_EQ(named[0], Row(500));
  EXPECT_EQ(named[9], Row(509));
  const RowLogMap map = solved.map(3);
  expect_nan_exactly_where_not_ok(map);
  EXPECT_EQ(map.status[600], Status::removed);
  EXPECT_EQ(map.status[499], Status::ok);
}

TEST(CloudFaults, OutliersDoNotChangeTheMap) {
  const Cloud cloud = flat_cloud(2000);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Vec3> near;
  for (int i = 0; i < 20; ++i) near.push_back({3 + 3 * uniform(random), 3 * uniform(random), 4 + uniform(random)});
  std::vector<std::vector<Vec3>> outliers{near};
  for (double far : {1e6, 1e12, 1e20, 3.4e38}) outliers.push_back({{far, -far, far}});
  for (const std::vector<Vec3>& added : outliers) {
    SCOPED_TRACE(added[0][0]);
    const RowLogMap map = SolvedCloud(joined(cloud.points, added)).map(3);
    expect_plane_distances(map, cloud.plane, 3, 1e-11);
    for (std::size_t i = 2000; i < map.status.size(); ++i) EXPECT_NE(map.status[i], Status::ok);
  }
}

TEST(CloudFaults, DensityMayVaryAHundredfold) {
  // The spacing grows tenfold from the pole of the sphere to the equator.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Cloud cloud;
  while (cloud.points.size() < 20000) {
    const Vec3 p = random_sphere(1, static_cast<unsigned>(random())).points[0];
    if (uniform(random) < std::pow(0.01, std::acos(p[2]) / 3.14159)) cloud.points.push_back(p);
  }
  cloud.normals = cloud.points;
  const SolvedCloud solved(cloud.points);
  EXPECT_EQ(solved.surface.details().components, 1);
  EXPECT_LT(sphere_error(cloud, solved.surface, solved.map(5), 5).angle, 0.11);  // measured 0.095
}

TEST(CloudFaults, NoiseAddsLessErrorThanItsShareOfTheSpacing) {
  const Cloud clean = even_sphere(10000);
  const double h = 0.035;
  double clean_error = 0;
  for (double share : {0.0, 0.1, 0.3}) {
    const SolvedCloud solved(with_noise(clean, share * h).points);
    const double error = sphere_error(clean, solved.surface, solved.map(5), 5).rms;
    if (share == 0) clean_error = error;
    EXPECT_LE(error, (1 + share) * clean_error);
  }
  EXPECT_LT(clean_error, 1.6 * h);
}

TEST(CloudFaults, APartWhoseTrianglesUnderflowIsRemoved) {
  const std::vector<Vec3> points = flat_cloud(100).points;
  const RowLogMap map = SolvedCloud(joined(points, scaled(0x1p-700, points))).map(7);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(map.status[i], Status::ok) << i;
  EXPECT_GT(std::ranges::count(map.status, Status::removed), 90);
}

}  // namespace
}  // namespace ahm::test
