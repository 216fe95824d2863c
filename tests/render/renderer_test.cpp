// Laws of the renderer: where things are drawn, what hides them, and which points are gray.
#include <set>

#include "pictures.hpp"

namespace ahm::render::test {
namespace {

constexpr int area = 400 * 300;

/// The unit sphere as a cloud of n points along a spiral, with its exact map from the north pole.
struct Sphere {
  std::vector<Vec3> points;
  std::vector<double> u, v;

  explicit Sphere(int n) {
    for (int k = 0; k < n; ++k) {
      const double z = 1 - (2.0 * k + 1) / n, angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
      const double ring = std::sqrt(1 - z * z), polar = std::acos(z);
      points.push_back({ring * std::cos(angle), ring * std::sin(angle), z});
      u.push_back(polar * std::cos(angle)), v.push_back(polar * std::sin(angle));
    }
  }
  Scene scene() const {
    Scene scene;
    scene.points = scene.normals = points;
    scene.u = u, scene.v = v;
    scene.source = {0, 0, 1};
    return scene;
  }
};

/// Laws of meshes and of clouds.
class Drawing : public testing::TestWithParam<bool> {
 protected:
  static Patch make_patch(int n, Vec3 center = {0, 0, 0}) { return Patch(n, GetParam(), center); }
  const Patch patch = make_patch(40);
  Scene scene = patch.scene();
  PictureOptions options = from_above();
};

INSTANTIATE_TEST_SUITE_P(Renderer, Drawing, testing::Values(true, false),
                         [](const auto& tested) { return std::string(tested.param ? "Mesh" : "Cloud"); });

TEST_P(Drawing, HasManyColorsOnAWhiteBackground) {
  const Pixels pixels(scene);
  ASSERT_EQ(pixels.width, 400);
  ASSERT_EQ(pixels.height, 300);
  for (const int x : {0, 399})
    for (const int y : {0, 299}) EXPECT_TRUE(is_white(pixels(x, y)));
  std::set<Rgb> colors;
  pixels.count([&](const Rgb& c) { return colors.insert(c).second; });
  EXPECT_GT(colors.size(), 300U);
  EXPECT_GT(pixels.count(is_colored), area / 4);
}

TEST_P(Drawing, MarksTheSourceInRed) {
  for (const double shift : {0.0, 0.5}) {
    scene.source = {shift, 0, 0};
    const Pixels pixels(scene);
    for (int y = 148; y <= 151; ++y) EXPECT_TRUE(is_red(pixels(static_cast<int>(200 + shift * 0.5 * 300 / 1.08), y)));
  }
}

/// Light and dark alternate along a ray in the middle of a sector. The patch is coarser than the rings.
TEST_P(Drawing, HasRingsAtMultiplesOfTheirWidth) {
  const Patch coarse = make_patch(25);
  options.ring_width = 0.15;
  options.sectors = 4;
  const Pixels pixels(coarse.scene(), options);
  const auto light_at = [&](double r) { return brightness(pixels.at(r * std::sqrt(0.5), r * std::sqrt(0.5))); };
  std::vector<double> borders;
  int before = light_at(0.11);
  for (double r = 0.115; r < 0.95; r += 0.005) {
    if (std::abs(light_at(r) - before) > 60) borders.push_back(r), r += 0.05;
    before = light_at(r);
  }
  ASSERT_EQ(borders.size(), 6U);
  for (std::size_t k = 0; k < borders.size(); ++k) EXPECT_NEAR(borders[k], 0.15 * (static_cast<double>(k) + 1), 0.012);
}

TEST_P(Drawing, HasWarmSquaresOnTheLeftAndColdOnesOnTheRight) {
  options.pattern = Pattern::grid;
  options.ring_width = 0.2;
  const Pixels pixels(scene, options);
  for (const double x : {-0.7, -0.3, 0.3, 0.5}) {
    const Rgb left = pixels.at(x, 0.1), right = pixels.at(x, -0.1);
    EXPECT_GT(left[0], left[2] + 30);
    EXPECT_GT(right[2], right[0] + 30);
    for (const double y : {0.1, -0.1}) EXPECT_GT(difference(pixels.at(x, y), pixels.at(x + 0.2, y)), 60);
  }
}

/// 5 x 5 square cells. Neighboring cells have unrelated numbers; the cell in the middle has none.
TEST_P(Drawing, HasDifferentColorsInNeighboringCells) {
  const Patch fine = make_patch(60);
  std::vector<Index> labels;
  for (const Vec3& p : fine.points) {
    const int column = static_cast<int>(std::floor(2.5 * (p[0] + 1))),
              row = static_cast<int>(std::floor(2.5 * (p[1] + 1)));
    labels.push_back(row >= 5 || column >= 5 || (row == 2 && column == 2) ? -1 : 7 * (5 * row + column) % 25);
  }
  const std::vector<double> distance(labels.size(), 0.1);
  scene = fine.scene();
  scene.u = scene.v = {};
  scene.labels = labels;
  scene.distance = distance;
  scene.source = fine.points.front();
  scene.source_axes.reset();
  options.pattern = Pattern::cells;
  const Pixels pixels(scene, options);
  const auto color = [&](int row, int column) { return pixels.at(0.4 * column - 0.8, 0.4 * row - 0.8); };
  EXPECT_FALSE(is_colored(color(2, 2)));
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column)
      for (const auto& [r, c] : {std::pair{row, column + 1}, {row + 1, column}, {row + 1, column + 1}})
        if (r < 5 && c < 5)
          EXPECT_GT(difference(color(row, column), color(r, c)), 40) << row << ' ' << column << ' ' << r << ' ' << c;
}

TEST_P(Drawing, HidesCurvesAndDotsBehindTheSurface) {
  for (const double z : {0.03, 0.0, -0.1, -0.5}) {
    const std::vector<Vec3> curve{{-0.5, 0.5, z}, {0.5, 0.5, z}}, dots{{-0.5, -0.5, z}};
    scene.curve = curve;
    scene.dots = dots;
    const Pixels pixels(scene);
    for (const double x : {-0.45, -0.2, 0.45}) EXPECT_EQ(is_red(pixels.at(x, 0.5)), z >= 0) << x << ' ' << z;
    EXPECT_EQ(is_red(pixels.at(-0.5, -0.5)), z >= 0) << z;
  }
}

/// The coordinates of the moved patch are exact in double precision.
TEST_P(Drawing, DoesNotDependOnTheDistanceFromTheOrigin) {
  const Patch near = make_patch(64), far = make_patch(64, {1048576, -2097152, 524288});
  const Image a = Pixels(near.scene()).image(), b = Pixels(far.scene()).image();
  int different = 0;
  for (std::size_t k = 0; k < a.rgba.size(); ++k) different += std::abs(a.rgba[k] - b.rgba[k]) > 8 ? 1 : 0;
  EXPECT_LT(different, area / 1000);
}

TEST_P(Drawing, IsGrayWithoutCoordinates) {
  Patch unmapped = patch;
  unmapped.remove_map();
  const Pixels pixels(unmapped.scene());
  EXPECT_GT(pixels.count([](const Rgb& c) { return is_drawn(c) && !is_colored(c); }), area / 4);
  EXPECT_LT(pixels.count(is_colored), area / 100);  // the source
}

TEST_P(Drawing, HatchesPointsOfLowQualityInGray) {
  std::vector<double> quality;
  for (const Vec3& p : patch.points) quality.push_back(p[0] < 0 ? 0.9 : 0.1);
  scene.source_axes.reset();
  const Pixels without(scene);
  scene.quality = quality;
  const Pixels with(scene);
  int colored = 0, light = 0, dark = 0, all = 0;
  for (double x = 0.1; x < 0.9; x += 0.02)
    for (double y = -0.9; y < 0.9; y += 0.02) {
      const Rgb right = with.at(x, y);
      EXPECT_EQ(with.at(-x, y), without.at(-x, y));
      ++all;
      colored += saturation(right) > 45 ? 1 : 0;
      light += brightness(right) > 520 ? 1 : 0, dark += brightness(right) < 460 ? 1 : 0;
    }
  EXPECT_LT(colored, all / 50);
  EXPECT_GT(light, all / 5);
  EXPECT_GT(dark, all / 5);
}

TEST_P(Drawing, DotsPointsWhoseDistanceIsOnlyABound) {
  const std::vector<double> quality(patch.points.size(), 0.9);
  std::vector<double> bounded;
  for (const Vec3& p : patch.points) bounded.push_back(p[0] > 0);
  scene.source_axes.reset();
  scene.quality = quality;
  const Pixels without(scene);
  scene.bounded = bounded;
  const Pixels with(scene);
  int darker = 0, all = 0;
  for (double x = 0.1; x < 0.9; x += 0.013)
    for (double y = -0.9; y < 0.9; y += 0.017) {
      EXPECT_EQ(with.at(-x, y), without.at(-x, y));
      ++all;
      darker += brightness(with.at(x, y)) < 0.8 * brightness(without.at(x, y)) ? 1 : 0;
    }
  EXPECT_GT(darker, all / 16);
  EXPECT_LT(darker, all / 2);
}

TEST_P(Drawing, HasNoHolesBetweenTrianglesOrDiscs) {
  for (const int n : {GetParam() ? 3 : 12, 17, 90, 400}) {
    const Patch any = make_patch(n);
    const Pixels pixels(any.scene());
    for (int y = 20; y < 280; ++y)
      for (int x = 70; x < 330; ++x) ASSERT_TRUE(is_drawn(pixels(x, y))) << n << ' ' << x << ' ' << y;
  }
}

TEST(Renderer, DoesNotDependOnTheNumberOfThreads) {
  const Sphere sphere(20'000);
  const Patch patch(60, true);
  for (const Scene& scene : {sphere.scene(), patch.scene()}) {
    PictureOptions one, many;
    one.threads = 1, many.threads = 7;
    EXPECT_EQ(draw_picture(scene, one).rgba, draw_picture(scene, many).rgba);
  }
}

TEST(Renderer, DrawsCloudsLikeMeshes) {
  const Patch cloud(30, false), mesh(30, true);
  PictureOptions options = from_above();
  options.ring_width = 0.2;
  const Pixels a(cloud.scene(), options), b(mesh.scene(), options);
  int different = 0;
  for (int y = 20; y < 280; ++y)
    for (int x = 70; x < 330; ++x) different += std::abs(brightness(a(x, y)) - brightness(b(x, y))) > 60 ? 1 : 0;
  EXPECT_LT(different, 260 * 260 / 200);
}

TEST(Renderer, DrawsPiecesOfACurveApart) {
  const Patch patch(40, true);
  const std::vector<Vec3> curve{{-0.5, 0.5, 0}, {-0.2, 0.5, 0}, {0.2, 0.5, 0}, {0.5, 0.5, 0}};
  const std::vector<Index> pieces{2}, beyond{4}, unsorted{2, 1};
  Scene scene = patch.scene();
  scene.curve = curve;
  EXPECT_TRUE(is_red(Pixels(scene).at(0, 0.5)));
  scene.curve_pieces = pieces;
  const Pixels pixels(scene);
  for (const double x : {-0.35, 0.35}) EXPECT_TRUE(is_red(pixels.at(x, 0.5))) << x;
  EXPECT_FALSE(is_red(pixels.at(0, 0.5)));
  for (const auto& wrong : {beyond, unsorted}) {
    scene.curve_pieces = wrong;
    EXPECT_THROW(draw_picture(scene), InvalidArgument);
  }
}

TEST(Renderer, HidesMarksBehindASphere) {
  const Sphere sphere(4000);
  const std::vector<Vec3> back{{0, 0, -1}}, front{{0, 0, 1}}, curve{{0.1, 0, -0.99}, {-0.1, 0, -0.99}};
  PictureOptions options = from_above();
  Scene scene = sphere.scene();
  scene.dots = back;
  scene.curve = curve;
  scene.source = {0, 0, -1};
  scene.source_axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
  EXPECT_EQ(Pixels(scene, options).count(is_red), 0);
  scene.dots = front;
  EXPECT_GT(Pixels(scene, options).count(is_red), 10);
  options.view_direction = {{0, 0, -1}};
  EXPECT_GT(Pixels(scene, options).count(is_red), 20);
}

/// Every other point is a third of the spacing in front of the plane; the source is behind it.
TEST(Renderer, ShowsTheSourceOfARoughCloud) {
  Patch patch(20, false);
  for (std::size_t k = 0; k < patch.points.size(); ++k) patch.points[k][2] = k % 2 == 0 ? -0.033 : 0.033;
  Scene scene = patch.scene();
  scene.source = {0, 0, -0.033};
  EXPECT_GT(Pixels(scene).count(is_red), 10);
  scene.source = {0, 0, -0.3};
  EXPECT_LT(Pixels(scene).count(is_red), 10);
}

/// The source is inside a shell. Only the hole in one side shows it.
TEST(Renderer, LooksAtTheSourceThroughAGap) {
  std::vector<Vec3> points;
  for (const Vec3& p : Sphere(6000).points)
    if (p[0] + 0.4 * p[1] < 0.75) points.push_back(p);
  points.push_back({-0.5, 0, 0});
  const std::vector<double> zero(points.size(), 0.0);
  Scene scene;
  scene.points = points, scene.u = scene.v = zero;
  scene.source = points.back();
  scene.source_axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_GT(Pixels(scene, {}).count(is_red), 50);
}

/// A wall without a map stands next to a patch with dots: on each side of the patch, on the left or right half of this side,
/// and as a dense cloud or as one large face.
TEST(Renderer, LooksAtTheMapWhereNoUnmappedPointsHideIt) {
  std::vector<Vec3> dots;
  for (double x = -0.8; x < 1; x += 0.4)
    for (double y = -0.8; y < 1; y += 0.4) dots.push_back({x, y, 0.02});
  PictureOptions options;
  options.width = 640, options.height = 480;
  const auto count_visible = [&](const std::vector<Vec3>& wall, bool is_face) {
    Patch patch(40, is_face);
    std::vector<Index> corners;
    for (const Vec3& p : wall) {
      corners.push_back(static_cast<Index>(patch.points.size()));
      patch.points.push_back(p);
    }
    if (is_face) patch.add_face(corners);
    patch.normals.resize(patch.points.size());
    patch.u.resize(patch.points.size(), NAN), patch.v.resize(patch.points.size(), NAN);
    Scene scene = patch.scene();
    scene.dots = dots;
    return Pixels(scene, options).count(is_red);
  };
  const int all = count_visible({}, false);
  for (int side = 0; side < 4; ++side) {
    const double c = std::array{1, 0, -1, 0}[side], s = std::array{0, 1, 0, -1}[side];
    for (const double half : {-1.0, 1.0}) {
      const auto at = [&](double along, double z) {
        return Vec3{1.1 * c - half * along * s, 1.1 * s + half * along * c, z};
      };
      std::vector<Vec3> dense;
      for (double along = 0.2; along <= 1.2; along += 0.05)
        for (double z = 0; z <= 1.2; z += 0.05) dense.push_back(at(along, z));
      EXPECT_GT(count_visible(dense, false), 0.95 * all) << side << ' ' << half;
      EXPECT_GT(count_visible({at(0.2, 0), at(1.2, 0), at(1.2, 1.2), at(0.2, 1.2)}, true), 0.95 * all)
          << side << ' ' << half;
    }
  }
}

/// Normals of scans have either sign.
TEST(Renderer, ShowsTheSourceOnEverySideOfAThinStem) {
  std::vector<Vec3> points, normals;
  constexpr int around = 16, rings = 400;
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around, sign = k % 2 == 0 ? 1 : -1;
      points.push_back({0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.01 * ring});
      normals.push_back({sign * std::cos(angle), sign * std::sin(angle), 0});
    }
  const std::vector<double> constant(points.size(), 0.1);
  Scene scene;
  scene.points = points, scene.normals = normals, scene.u = scene.v = constant;
  PictureOptions options;
  options.width = 640, options.height = 480;
  for (int k = 0; k < around; ++k) {
    scene.source = points[static_cast<std::size_t>(around * rings / 2 + k)];
    EXPECT_GT(Pixels(scene, options).count(is_red), 20) << k;
  }
}

struct FourTriangles {
  std::vector<Vec3> points;
  std::vector<Index> vertices;
  std::vector<Offset> begin{0, 3, 6, 9, 12};

