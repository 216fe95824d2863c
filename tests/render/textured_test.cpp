// Pictures of textured meshes and colored points.
#include <functional>

#include "ahm/render/textured_picture.hpp"
#include "pictures.hpp"

namespace ahm::render::test {
namespace {

/// A square [-1, 1]^2 in the plane z = `height` that faces +z.
struct Square {
  std::vector<Vec3> points;
  std::vector<Offset> begin{0, 4};
  std::vector<Index> vertices{0, 1, 2, 3};
  std::vector<double> texture_coordinates{0, 0, 1, 0, 1, 1, 0, 1};

  explicit Square(double height) : points{{-1, -1, height}, {1, -1, height}, {1, 1, height}, {-1, 1, height}} {}
  io::MeshPart part(const Image* image) const {
    io::MeshPart part;
    part.name = "square";
    part.points = points;
    part.faces = {begin, vertices};
    if (image) part.texture_coordinates = texture_coordinates;
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

class TexturedPicture : public testing::Test {
 protected:
  void SetUp() override {
    if (!io::has_images()) GTEST_SKIP() << "built without stb";
  }
  /// Seen from +z, with y upwards. The square fills the middle of the picture.
  Pixels picture(const TexturedScene& scene) const {
    PictureOptions options;
    options.width = options.height = 200;
    options.view_direction = Vec3{0, 0, 1};
    options.up = Vec3{0, 1, 0};
    write_textured_png(file, scene, options);
    return Pixels(io::read_image(file));
  }

  const Folder folder{};
  const std::filesystem::path file = folder / "picture.png";
};

/// Red at the left, green at the right, dark at the bottom.
TEST_F(TexturedPicture, ShowsTheImageUpright) {
  const Image image = painted(8, [](int x, int y) {
    const int light = y < 4 ? 250 : 120;
    return std::array{x < 4 ? light : 0, x < 4 ? 0 : light, 0, 255};
  });
  const Square square(0);
  const std::array parts{square.part(&image)};
  const Pixels shown = picture({.parts = parts});
  EXPECT_GT(shown(60, 60)[0], 2 * shown(60, 60)[1] + 50);
  EXPECT_GT(shown(140, 60)[1], 2 * shown(140, 60)[0] + 50);
  EXPECT_GT(shown(60, 60)[0], shown(60, 140)[0] + 30);
  EXPECT_TRUE(is_white(shown(2, 2)));
}

TEST_F(TexturedPicture, ShowsPartsBehindTransparentParts) {
  const Image image = painted(8, [](int x, int) { return std::array{0, 0, 255, x < 4 ? 0 : 255}; });
  const Square middle(0), front(0.01), back(-0.01);
  io::MeshPart base = middle.part(nullptr), above = front.part(&image), below = back.part(&image);
  base.color = {1, 0, 0};
  above.transparent = below.transparent = true;
  for (const bool is_above : {true, false}) {
    const std::array parts{is_above ? above : below, base};  // transparent parts are drawn last
    const Pixels shown = picture({.parts = parts});
    EXPECT_GT(shown(60, 100)[0], 100);
    EXPECT_EQ(shown(60, 100)[2], 0);
    EXPECT_EQ(shown(140, 100)[is_above ? 0 : 2], 0);
    EXPECT_GT(shown(140, 100)[is_above ? 2 : 0], 100);
  }
}

/// The blue disc is behind the green one.
TEST_F(TexturedPicture, ShowsPointsAsDiscs) {
  const std::vector<Vec3> points{{-1, 0, 0}, {1, 0, 0}, {1, 0, -1}};
  const std::vector<std::array<std::uint8_t, 3>> colors{{200, 0, 0}, {0, 200, 0}, {0, 0, 200}};
  const std::vector<double> radii{0.3, 0.3, 0.3};
  const Pixels shown = picture({.points = points, .colors = colors, .radii = radii});
  std::array<int, 3> pixels{};
  int left_of_green = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const Rgb color = shown(x, y);
        const bool is_disc = color[c] > 150 && color[(c + 1) % 3] < 50 && color[(c + 2) % 3] < 50;
        pixels[c] += is_disc, left_of_green += is_disc && c == 1 && x < 100;
      }
  const auto [red, green, blue] = pixels;
  EXPECT_GT(red, 300);
  EXPECT_NEAR(red, green, 0.1 * red);
  EXPECT_LT(blue, 0.3 * green);
  EXPECT_EQ(left_of_green, 0);
}

TEST_F(TexturedPicture, RefusesSmallPicturesAndIncompleteScenes) {
  const Square square(0);
  const std::array parts{square.part(nullptr)};
  PictureOptions small;
  small.width = 8;
  EXPECT_THROW(write_textured_png(file, {.parts = parts}, small), InvalidArgument);
  const std::vector<Vec3> points(3);
  EXPECT_THROW(write_textured_png(file, {.points = points}), InvalidArgument);
  EXPECT_THROW(write_textured_png(file, {}), InvalidGeometry);
  EXPECT_EQ(folder.files(), 0U);
}

}  // namespace
}  // namespace ahm::render::test
