#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "ahm/io/read.hpp"
#include "program.hpp"

namespace ahm::test {
namespace {

const std::vector<Vec3> upward(std::size_t n) { return std::vector<Vec3>(n, Vec3{0, 0, 1}); }

TEST(Logmap, IsTheIdentityOnAPlane) {
  Folder folder;
  const auto points = plane(40);
  const auto input = folder.write("plane.xyz", xyz(points, upward(points.size())));
  const auto run_result = run({"logmap", input, "--source", "0", "-o", folder / "map.csv", "--u-axis", "1,0,0"});
  ASSERT_EQ(run_result.status, 0) << run_result.err;
  const auto rows = read_csv(folder / "map.csv");
  ASSERT_EQ(rows.size(), points.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].status, "ok");
    EXPECT_EQ(rows[i].index, static_cast<long>(i));
    EXPECT_EQ(rows[i].position, points[i]);
    const double u = points[i][0] - points[0][0], v = points[i][1] - points[0][1];
    EXPECT_NEAR(rows[i].u, u, 1e-9);
    EXPECT_NEAR(rows[i].v, v, 1e-9);
    EXPECT_NEAR(rows[i].distance, std::hypot(u, v), 1e-9);
    if (i == 0) continue;  // no direction at the source itself
    EXPECT_NEAR(std::remainder(rows[i].angle - std::atan2(v, u), 2 * std::numbers::pi), 0.0, 1e-6);
  }
}

TEST(Logmap, BothVariantsAreExactOnAPlaneWithoutNormals) {
  Folder folder;
  const auto points = plane(25);
  const auto input = folder.write("plane.xyz", xyz(points));
  for (const std::string variant : {"adaptive", "localized"}) {
    const auto result = run({"logmap", input, "-s", "0", "-o", folder / "map.csv", "--variant", variant});
    ASSERT_EQ(result.status, 0) << result.err;
    for (const Row& row : read_csv(folder / "map.csv"))
      EXPECT_NEAR(row.distance, std::hypot(row.position[0] - points[0][0], row.position[1] - points[0][1]), 1e-9);
  }
}

TEST(Logmap, MeasuresArcsOnASphere) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(4000)));
  const auto result = run({"logmap", input, "--source", "0", "-o", folder / "map.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  double worst = 0;
  for (const Row& row : read_csv(folder / "map.csv")) {
    ASSERT_EQ(row.status, "ok");
    const double exact = std::acos(std::clamp(row.position[2], -1.0, 1.0));
    if (exact < 2.0) worst = std::max(worst, std::abs(row.distance - exact));
  }
  EXPECT_LT(worst, 0.11);  // two spacings of 0.056
}

TEST(Logmap, StartsAtTheVertexNearestToAPosition) {
  Folder folder;
  const auto input = folder.write("plane.xyz", xyz(plane(15)));
  const auto a =
      run({"logmap", input, "--source=-5,0.5,0.25", "-o", folder / "map.csv", "--json", folder / "map.json"});
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("nearest"), std::string::npos) << "a source far outside deserves a warning: " << a.err;
  const auto rows = read_csv(folder / "map.csv");
  double nearest = 1e9;
  for (const Row& row : rows) nearest = std::min(nearest, std::hypot(row.position[0] + 5, row.position[1] - 0.5));
  const auto index = read_json(folder / "map.json").at("source").at("index").get<std::size_t>();
  EXPECT_EQ(std::hypot(rows[index].position[0] + 5, rows[index].position[1] - 0.5), nearest);
  EXPECT_LT(rows[index].distance, 1e-12);
}

TEST(Logmap, KeepsTheOrderOfTheInputWithAVoxelGrid) {
  Folder folder;
  const auto points = plane(40);
  const auto input = folder.write("plane.xyz", xyz(points));
  const auto result = run({"logmap", input, "--source", "5", "-o", folder / "map.csv", "--voxel", "0.06"});
#ifdef AHM_WITH_PCL
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rows = read_csv(folder / "map.csv");
  ASSERT_EQ(rows.size(), points.size());
  std::size_t removed = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].position, points[i]);
    if (rows[i].status == "removed") {
      ++removed;
      EXPECT_TRUE(std::isnan(rows[i].u) && std::isnan(rows[i].distance));
    } else {
      EXPECT_NEAR(rows[i].distance, std::hypot(points[i][0] - points[5][0], points[i][1] - points[5][1]), 1e-9);
    }
  }
  EXPECT_EQ(rows[5].status, "ok");  // the source represents its own voxel
  EXPECT_GT(removed, points.size() / 4);