  Scene scene() const {
    Scene scene;
    scene.points = points, scene.face_begin = begin, scene.face_vertices = vertices;
    return scene;
  }
};

/// Six points, long along the view. The picture has margins of 8 %, as wide on opposite sides.
TEST(Renderer, FillsThePictureFromEveryDirection) {
  const FourTriangles mesh{.points = {{0, 0, 0}, {4, 0.2, 0}, {4, 1, 0.5}, {0.5, 1.5, 0}, {2, 0, 1}, {-1, 0, 2}},
                           .vertices = {0, 1, 2, 0, 2, 3, 0, 4, 1, 0, 5, 4}};
  PictureOptions options = from_above();
  options.pattern = Pattern::none;
  for (const Vec3& direction :
       std::vector<Vec3>{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0.2, 0.1}, {3, -1, 2}}) {
    options.view_direction = direction;
    const Pixels pixels(mesh.scene(), options);
    int left = 400, right = 0, top = 300, bottom = 0;
    for (int y = 0; y < 300; ++y)
      for (int x = 0; x < 400; ++x)
        if (is_drawn(pixels(x, y))) {
          left = std::min(left, x), right = std::max(right, x);
          top = std::min(top, y), bottom = std::max(bottom, y);
        }
    EXPECT_NEAR(left + right, 399, 4) << direction[0] << " " << direction[1] << " " << direction[2];
    EXPECT_NEAR(top + bottom, 299, 4) << direction[0] << " " << direction[1] << " " << direction[2];
    EXPECT_NEAR(std::max((right - left + 1) / 400.0, (bottom - top + 1) / 300.0), 1 / 1.08, 0.01);
  }
}

