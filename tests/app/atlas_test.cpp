// Texture atlases as files.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "ahm/io/textured_mesh.hpp"
#include "program.hpp"

namespace ahm::test {
namespace {

/// A sphere of quadrilaterals between two caps of triangles, as OFF.
std::string globe(int around) {
  const int rings = around / 2 - 1;
  std::string points = "0 0 1\n", faces;
  for (int r = 1; r <= rings; ++r)
    for (int a = 0; a < around; ++a) {
      const double t = std::numbers::pi * r / (rings + 1), p = 2 * std::numbers::pi * a / around;
      points += std::to_string(std::sin(t) * std::cos(p)) + " " + std::to_string(std::sin(t) * std::sin(p)) + " " +
                std::to_string(std::cos(t)) + "\n";
    }
  points += "0 0 -1\n";
  const auto at = [&](int r, int a) { return std::to_string(1 + (r - 1) * around + a % around) + " "; };
  const int last = 1 + rings * around;
  for (int a = 0; a < around; ++a) {
    faces += "3 0 " + at(1, a) + at(1, a + 1) + "\n";
    for (int r = 1; r < rings; ++r) faces += "4 " + at(r, a) + at(r + 1, a) + at(r + 1, a + 1) + at(r, a + 1) + "\n";
    faces += "3 " + at(rings, a) + std::to_string(last) + " " + at(rings, a + 1) + "\n";
  }
  return "OFF\n" + std::to_string(last + 1) + " " + std::to_string(around * (rings + 1)) + " 0\n" + points + faces;
}

struct ObjFile {
  std::vector<Vec3> v;
  std::vector<std::array<double, 2>> vt;
  std::vector<std::vector<std::array<int, 2>>> faces;

  explicit ObjFile(const std::string& name) {
    std::ifstream file(name);
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      std::string word;
      words >> word;
      if (word == "v") v.emplace_back(), words >> v.back()[0] >> v.back()[1] >> v.back()[2];
      if (word == "vt") vt.emplace_back(), words >> vt.back()[0] >> vt.back()[1];
      if (word != "f") continue;
      faces.emplace_back();
      while (words >> word)
        faces.back().push_back({std::stoi(word) - 1, std::stoi(word.substr(word.find('/') + 1)) - 1});
    }
  }
};

TEST(AtlasCommand, WritesEveryPolygonOnceInsideTheTexture) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  const std::string input = folder.write("globe.off", globe(32));
  const Outcome outcome = run({"atlas", input, "--charts", "8", "--size", "512", "-o", folder / "globe.obj", "--json",
                               folder / "globe.json", "--view", folder / "globe.png"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"globe.json", "globe.mtl", "globe.obj", "globe.off", "globe.png",
                                                      "globe_atlas.png"}));
  EXPECT_EQ(io::read_image(folder / "globe_atlas.png").width, 512);
  EXPECT_EQ(io::read_image(folder / "globe.png").width, 1600);
  const ObjFile obj(folder / "globe.obj");
  EXPECT_EQ(obj.v.size(), 482U);
  ASSERT_EQ(obj.faces.size(), 512U);
  const auto json = read_json(folder / "globe.json");
  const double scale = json.at("texture").at("texels_per_unit").get<double>() / 512;
  std::size_t quads = 0;
  double ratio = 0;
  for (const auto& face : obj.faces) {
    quads += face.size() == 4;
    for (const auto& [v, vt] : face)
      for (double x : obj.vt.at(static_cast<std::size_t>(vt))) EXPECT_TRUE(x > 0 && x < 1);
    const auto [a, b] = std::array{face[0], face[1]};
    const auto &p = obj.v[a[0]], &q = obj.v[b[0]];
    const auto &s = obj.vt[a[1]], &t = obj.vt[b[1]];
    ratio += std::hypot(s[0] - t[0], s[1] - t[1]) / scale / std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) / 512;
  }
  EXPECT_EQ(quads, 32U * 14);
  EXPECT_NEAR(ratio, 1, 0.1);  // lengths on the surface, on average
  EXPECT_EQ(json.at("uncharted"), 0);
  EXPECT_EQ(json.at("charts").size(), 8U);
  EXPECT_LT(json.at("distortion").at("percentile_95").get<double>(), 1.4);
  EXPECT_EQ(json.at("distortion").at("flipped"), 0);
}

