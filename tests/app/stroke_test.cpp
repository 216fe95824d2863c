// Coordinates along curves.
#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

class Stroke : public InFolder {
 protected:
  Stroke() { write("plane.xyz", xyz(plane(30))); }
};

/// Expects u = x - `start` and v = y - `height`, or v = height - y: the normal of a plane may have either sign.
void expect_straight(const std::vector<Row>& rows, double start, double height) {
  double side = 0;
  for (const Row& p : rows) {
    const double away = p["y"] - height;
    if (side == 0 && std::abs(away) > 1e-9) side = away * p["v"] > 0 ? 1 : -1;
    ASSERT_NEAR(p["u"], p["x"] - start, 1e-9);
    ASSERT_NEAR(p["v"], side * away, 1e-9);
  }
}

/// An uneven sheet of 12 x 12 quads, or of twice as many triangles, in the unit square.
std::string square(bool triangles) { return obj(lattice(13, 1.0 / 12, 0.2), cells(13, triangles)); }

TEST_F(Stroke, AlongALineOnAPlaneOfPointsIsThePlane) {
  const auto json = summary("stroke plane.xyz --curve '0.21,0.4,0 0.77,0.4,0' -o stroke.csv");
  const auto rows = read_csv("stroke.csv");
  ASSERT_EQ(rows.size(), 900U);
  expect_straight(rows, 0.21, 0.4);
  for (const Row& p : rows)
    EXPECT_NEAR(p["distance"], std::hypot(std::max({0.0, 0.21 - p["x"], p["x"] - 0.77}), p["y"] - 0.4), 1e-9);
  EXPECT_EQ(json.at("low_quality"), std::ranges::count_if(rows, [](const Row& p) { return p["quality"] < 0.5; }));
  EXPECT_LT(number(json, "/low_quality"), 9);
  EXPECT_NEAR(number(json, "/curve/length"), 0.56, 1e-12);
  EXPECT_LT(number(json, "/curve/largest_gap"), 1e-12);
  EXPECT_TRUE(read_text("stroke.csv").starts_with("index,x,y,z,u,v,distance,status,quality,spread\n"));
  write("above.txt", "# above\n0.2 0.4 0.01\n\n0.5 0.4 0.02\n 0.8,0.4,0.01\n");  // projected to the plane
  expect_straight(table("stroke plane.xyz --curve above.txt"), 0.2, 0.4);
}

TEST_F(Stroke, AlongALineOnAFlatMeshIsThePlane) {
  for (const bool triangles : {true, false}) {
    write("sheet.obj", square(triangles));
    expect_straight(table("stroke sheet.obj --curve '0.2,0.43,0 0.5,0.43,0.3 0.9,0.43,-0.1'"), 0.2, 0.43);
    // The middles of two faces of a row: of quads at the same height, of triangles the lower ones.
    const std::string middle = triangles ? ":0.25,0.5,0.25" : ":0.25,0.25,0.25,0.25";
    const int first = triangles ? 2 * (5 * 12 + 2) : 5 * 12 + 2, last = triangles ? 2 * (5 * 12 + 9) : 5 * 12 + 9;
    const auto rows = table("stroke sheet.obj --curve 'face:" + std::to_string(first) + middle +
                            " face:" + std::to_string(last) + middle + "'");
    const double start = rows[0]["x"] - rows[0]["u"];
    EXPECT_GT(start, 2.0 / 12);
    EXPECT_LT(start, 3.5 / 12);
    expect_straight(rows, start, (triangles ? 5.25 : 5.5) / 12);
  }
  write("sheet.obj", square(true));
  const auto rows = table("stroke sheet.obj --curve '80 83 88'");  // vertices at y = 1/2
  expect_straight(rows, rows[80]["x"], 0.5);
}

TEST_F(Stroke, EndsAtTheRadius) {
  const std::string command = "stroke plane.xyz --curve '0.21,0.4,0 0.77,0.4,0'";
  const auto expected = table(command), rows = table(command + " --radius 0.2");
  ASSERT_EQ(rows.size(), expected.size());
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(std::isnan(rows[i]["u"]), expected[i]["distance"] > 0.2) << i;
    if (std::isnan(rows[i]["u"])) {
      ++beyond;
      for (const char* name : {"distance", "quality", "spread"}) EXPECT_TRUE(std::isnan(rows[i][name])) << name;
    } else {
      for (const char* name : {"u", "v"}) EXPECT_EQ(rows[i][name], expected[i][name]);
    }
  }
  EXPECT_GT(beyond, 0U);
}

TEST_F(Stroke, AlongACircleOnAPlaneIsThePlaneAroundItsMiddle) {
  const int n = 90;
  const double radius = 0.3;
  Points circle;
  for (int k = 0; k < n; ++k)
    circle.push_back({0.5 + radius * std::cos(2 * pi * k / n), 0.5 + radius * std::sin(2 * pi * k / n), 0});
  write("circle.txt", xyz(circle));
  // The sides of the polygon are inside of the circle by up to the sagitta, and so are the coordinates.
  const double sagitta = radius * (1 - std::cos(pi / n));
  double side = 0;
  for (const Row& p : table("stroke plane.xyz --curve circle.txt --circle")) {
    if (side == 0) side = p["v"] * (p["y"] - 0.5) > 0 ? 1 : -1;
    EXPECT_NEAR(p["u"], p["x"] - 0.5, 2 * sagitta);
    EXPECT_NEAR(p["v"], side * (p["y"] - 0.5), 2 * sagitta);
    EXPECT_NEAR(p["distance"], std::abs(std::hypot(p["x"] - 0.5, p["y"] - 0.5) - radius), 2 * sagitta);
  }
}

