// Coordinates along curves, through the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

/// The rows of a run that succeeds.
std::vector<NumberRow> stroke(const Folder& folder, const std::string& input, const std::string& curve,
                              const Words& more = {}) {
  Words words{"stroke", input, "--curve", curve, "-o", folder / "stroke.csv", "--json", folder / "stroke.json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.status == 0 ? read_numbers(folder / "stroke.csv") : std::vector<NumberRow>{};
}

/// Expects u = x - `start` and v = y - `height` in all rows, or v = height - y: a plane may be seen from either side.
void expect_straight(std::vector<NumberRow>& rows, double start, double height, double tolerance) {
  double side = 0;
  for (NumberRow& p : rows) {
    const double away = p["y"] - height;
    if (side == 0 && std::abs(away) > tolerance) side = away * p["v"] > 0 ? 1 : -1;
    ASSERT_NEAR(p["u"], p["x"] - start, tolerance);
    ASSERT_NEAR(p["v"], side * away, tolerance);
  }
}

/// A sheet of m x m quads or of twice as many triangles in the unit square, uneven.
std::string sheet(int m, bool triangles) {
  std::ostringstream text;
  text.precision(17);
  text << "OFF\n" << (m + 1) * (m + 1) << ' ' << m * m * (triangles ? 2 : 1) << " 0\n";
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= m; ++i) text << (i + 0.2 * std::sin(7.0 * j * i)) / m << ' ' << 1.0 * j / m << " 0\n";
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) {
      const int a = j * (m + 1) + i, b = a + 1, c = b + m + 1, d = a + m + 1;
      if (triangles)
        text << "3 " << a << ' ' << b << ' ' << c << "\n3 " << a << ' ' << c << ' ' << d << '\n';
      else
        text << "4 " << a << ' ' << b << ' ' << c << ' ' << d << '\n';
    }
  return text.str();
}

TEST(StrokeCommand, AStraightLineOnAPlaneOfPointsGivesThePlane) {
  const Folder folder;
  const std::string input = folder.write("plane.xyz", xyz(plane(30)));
  auto rows = stroke(folder, input, "0.21,0.4,0 0.77,0.4,0");
  ASSERT_EQ(rows.size(), 900U);
  expect_straight(rows, 0.21, 0.4, 1e-9);
  for (NumberRow& p : rows)
    EXPECT_NEAR(p["distance"], std::hypot(std::max({0.0, 0.21 - p["x"], p["x"] - 0.77}), p["y"] - 0.4), 1e-9);
  const auto summary = read_json(folder / "stroke.json"), curve = summary.at("curve");
  EXPECT_EQ(summary.at("untrusted"),
            std::count_if(rows.begin(), rows.end(), [](NumberRow& p) { return p["quality"] < 0.5; }));
  EXPECT_LT(summary.at("untrusted"), 9);
  EXPECT_NEAR(curve.at("length").get<double>(), 0.56, 1e-12);
  EXPECT_LT(curve.at("largest_gap").get<double>(), 1e-12);
  EXPECT_TRUE(read_text(folder / "stroke.csv").starts_with("index,x,y,z,u,v,distance,status,quality,spread\n"));
}

TEST(StrokeCommand, ALineAbovePointsIsMovedToThem) {
  const Folder folder;
  const std::string input = folder.write("plane.xyz", xyz(plane(30)));
  auto rows = stroke(folder, input, folder.write("line.txt", "# above\n0.2 0.4 0.01\n\n0.5 0.4 0.02\n 0.8,0.4,0.01\n"));
  expect_straight(rows, 0.2, 0.4, 1e-9);
}

