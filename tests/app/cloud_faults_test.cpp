// Clouds that are hard: duplicates, too few points, lines, clusters, walls, normals of either sign.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

struct Result {
  Outcome outcome;
  std::vector<Row> rows;
  nlohmann::json json;
};

/// Maps a cloud that must succeed.
Result map_cloud(const std::string& cloud, Words more = {}) {
  Folder folder;
  Words words = {
      "logmap",           folder.write("cloud.xyz", cloud), "--source", "0", "-o", folder / "map.csv", "--json",
      folder / "map.json"};
  words.insert(words.end(), more.begin(), more.end());
  Result result{run(words), {}, {}};
  EXPECT_EQ(result.outcome.status, 0) << result.outcome.err;
  if (result.outcome.status == 0)
    result.rows = read_csv(folder / "map.csv"), result.json = read_json(folder / "map.json");
  return result;
}

/// Maps a cloud that must be refused with a message that contains the word.
void expect_refused(const std::string& cloud, const std::string& word, Words more = {}) {
  Folder folder;
  Words words = {"logmap", folder.write("cloud.xyz", cloud), "--source", "0", "-o", folder / "map.csv"};
  words.insert(words.end(), more.begin(), more.end());
  const auto outcome = run(words);
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  EXPECT_EQ(folder.files(), Words{"cloud.xyz"});
}

std::vector<Vec3> moved(std::vector<Vec3> points, const Vec3& by, double scale = 1.0) {
  for (Vec3& p : points)
    for (std::size_t a = 0; a < 3; ++a) p[a] = scale * p[a] + by[a];
  return points;
}

std::vector<Vec3> joined(std::vector<Vec3> a, const std::vector<Vec3>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::size_t count(const Result& r, const std::string& status) {
  return static_cast<std::size_t>(
      std::count_if(r.rows.begin(), r.rows.end(), [&](const Row& row) { return row.status == status; }));
}

TEST(CloudFaults, EqualPointsShareOneResult) {
  const auto once = plane(20);
  const auto result = map_cloud(xyz(joined(once, once)));
  ASSERT_EQ(result.rows.size(), 2 * once.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(result.rows[i].status, "ok");
    EXPECT_EQ(result.rows[i].u, result.rows[i + once.size()].u);
    EXPECT_EQ(result.rows[i].v, result.rows[i + once.size()].v);
  }
  EXPECT_EQ(result.json.at("pointcloud").at("duplicates"), once.size());
}

TEST(CloudFaults, TooFewPointsAreRefused) {
  expect_refused("0 0 0\n", "3");
  expect_refused("0 0 0\n1 0 0\n", "3");
  expect_refused("0 0 0\n0 0 0\n0 0 0\n0 0 0\n", "distinct");
}

TEST(CloudFaults, PointsOnALineAreRefused) {
  std::string line;
  for (int i = 0; i < 50; ++i) line += std::to_string(i) + " 0 0\n";
  expect_refused(line, "line");
}

TEST(CloudFaults, FewerPointsThanNeighboursAreEnough) {
  const auto points = plane(3);
  const auto result = map_cloud(xyz(points));
  EXPECT_EQ(count(result, "ok"), 9U);
  EXPECT_EQ(result.json.at("pointcloud").at("k"), 8);
  EXPECT_FALSE(result.json.at("warnings").empty());
  EXPECT_NE(result.outcome.err.find("warning"), std::string::npos);
}

TEST(CloudFaults, AnotherClusterIsMarked) {
  const auto one = plane(20);
  const auto result = map_cloud(xyz(joined(one, moved(plane(20), {50, 0, 0}))));
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    EXPECT_EQ(result.rows[i].status, i < one.size() ? "ok" : "disconnected") << i;
    EXPECT_EQ(std::isnan(result.rows[i].u), i >= one.size());
  }
  EXPECT_EQ(result.json.at("status").at("disconnected"), one.size());
}

TEST(CloudFaults, AStrayPointIsMarked) {
  auto points = plane(20);
  points.push_back({0.5, 0.5, 30});
  const auto result = map_cloud(xyz(points));
  EXPECT_NE(result.rows.back().status, "ok");
  EXPECT_EQ(count(result, "ok"), points.size() - 1);
}

