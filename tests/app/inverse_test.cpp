// Points of a surface at given coordinates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "program.hpp"

namespace ahm::test {
namespace {

TEST(InverseCommand, FindsThePointsOfAPlane) {
  Folder folder;
  const auto points = plane(30);  // point 0 is its middle
  const std::string out = folder / "points.csv", json = folder / "points.json";
  const Outcome outcome =
      run({"inverse", folder.write("plane.xyz", xyz(points)), "-s", "0", "--u-axis", "1,0,0", "--at",
           folder.write("at.txt", "# pairs\n0 0\n0.1,0.2\n-0.3 0.05\n50 0\n"), "-o", out, "--json", json});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = read_numbers(out);
  ASSERT_EQ(rows.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) {
    NumberRow p = rows[i];
    EXPECT_NEAR(p["x"], points[0][0] + p["u"], 1e-9);
    EXPECT_NEAR(p["y"], points[0][1] + p["nz"] * p["v"], 1e-9);  // the plane may be seen from either side
    EXPECT_NEAR(p["z"], 0, 1e-12);
    EXPECT_NEAR(p["hx"], 1, 1e-9);
  }
  EXPECT_NE(rows[1].at("y"), rows[0].at("y"));
  EXPECT_TRUE(std::isnan(rows[3].at("x")));  // beyond the border
  EXPECT_EQ(read_json(json).at("found"), 3);
}

TEST(InverseCommand, OfTheSurroundingsAloneIsThatOfTheWholeCloud) {
  Folder folder;
  const auto points = plane(40);
  const auto input = folder.write("plane.xyz", xyz(points, std::vector<Vec3>(points.size(), Vec3{0, 0, 1})));
  const auto at = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "inverse", input, "-s", "0", "--u-axis", "1,0,0", "--at", "0.1,0.2 -0.05,0.1", "-o", folder / "at.csv"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_numbers(folder / "at.csv");
  };
  const auto whole = at({}), local = at({"--local"});
  ASSERT_EQ(whole.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i)
    for (const char* name : {"x", "y", "z", "nx", "hx"})
      EXPECT_NEAR(whole[i].at(name), local[i].at(name), 1e-9) << name;
  EXPECT_EQ(run({"inverse", input, "-s", "0", "--at", "0,0", "--local", "-o", folder / "o.csv"}).status, 1);
}

/// How far `ahm inverse` leads from the points whose coordinates `ahm logmap` tells, each with options of its own.
double farthest_back(const std::vector<std::string>& there, const std::vector<std::string>& back) {
  Folder folder;
  const auto points = sphere(2000);
  const std::string input = folder.write("sphere.xyz", xyz(points)), map = folder / "map.csv";
  const auto succeeds = [](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  };
  succeeds({"logmap", input, "-s", "0", "-o", map}, there);
  std::string at;
  std::vector<std::size_t> asked;
  const auto rows = read_numbers(map);
  for (std::size_t i = 1; i < rows.size(); i += 97) {
    if (rows[i].at("distance") > 2) continue;
    at += std::to_string(rows[i].at("u")) + "," + std::to_string(rows[i].at("v")) + " ";
    asked.push_back(i);
  }
  succeeds({"inverse", input, "-s", "0", "--at", at, "-o", folder / "points.csv"}, back);
  const auto found = read_numbers(folder / "points.csv");
  EXPECT_EQ(found.size(), asked.size());
  EXPECT_GT(found.size(), 5U);
  double farthest = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Vec3& p = points[asked[k]];
    farthest =
        std::max(farthest, std::hypot(found[k].at("x") - p[0], found[k].at("y") - p[1], found[k].at("z") - p[2]));
  }
  return farthest;
}

TEST(InverseCommand, GoesBackWhereALogmapOfTheSameOptionsCameFrom) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, {"--t-coef", "4"}, {"--strategy", "march"}, {"--variant", "localized"}})
    EXPECT_LT(farthest_back(options, options), 1e-5);
  EXPECT_GT(farthest_back({"--t-coef", "4"}, {}), 1e-3);
}

TEST(InverseCommand, RefusesNonsense) {
  Folder folder;
  const std::string input = folder.write("plane.xyz", xyz(plane(5)));
  EXPECT_EQ(run({"inverse", input, "-s", "0", "--at", "1,2,3", "-o", folder / "o.csv"}).status, 2);
  EXPECT_EQ(run({"inverse", input, "-s", "0", "--at", "", "-o", folder / "o.csv"}).status, 2);
  EXPECT_EQ(run({"inverse", input, "-s", "0", "--at", "1,nan", "-o", folder / "o.csv"}).status, 2);
  EXPECT_EQ(run({"inverse", input, "-s", "0", "--at", "0,0", "-o", folder / "o.obj"}).status, 1);
  EXPECT_EQ(
      run({"inverse", input, "-s", "0", "--at", "0,0", "-o", folder / "o.csv", "--method", "exact", "--t-coef", "2"})
          .status,
      2);
}

}  // namespace
}  // namespace ahm::test