/// A steep pyramid without a base: the tip is not cut off.
TEST(Renderer, ShowsATipThatPointsAtTheViewer) {
  const FourTriangles mesh{.points = {{0, 0, 8}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                           .vertices = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1}};
  PictureOptions options = from_above();
  options.pattern = Pattern::none;
  const Pixels pixels(mesh.scene(), options);
  for (int x = 196; x < 204; ++x) EXPECT_TRUE(is_drawn(pixels(x, 150))) << x;
}

/// A square in front of the camera, with one corner far behind it.
TEST(Renderer, CutsTrianglesBehindTheCamera) {
  Patch patch(2, true);
  for (Vec3& p : patch.points)
    if (p[0] > 0.5 && p[1] > 0.5) p[2] = 100;
  std::vector<double> u(patch.points.size(), NAN);
  for (std::size_t k : {0, 1, 3, 4}) u[k] = patch.u[k];
  Scene scene = patch.scene();
  scene.u = scene.v = u;
  EXPECT_GT(Pixels(scene).count(is_drawn), area / 4);
}

TEST(Renderer, BrightnessIncreasesWithDistanceAndAlongTheColorBar) {
  const Patch patch(60, true);
  PictureOptions options = from_above();
  options.width = 800, options.height = 600;
  options.pattern = Pattern::distance;
  options.ring_width = 10;  // no lines
  Scene scene = patch.scene();
  scene.source_axes.reset();
  const Pixels pixels(scene, options);
  const auto luminance = [&](int x, int y) {
    const Rgb c = pixels(x, y);
    return 30 * c[0] + 59 * c[1] + 11 * c[2];
  };
  for (int r = 40; r < 270; r += 10) EXPECT_GT(luminance(400 + r, 300), luminance(390 + r, 300)) << r;
  int levels = 0;
  for (int y = 570; y > 426; y -= 4) {
    EXPECT_GE(luminance(26, y), luminance(26, y + 4)) << y;
    levels += luminance(26, y) > luminance(26, y + 4) ? 1 : 0;
  }
  EXPECT_GE(levels, 25);
}

