// Pictures of textured meshes and colored points.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "ahm/error.hpp"
#include "ahm/render/textured_picture.hpp"

namespace ahm::render {
namespace {

/// A square [-1, 1]^2 in the plane z = `height`, facing +z, under an image.
struct Square {
  std::vector<Vec3> points;
  std::vector<Offset> begin{0, 4};
  std::vector<Index> vertices{0, 1, 2, 3};
  std::vector<double> places{0, 0, 1, 0, 1, 1, 0, 1};

  explicit Square(double height) : points{{-1, -1, height}, {1, -1, height}, {1, 1, height}, {-1, 1, height}} {}
  io::MeshPart part(const Image* image) const {
    io::MeshPart part;
    part.name = "square";
    part.points = points;
    part.faces = {begin, vertices};
    if (image) part.texture_coordinates = places;
    part.texture = image;
    return part;
  }
};

/// `color(column, row)`: red, green, blue, opacity.
Image painted(int size, const std::function<std::array<int, 4>(int, int)>& color) {
  Image image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      for (std::size_t c = 0; c < 4; ++c) image.pixel(x, y)[c] = static_cast<std::uint8_t>(color(x, y)[c]);
  return image;
}

class TexturedPicture : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  }
  void TearDown() override { std::filesystem::remove(path_); }

  /// Seen from +z, y upwards; the square fills the middle of the picture.
  Image picture(const TexturedScene& scene) const {
    PictureOptions options;
    options.width = options.height = 200;
    options.view_direction = Vec3{0, 0, 1};
    options.up = Vec3{0, 1, 0};
    write_textured_png(path_, scene, options);
    return io::read_image(path_);
  }

  std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                ("ahm_textured_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
                                 ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".png");
};

TEST_F(TexturedPicture, ShowsTheImageTheRightWayUp) {
  const Image image = painted(8, [](int x, int y) {  // red left, green right; dark below
    const int light = y < 4 ? 250 : 120;
    return std::array{x < 4 ? light : 0, x < 4 ? 0 : light, 0, 255};
  });
  const Square square(0);
  const std::array parts{square.part(&image)};
  const Image shown = picture({.parts = parts});
  const auto at = [&](int x, int y, int c) { return static_cast<int>(shown.pixel(x, y)[c]); };
  EXPECT_GT(at(60, 60, 0), 2 * at(60, 60, 1) + 50);
  EXPECT_GT(at(140, 60, 1), 2 * at(140, 60, 0) + 50);
  EXPECT_GT(at(60, 60, 0), at(60, 140, 0) + 30);
  EXPECT_EQ(at(2, 2, 0) + at(2, 2, 1) + at(2, 2, 2), 3 * 255);  // nothing there
}

TEST_F(TexturedPicture, LaysTransparentPartsOverWhatLiesBehind) {
  const Image image = painted(8, [](int x, int) { return std::array{0, 0, 255, x < 4 ? 0 : 255}; });
  const Square behind(0), before(0.01), covered(-0.01);
  io::MeshPart base = behind.part(nullptr), decal = before.part(&image), under = covered.part(&image);
  base.color = {1, 0, 0};
  decal.transparent = under.transparent = true;
  for (const bool above : {true, false}) {
    const std::array parts{above ? decal : under, base};  // whatever the order
    const Image shown = picture({.parts = parts});
    EXPECT_GT(shown.pixel(60, 100)[0], 100);
    EXPECT_EQ(shown.pixel(60, 100)[2], 0);
    EXPECT_EQ(shown.pixel(140, 100)[above ? 0 : 2], 0);
    EXPECT_GT(shown.pixel(140, 100)[above ? 2 : 0], 100);
  }
}

TEST_F(TexturedPicture, ShowsPointsAsDiscsInTheirColors) {
  const std::vector<Vec3> points{{-1, 0, 0}, {1, 0, 0}, {1, 0, -1}};  // the last lies behind the second
  const std::vector<std::array<std::uint8_t, 3>> colors{{200, 0, 0}, {0, 200, 0}, {0, 0, 200}};
  const std::vector<double> radii{0.3, 0.3, 0.3};
  const Image shown = picture({.points = points, .colors = colors, .radii = radii});
  int red = 0, green = 0, blue = 0, left_of_green = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const std::uint8_t* p = shown.pixel(x, y);
      red += p[0] > 150 && p[1]<50, blue += p[2]> 150 && p[0] < 50 && p[1] < 50;
      if (p[1] > 150 && p[0] < 50) ++green, left_of_green += x < 100;
    }
  EXPECT_GT(red, 300);
  EXPECT_NEAR(red, green, 0.1 * red);
  EXPECT_LT(blue, 0.3 * green);
  EXPECT_EQ(left_of_green, 0);
}

TEST_F(TexturedPicture, RefusesWhatDoesNotFit) {
  const Square square(0);
  const std::array parts{square.part(nullptr)};
  PictureOptions small;
  small.width = 8;
  EXPECT_THROW(write_textured_png(path_, {.parts = parts}, small), InvalidArgument);
  const std::vector<Vec3> points(3);
  EXPECT_THROW(write_textured_png(path_, {.points = points}), InvalidArgument);
  EXPECT_THROW(write_textured_png(path_, {}), InvalidGeometry);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace ahm::render
