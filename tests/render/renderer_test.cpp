// Laws of the renderer: what is where, what hides what, and what is not to be trusted.
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "pixels.hpp"

namespace ahm::render::test {
namespace {

/// Unit sphere as a cloud of n points along a spiral, with its exact map from the north pole.
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

/// Radii at which light changes along a ray through the middle of a sector, in units of the patch.
std::vector<double> ring_borders(const Pixels& pixels, double direction, double to) {
  std::vector<double> borders;
  double before = brightness(at_place(pixels, 0.11 * std::cos(direction), 0.11 * std::sin(direction)));
  for (double r = 0.115; r < to; r += 0.005) {
    const double now = brightness(at_place(pixels, r * std::cos(direction), r * std::sin(direction)));
    if (std::abs(now - before) > 60) borders.push_back(r), r += 0.05;
    before = brightness(at_place(pixels, r * std::cos(direction), r * std::sin(direction)));
  }
  return borders;
}

TEST(Renderer, RingsOfAPlaneLieAtWholeRingWidths) {
  for (const bool is_mesh : {true, false}) {
    const Patch patch(25, is_mesh);  // coarser than the rings are wide: the pattern is not that of single points
    PictureOptions options = from_above();
    options.ring_width = 0.15;
    options.sectors = 4;
    const std::vector<double> borders =
        ring_borders(Pixels(draw_picture(patch.scene(), options)), 0.25 * std::numbers::pi, 0.95);
    ASSERT_EQ(borders.size(), 6U) << is_mesh;
    for (std::size_t k = 0; k < borders.size(); ++k)
      EXPECT_NEAR(borders[k], 0.15 * (static_cast<double>(k) + 1), 0.012);
  }
}

TEST(Renderer, RingsOfACloudAreAsCleanAsThoseOfTheMesh) {
  const Patch cloud(30, false), mesh(30, true);
  PictureOptions options = from_above();
  options.ring_width = 0.2;
  const Pixels a(draw_picture(cloud.scene(), options)), b(draw_picture(mesh.scene(), options));
  int different = 0;
  for (int y = 20; y < 280; ++y)
    for (int x = 70; x < 330; ++x) different += std::abs(brightness(a(x, y)) - brightness(b(x, y))) > 60 ? 1 : 0;
  EXPECT_LT(different, 260 * 260 / 200);
}

TEST(Renderer, HidesDotsSourceAndCurveBehindTheSurface) {
  const Sphere sphere(4000);
  const std::vector<Vec3> dots{{0, 0, -1}}, front{{0, 0, 1}}, curve{{0.1, 0, -0.99}, {-0.1, 0, -0.99}};
  PictureOptions options = from_above();
  Scene scene = sphere.scene();
  scene.dots = dots;
  scene.curve = curve;
  scene.source = {0, 0, -1};
  scene.source_axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
  EXPECT_EQ(Pixels(draw_picture(scene, options)).count(is_source_red), 0);
  scene.dots = front;
  EXPECT_GT(Pixels(draw_picture(scene, options)).count(is_source_red), 10);
  options.view_direction = {{0, 0, -1}};
  EXPECT_GT(Pixels(draw_picture(scene, options)).count(is_source_red), 20);
}

TEST(Renderer, ShowsTheSourceAmongTheDiscsOfARoughCloud) {
  // Every other point a third of the spacing before the plane, the source behind it.
  Patch patch(20, false);
  for (std::size_t k = 0; k < patch.points.size(); ++k) patch.points[k][2] = k % 2 == 0 ? -0.033 : 0.033;
  Scene scene = patch.scene();
  scene.source = {0, 0, -0.033};
  EXPECT_GT(Pixels(draw_picture(scene, from_above())).count(is_source_red), 10);
  scene.source = {0, 0, -0.3};
  EXPECT_LT(Pixels(draw_picture(scene, from_above())).count(is_source_red), 10);
}

TEST(Renderer, LooksAtTheSourceThroughAGap) {
  // A shell with a hole at one side, seen from the source inside of it: nothing but the hole shows it.
  Sphere shell(6000);
  std::vector<Vec3> points;
  for (const Vec3& p : shell.points)
    if (p[0] + 0.4 * p[1] < 0.75) points.push_back(p);
  points.push_back({-0.5, 0, 0});
  const std::vector<double> zero(points.size(), 0.0);
  Scene scene;
  scene.points = points, scene.u = scene.v = zero;
  scene.source = points.back();
  scene.source_axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_GT(Pixels(draw_picture(scene)).count(is_source_red), 50);
}

TEST(Renderer, LooksAtTheMapFromWhereNothingWithoutAMapStandsBeforeIt) {
  std::vector<Vec3> dots;  // on the ground, and to be seen from wherever nothing stands before it
  for (double x = -0.8; x < 1; x += 0.4)
    for (double y = -0.8; y < 1; y += 0.4) dots.push_back({x, y, 0.02});
  struct Wall {
    std::vector<Vec3> points;
    bool is_one_face = false;
  };
  const auto seen = [&](const Wall& wall) {
    Patch patch(40, wall.is_one_face);
    if (wall.is_one_face) {
      for (std::size_t k = 0; k < wall.points.size(); ++k)
        patch.face_vertices.push_back(static_cast<Index>(patch.points.size() + k));
      patch.face_begin.push_back(static_cast<Offset>(patch.face_vertices.size()));
    }
    patch.points.insert(patch.points.end(), wall.points.begin(), wall.points.end());
    patch.normals.resize(patch.points.size());
    patch.u.resize(patch.points.size(), NAN), patch.v.resize(patch.points.size(), NAN);
    Scene scene = patch.scene();
    scene.dots = dots;
    PictureOptions options;
    options.width = 640, options.height = 480;
    return Pixels(draw_picture(scene, options)).count(is_source_red);
  };
  const int all = seen({});
  for (int side = 0; side < 4; ++side) {  // of a wall beside the ground: from its side the source could be seen
    const double c = std::array{1, 0, -1, 0}[side], s = std::array{0, 1, 0, -1}[side];
    for (const double hand : {-1.0, 1.0}) {
      const auto at = [&](double along, double z) {
        return Vec3{1.1 * c - hand * along * s, 1.1 * s + hand * along * c, z};
      };
      Wall dense, wide{{at(0.2, 0), at(1.2, 0), at(1.2, 1.2), at(0.2, 1.2)}, true};
      for (double along = 0.2; along <= 1.2; along += 0.05)
        for (double z = 0; z <= 1.2; z += 0.05) dense.points.push_back(at(along, z));
      EXPECT_GT(seen(dense), 0.95 * all) << side << ' ' << hand;
      EXPECT_GT(seen(wide), 0.95 * all) << side << ' ' << hand << ", one face";
    }
  }
}

TEST(Renderer, ThinStemsOfCloudsStandAndShowTheSourceOnWhicheverSideItLies) {
  std::vector<Vec3> points, normals;
  constexpr int around = 16, rings = 400;
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      points.push_back({0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.01 * ring});
      const double sign = k % 2 == 0 ? 1 : -1;  // scans come with either
      normals.push_back({sign * std::cos(angle), sign * std::sin(angle), 0});
    }
  const std::vector<double> u(points.size(), 0.1), v(points.size(), 0.1);
  Scene scene;
  scene.points = points, scene.normals = normals, scene.u = u, scene.v = v;
  PictureOptions options;
  options.width = 640, options.height = 480;
  for (int k = 0; k < around; ++k) {
    scene.source = points[static_cast<std::size_t>(around * rings / 2 + k)];
    const Pixels pixels(draw_picture(scene, options));
    EXPECT_GT(pixels.count(is_source_red), 20) << k;
  }
}

TEST(Renderer, ADotOnThinGroundIsSeenFromAboveAlone) {
  for (const bool is_mesh : {true, false}) {
    const Patch patch(60, is_mesh);
    const std::vector<Vec3> above{{0.5, 0.5, 0.03}}, below{{0.5, 0.5, -0.1}};
    Scene scene = patch.scene();
    scene.dots = above;
    EXPECT_TRUE(is_source_red(at_place(Pixels(draw_picture(scene, from_above())), 0.5, 0.5)));
    scene.dots = below;
    EXPECT_FALSE(is_source_red(at_place(Pixels(draw_picture(scene, from_above())), 0.5, 0.5)));
  }
}

TEST(Renderer, HatchesInGrayWhatIsNotToBeTrusted) {
  for (const bool is_mesh : {true, false}) {
    const Patch patch(40, is_mesh);
    std::vector<double> quality;
    for (const Vec3& p : patch.points) quality.push_back(p[0] < 0 ? 0.9 : 0.1);
    Scene scene = patch.scene();
    scene.source_axes.reset();
    const Pixels trusted(draw_picture(scene, from_above()));
    scene.quality = quality;
    const Pixels pixels(draw_picture(scene, from_above()));
    int colored = 0, light = 0, dark = 0, all = 0;
    for (double x = 0.1; x < 0.9; x += 0.02)
      for (double y = -0.9; y < 0.9; y += 0.02) {
        const Rgb right = at_place(pixels, x, y);
        EXPECT_EQ(at_place(pixels, -x, y), at_place(trusted, -x, y));
        ++all;
        colored += spread(right) > 45 ? 1 : 0;
        light += brightness(right) > 520 ? 1 : 0, dark += brightness(right) < 460 ? 1 : 0;
      }
    EXPECT_LT(colored, all / 50) << is_mesh;
    EXPECT_GT(light, all / 5);
    EXPECT_GT(dark, all / 5);
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

TEST(Renderer, LeavesNoHolesBetweenTrianglesAndDiscs) {
  for (const bool is_mesh : {true, false})
    for (const int n : {is_mesh ? 3 : 12, 17, 90, 400}) {
      const Patch patch(n, is_mesh);
      const Pixels pixels(draw_picture(patch.scene(), from_above()));
      for (int y = 20; y < 280; ++y)
        for (int x = 70; x < 330; ++x) ASSERT_FALSE(is_white(pixels(x, y))) << n << ' ' << x << ' ' << y;
    }
}

TEST(Renderer, CutsTrianglesThatReachBehindTheCamera) {
  Patch patch(2, true);  // a square before the camera, and one corner far behind it
  for (Vec3& p : patch.points)
    if (p[0] > 0.5 && p[1] > 0.5) p[2] = 100;
  PictureOptions options = from_above();
  const std::vector<double> unmapped(patch.points.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<double> u = unmapped;
  for (std::size_t k : {0, 1, 3, 4}) u[k] = patch.u[k];
  Scene scene = patch.scene();
  scene.u = scene.v = u;
  const Pixels pixels(draw_picture(scene, options));
  EXPECT_GT(pixels.count([](const Rgb& c) { return !is_white(c); }), 400 * 300 / 4);
}

TEST(Renderer, DistancesRiseInBrightnessAndHaveABar) {
  const Patch patch(60, true);
  PictureOptions options = from_above();
  options.width = 800, options.height = 600;
  options.pattern = Pattern::distance;
  options.ring_width = 10;  // no lines
  Scene scene = patch.scene();
  scene.source_axes.reset();
  const Pixels pixels(draw_picture(scene, options));
  const auto sum = [](const Rgb& c) { return 30 * c[0] + 59 * c[1] + 11 * c[2]; };
  int before = 0;
  for (int r = 30; r < 270; r += 10) {
    const int now = sum(pixels(400 + r, 300));
    EXPECT_GT(now, before) << r;
    before = now;
  }
  int levels = 0, last = 0;  // the bar, from below
  for (int y = 574; y > 426; y -= 4) {
    const int now = sum(pixels(26, y));
    EXPECT_GE(now, last) << y;
    levels += now > last ? 1 : 0;
    last = now;
  }
  EXPECT_GT(levels, 25);
}

TEST(Renderer, TheSurfaceAloneNeedsNoMap) {
  Patch patch(20, true);
  Scene scene = patch.scene();
  scene.u = scene.v = {};
  scene.source_axes.reset();
  PictureOptions options = from_above();
  options.pattern = Pattern::none;
  const Pixels pixels(draw_picture(scene, options));
  EXPECT_GT(pixels.count([](const Rgb& c) { return !is_white(c) && spread(c) < 25; }), 400 * 300 / 3);
}

}  // namespace
}  // namespace ahm::render::test