TEST(Renderer, DrawsASurfaceWithoutAMap) {
  const Patch patch(20, true);
  Scene scene = patch.scene();
  scene.u = scene.v = {};
  scene.source_axes.reset();
  PictureOptions options = from_above();
  options.pattern = Pattern::none;
  EXPECT_GT(Pixels(scene, options).count([](const Rgb& c) { return is_drawn(c) && saturation(c) < 25; }), area / 3);
}

TEST(Renderer, IgnoresFarOutliersWhenItChoosesTheFrame) {
  Patch patch(40, false);
  for (const double x : {1e3, -1e3, 1e6}) {
    patch.points.push_back({x, x, x});
    patch.normals.push_back({0, 0, 1});
    patch.u.push_back(x), patch.v.push_back(x);
  }
  EXPECT_GT(Pixels(patch.scene()).count(is_colored), area / 4);
}

TEST(Renderer, DrawsTinyClouds) {
  const std::vector<std::vector<Vec3>> clouds = {
      {{0, 0, 0}}, {{5, 5, 5}, {5, 5, 5}}, {{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}}};
  PictureOptions options = from_above();
  options.view_direction.reset();
  for (const auto& points : clouds) {
    const std::vector<double> zero(points.size(), 0.0);
    Scene scene;
    scene.points = points;
    scene.u = scene.v = zero;
    scene.source = points.front();
    EXPECT_GT(Pixels(scene, options).count(is_drawn), 50);
  }
}

}  // namespace
}  // namespace ahm::render::test
