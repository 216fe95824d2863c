#include <gtest/gtest.h>

#include <set>

#include "ahm/error.hpp"
#include "ahm/io/image.hpp"
#include "pixels.hpp"

namespace ahm::render::test {
namespace {

class Png : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_write_png()) GTEST_SKIP() << "built without stb";
  }

  PictureOptions options = from_above();
  Folder folder;
};

Pixels picture(const Folder& folder, const Scene& scene, const PictureOptions& options) {
  write_png(folder / "picture.png", scene, options);
  return Pixels(io::read_image(folder / "picture.png"));
}

TEST_F(Png, HasTheSizeAskedForAndAWhiteBackground) {
  for (const bool is_mesh : {true, false}) {
    const Patch patch(40, is_mesh);
    const Pixels pixels = picture(folder, patch.scene(), options);
    ASSERT_EQ(pixels.width, 400);
    ASSERT_EQ(pixels.height, 300);
    for (const int x : {0, 399})
      for (const int y : {0, 299}) EXPECT_TRUE(is_white(pixels(x, y)));
    EXPECT_EQ(folder.files(), 1U);
  }
}

std::set<Rgb> colors(const Pixels& pixels) {
  std::set<Rgb> result;
  pixels.count([&](const Rgb& c) { return result.insert(c).second; });
  return result;
}

TEST_F(Png, IsPaintedInManyColors) {
  for (const bool is_mesh : {true, false}) {
    const Patch patch(40, is_mesh);
    const Pixels pixels = picture(folder, patch.scene(), options);
    EXPECT_GT(colors(pixels).size(), 300U);
    EXPECT_GT(pixels.count(is_colored), 400 * 300 / 4);
  }
}

TEST_F(Png, MarksTheSourceInRedWhereItIs) {
  // Seen from straight above, the patch fills the height up to the margin: u = 0.5 lies a quarter of that to the right.
  for (const double shift : {0.0, 0.5}) {
    const Patch patch(40, true);
    Scene scene = patch.scene();
    scene.source = {shift, 0, 0};
    const Pixels pixels = picture(folder, scene, options);
    const double expected = 200 + shift * 0.5 * 300 / 1.08;
    for (int y = 148; y <= 151; ++y) EXPECT_TRUE(is_source_red(pixels(static_cast<int>(expected), y)));
  }
}

TEST_F(Png, RingsHaveTheGivenWidth) {
  // Along a ray inside one sector, light and dark alternate: 0.2 and 0.6 are in light rings, 0.3 and 0.5 in their
  // borders.
  const Patch patch(40, true);
  options.ring_width = 0.2;
  options.sectors = 2;
  const Pixels pixels = picture(folder, patch.scene(), options);
  const auto brightness = [&](double r) {
    const int offset = static_cast<int>(std::lround(r * 0.5 * 300 / 1.08 * std::sqrt(0.5)));
    return render::test::brightness(pixels(200 - offset, 150 - offset));
  };
  for (const double r : {0.3, 0.7}) {
    EXPECT_LT(brightness(r) + 60, brightness(r + 0.2));
    EXPECT_LT(brightness(r + 0.4) + 60, brightness(r + 0.2));
  }
}