#else
  EXPECT_EQ(result.status, 1);
#endif
}

TEST(Logmap, KeepsTheColorsThatCameIn) {
  Folder folder;
  const auto input = folder.write(
      "c.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nproperty "
      "uchar red\n"
      "property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 255 0 7\n1 0 0 1 2 3\n1 1 0 4 5 6\n0 1 0 8 9 10\n4 0 1 2 3\n");
  ASSERT_EQ(run({"logmap", input, "-s", "0", "-o", folder / "map.ply"}).status, 0);
  EXPECT_EQ(io::read(folder / "map.ply").colors, io::read(input).colors);
}

#ifdef AHM_WITH_PCL
/// As a depth camera makes them: pixels without a point are not finite.
TEST(Logmap, KeepsThePictureOfACamera) {
  Folder folder;
  std::string text =
      "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 12\nHEIGHT 9\n"
      "VIEWPOINT 0.5 0.25 -3 0 1 0 0\nPOINTS 108\nDATA ascii\n";
  for (int i = 0; i < 108; ++i)
    text +=
        i % 12 == 5 && i < 60 ? "nan nan nan 0\n" : std::to_string(i % 12) + " " + std::to_string(i / 12) + " 0 0.25\n";
  const auto input = folder.write("camera.pcd", text);
  const Outcome outcome = run({"logmap", input, "-s", "0", "-o", folder / "map.pcd", "--drop-nan"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const io::Geometry map = io::read(folder / "map.pcd"), given = io::read(input);
  ASSERT_TRUE(map.acquisition.has_value());
  EXPECT_EQ(map.acquisition->width, 12U);
  EXPECT_EQ(map.acquisition->height, 9U);
  EXPECT_EQ(map.acquisition->position, (Vec3{0.5, 0.25, -3}));
  EXPECT_EQ(map.acquisition->orientation, (std::array<double, 4>{0, 1, 0, 0}));
  EXPECT_EQ(map.properties.front().name, "intensity");
  EXPECT_EQ(map.properties.front().values, given.properties.front().values);
  EXPECT_TRUE(std::isnan(map.points[5][0]));
  EXPECT_EQ(map.points[107], given.points[107]);
}
#endif

TEST(Logmap, MarksWhatLiesBeyondTheRadius) {
  Folder folder;
  const auto points = plane(30);
  const auto input = folder.write("plane.xyz", xyz(points));
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--local"}}) {
    std::vector<std::string> words{"logmap", input, "--source", "0", "-o", folder / "map.csv", "--radius", "0.3"};
    words.insert(words.end(), more.begin(), more.end());
    ASSERT_EQ(run(words).status, 0);
    for (const Row& row : read_csv(folder / "map.csv")) {
      const double exact = std::hypot(row.position[0] - points[0][0], row.position[1] - points[0][1]);
      EXPECT_EQ(row.status, exact > 0.3 ? "beyond_radius" : "ok");
      EXPECT_EQ(std::isnan(row.u), exact > 0.3);
      EXPECT_TRUE(row.status != "ok" || std::abs(row.distance - exact) < 1e-10);
    }
  }
}

TEST(Logmap, NeedsARadiusToBeLocal) {
  Folder folder;
  const Outcome outcome =
      run({"logmap", folder.write("plane.xyz", xyz(plane(10))), "-s", "0", "-o", folder / "map.csv", "--local"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("--radius"), std::string::npos) << outcome.err;
}

TEST(Logmap, EverySearchGivesTheSameMap) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(1500)));
  std::vector<std::string> searches = {"nanoflann"};
#ifdef AHM_WITH_FLANN
  searches.emplace_back("flann");
#endif
#ifdef AHM_WITH_PCL
  searches.emplace_back("pcl");
#endif
  std::vector<std::vector<Row>> maps;
  for (const std::string& knn : searches) {
    const auto result = run({"logmap", input, "--source", "0", "-o", folder / "map.csv", "--knn", knn});
    ASSERT_EQ(result.status, 0) << result.err;
    maps.push_back(read_csv(folder / "map.csv"));
  }
  for (const auto& map : maps)
    for (std::size_t i = 0; i < map.size(); ++i) EXPECT_NEAR(map[i].distance, maps[0][i].distance, 1e-6);
}

