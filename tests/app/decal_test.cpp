// Decals as files.
#include <gtest/gtest.h>

#include <cmath>

#include "ahm/io/read.hpp"
#include "ahm/io/textured_mesh.hpp"
#include "program.hpp"

namespace ahm::test {
namespace {

/// A plate of quadrilaterals, [0, 2]^2 at height 5, as OFF.
std::string plate() {
  const int m = 21;
  std::string off = "OFF\n441 400 0\n";
  for (int y = 0; y < m; ++y)
    for (int x = 0; x < m; ++x) off += std::to_string(0.1 * x) + " " + std::to_string(0.1 * y) + " 5\n";
  for (int y = 0; y + 1 < m; ++y)
    for (int x = 0; x + 1 < m; ++x) {
      const int a = y * m + x;
      off += "4 " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(a + m + 1) + " " +
             std::to_string(a + m) + "\n";
    }
  return off;
}

/// Red on the left, blue on the right, opaque but for its upper half.
std::string half_and_half(const Folder& folder) {
  Image image(40, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) {
      std::uint8_t* p = image.pixel(x, y);
      p[0] = x < 20 ? 255 : 0, p[2] = x < 20 ? 0 : 255, p[3] = y < 10 ? 0 : 255;
    }
  io::write_png(folder / "image.png", image);
  return folder / "image.png";
}

TEST(DecalCommand, LaysTheImageOnAPlate) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  const std::string image = half_and_half(folder);
  for (const std::string method : {"heat", "exact"}) {
    const Outcome outcome = run({"decal", folder.write("plate.off", plate()), "--image", image, "--source", "1,1,5",
                                 "--u-axis", "1,0,0", "--size", "1", "--lift", "0", "--alone", "--method", method, "-o",
                                 folder / "decal.obj", "--json", folder / "decal.json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const io::Geometry decal = io::read(folder / "decal.obj");
    Vec3 low{9, 9, 9}, high{-9, -9, -9};
    for (const Vec3& p : decal.points)
      for (std::size_t c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
    const Vec3 low_corner{0.5, 0.75, 5}, high_corner{1.5, 1.25, 5};
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(low[c], low_corner[c], 1e-9);
      EXPECT_NEAR(high[c], high_corner[c], 1e-9);
    }
    const auto json = read_json(folder / "decal.json");
    EXPECT_NEAR(json.at("covered").get<double>(), 1, 1e-9);
    EXPECT_NEAR(json.at("distortion").at("mean").get<double>(), 1, 1e-9);
  }
}

TEST(DecalCommand, KeepsTheNormalsOfWhatIsFarAway) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  const std::string image = half_and_half(folder), plate_file = folder.write("plate.off", plate());
  for (const std::string local : {"", "--local"}) {
    std::vector<std::string> words{"decal",     plate_file, "--image", image, "--source",
                                   "0.3,0.3,5", "--size",   "0.3",     "-o",  folder / "decal.obj"};
    if (!local.empty()) words.push_back(local);
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const io::Geometry decal = io::read(folder / "decal.obj");
    EXPECT_GE(decal.normals.size(), 441U) << local;
    for (const Vec3& normal : decal.normals) EXPECT_NEAR(normal[2], 1, 1e-9) << local;
  }
}

TEST(DecalCommand, PaintsPointsUnderTheOpaquePart) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  const std::string image = half_and_half(folder);
  const auto points = plane(30);
  for (const std::string& input : {folder.write("plate.off", plate()), folder.write("plane.xyz", xyz(points))}) {
    const bool is_mesh = input.ends_with("off");
    const Vec3 middle = is_mesh ? Vec3{1, 1, 5} : points[0];
    const Outcome outcome = run({"decal", input, "--image", image, "--source", is_mesh ? "1,1,5" : "0", "--u-axis",
                                 "1,0,0", "--size", "0.6", "-o", folder / "out.ply", "--view", folder / "view.png"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const io::Geometry out = io::read(folder / "out.ply");
    int red = 0, blue = 0;
    double below = 0;  // the plane may be seen from either side
    for (std::size_t i = 0; i < out.points.size(); ++i) {
      const double x = out.points[i][0] - middle[0], y = out.points[i][1] - middle[1];
      const auto [r, g, b] = out.colors[i];
      if (r == g && g == b) continue;
      EXPECT_TRUE(std::abs(x) < 0.02 || (r > b) == (x < 0)) << x << ' ' << y;
      EXPECT_LE(std::abs(x), 0.3 + 1e-9);
      EXPECT_LE(std::abs(y), 0.15 + 1e-9);
      if (std::abs(y) > 0.02) {
        if (below == 0) below = y;
        EXPECT_GT(y * below, 0);
      }
      r > b ? ++red : ++blue;
    }
    EXPECT_GT(std::min(red, blue), is_mesh ? 2 : 20);
    EXPECT_EQ(out.face_count(), is_mesh ? 400U : 0U);
  }
}

TEST(DecalCommand, KeepsTheColumnsThatCameIn) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  std::string text = "//X Y Z Amplitude\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(i % 10) + " " + std::to_string(i / 10) + " 0 " + std::to_string(0.5 * i) + "\n";
  const std::string input = folder.write("scan.xyz", text);
  ASSERT_EQ(run({"decal", input, "--image", half_and_half(folder), "-s", "55", "--size", "3", "-o", folder / "out.ply"})
                .status,
            0);
  const io::Geometry given = io::read(input), out = io::read(folder / "out.ply");
  ASSERT_EQ(out.properties.size(), 1U);
  EXPECT_EQ(out.properties[0].name, given.properties.at(0).name);
  EXPECT_EQ(out.properties[0].values, given.properties.at(0).values);
}

TEST(DecalCommand, LeavesOutWhatLiesBeyondTheSurface) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  const Outcome outcome = run({"decal", folder.write("plate.off", plate()), "--image", half_and_half(folder), "-s",
                               "0,1,5", "--u-axis", "1,0,0", "--size", "1", "-o", folder / "decal.glb", "--json",
                               folder / "decal.json", "--view", folder / "view.png"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(read_json(folder / "decal.json").at("covered").get<double>(), 0.5, 1e-9);
  EXPECT_NE(outcome.err.find("50 % of the image"), std::string::npos) << outcome.err;
}

TEST(DecalCommand, RefusesWhatItCannotDo) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Folder folder;
  const std::string input = folder.write("plate.off", plate()), image = half_and_half(folder);
  const auto refuses = [&](std::vector<std::string> arguments, const std::string& part) {
    arguments.insert(arguments.begin(), {"decal", input});
    const Outcome outcome = run(arguments);
    EXPECT_NE(outcome.status, 0);
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  };
  const std::string out = folder / "out.obj";
  refuses({"--image", folder / "none.png", "-s", "0", "--size", "1", "-o", out}, "none.png");
  refuses({"--image", input, "-s", "0", "--size", "1", "-o", out}, "PNG or JPEG");
  refuses({"--image", image, "-s", "0", "--size", "0", "-o", out}, "--size");
  refuses({"--image", image, "-s", "0", "--size", "-1", "-o", out}, "--size");
  refuses({"--image", image, "-s", "9999", "--size", "1", "-o", out}, "9999");
  refuses({"--image", image, "-s", "0", "--size", "1", "-o", folder / "out.csv"}, ".ply");
  refuses({"--image", image, "-s", "0", "--size", "1", "--lift", "0.1", "-o", folder / "out.ply"}, "--lift");
  refuses({"--image", image, "-s", "0", "--size", "1", "-o", folder / "out.glb", "--json", image}, "image.png");
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"image.png", "plate.off"}));
}

}  // namespace
}  // namespace ahm::test
