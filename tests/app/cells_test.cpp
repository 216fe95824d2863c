// Cells, spread sources and centers.
#include <algorithm>
#include <cmath>
#include <set>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

using Cells = InFolder;

TEST_F(Cells, OfTwoPointsMeetAtTheBisector) {
  const auto points = plane(30);
  write("plane.xyz", xyz(points));
  const auto sources = summary("cells plane.xyz --sources '0.2,0.3,0 0.8,0.6,0' -o cells.csv").at("sources");
  EXPECT_TRUE(read_text("cells.csv").starts_with("index,x,y,z,distance,status,label\n"));
  const Vec3 a = sources[0].at("position"), b = sources[1].at("position");
  EXPECT_EQ(points.at(sources[0].at("row")), a);
  const double h = 1.0 / 30;
  EXPECT_LT(distance(a, {0.2, 0.3, 0}), h);
  for (const Row& p : read_csv("cells.csv")) {
    const double to_a = distance(a, p.position()), to_b = distance(b, p.position());
    if (std::abs(to_a - to_b) > 2 * h) {
      EXPECT_EQ(p["label"], to_a < to_b ? 0 : 1);
    }
    // At the rim the stars of a cloud are not those of one triangulation, and paths bend a little.
    EXPECT_NEAR(p["distance"], p["label"] == 0 ? to_a : to_b, 0.02 * h);
  }
}

TEST_F(Cells, MayHaveEveryVertexAsASource) {
  const int n = 3000;
  std::string all;
  for (int i = n; i-- > 0;) all += std::to_string(i) + "\n";
  write("all.txt", all);
  write("twice.txt", all + "17\n");
  write("sphere.xyz", xyz(sphere(n)));
  for (const Row& p : table("cells sphere.xyz --sources all.txt")) {
    EXPECT_EQ(p["label"], n - 1 - p["index"]);
    EXPECT_EQ(p["distance"], 0);
  }
  expect_refused("cells sphere.xyz -o new.csv", {{"--sources twice.txt", 1, {"--sources 17"}}});
}

TEST_F(Cells, OfSpreadSourcesAreSmallerThanTheirDistances) {
  const int n = 3000;
  write("sphere.xyz", xyz(sphere(n)));
  const auto json = summary("cells sphere.xyz --count 12 --start 7 -o cells.csv");
  const auto rows = read_csv("cells.csv");
  const auto& sources = json.at("sources");
  ASSERT_EQ(sources.size(), 12U);
  EXPECT_EQ(sources[0].at("row"), 7);
  double area = 0, vertices = 0, nearest = 10;
  for (std::size_t k = 0; k < 12; ++k) {
    area += number(sources[k], "/area");
    vertices += number(sources[k], "/vertices");
    for (std::size_t l = 0; l < k; ++l)
      nearest = std::min(nearest, 2 * std::asin(distance(sources[k].at("position"), sources[l].at("position")) / 2));
    EXPECT_EQ(rows.at(sources[k].at("row"))["label"], static_cast<double>(k));
  }
  const double h = std::sqrt(4 * pi / n);
  EXPECT_EQ(vertices, n);
  EXPECT_NEAR(area, 4 * pi, 4 * pi * h);
  EXPECT_LT(number(json, "/largest_distance"), nearest + 2 * h);
}

TEST_F(Cells, OfPolygonsHaveCornersAsSources) {
  write("sheet.obj", obj(lattice(11), cells(11)));
  std::set<int> rows;
  const auto json = summary("cells sheet.obj --count 20 -o cells.csv");
  for (const auto& source : json.at("sources")) {
    const int row = source.at("row");
    EXPECT_EQ(Vec3(source.at("position")), (Vec3{row % 11 * 1.0, row / 11 * 1.0, 0}));
    rows.insert(row);
  }
  EXPECT_EQ(rows.size(), 20U);
}