TEST(StrokeCommand, PointsInFacesGiveThePlaneOnMeshes) {
  for (const bool triangles : {true, false}) {
    const Folder folder;
    const std::string input = folder.write("sheet.off", sheet(12, triangles));
    auto rows = stroke(folder, input, "0.2,0.43,0 0.5,0.43,0.3 0.9,0.43,-0.1");  // projected to faces
    expect_straight(rows, 0.2, 0.43, 1e-9);
    // The middles of two faces of a row: of quads both at the same height, of triangles the lower ones.
    const std::string middle = triangles ? ":0.25,0.5,0.25" : ":0.25,0.25,0.25,0.25";
    const int first = triangles ? 2 * (5 * 12 + 2) : 5 * 12 + 2, last = triangles ? 2 * (5 * 12 + 9) : 5 * 12 + 9;
    rows = stroke(folder, input, "face:" + std::to_string(first) + middle + " face:" + std::to_string(last) + middle);
    const double height = (triangles ? 5.25 : 5.5) / 12, start = rows[0]["x"] - rows[0]["u"];
    EXPECT_GT(start, 2.0 / 12);
    EXPECT_LT(start, 3.5 / 12);
    expect_straight(rows, start, height, 1e-9);
  }
}

TEST(StrokeCommand, ARadiusLeavesOutWhatLiesBeyondAndMovesNothing) {
  const Folder folder;
  const std::string input = folder.write("plane.xyz", xyz(plane(30))), curve = "0.21,0.4,0 0.77,0.4,0";
  auto whole = stroke(folder, input, curve), near = stroke(folder, input, curve, {"--radius", "0.2"});
  ASSERT_EQ(near.size(), whole.size());
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (std::isnan(near[i]["u"])) {
      ++beyond;
      for (const char* name : {"distance", "quality", "spread"}) EXPECT_TRUE(std::isnan(near[i][name])) << name;
    } else {
      EXPECT_EQ(near[i]["u"], whole[i]["u"]);
      EXPECT_EQ(near[i]["v"], whole[i]["v"]);
    }
    EXPECT_EQ(std::isnan(near[i]["u"]), whole[i]["distance"] > 0.2) << i;
  }
  EXPECT_GT(beyond, 0U);
}

TEST(StrokeCommand, VerticesMakeACurveToo) {
  const Folder folder;
  const std::string input = folder.write("sheet.off", sheet(12, true));
  const int row = 6 * 13;  // at y = 1/2
  auto rows =
      stroke(folder, input, std::to_string(row + 2) + " " + std::to_string(row + 5) + " " + std::to_string(row + 10));
  expect_straight(rows, rows[row + 2]["x"], 0.5, 1e-9);
}

TEST(StrokeCommand, ACircleOnAPlaneGivesThePlaneAroundItsMiddle) {
  const Folder folder;
  std::ostringstream circle;
  circle.precision(17);
  const int n = 90;
  const double radius = 0.3;
  for (int k = 0; k < n; ++k)
    circle << 0.5 + radius * std::cos(2 * std::numbers::pi * k / n) << ' '
           << 0.5 + radius * std::sin(2 * std::numbers::pi * k / n) << " 0\n";
  auto rows =
      stroke(folder, folder.write("plane.xyz", xyz(plane(30))), folder.write("circle.txt", circle.str()), {"--circle"});
  // A polygon: its sides lie inside of the circle by this much, and so do their coordinates.
  const double sagitta = radius * (1 - std::cos(std::numbers::pi / n));
  double side = 0;
  for (NumberRow& p : rows) {
    if (side == 0) side = p["v"] * (p["y"] - 0.5) > 0 ? 1 : -1;
    EXPECT_NEAR(p["u"], p["x"] - 0.5, 2 * sagitta);
    EXPECT_NEAR(p["v"], side * (p["y"] - 0.5), 2 * sagitta);
    EXPECT_NEAR(p["distance"], std::abs(std::hypot(p["x"] - 0.5, p["y"] - 0.5) - radius), 2 * sagitta);
  }
}

