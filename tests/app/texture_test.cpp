// Meshes with texture coordinates: atlases and decals.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ahm/io/read.hpp"
#include "ahm/io/textured_mesh.hpp"
#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

/// The unit sphere: quads between two caps of triangles.
std::string globe(int around) {
  const int rings = around / 2 - 1, last = 1 + rings * around;
  Points points{{0, 0, 1}};
  for (int r = 1; r <= rings; ++r)
    for (int a = 0; a < around; ++a) {
      const double t = pi * r / (rings + 1), p = 2 * pi * a / around;
      points.push_back({std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)});
    }
  points.push_back({0, 0, -1});
  const auto at = [&](int r, int a) { return 1 + (r - 1) * around + a % around; };
  Faces faces;
  for (int a = 0; a < around; ++a) {
    faces.push_back({0, at(1, a), at(1, a + 1)});
    for (int r = 1; r < rings; ++r) faces.push_back({at(r, a), at(r + 1, a), at(r + 1, a + 1), at(r, a + 1)});
    faces.push_back({at(rings, a), last, at(rings, a + 1)});
  }
  return obj(points, faces);
}

class Atlas : public InFolderWithImages {
 protected:
  Atlas() { write("globe.obj", globe(32)); }
};

TEST_F(Atlas, HasEveryPolygonOnceInsideTheTexture) {
  const auto json = summary("atlas globe.obj --charts 8 --size 512 -o atlas.obj --view view.png");
  EXPECT_EQ(files(), (Words{"atlas.mtl", "atlas.obj", "atlas_atlas.png", "globe.obj", "view.png"}));
  EXPECT_EQ(io::read_image("atlas_atlas.png").width, 512);
  EXPECT_EQ(io::read_image("view.png").width, 1600);
  const auto v = obj_lines("atlas.obj", "v"), vt = obj_lines("atlas.obj", "vt"), faces = obj_lines("atlas.obj", "f");
  EXPECT_EQ(v.size(), 482U);
  ASSERT_EQ(faces.size(), 512U);
  const double scale = number(json, "/texture/texels_per_unit") / 512;
  std::size_t quads = 0;
  double ratio = 0;
  for (const auto& face : faces) {  // v, vt and vn of each corner
    quads += face.size() == 12;
    const auto point = [&](std::size_t k) -> Vec3 {
      const auto& p = v.at(static_cast<std::size_t>(face[3 * k]) - 1);
      return {p[0], p[1], p[2]};
    };
    const auto uv = [&](std::size_t k) -> Vec3 {
      const auto& p = vt.at(static_cast<std::size_t>(face[3 * k + 1]) - 1);
      return {p[0], p[1], 0};
    };
    for (std::size_t k = 0; k < face.size() / 3; ++k)
      for (const std::size_t c : {0, 1}) EXPECT_TRUE(uv(k)[c] > 0 && uv(k)[c] < 1);
    ratio += distance(uv(0), uv(1)) / scale / distance(point(0), point(1)) / 512;
  }
  EXPECT_EQ(quads, 32U * 14);
  EXPECT_NEAR(ratio, 1, 0.1);  // mean ratio of lengths in the texture and on the surface
  EXPECT_EQ(json.at("charts").size(), 8U);
  expect_values(json, {{"/uncharted", 0}, {"/distortion/flipped", 0}});
  EXPECT_LT(number(json, "/distortion/percentile_95"), 1.4);
}

TEST_F(Atlas, HasMoreSourcesUntilTheChartsAreGood) {
  const Outcome one = run_ok("atlas globe.obj --charts 1 -o one.glb --json one.json");
  const Outcome more = run_ok("atlas globe.obj --charts 1 --max-distortion 1.4 -o more.glb --json more.json");
  EXPECT_TRUE(has(one.err, "--max-distortion"));  // flipped at the back of the sphere
  EXPECT_FALSE(has(more.err, "flipped"));
  const auto before = read_json("one.json"), after = read_json("more.json");
  EXPECT_GT(after.at("sources").size(), 3U);
  EXPECT_LE(number(after, "/distortion/percentile_95"), 1.4);
  EXPECT_LT(number(after, "/distortion/mean"), number(before, "/distortion/mean"));
}

TEST_F(Atlas, OfACloudHasTheSelectedSources) {
  write("sphere.xyz", xyz(sphere(1500)));
  const auto json = summary("atlas sphere.xyz --sources '0 0,0,-1 1,0,0 -1,0,0 0,1,0 0,-1,0' -o s.obj");
  EXPECT_EQ(json.at("sources").size(), 6U);
  EXPECT_LT(number(json, "/distortion/percentile_95"), 1.3);
  EXPECT_NEAR(number(json, "/faces"), 2 * 1500, 60);
}

TEST_F(Atlas, OfACutMeshHasEverySheetFlat) {
  write("book.obj", book(10));
  const auto json = summary("atlas book.obj --non-manifold split --charts 3 -o atlas.obj");
  EXPECT_EQ(json.at("charts").size(), 3U);
  expect_values(json, {{"/uncharted", 0}});
  EXPECT_NEAR(number(json, "/distortion/largest"), 1, 1e-9);
}

