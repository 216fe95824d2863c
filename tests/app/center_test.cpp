// Means and medians, through the program.
#include <gtest/gtest.h>

#include <cmath>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

nlohmann::json center_of(const Folder& folder, const std::vector<Vec3>& points, const Words& more) {
  Words words{"center", folder.write("points.xyz", xyz(points)), "--json", folder / "center.json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return read_json(folder / "center.json").at("center");
}

TEST(CenterCommand, TheMeanOfPointsOfAPlaneIsTheirWeightedMean) {
  const Folder folder;
  const auto points = plane(25);
  const auto center = center_of(folder, points, {"--points", "3 170 611", "--weights", "1 2.5 1"});
  const Vec3 found = center.at("position");
  double spread = 0;
  for (int a = 0; a < 2; ++a) EXPECT_NEAR(found[a], (points[3][a] + 2.5 * points[170][a] + points[611][a]) / 4.5, 1e-9);
  for (const auto& [row, weight] : {std::pair{3, 1.0}, {170, 2.5}, {611, 1.0}})
    spread += weight / 4.5 * std::pow(std::hypot(points[row][0] - found[0], points[row][1] - found[1]), 2);
  EXPECT_NEAR(center.at("spread").get<double>(), std::sqrt(spread), 1e-9);
  EXPECT_TRUE(center.at("converged").get<bool>());
  EXPECT_EQ(center.at("vertex_position"), points.at(center.at("row")));
}

TEST(CenterCommand, AtTheMedianTheDirectionsToThePointsCancel) {
  const Folder folder;
  const auto points = plane(25);
  const auto list = folder.write("list.txt", "0.1 0.1 0\n0.9 0.2 0\n0.45 0.9 0\n0.6 0.85 0\n");
  const Vec3 m = center_of(folder, points, {"--points", list, "--median"}).at("position");
  double sum[] = {0, 0};
  for (const Vec3& wanted : {Vec3{0.1, 0.1, 0}, {0.9, 0.2, 0}, {0.45, 0.9, 0}, {0.6, 0.85, 0}}) {
    Vec3 p = points[0];
    for (const Vec3& x : points)
      if (std::hypot(x[0] - wanted[0], x[1] - wanted[1]) < std::hypot(p[0] - wanted[0], p[1] - wanted[1])) p = x;
    const double away = std::hypot(p[0] - m[0], p[1] - m[1]);
    for (int a = 0; a < 2; ++a) sum[a] += (p[a] - m[a]) / away;
  }
  EXPECT_NEAR(std::hypot(sum[0], sum[1]), 0, 1e-6);
}

TEST(CenterCommand, PointsAroundThePoleOfASphereHaveTheirMeanThere) {
  const Folder folder;
  const auto center = center_of(folder, sphere(3000), {"--points", "0.6,0,0.8 -0.3,0.519615,0.8 -0.3,-0.519615,0.8"});
  const Vec3 p = center.at("position");
  const double h = 0.065;  // between points, by which the given ones were moved as well
  EXPECT_LT(std::hypot(p[0], p[1]), h);
  EXPECT_NEAR(center.at("spread").get<double>(), std::acos(0.8), h);
}

TEST(CenterCommand, WarnsOfACenterInAHole) {
  const Folder folder;
  auto points = plane(25);
  std::erase_if(points, [](const Vec3& p) { return std::hypot(p[0] - 0.5, p[1] - 0.5) < 0.3; });
  const Outcome outcome = run({"center", folder.write("ring.xyz", xyz(points)), "--points", "0.1,0.1,0 0.9,0.9,0"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("in a hole"), std::string::npos) << outcome.err;
}

TEST(CenterCommand, ExplainsItself) {
  const Outcome outcome = run({"center", "--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const std::string word : {"--points", "--weights", "--median", "--start", "--json", "Examples"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
}

TEST(CenterCommand, RefusesNonsense) {
  const Folder folder;
  const auto input = folder.write("plane.xyz", xyz(plane(10)));
  const auto expect = [&](const Words& more, int status, const std::string& culprit) {
    Words words{"center", input};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(culprit), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  };
  expect({}, 2, "--points");
  expect({"--points", "1 -2"}, 2, "-2");
  expect({"--points", "1 200"}, 1, "--points 200");
  expect({"--points", "1 2", "--weights", "1"}, 1, "--weights");
  expect({"--points", "1 2", "--weights", "1 x"}, 2, "--weights");
  expect({"--points", "1 2", "--weights", "1 -1"}, 1, "weight");
  expect({"--points", "face:0:1,0,0"}, 1, "--points face");
  expect({"--points", "1 2", "--start", "100"}, 1, "--start 100");
  expect({"--points", "1 2", "--json", folder / "nowhere/x.json"}, 1, "nowhere");
  EXPECT_EQ(folder.files(), Words{"plane.xyz"});
}

TEST(CenterCommand, QuietIsTheResultAlone) {
  const Folder folder;
  const Words words{"center", folder.write("plane.xyz", xyz(plane(9))), "--points", "0 8", "--json"};
  Words quiet = words;
  quiet.insert(quiet.end(), {folder / "c.json", "--quiet"});
  const Outcome outcome = run(quiet);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out.substr(0, 16), "mean of 2 points");
  EXPECT_EQ(outcome.out.find("peak memory"), std::string::npos);
  quiet = words;
  quiet.insert(quiet.end(), {"-", "--quiet"});
  EXPECT_EQ(nlohmann::json::parse(run(quiet).out).at("center").at("kind"), "mean");
}

}  // namespace
}  // namespace ahm::test