TEST(StrokeCommand, TheEquatorOfASphereGivesLongitudeAndLatitude) {
  const Folder folder;
  std::string equator;
  const int n = 60;
  for (int k = 0; k < n; ++k)
    equator += std::to_string(std::cos(2 * std::numbers::pi * k / n)) + "," +
               std::to_string(std::sin(2 * std::numbers::pi * k / n)) + ",0\n";
  auto rows =
      stroke(folder, folder.write("sphere.xyz", xyz(sphere(4000))), folder.write("equator.txt", equator), {"--closed"});
  const double h = std::sqrt(4 * std::numbers::pi / 4000);
  double side = 0;
  for (NumberRow& p : rows) {
    const double latitude = std::asin(p["z"]), longitude = std::atan2(p["y"], p["x"]);
    if (std::abs(latitude) > 1.5) EXPECT_LT(p["quality"], 0.5);  // all of the equator is as near
    if (std::abs(latitude) > 1) continue;
    if (side == 0 && std::abs(latitude) > h) side = latitude * p["v"] > 0 ? 1 : -1;
    EXPECT_NEAR(p["v"], side * latitude, h);
    EXPECT_NEAR(p["distance"], std::abs(latitude), 0.5 * h);
    if (std::abs(longitude) < std::numbers::pi / 2) continue;  // u jumps where the curve closes
    EXPECT_NEAR(std::remainder(p["u"] - longitude, 2 * std::numbers::pi), 0, h);
  }
  EXPECT_NEAR(read_json(folder / "stroke.json").at("curve").at("length").get<double>(), 2 * std::numbers::pi, h * h);
}

TEST(StrokeCommand, AClosedCurveAlongAOneSidedBandIsRefused) {
  const Folder folder;
  const int around = 60, across = 5;  // the last column meets the first one upside down
  std::ostringstream off;
  off.precision(17);
  off << "OFF\n" << around * across << ' ' << 2 * around * (across - 1) << " 0\n";
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double angle = 2 * std::numbers::pi * i / around, w = 0.1 * (j - across / 2);
      const double r = 1 + w * std::cos(angle / 2);
      off << r * std::cos(angle) << ' ' << r * std::sin(angle) << ' ' << w * std::sin(angle / 2) << '\n';
    }
  const auto at = [&](int i, int j) { return i < around ? i * across + j : across - 1 - j; };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j + 1 < across; ++j)
      off << "3 " << at(i, j) << ' ' << at(i + 1, j) << ' ' << at(i + 1, j + 1) << "\n3 " << at(i, j) << ' '
          << at(i + 1, j + 1) << ' ' << at(i, j + 1) << '\n';
  const std::string input = folder.write("band.off", off.str());
  std::string middle;
  for (int i = 0; i < around; ++i) middle += std::to_string(i * across + across / 2) + " ";
  const Outcome closed = run({"stroke", input, "--curve", middle, "--closed", "-o", folder / "stroke.csv"});
  EXPECT_EQ(closed.status, 1);
  EXPECT_NE(closed.err.find("one-sided"), std::string::npos) << closed.err;
  // Open, it has two sides, a little short of meeting each other: across the band v is the way from its middle.
  auto rows = stroke(folder, input, middle);
  double side = 0;
  for (int i = 5; i < around - 5; ++i)
    for (int j = 0; j < across; ++j) {
      if (j == across / 2) continue;
      NumberRow& p = rows.at(static_cast<std::size_t>(at(i, j)));
      if (side == 0) side = p["v"] * (j - across / 2) > 0 ? 1 : -1;
      EXPECT_NEAR(p["v"], side * 0.1 * (j - across / 2), 0.02);
    }
}