int difference(const Rgb& a, const Rgb& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

TEST_F(Png, SquaresAreWarmOnTheLeftAndColdOnTheRight) {
  for (const bool is_mesh : {true, false}) {
    const Patch patch(40, is_mesh);
    options.pattern = Pattern::grid;
    options.ring_width = 0.2;
    const Pixels pixels = picture(folder, patch.scene(), options);
    for (const double x : {-0.7, -0.3, 0.3, 0.5}) {
      const Rgb left = at_place(pixels, x, 0.1), right = at_place(pixels, x, -0.1);
      EXPECT_GT(left[0], left[2] + 30);
      EXPECT_GT(right[2], right[0] + 30);
      for (const double y : {0.1, -0.1})  // next to each other, light and dark
        EXPECT_GT(difference(at_place(pixels, x, y), at_place(pixels, x + 0.2, y)), 60);
    }
  }
}

TEST_F(Png, NeighbouringCellsDifferAndPointsOfNoCellAreGray) {
  for (const bool is_mesh : {true, false}) {
    const Patch patch(60, is_mesh);
    std::vector<Index> labels;
    for (const Vec3& p : patch.points) {  // bricks, numbered so that neighbours have any numbers
      const int column = static_cast<int>(std::floor(2.5 * (p[0] + 1))),
                row = static_cast<int>(std::floor(2.5 * (p[1] + 1)));
      labels.push_back(row >= 5 || column >= 5 || (row == 2 && column == 2) ? -1 : 7 * (5 * row + column) % 25);
    }
    const std::vector<double> distance(labels.size(), 0.1);
    Scene scene = patch.scene();
    scene.u = scene.v = {};
    scene.labels = labels;
    scene.distance = distance;
    scene.source = patch.points.front();
    scene.source_axes.reset();
    options.pattern = Pattern::cells;
    const Pixels pixels = picture(folder, scene, options);
    const auto brick = [&](int row, int column) { return at_place(pixels, 0.4 * column - 0.8, 0.4 * row - 0.8); };
    EXPECT_FALSE(is_colored(brick(2, 2)));
    for (int row = 0; row < 5; ++row)
      for (int column = 0; column < 5; ++column)
        for (const auto& [r, c] :
             {std::pair{row, column + 1}, std::pair{row + 1, column}, std::pair{row + 1, column + 1}}) {
          if (r == 5 || c == 5) continue;
          EXPECT_GT(difference(brick(row, column), brick(r, c)), 40) << row << ' ' << column << ' ' << r << ' ' << c;
        }
  }
}

TEST_F(Png, DrawsCurveAndDotsWhereNothingHidesThem) {
  for (const bool is_mesh : {true, false}) {
    const Patch patch(40, is_mesh);
    for (const double z : {0.0, -0.5}) {
      const std::vector<Vec3> curve{{-0.5, 0.5, z}, {0.5, 0.5, z}}, dots{{-0.5, -0.5, z}};
      Scene scene = patch.scene();
      scene.curve = curve;
      scene.dots = dots;
      const Pixels pixels = picture(folder, scene, options);
      for (const double x : {-0.45, -0.2, 0.45}) EXPECT_EQ(is_source_red(at_place(pixels, x, 0.5)), z == 0) << x;
      EXPECT_EQ(is_source_red(at_place(pixels, -0.5, -0.5)), z == 0);
    }
  }
}

TEST_F(Png, DrawsNothingBetweenThePiecesOfACurve) {
  const Patch patch(40, true);
  const std::vector<Vec3> curve{{-0.5, 0.5, 0}, {-0.2, 0.5, 0}, {0.2, 0.5, 0}, {0.5, 0.5, 0}};
  const std::vector<Index> pieces{2}, beyond{4}, unsorted{2, 1};
  Scene scene = patch.scene();
  scene.curve = curve;
  EXPECT_TRUE(is_source_red(at_place(picture(folder, scene, options), 0, 0.5)));
  scene.curve_pieces = pieces;
  const Pixels pixels = picture(folder, scene, options);
  for (const double x : {-0.35, 0.35}) EXPECT_TRUE(is_source_red(at_place(pixels, x, 0.5))) << x;
  EXPECT_FALSE(is_source_red(at_place(pixels, 0, 0.5)));
  for (const auto& wrong : {beyond, unsorted}) {
    scene.curve_pieces = wrong;
    EXPECT_THROW(write_png(folder / "curve.png", scene, options), InvalidArgument);
  }
}

TEST_F(Png, IsTheSameEveryTime) {
  for (const bool is_mesh : {true, false}) {
    const Patch patch(40, is_mesh);
    write_png(folder / "a.png", patch.scene(), options);
    write_png(folder / "b.png", patch.scene(), options);
    EXPECT_EQ(read(folder / "a.png"), read(folder / "b.png"));
  }
}

TEST_F(Png, DoesNotDependOnHowFarFromTheOriginTheSceneLies) {
  for (const bool is_mesh : {true, false}) {
    const Patch near(64, is_mesh), far(64, is_mesh, {1048576, -2097152, 524288});  // exact in double: same patch, moved
    const Pixels a = picture(folder, near.scene(), options), b = picture(folder, far.scene(), options);
    int different = 0;
    for (std::size_t k = 0; k < a.image().rgba.size(); ++k)
      different += std::abs(a.image().rgba[k] - b.image().rgba[k]) > 8 ? 1 : 0;
    EXPECT_LT(different, 400 * 300 / 1000);
  }
}

TEST_F(Png, PointsWithoutCoordinatesAreGray) {
  for (const bool is_mesh : {true, false}) {
    Patch patch(40, is_mesh);
    patch.forget_map();
    const Pixels pixels = picture(folder, patch.scene(), options);
    EXPECT_GT(pixels.count([](const Rgb& c) { return !is_white(c) && !is_colored(c); }), 400 * 300 / 4);
    EXPECT_LT(pixels.count(is_colored), 400 * 300 / 100);  // the source mark
  }
}

TEST_F(Png, FloatersDoNotShrinkThePicture) {
  Patch patch(40, false);
  for (const double x : {1e3, -1e3, 1e6}) {
    patch.points.push_back({x, x, x});
    patch.normals.push_back({0, 0, 1});
    patch.u.push_back(x);
    patch.v.push_back(x);
  }
  EXPECT_GT(picture(folder, patch.scene(), options).count(is_colored), 400 * 300 / 4);
}

TEST_F(Png, ShowsSmallAndOddScenes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<Vec3>> clouds = {
      {{0, 0, 0}}, {{5, 5, 5}, {5, 5, 5}}, {{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {nan, 0, 0}, {0, 1, 0}}};
  for (const auto& points : clouds) {
    const std::vector<double> zero(points.size(), 0.0);
    Scene scene;
    scene.points = points;
    scene.u = zero;
    scene.v = zero;
    scene.source = points.front();
    options.view_direction.reset();
    EXPECT_GT(picture(folder, scene, options).count([](const Rgb& c) { return !is_white(c); }), 50);
  }
}

TEST_F(Png, AFailedWriteLeavesNothing) {
  const Patch patch(4, true);
  EXPECT_THROW(write_png(folder / "missing/picture.png", patch.scene(), options), IoError);
  EXPECT_EQ(folder.files(), 0U);
}

}  // namespace
}  // namespace ahm::render::test