TEST(Logmap, DoesNotDependOnThreads) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(2000)));
  for (const std::string threads : {"1", "3"})
    ASSERT_EQ(run({"logmap", input, "-s", "9", "-o", folder / (threads + ".csv"), "--threads", threads}).status, 0);
  EXPECT_EQ(read_text(folder / "1.csv"), read_text(folder / "3.csv"));
}

TEST(Json, TellsWhatWasDone) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(1000)));
  const auto result = run(
      {"logmap", input, "--source", "3", "--method", "heat", "-o", folder / "map.csv", "--json", folder / "map.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = read_json(folder / "map.json");
  EXPECT_EQ(json.at("n"), 1000);
  EXPECT_EQ(json.at("backend"), "pointcloud");
  EXPECT_EQ(json.at("variant"), "adaptive");
  EXPECT_EQ(json.at("strategy"), "global");
  EXPECT_GT(json.at("mean_edge_length").get<double>(), 0.0);
  EXPECT_LT(json.at("mean_edge_length").get<double>(), 0.5);
  for (const char* status : {"ok", "disconnected", "beyond_radius", "unreached", "removed"})
    EXPECT_TRUE(json.at("status").contains(status));
  EXPECT_EQ(json.at("status").at("ok"), 1000);
  EXPECT_TRUE(json.at("warnings").is_array());
  for (const char* stage : {"read", "graph", "factor", "solve", "write"})
    EXPECT_GE(json.at("seconds").at(stage).get<double>(), 0.0);
  EXPECT_GT(json.at("peak_rss_bytes").get<std::int64_t>(), 1000000);
  for (const char* library : {"ahm", "cholmod", "blas"})
    EXPECT_FALSE(json.at("versions").at(library).get<std::string>().empty());
  EXPECT_EQ(json.at("source").at("index"), 3);
  EXPECT_EQ(json.at("source").at("position").size(), 3U);
  for (const char* axis : {"u", "v", "normal"}) EXPECT_EQ(json.at("source").at("frame").at(axis).size(), 3U);
  EXPECT_EQ(json.at("pointcloud").at("components"), 1);
}

TEST(Json, GoesAloneToStandardOutput) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(500)));
  const auto result =
      run({"logmap", input, "--source", "0", "--method", "heat", "-o", folder / "map.csv", "--json", "-", "--verbose"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out).at("n"), 500);
  EXPECT_NE(result.err.find("500 vertices"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("factor"), std::string::npos) << result.err;
}

TEST(Output, IsSilentOnStandardErrorWhenAllIsWell) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(2000)));
  const auto result = run({"logmap", input, "--source", "0", "-o", folder / "map.csv"});
  ASSERT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("2000 ok"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("map.csv"), std::string::npos) << result.out;
}

TEST(Output, SaysWhereMeshesWithTextureCoordinatesAreAskedFor) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(100)));
  for (const std::string name : {"map.obj", "map.glb"}) {
    const Outcome outcome = run({"logmap", input, "-s", "0", "-o", folder / name});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("--corners " + (folder / name)), std::string::npos) << outcome.err;
  }
}

TEST(Output, ChoosesTheFormatByExtension) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(500)));
  for (const auto& [name, start] :
       std::map<std::string, std::string>{{"map.ply", "ply"}, {"map.CSV", "index"}, {"map.pcd", "#"}}) {
    const auto result = run({"logmap", input, "--source", "0", "-o", folder / name});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(read_text(folder / name).substr(0, start.size()), start) << name;
  }
}

TEST(View, DrawsAPngAndAPage) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(2000)));
  for (const std::string name : {"map.png", "map.html"}) {
    const auto result = run({"logmap", input, "--source", "0", "-o", folder / "map.csv", "--view", folder / name});
    if (result.status != 0 && result.err.find("this build of ahm cannot write") != std::string::npos) continue;
    ASSERT_EQ(result.status, 0) << result.err;
    const auto bytes = read_text(folder / name);
    EXPECT_GT(bytes.size(), 1000U);
    EXPECT_EQ(bytes.substr(0, 4), name == "map.png" ? "\x89PNG" : bytes.substr(0, 4));
  }
}

}  // namespace
}  // namespace ahm::test
