// Difficult clouds: duplicates, too few points, lines, clusters, walls, outliers, noise; and clouds that a voxel grid thins.
#include <algorithm>
#include <cmath>

#include "ahm/io/image.hpp"
#include "ahm/io/read.hpp"
#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

class CloudFile : public LogmapOf {
 protected:
  CloudFile() : LogmapOf("cloud.xyz") {}
};

TEST_F(CloudFile, WithEqualPointsHasEqualRows) {
  const auto once = plane(20);
  const auto rows = map(xyz(joined(once, once)));
  ASSERT_EQ(count(rows, "ok"), 2 * once.size());
  for (std::size_t i = 0; i < once.size(); ++i)
    for (const char* name : {"u", "v"}) EXPECT_EQ(rows[i][name], rows[i + once.size()][name]);
  EXPECT_EQ(json.at("pointcloud").at("duplicates"), once.size());
}

TEST_F(CloudFile, ThatIsNoSurfaceIsRejected) {
  expect_error("0 0 0\n", "3");
  expect_error("0 0 0\n1 0 0\n", "3");
  expect_error("0 0 0\n0 0 0\n0 0 0\n0 0 0\n", "distinct");
  std::string line;
  for (int i = 0; i < 50; ++i) line += std::to_string(i) + " 0 0\n";
  expect_error(line, "line");
}

TEST_F(CloudFile, MayHaveFewerPointsThanNeighbors) {
  EXPECT_EQ(count(map(xyz(plane(3))), "ok"), 9U);
  EXPECT_EQ(json.at("pointcloud").at("k"), 8);
  EXPECT_FALSE(json.at("warnings").empty());
  EXPECT_TRUE(has(err, "warning"));
}

TEST_F(CloudFile, IsDisconnectedFromOtherClusters) {
  const auto cluster = plane(20);
  const auto rows = map(xyz(joined(cluster, moved(cluster, {50, 0, 0}))));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].status, i < cluster.size() ? "ok" : "disconnected") << i;
    EXPECT_EQ(std::isnan(rows[i]["u"]), i >= cluster.size());
  }
  EXPECT_EQ(json.at("status").at("disconnected"), cluster.size());
  const auto with_stray = map(xyz(joined(cluster, {{0.5, 0.5, 30}})));
  EXPECT_NE(with_stray.back().status, "ok");
  EXPECT_EQ(count(with_stray, "ok"), cluster.size());
}

#ifdef AHM_WITH_PCL
TEST_F(CloudFile, LosesOutliersOnRequest) {
  auto points = joined(plane(20), {{0.5, 0.5, 0.4}});
  EXPECT_EQ(map(xyz(points), "-s 0 --outliers").back().status, "removed");
  std::swap(points.front(), points.back());
  expect_error(xyz(points), "--outliers", "-s 0 --outliers");
  expect_error(xyz(points), "--voxel", "-s 0 --voxel 1e-12");  // more voxels than integers
}
#endif

TEST_F(CloudFile, WithNonFinitePointsIsRejectedUnlessTheyAreDropped) {
  auto points = plane(20);
  points[17][1] = not_a_number;
  points[30][2] = std::numeric_limits<double>::infinity();
  expect_error(xyz(points), "17");
  expect_error(xyz(points), "--drop-nan");
  const auto rows = map(xyz(points), "-s 0 --drop-nan");
  ASSERT_EQ(rows.size(), points.size());
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].status, i == 17 || i == 30 ? "removed" : "ok") << i;
  std::swap(points[0], points[17]);
  expect_error(xyz(points), "--source 0", "-s 0 --drop-nan");
}

TEST_F(CloudFile, HasTheSameMapForNormalsOfBothSigns) {
  const auto points = sphere(3000);
  auto normals = points;
  for (std::size_t i = 0; i < normals.size(); i += 2)
    for (double& x : normals[i]) x = -x;
  const auto expected = map(xyz(points, points)), rows = map(xyz(points, normals));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i][2] < -0.9) continue;  // near the cut locus
    EXPECT_NEAR(rows[i]["distance"], expected[i]["distance"], 1e-6);
  }
}