TEST_F(Atlas, OptionsAreChecked) {
  expect_refused("atlas globe.obj", {{"-o out.stl", 1, {".obj or .glb"}},
                                     {"-o out.obj --charts 0", 2, {"--charts"}},
                                     {"-o out.obj --max-distortion 1", 2, {"--max-distortion"}},
                                     {"-o out.obj --charts 3 --sources '1 2'", 2, {"--sources"}},
                                     {"-o out.obj --sources '1 1'", 1, {"twice"}},
                                     {"-o out.obj --texture none.png", 1, {"none.png"}},
                                     {"-o out.obj --size 16 --margin 9", 1, {"size"}},
                                     {"-o out.obj --view out.html", 1, {".png"}}});
}

/// A plate of quads, [0, 2]^2 at height 5, and an image: red on the left, blue on the right, and transparent in its upper half.
class Decal : public InFolderWithImages {
 protected:
  void SetUp() override {
    InFolderWithImages::SetUp();
    write("plate.obj", obj(moved(lattice(21, 0.1), {0, 0, 5}), cells(21)));
    Image image(40, 20);
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 40; ++x) {
        std::uint8_t* p = image.pixel(x, y);
        p[0] = x < 20 ? 255 : 0, p[2] = x < 20 ? 0 : 255, p[3] = y < 10 ? 0 : 255;
      }
    io::write_png("image.png", image);
  }
};

TEST_F(Decal, HasItsSizeOnAPlate) {
  for (const std::string method : {"heat", "exact"}) {
    const auto json = summary(
        "decal plate.obj --image image.png --source 1,1,5 --u-axis 1,0,0 --size 1 --lift 0 --alone -o decal.obj "
        "--method " +
        method);
    Vec3 low{9, 9, 9}, high{-9, -9, -9};
    for (const Vec3& p : io::read("decal.obj").points)
      for (std::size_t c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
    EXPECT_LT(distance(low, {0.5, 0.75, 5}), 1e-9);
    EXPECT_LT(distance(high, {1.5, 1.25, 5}), 1e-9);
    EXPECT_NEAR(number(json, "/covered"), 1, 1e-9);
    EXPECT_NEAR(number(json, "/distortion/mean"), 1, 1e-9);
  }
}

TEST_F(Decal, KeepsTheNormalsOfTheWholeMesh) {
  for (const std::string local : {"", " --local"}) {
    run_ok("decal plate.obj --image image.png --source 0.3,0.3,5 --size 0.3 -o decal.obj" + local);
    const io::Geometry decal = io::read("decal.obj");
    EXPECT_GE(decal.normals.size(), 441U) << local;
    for (const Vec3& normal : decal.normals) EXPECT_NEAR(normal[2], 1, 1e-9) << local;
  }
}

TEST_F(Decal, ColorsPointsUnderItsOpaquePart) {
  const auto points = plane(30);
  write("plane.xyz", xyz(points));
  for (const bool is_mesh : {true, false}) {
    const Vec3 middle = is_mesh ? Vec3{1, 1, 5} : points[0];
    run_ok((is_mesh ? "decal plate.obj --source 1,1,5" : "decal plane.xyz --source 0") +
           std::string(" --image image.png --u-axis 1,0,0 --size 0.6 -o out.ply --view view.png"));
    const io::Geometry out = io::read("out.ply");
    int red = 0, blue = 0;
    double below = 0;  // the normal of the plane may have either sign
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

TEST_F(Decal, KeepsTheColumnsOfTheInput) {
  std::string text = "//X Y Z Amplitude\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(i % 10) + " " + std::to_string(i / 10) + " 0 " + std::to_string(0.5 * i) + "\n";
  write("scan.xyz", text);
  run_ok("decal scan.xyz --image image.png -s 55 --size 3 -o out.ply");
  const io::Geometry input = io::read("scan.xyz"), out = io::read("out.ply");
  ASSERT_EQ(out.properties.size(), 1U);
  EXPECT_EQ(out.properties[0].name, input.properties.at(0).name);
  EXPECT_EQ(out.properties[0].values, input.properties.at(0).values);
}

TEST_F(Decal, LeavesOutWhatIsBeyondTheSurface) {
  const Outcome outcome = run_ok(
      "decal plate.obj --image image.png -s 0,1,5 --u-axis 1,0,0 --size 1 -o decal.glb --json decal.json --view "
      "view.png");
  EXPECT_NEAR(number(read_json("decal.json"), "/covered"), 0.5, 1e-9);
  EXPECT_TRUE(has(outcome.err, "50 % of the image"));
}

TEST_F(Decal, OptionsAreChecked) {
  expect_refused("decal plate.obj", {{"--image none.png -s 0 --size 1 -o out.obj", 1, {"none.png"}},
                                     {"--image plate.obj -s 0 --size 1 -o out.obj", 1, {"PNG or JPEG"}}});
  expect_refused("decal plate.obj --image image.png",
                 {{"-s 0 --size 0 -o out.obj", 2, {"--size"}},
                  {"-s 0 --size -1 -o out.obj", 2, {"--size"}},
                  {"-s 9999 --size 1 -o out.obj", 1, {"9999"}},
                  {"-s 0 --size 1 -o out.csv", 1, {".ply"}},
                  {"-s 0 --size 1 --lift 0.1 -o out.ply", 1, {"--lift"}},
                  {"-s 0 --size 1 -o out.glb --json image.png", 1, {"image.png"}}});
}

}  // namespace
}  // namespace ahm::test