TEST_F(Stroke, AlongTheEquatorOfASphereIsLongitudeAndLatitude) {
  write("sphere.xyz", xyz(sphere(4000)));
  const int n = 60;
  std::string equator;
  for (int k = 0; k < n; ++k)
    equator += std::to_string(std::cos(2 * pi * k / n)) + "," + std::to_string(std::sin(2 * pi * k / n)) + ",0\n";
  write("equator.txt", equator);
  const auto json = summary("stroke sphere.xyz --curve equator.txt --closed -o stroke.csv");
  const double h = std::sqrt(4 * pi / 4000);
  double side = 0;
  for (const Row& p : read_csv("stroke.csv")) {
    const double latitude = std::asin(p["z"]), longitude = std::atan2(p["y"], p["x"]);
    if (std::abs(latitude) > 1.5) EXPECT_LT(p["quality"], 0.5);  // all points of the equator are equally near
    if (std::abs(latitude) > 1) continue;
    if (side == 0 && std::abs(latitude) > h) side = latitude * p["v"] > 0 ? 1 : -1;
    EXPECT_NEAR(p["v"], side * latitude, h);
    EXPECT_NEAR(p["distance"], std::abs(latitude), 0.5 * h);
    if (std::abs(longitude) < pi / 2) continue;  // u jumps where the curve closes
    EXPECT_NEAR(std::remainder(p["u"] - longitude, 2 * pi), 0, h);
  }
  EXPECT_NEAR(number(json, "/curve/length"), 2 * pi, h * h);
}

TEST_F(Stroke, ClosedAlongAOneSidedBandIsRejected) {
  const int around = 60, across = 5;  // the last column meets the first one upside down
  Points points;
  std::string middle;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double angle = 2 * pi * i / around, w = 0.1 * (j - across / 2), r = 1 + w * std::cos(angle / 2);
      points.push_back({r * std::cos(angle), r * std::sin(angle), w * std::sin(angle / 2)});
    }
    middle += std::to_string(i * across + across / 2) + " ";
  }
  const auto at = [&](int i, int j) { return i < around ? i * across + j : across - 1 - j; };
  Faces faces;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j + 1 < across; ++j)
      faces.insert(faces.end(),
                   {{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, {at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
  write("band.obj", obj(points, faces));
  const std::string command = "stroke band.obj --curve '" + middle + "'";
  expect_refused(command, {{"--closed -o closed.csv", 1, {"one-sided"}}});
  // The open curve has two sides: across the band v is the distance from its middle.
  const auto rows = table(command);
  double side = 0;
  for (int i = 5; i < around - 5; ++i)
    for (int j = 0; j < across; ++j) {
      if (j == across / 2) continue;
      const double v = rows.at(static_cast<std::size_t>(at(i, j)))["v"];
      if (side == 0) side = v * (j - across / 2) > 0 ? 1 : -1;
      EXPECT_NEAR(v, side * 0.1 * (j - across / 2), 0.02);
    }
}

TEST_F(Stroke, BetweenTwoPointsOfACloudFollowsThePath) {
  write("sphere.xyz", xyz(sphere(2000)));
  EXPECT_EQ(run_ok("stroke sphere.xyz --curve '1,0,0 0,1,0' -o stroke.csv").err, "");
  write("two.xyz", xyz(joined(sphere(2000), moved(sphere(2000), {3, 0, 0}))));
  EXPECT_TRUE(has(run_ok("stroke two.xyz --curve '1,0,0 2,0,0' -o stroke.csv").err, "instead of a shortest path",
                  "does not connect their ends", "add points"));
}

TEST_F(Stroke, WithPositionsIsAMovedMap) {
  // The line y = 0.4 from x = 0.21, turned by a quarter and moved: (x, y) -> (3 - (y - 0.4), 5 + x - 0.21).
  const auto json = summary(
      "stroke plane.xyz --curve '0.21,0.4,0 0.5,0.4,0 0.77,0.4,0' --positions '3,5 3,5.29 3,5.56' -o stroke.csv");
  const auto rows = read_csv("stroke.csv");
  ASSERT_EQ(rows.size(), 900U);
  const double side = rows[0]["v"] != 0 && (rows[0]["u"] - 3) * (rows[0]["y"] - 0.4) > 0 ? 1 : -1;
  for (const Row& p : rows) {
    ASSERT_NEAR(p["u"], 3 + side * (p["y"] - 0.4), 1e-9);
    ASSERT_NEAR(p["v"], 5 + p["x"] - 0.21, 1e-9);
    const double beyond = std::max({0.0, 0.21 - p["x"], p["x"] - 0.77});
    ASSERT_NEAR(p["distance"], std::hypot(p["y"] - 0.4, beyond), 1.0 / 30);  // an edge: distances are from samples
  }
  expect_values(json, {{"/curve/shape", "positions"}});
}

}  // namespace
}  // namespace ahm::test