TEST(StrokeCommand, TwoPointsOnACloudAreJoinedAlongIt) {
  const Folder folder;
  const Outcome outcome = run(
      {"stroke", folder.write("sphere.xyz", xyz(sphere(2000))), "--curve", "1,0,0 0,1,0", "-o", folder / "stroke.csv"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
}

TEST(StrokeCommand, WarnsOfACurveThatLeavesTheSurface) {
  const Folder folder;
  std::vector<Vec3> points = sphere(2000);
  for (const Vec3& p : sphere(2000)) points.push_back({p[0] + 3, p[1], p[2]});
  const Outcome outcome =
      run({"stroke", folder.write("two.xyz", xyz(points)), "--curve", "1,0,0 2,0,0", "-o", folder / "stroke.csv"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const std::string words : {"instead of a shortest path", "does not connect their ends", "add points"})
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
}

TEST(StrokeCommand, ExplainsItself) {
  const Outcome outcome = run({"stroke", "--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const std::string word : {"--curve", "--closed", "--circle", "--view", "CURVE", "face:", "Examples"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
}

TEST(StrokeCommand, RefusesNonsenseAndLeavesNothing) {
  const Folder folder;
  const auto input = folder.write("plane.xyz", xyz(plane(10)));
  const auto bad = folder.write("bad.txt", "0 0 0\n1 zero 0\n"), empty = folder.write("empty.txt", "# nothing\n");
  const std::string out = folder / "stroke.csv";
  const auto expect = [&](const Words& more, int status, const std::string& culprit) {
    Words words{"stroke", input, "-o", out};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(culprit), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  };
  expect({}, 2, "--curve");
  expect({"--curve", "0,0,0 1,0"}, 2, "1,0");
  expect({"--curve", " "}, 2, "empty");
  expect({"--curve", bad}, 1, "line 2");
  expect({"--curve", empty}, 1, "no entries");
  expect({"--curve", "5"}, 1, "at least 2");
  expect({"--curve", "5 5 5"}, 1, "at least 2");
  expect({"--curve", "0.1,0.1,0 0.9,0.9,0", "--closed"}, 1, "turns back");
  expect({"--curve", "5 100"}, 1, "--curve 100");
  expect({"--curve", "face:0:1,0,0 face:1:1,0,0"}, 1, "--curve face");
  expect({"--curve", "0.1,0.1,0 0.9,0.1,0 0.1,0.1,0"}, 1, "turns back");
  expect({"--curve", "0,0,0 1e9,0,0"}, 1, "units");
  expect({"--curve", "0,0,0 1,0,0", "--view", folder / "stroke.jpg"}, 2, "--view");
  expect({"--curve", "0,0,0 1,0,0", "-o", folder / "nowhere/a.csv"}, 2, "--output");
  EXPECT_EQ(folder.files(), (Words{"bad.txt", "empty.txt", "plane.xyz"}));
}

TEST(StrokeCommand, GivenPositionsMoveTheMap) {
  const Folder folder;
  const std::string input = folder.write("plane.xyz", xyz(plane(30)));
  // The line y = 0.4 from x = 0.21, a quarter turned and moved: (x, y) -> (3 - (y - 0.4), 5 + x - 0.21).
  const auto rows = stroke(folder, input, "0.21,0.4,0 0.5,0.4,0 0.77,0.4,0", {"--positions", "3,5 3,5.29 3,5.56"});
  ASSERT_EQ(rows.size(), 900U);
  const double side = rows[0].at("v") != 0 && (rows[0].at("u") - 3) * (rows[0].at("y") - 0.4) > 0 ? 1 : -1;
  for (const NumberRow& p : rows) {
    ASSERT_NEAR(p.at("u"), 3 + side * (p.at("y") - 0.4), 1e-9);
    ASSERT_NEAR(p.at("v"), 5 + p.at("x") - 0.21, 1e-9);
    const double beyond = std::max({0.0, 0.21 - p.at("x"), p.at("x") - 0.77});
    ASSERT_NEAR(p.at("distance"), std::hypot(p.at("y") - 0.4, beyond), 1.0 / 30);  // an edge: it is from samples
  }
  EXPECT_EQ(read_json(folder / "stroke.json").at("curve").at("shape"), "positions");
}

TEST(StrokeCommand, PositionsThatDoNotFitAreRefused) {
  const Folder folder;
  const std::string input = folder.write("plane.xyz", xyz(plane(12)));
  const auto refused = [&](const Words& more) {
    Words words{"stroke", input, "--curve", "0.2,0.4,0 0.8,0.4,0", "-o", folder / "stroke.csv"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  EXPECT_EQ(refused({"--positions", "0,0 1,0 2,0"}).status, 2);
  EXPECT_EQ(refused({"--positions", "0,0 1,0", "--circle"}).status, 2);
  const Outcome still = refused({"--positions", "1,1 1,1"});
  EXPECT_EQ(still.status, 1);
  EXPECT_NE(still.err.find("does not advance"), std::string::npos) << still.err;
}

}  // namespace
}  // namespace ahm::test