TEST_F(Cells, AreMissingOnComponentsWithoutASource) {
  write("planes.xyz", xyz(joined(plane(15), moved(plane(15), {9, 0, 0}))));
  const Outcome outcome = run_ok("cells planes.xyz --sources '0 5' -o cells.csv --json -");
  for (const Row& p : read_csv("cells.csv")) {
    EXPECT_EQ(std::isnan(p["label"]), p["x"] > 5);
    EXPECT_EQ(p.status, p["x"] > 5 ? "disconnected" : "ok");
  }
  EXPECT_TRUE(has(outcome.err, "225 of 450 vertices are not connected"));
}

class Center : public InFolder {
 protected:
  const Points points = plane(25);

  Center() { write("plane.xyz", xyz(points)); }
};

TEST_F(Center, OfPointsOfAPlaneIsTheirWeightedMean) {
  const auto center = summary("center plane.xyz --points '3 170 611' --weights '1 2.5 1'").at("center");
  const Vec3 found = center.at("position");
  double spread = 0;
  for (int a = 0; a < 2; ++a) EXPECT_NEAR(found[a], (points[3][a] + 2.5 * points[170][a] + points[611][a]) / 4.5, 1e-9);
  for (const auto& [row, weight] : {std::pair{3, 1.0}, {170, 2.5}, {611, 1.0}})
    spread += weight / 4.5 * std::pow(std::hypot(points[row][0] - found[0], points[row][1] - found[1]), 2);
  EXPECT_NEAR(number(center, "/spread"), std::sqrt(spread), 1e-9);
  expect_values(center, {{"/kind", "mean"}, {"/converged", true}});
  EXPECT_EQ(center.at("vertex_position"), points.at(center.at("row")));
}

TEST_F(Center, IsTheMedianWhereTheDirectionsToThePointsCancel) {
  const Points near{{0.1, 0.1, 0}, {0.9, 0.2, 0}, {0.45, 0.9, 0}, {0.6, 0.85, 0}};
  write("list.txt", xyz(near));
  const Vec3 m = summary("center plane.xyz --points list.txt --median").at("center").at("position");
  double sum[] = {0, 0};
  for (const Vec3& position : near) {
    const Vec3 p = *std::ranges::min_element(points, {}, [&](const Vec3& x) { return distance(x, position); });
    for (int a = 0; a < 2; ++a) sum[a] += (p[a] - m[a]) / std::hypot(p[0] - m[0], p[1] - m[1]);
  }
  EXPECT_NEAR(std::hypot(sum[0], sum[1]), 0, 1e-6);
}

TEST_F(Center, OfPointsAroundThePoleOfASphereIsThePole) {
  write("sphere.xyz", xyz(sphere(3000)));
  const auto center =
      summary("center sphere.xyz --points '0.6,0,0.8 -0.3,0.519615,0.8 -0.3,-0.519615,0.8'").at("center");
  const Vec3 p = center.at("position");
  const double h = 0.065;  // spacing of the points, and how far the three points are moved to the cloud
  EXPECT_LT(std::hypot(p[0], p[1]), h);
  EXPECT_NEAR(number(center, "/spread"), std::acos(0.8), h);
}

TEST_F(Center, InAHoleIsReported) {
  auto ring = points;
  std::erase_if(ring, [](const Vec3& p) { return std::hypot(p[0] - 0.5, p[1] - 0.5) < 0.3; });
  write("ring.xyz", xyz(ring));
  EXPECT_TRUE(has(run_ok("center ring.xyz --points '0.1,0.1,0 0.9,0.9,0'").err, "in a hole"));
}

TEST_F(Center, IsPrintedWithoutTheCostIfQuiet) {
  const Outcome outcome = run_ok("center plane.xyz --points '0 8' --quiet");
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(outcome.out.starts_with("mean of 2 points"));
  EXPECT_FALSE(has(outcome.out, "peak memory"));
  expect_values(summary("center plane.xyz --points '0 8' --quiet"), {{"/center/kind", "mean"}});
}

}  // namespace
}  // namespace ahm::test