TEST_F(CloudFile, WithAMissingNormalIsMapped) {
  const auto points = plane(20);
  Points normals(points.size(), Vec3{0, 0, 1});
  normals[5] = {0, 0, 0};
  for (const char* how : {"-s 0", "-s 0 --normals estimate"})
    EXPECT_EQ(count(map(xyz(points, normals), how), "ok"), points.size());
}

TEST_F(CloudFile, OfAThinWallHasTwoSheets) {
  const auto front = plane(30);  // spacing 0.033
  Points normals(front.size(), Vec3{0, 0, -1});
  normals.resize(2 * front.size(), Vec3{0, 0, 1});
  const auto rows = map(xyz(joined(front, moved(front, {0, 0, 0.012})), normals));
  EXPECT_GT(number(json, "/pointcloud/rejected_normals"), 0);
  for (std::size_t i = 0; i < front.size(); ++i) {
    EXPECT_EQ(rows[i].status, "ok");
    EXPECT_NEAR(rows[i]["distance"], distance(front[i], front[0]), 1e-9);
    EXPECT_EQ(rows[i + front.size()].status, "disconnected");
  }
}

TEST_F(CloudFile, HasTheSameMapAtOtherScalesAndPlaces) {
  const auto points = sphere(800);
  const auto expected = map(xyz(points));
  for (const double scale : {1e-200, 1e200}) {
    const auto rows = map(xyz(moved(points, {0, 0, 0}, scale)));
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_NEAR(rows[i]["distance"] / scale, expected[i]["distance"], 1e-6) << scale;
  }
  const auto rows = map(xyz(moved(points, {1e6, -2e6, 5e5})));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i][2] < -0.9) continue;
    EXPECT_NEAR(rows[i]["distance"], expected[i]["distance"], 1e-6);
  }
}

// Every point lies half a spacing inside or outside of the unit sphere.
TEST_F(CloudFile, WithNoiseIsSmoothedUnlessThatIsTurnedOff) {
  Points points = sphere(2000);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (double& x : points[i]) x *= i * i % 7 < 3 ? 1.03 : 0.97;
  map(xyz(points));
  EXPECT_TRUE(has(err, "points were smoothed"));
  map(xyz(points), "-s 0 --smooth 0.3");
  EXPECT_TRUE(has(err, "2000 points were smoothed"));
  map(xyz(points), "-s 0 --smooth off");
  EXPECT_FALSE(has(err, "smoothed"));
}

#ifdef AHM_WITH_PCL
/// As a depth camera makes them: pixels without a point are not finite.
TEST_F(CloudFile, KeepsTheImageOfACamera) {
  std::string text =
      "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 12\nHEIGHT 9\n"
      "VIEWPOINT 0.5 0.25 -3 0 1 0 0\nPOINTS 108\nDATA ascii\n";
  for (int i = 0; i < 108; ++i)
    text +=
        i % 12 == 5 && i < 60 ? "nan nan nan 0\n" : std::to_string(i % 12) + " " + std::to_string(i / 12) + " 0 0.25\n";
  write("camera.pcd", text);
  run_ok("logmap camera.pcd -s 0 -o map.pcd --drop-nan");
  const io::Geometry map = io::read("map.pcd"), input = io::read("camera.pcd");
  ASSERT_TRUE(map.acquisition.has_value());
  EXPECT_EQ(map.acquisition->width, 12U);
  EXPECT_EQ(map.acquisition->height, 9U);
  EXPECT_EQ(map.acquisition->position, (Vec3{0.5, 0.25, -3}));
  EXPECT_EQ(map.acquisition->orientation, (std::array<double, 4>{0, 1, 0, 0}));
  EXPECT_EQ(map.properties.front().name, "intensity");
  EXPECT_EQ(map.properties.front().values, input.properties.front().values);
  EXPECT_TRUE(std::isnan(map.points[5][0]));
  EXPECT_EQ(map.points[107], input.points[107]);
}
#else
TEST_F(CloudFile, IsNotThinnedWithoutPcl) { expect_error(xyz(plane(40)), "--voxel", "-s 0 --voxel 0.06"); }
#endif