TEST(AtlasCommand, AddsSourcesUntilTheChartsAreGood) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  const std::string input = folder.write("globe.off", globe(32));
  const Outcome one = run({"atlas", input, "--charts", "1", "-o", folder / "one.glb", "--json", folder / "one.json"});
  const Outcome more = run({"atlas", input, "--charts", "1", "--max-distortion", "1.4", "-o", folder / "more.glb",
                            "--json", folder / "more.json"});
  ASSERT_EQ(one.status + more.status, 0) << one.err << more.err;
  EXPECT_NE(one.err.find("--max-distortion"), std::string::npos) << one.err;  // flipped behind the sphere
  EXPECT_EQ(more.err.find("flipped"), std::string::npos) << more.err;
  const auto before = read_json(folder / "one.json"), after = read_json(folder / "more.json");
  EXPECT_GT(after.at("sources").size(), 3U);
  EXPECT_LE(after.at("distortion").at("percentile_95").get<double>(), 1.4);
  EXPECT_LT(after.at("distortion").at("mean").get<double>(), before.at("distortion").at("mean").get<double>());
}

TEST(AtlasCommand, TakesCloudsAndSourcesByHand) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  const Outcome outcome =
      run({"atlas", folder.write("sphere.xyz", xyz(sphere(1500))), "--sources", "0 0,0,-1 1,0,0 -1,0,0 0,1,0 0,-1,0",
           "-o", folder / "s.obj", "--json", folder / "s.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = read_json(folder / "s.json");
  EXPECT_EQ(json.at("sources").size(), 6U);
  EXPECT_LT(json.at("distortion").at("percentile_95").get<double>(), 1.3);
  EXPECT_NEAR(json.at("faces").get<double>(), 2 * 1500, 60);
}

TEST(AtlasCommand, FlattensEverySheetOfACutMesh) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  // An open book of three flat pages that share their spine: 9 edges with three faces each.
  const int m = 10, pages = 3;
  std::string points, faces;
  for (int y = 0; y < m; ++y) points += "0 0 " + std::to_string(0.1 * y) + "\n";
  for (int page = 0; page < pages; ++page) {
    const double a = 0.4 + 0.9 * page;
    const auto at = [&](int x, int y) {
      return std::to_string(x == 0 ? y : m + page * m * (m - 1) + (x - 1) * m + y) + " ";
    };
    for (int x = 1; x < m; ++x)
      for (int y = 0; y < m; ++y)
        points += std::to_string(0.1 * x * std::cos(a)) + " " + std::to_string(0.1 * x * std::sin(a)) + " " +
                  std::to_string(0.1 * y) + "\n";
    for (int x = 0; x + 1 < m; ++x)
      for (int y = 0; y + 1 < m; ++y)
        faces += "3 " + at(x, y) + at(x + 1, y) + at(x + 1, y + 1) + "\n3 " + at(x, y) + at(x + 1, y + 1) +
                 at(x, y + 1) + "\n";
  }
  const int vertices = m + pages * m * (m - 1), triangles = pages * 2 * (m - 1) * (m - 1);
  Folder folder;
  const std::string input = folder.write(
      "book.off", "OFF\n" + std::to_string(vertices) + " " + std::to_string(triangles) + " 0\n" + points + faces);
  const Outcome outcome = run({"atlas", input, "--non-manifold", "split", "--charts", "3", "-o", folder / "book.obj",
                               "--json", folder / "book.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = read_json(folder / "book.json");
  EXPECT_EQ(json.at("uncharted"), 0);
  EXPECT_EQ(json.at("charts").size(), 3U);
  EXPECT_NEAR(json.at("distortion").at("largest").get<double>(), 1, 1e-4);  // six digits in the file
}

TEST(AtlasCommand, RefusesWhatItCannotDo) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  const std::string input = folder.write("globe.off", globe(8));
  const auto refuses = [&](std::vector<std::string> arguments, const std::string& part) {
    arguments.insert(arguments.begin(), {"atlas", input});
    const Outcome outcome = run(arguments);
    EXPECT_NE(outcome.status, 0);
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  };
  const std::string out = folder / "out.obj";
  refuses({"-o", folder / "out.stl"}, ".obj or .glb");
  refuses({"-o", out, "--charts", "0"}, "--charts");
  refuses({"-o", out, "--max-distortion", "1"}, "--max-distortion");
  refuses({"-o", out, "--charts", "3", "--sources", "1 2"}, "--sources");
  refuses({"-o", out, "--sources", "1 1"}, "twice");
  refuses({"-o", out, "--texture", folder / "none.png"}, "none.png");
  refuses({"-o", out, "--size", "16", "--margin", "9"}, "size");
  refuses({"-o", out, "--view", folder / "out.html"}, ".png");
  EXPECT_EQ(folder.files(), std::vector<std::string>{"globe.off"});
}

}  // namespace
}  // namespace ahm::test
