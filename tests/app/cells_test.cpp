// Cells and spread points, through the program.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

TEST(CellsCommand, TwoPointsOfAPlaneShareItAtTheirBisector) {
  const Folder folder;
  const auto points = plane(30);
  const std::string out = folder / "cells.csv";
  const Outcome outcome = run({"cells", folder.write("plane.xyz", xyz(points)), "--sources", "0.2,0.3,0 0.8,0.6,0",
                               "-o", out, "--json", folder / "cells.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(read_text(out).starts_with("index,x,y,z,distance,status,label\n"));
  const auto json = read_json(folder / "cells.json");
  const Vec3 a = json.at("sources")[0].at("position"), b = json.at("sources")[1].at("position");
  EXPECT_EQ(points.at(json.at("sources")[0].at("row")), a);
  const double h = 1.0 / 30;
  EXPECT_LT(distance(a, {0.2, 0.3, 0}), h);
  for (NumberRow p : read_numbers(out)) {
    const Vec3 x{p["x"], p["y"], p["z"]};
    const double to_a = distance(a, x), to_b = distance(b, x);
    if (std::abs(to_a - to_b) > 2 * h) {
      EXPECT_EQ(p["label"], to_a < to_b ? 0 : 1);
    }
    // Along the rim the stars of a cloud are not those of one triangulation, and the way bends a little.
    EXPECT_NEAR(p["distance"], p["label"] == 0 ? to_a : to_b, 0.02 * h);
  }
}

TEST(CellsCommand, TakesEveryVertexAsASource) {
  const Folder folder;
  const int n = 3000;
  std::string all;
  for (int i = n; i-- > 0;) all += std::to_string(i) + "\n";
  const auto input = folder.write("sphere.xyz", xyz(sphere(n)));
  const std::string out = folder / "cells.csv";
  const Outcome outcome = run({"cells", input, "--sources", folder.write("all.txt", all), "-o", out});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (NumberRow p : read_numbers(out)) {
    EXPECT_EQ(p["label"], n - 1 - p["index"]);
    EXPECT_EQ(p["distance"], 0);
  }
  const Outcome twice = run({"cells", input, "--sources", folder.write("twice.txt", all + "17\n"), "-o", out});
  EXPECT_EQ(twice.status, 1);
  EXPECT_NE(twice.err.find("--sources 17"), std::string::npos) << twice.err;
}

TEST(CellsCommand, SpreadSourcesLieFartherApartThanAnyPointFromItsSource) {
  const Folder folder;
  const int n = 3000;
  const std::string out = folder / "cells.csv";
  const Outcome outcome = run({"cells", folder.write("sphere.xyz", xyz(sphere(n))), "--count", "12", "--start", "7",
                               "-o", out, "--json", folder / "cells.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = read_json(folder / "cells.json");
  const auto& sources = json.at("sources");
  ASSERT_EQ(sources.size(), 12U);
  EXPECT_EQ(sources[0].at("row"), 7);
  double area = 0, vertices = 0, nearest = 10;
  for (std::size_t k = 0; k < 12; ++k) {
    area += sources[k].at("area").get<double>();
    vertices += sources[k].at("vertices").get<double>();
    for (std::size_t l = 0; l < k; ++l)
      nearest = std::min(nearest, 2 * std::asin(distance(sources[k].at("position"), sources[l].at("position")) / 2));
  }
  const double h = std::sqrt(4 * std::numbers::pi / n);
  EXPECT_EQ(vertices, n);
  EXPECT_NEAR(area, 4 * std::numbers::pi, 4 * std::numbers::pi * h);
  EXPECT_LT(json.at("largest_distance").get<double>(), nearest + 2 * h);
  std::vector<NumberRow> rows = read_numbers(out);
  std::vector<bool> seen(12, false);
  for (NumberRow& p : rows) seen.at(static_cast<std::size_t>(p["label"])) = true;
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_TRUE(seen[k]);
    EXPECT_EQ(rows.at(sources[k].at("row"))["label"], static_cast<double>(k));  // cells contain their source
  }
}

TEST(CellsCommand, SpreadSourcesOfPolygonsAreTheirCorners) {
  const Folder folder;
  std::string off = "OFF\n121 100 0\n";
  for (int j = 0; j <= 10; ++j)
    for (int i = 0; i <= 10; ++i) off += std::to_string(i) + " " + std::to_string(j) + " 0\n";
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 10; ++i) {
      const int a = 11 * j + i;
      for (int corner : {4, a, a + 1, a + 12, a + 11}) off += std::to_string(corner) + " ";
      off += "\n";
    }
  const Outcome outcome = run({"cells", folder.write("sheet.off", off), "--count", "20", "-o", folder / "cells.csv",
                               "--json", folder / "cells.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::set<int> rows;
  const auto json = read_json(folder / "cells.json");
  for (const auto& source : json.at("sources")) {
    const int row = source.at("row");
    EXPECT_EQ(Vec3(source.at("position")), (Vec3{row % 11 * 1.0, row / 11 * 1.0, 0}));
    rows.insert(row);
  }
  EXPECT_EQ(rows.size(), 20U);
}

TEST(CellsCommand, PartsWithoutASourceHaveNoCell) {
  const Folder folder;
  auto points = plane(15);
  const std::size_t half = points.size();
  for (std::size_t i = 0; i < half; ++i) points.push_back({points[i][0] + 9, points[i][1], 0});
  const std::string out = folder / "cells.csv";
  const Outcome outcome =
      run({"cells", folder.write("planes.xyz", xyz(points)), "--sources", "0 5", "-o", out, "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (NumberRow p : read_numbers(out)) EXPECT_EQ(std::isnan(p["label"]), p["x"] > 5);
  EXPECT_NE(read_text(out).find(",disconnected,nan"), std::string::npos);
  EXPECT_NE(outcome.err.find("50 % of the vertices are not connected"), std::string::npos) << outcome.err;
}

TEST(CellsCommand, ExplainsItself) {
  const Outcome outcome = run({"cells", "--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const std::string word : {"--sources", "--count", "--start", "--view", "label", "Examples"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
}

TEST(CellsCommand, RefusesNonsenseAndLeavesNothing) {
  const Folder folder;
  const auto input = folder.write("plane.xyz", xyz(plane(10)));
  const auto expect = [&](const Words& more, int status, const std::string& culprit) {
    Words words{"cells", input, "-o", folder / "cells.csv"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(culprit), std::string::npos) << outcome.err;
  };
  expect({}, 2, "--sources");
  expect({"--sources", "1", "--count", "2"}, 2, "--count");
  expect({"--sources", "1", "--start", "2"}, 2, "--count");
  expect({"--count", "0"}, 2, "--count");
  expect({"--count", "101"}, 1, "--count 101");
  expect({"--sources", "1 x"}, 2, "'x'");
  expect({"--sources", "1 100"}, 1, "--sources 100");
  expect({"--sources", "1 2 1"}, 1, "once");
  expect({"--sources", "face:0:1,0,0"}, 1, "--sources face");
  EXPECT_EQ(folder.files(), Words{"plane.xyz"});
}

}  // namespace
}  // namespace ahm::test