/// A plane of 1600 points, of which a voxel grid keeps about one in four.
class ThinnedCloud : public InFolderWithImages {
 protected:
  void SetUp() override {
    InFolderWithImages::SetUp();
#ifndef AHM_WITH_PCL
    GTEST_SKIP() << "this build has no PCL";
#endif
    write("plane.xyz", xyz(points));
  }

  const Points points = plane(40);
};

TEST_F(ThinnedCloud, KeepsTheOrderOfTheInput) {
  const auto rows = table("logmap plane.xyz --source 5 --voxel 0.06");
  ASSERT_EQ(rows.size(), points.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].position(), points[i]);
    if (rows[i].status == "removed")
      EXPECT_TRUE(std::isnan(rows[i]["u"]) && std::isnan(rows[i]["distance"]));
    else
      EXPECT_NEAR(rows[i]["distance"], distance(points[i], points[5]), 1e-9);
  }
  EXPECT_EQ(rows[5].status, "ok");  // the source represents its own voxel
  EXPECT_GT(count(rows, "removed"), points.size() / 4);
}

/// Share of the drawn pixels that have no color.
double gray_share(const Image& image) {
  std::size_t gray = 0, drawn = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      const auto [least, most] = std::minmax({p[0], p[1], p[2]});
      if (least == 255) continue;
      ++drawn;
      gray += most - least < 12;
    }
  return static_cast<double>(gray) / static_cast<double>(drawn);
}

TEST_F(ThinnedCloud, IsDrawnWithoutTheRemovedPoints) {
  for (const std::string command : {"logmap --source 0", "stroke --curve '0.2,0.2,0 0.8,0.7,0'", "cells --count 9"}) {
    run_ok(command + " plane.xyz --voxel 0.05 -o out.csv --view view.png --size 400x300");
    EXPECT_LT(gray_share(io::read_image("view.png")), 0.2) << command;
  }
}

TEST_F(ThinnedCloud, HasTheColorsOfADecalAtAllPoints) {
  Image red(4, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) red.pixel(x, y)[0] = red.pixel(x, y)[3] = 255;
  io::write_png("red.png", red);
  run_ok("decal plane.xyz --voxel 0.05 --image red.png --source 0 --u-axis 1,0,0 --size 0.5 -o out.ply");
  const io::Geometry out = io::read("out.ply");
  ASSERT_EQ(out.colors.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double away = std::max(std::abs(points[i][0] - points[0][0]), std::abs(points[i][1] - points[0][1]));
    if (std::abs(away - 0.25) < 0.05) continue;  // the nearest kept point may be on the other side of the border
    EXPECT_EQ(out.colors[i][1] == 0, away < 0.25) << i;
  }
}

TEST_F(ThinnedCloud, KeepsEveryRowThatACommandNames) {
  // At most one of several neighbors in a voxel would be kept.
  const Words named{"41", "42", "81", "82", "83", "905", "906"};
  std::string list, pairs, lines;
  for (const std::string& row : named) {
    list += row + " ";
    pairs += row + " 0\n";
    lines += row + " 1,0,0 0.1\n";
  }
  write("pairs.txt", pairs);
  write("lines.txt", lines);
  for (const std::string& command :
       {std::string("path --from 41 --through '42 81' --to '82 83 905 906' -o out.csv"),
        std::string("path --pairs pairs.txt -o out.csv"), std::string("trace --lines lines.txt -o out.csv"),
        std::string("cells --count 4 --start 82 -o out.csv"), "center --start 42 --points '" + list + "'",
        "stroke -o out.csv --curve '" + list + "'", std::string("atlas --sources '41 42 906' -o out.obj")})
    run_ok(command + " plane.xyz --voxel 0.05");
  const auto rows = table("cells plane.xyz --voxel 0.05 --sources '" + list + "'");
  for (std::size_t k = 0; k < named.size(); ++k) EXPECT_EQ(rows[std::stoul(named[k])]["label"], static_cast<double>(k));
  expect_refused("path plane.xyz --voxel 0.05 -o new.csv", {{"--from 0 --to 1600", 1, {"--to 1600"}}});
}

}  // namespace
}  // namespace ahm::test