#ifdef AHM_WITH_PCL
TEST(CloudFaults, OutliersAreRemovedOnRequest) {
  auto points = plane(20);
  points.push_back({0.5, 0.5, 0.4});
  const auto result = map_cloud(xyz(points), {"--outliers"});
  EXPECT_EQ(result.rows.back().status, "removed");
  std::swap(points.front(), points.back());
  expect_refused(xyz(points), "--outliers", {"--outliers"});
}

TEST(CloudFaults, VoxelsThatOverflowAreRefused) { expect_refused(xyz(plane(20)), "--voxel", {"--voxel", "1e-12"}); }
#endif

TEST(CloudFaults, NonFinitePointsAreRefusedByIndexOrDropped) {
  auto points = plane(20);
  points[17][1] = std::numeric_limits<double>::quiet_NaN();
  points[30][2] = std::numeric_limits<double>::infinity();
  expect_refused(xyz(points), "17");
  expect_refused(xyz(points), "--drop-nan");
  const auto result = map_cloud(xyz(points), {"--drop-nan"});
  ASSERT_EQ(result.rows.size(), points.size());
  for (std::size_t i = 0; i < result.rows.size(); ++i)
    EXPECT_EQ(result.rows[i].status, i == 17 || i == 30 ? "removed" : "ok") << i;
  std::swap(points[0], points[17]);
  expect_refused(xyz(points), "--source 0", {"--drop-nan"});
}

TEST(CloudFaults, NormalsOfEitherSignGiveTheSameMap) {
  const auto points = sphere(3000);
  auto flipped = points;
  for (std::size_t i = 0; i < flipped.size(); i += 2)
    for (double& x : flipped[i]) x = -x;
  const auto clean = map_cloud(xyz(points, points));
  const auto mixed = map_cloud(xyz(points, flipped));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i][2] < -0.9) continue;  // about the cut locus
    EXPECT_NEAR(mixed.rows[i].distance, clean.rows[i].distance, 1e-6);
  }
}

TEST(CloudFaults, MissingNormalsAreEstimated) {
  const auto points = plane(20);
  std::vector<Vec3> normals(points.size(), Vec3{0, 0, 1});
  normals[5] = {0, 0, 0};
  for (const std::vector<std::string>& how : {std::vector<std::string>{}, {"--normals", "estimate"}})
    EXPECT_EQ(count(map_cloud(xyz(points, normals), how), "ok"), points.size());
  expect_refused(xyz(points), "--normals oriented", {"--normals", "oriented"});
}

TEST(CloudFaults, AUAxisOffTheSurfaceIsRefused) { expect_refused(xyz(plane(20)), "--u-axis", {"--u-axis", "0,0,1"}); }

TEST(CloudFaults, TwoSheetsOfAThinWallStayApart) {
  const auto front = plane(30);  // spacing 0.033
  const auto back = moved(front, {0, 0, 0.012});
  std::vector<Vec3> normals(front.size(), Vec3{0, 0, -1});
  normals.resize(2 * front.size(), Vec3{0, 0, 1});
  const auto result = map_cloud(xyz(joined(front, back), normals));
  EXPECT_GT(result.json.at("pointcloud").at("rejected_normals").get<long>(), 0);
  for (std::size_t i = 0; i < front.size(); ++i) {
    EXPECT_EQ(result.rows[i].status, "ok");
    EXPECT_NEAR(result.rows[i].distance, std::hypot(front[i][0] - front[0][0], front[i][1] - front[0][1]), 1e-9);
    EXPECT_EQ(result.rows[i + front.size()].status, "disconnected");
  }
}

TEST(CloudFaults, ScaleAndPlaceDoNotMatter) {
  const auto points = sphere(800);
  const auto plain = map_cloud(xyz(points));
  for (double scale : {1e-200, 1e200}) {
    const auto scaled = map_cloud(xyz(moved(points, {0, 0, 0}, scale)));
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_NEAR(scaled.rows[i].distance / scale, plain.rows[i].distance, 1e-6) << scale;
  }
  const auto away = map_cloud(xyz(moved(points, {1e6, -2e6, 5e5})));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i][2] < -0.9) continue;
    EXPECT_NEAR(away.rows[i].distance, plain.rows[i].distance, 1e-6);
  }
}

}  // namespace
}  // namespace ahm::test
