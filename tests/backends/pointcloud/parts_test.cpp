// A part of a cloud has the same map alone, among others and with its rows in another order. This includes lattices, where
// distances tie and neighbors lie on a circle.

#include "clouds.hpp"

namespace ahm::test {
namespace {

constexpr double lattice_spacing =
    0.1;  // no power of two: equal distances of the lattice are equal only up to rounding

std::vector<Vec3> flat_lattice(int side) {
  std::vector<Vec3> points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) points.push_back({lattice_spacing * i, lattice_spacing * j, 0});
  return points;
}

/// The points of a lattice on the surface of a cube around the origin.
std::vector<Vec3> cube_lattice(int side) {
  std::vector<Vec3> points;
  for (int i = 0; i <= side; ++i)
    for (int j = 0; j <= side; ++j)
      for (int k = 0; k <= side; ++k)
        if (i % side == 0 || j % side == 0 || k % side == 0)
          points.push_back(lattice_spacing * Vec3{i - 0.5 * side, j - 0.5 * side, k - 0.5 * side});
  return points;
}

std::vector<Index> numbers_from(Index first, std::size_t count) {
  std::vector<Index> rows(count);
  std::iota(rows.begin(), rows.end(), first);
  return rows;
}

/// @param rows  row of each point of the part in the file
void expect_same_maps(const SolvedCloud& part, const SolvedCloud& file, const std::vector<Index>& rows) {
  for (const Index source : {0, 317}) {
    const RowLogMap a = part.map(source), b = file.map(rows[source]);
    expect_same_rows(a, b, 1e-9 * std::ranges::max(a.distance), [&](Index i) { return rows[i]; });
  }
}

TEST(Parts, HaveTheSameMapNextToOthersAndInAnyOrder) {
  std::mt19937_64 random(5);
  const std::vector<Vec3> sphere = joined({}, scaled(3.3, random_sphere(700).points), {41.7, -13.1, 9.9});
  const std::pair<const char*, std::vector<Vec3>> parts[] = {
      {"flat lattice", flat_lattice(30)},
      {"moved lattice", joined({}, flat_lattice(30), {200.3, -57.1, 3.7})},
      {"cube", cube_lattice(14)},
      {"even sphere", even_sphere(1000).points},
      {"random sphere", random_sphere(1000).points}};
  for (const auto& [name, points] : parts) {
    SCOPED_TRACE(name);
    const SolvedCloud alone(points);
    expect_same_maps(alone, SolvedCloud(joined(sphere, points)), numbers_from(700, points.size()));
    expect_same_maps(alone, SolvedCloud(joined(points, points, {1000.3, 17.7, -333.3})),
                     numbers_from(0, points.size()));
    std::vector<Index> order = numbers_from(0, points.size());
    std::shuffle(order.begin(), order.end(), random);
    std::vector<Vec3> shuffled(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) shuffled[order[i]] = points[i];
    expect_same_maps(alone, SolvedCloud(shuffled), order);
  }
}

// Each part decides whether signs of normals separate sheets or are wrong.
TEST(Parts, HaveTheirOwnThinWalls) {
  Cloud wall;  // two flat sheets close to each other, with normals that point away from each other
  for (double side : {-1.0, 1.0})
    for (const Vec3& p : flat_lattice(24)) {
      wall.points.push_back({p[0], p[1], 0.3 * side * lattice_spacing});
      wall.normals.push_back({0, 0, side});
    }
  Cloud wrong = random_sphere(1500);
  for (std::size_t i = 0; i < wrong.normals.size(); i += 2) wrong.normals[i] = -wrong.normals[i];
  const SolvedCloud file(joined(wrong.points, wall.points, {50.3, 0, 0}), joined(wrong.normals, wall.normals));
  expect_same_maps(SolvedCloud(wrong.points, wrong.normals), file, numbers_from(0, 1500));
  for (const Index source : {0, 576}) {
    const RowLogMap map = file.map(1500 + source);
    for (Index i = 0; i < 1152; ++i) {
      const bool same_sheet = (i < 576) == (source == 0);
      ASSERT_EQ(map.status[1500 + i] == Status::ok, same_sheet);
      if (same_sheet) ASSERT_NEAR(map.distance[1500 + i], norm(wall.points[i] - wall.points[source]), 1e-9);
    }
  }
}

TEST(Parts, HaveTheirOwnNoise) {
  const Cloud clean = random_sphere(3000), noisy = with_noise(clean, sphere_spacing(3000));
  const auto alone = PointCloudSurface::build(noisy.points),
             together = PointCloudSurface::build(joined(noisy.points, clean.points, {100, 0, 0}));
  ASSERT_GT(alone.details().smoothed, 2900);
  EXPECT_EQ(together.details().smoothed, alone.details().smoothed);
  EXPECT_NEAR(together.details().noise, alone.details().noise, 1e-12);
  EXPECT_EQ(together.details().thick, alone.details().thick);
  const auto normal = [](const PointCloudSurface& surface, Row row) {
    return surface.graph().frame(surface.vertex(row).index)->normal;
  };
  for (Row row(0); row.index < 3000; ++row.index)
    ASSERT_NEAR(std::abs(dot(normal(alone, row), normal(together, row))), 1, 1e-9);
}

TEST(Parts, HaveTheirOwnDistances) {
  const Cloud clean = even_sphere(2000);
  const std::vector<Vec3> large = scaled(30, with_noise(random_sphere(1000), 0.1).points);
  const SolvedCloud alone(clean.points), together(joined(clean.points, large, {100, 0, 0}));
  for (const Index source : {0, 700}) {
    const RowLogMap a = alone.map(source), b = together.map(source);
    for (Index i = 0; i < 2000; ++i) {
      ASSERT_NEAR(a.distance[i], b.distance[i], 1e-9);
      ASSERT_NEAR(std::hypot(a.u[i], a.v[i]), std::hypot(b.u[i], b.v[i]), 1e-9);
    }
  }
}

/// 30 points of a tilted rectangle with spacing 0.1, from `corner` on.
std::vector<Vec3> island(const Vec3& corner, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> jitter(-0.03, 0.03);
  std::vector<Vec3> points;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 6; ++j) {
      const double u = 0.1 * i + jitter(random), v = 0.1 * j + jitter(random);
      points.push_back(corner + Vec3{0.8 * u, v, 0.6 * u});
    }
  return points;
}

// Points that are not joined to an island do not change its plane.
TEST(Islands, KeepTheirPlanes) {
  /// Distances in the flat part of the rows first, ..., first + count - 1 are those of space.
  const auto expect_flat = [](const std::vector<Vec3>& points, const SolvedCloud& solved, Index first, Index count) {
    const RowLogMap map = solved.map(first);
    for (Index i = first; i < first + count; ++i) {
      ASSERT_EQ(map.status[i], Status::ok);
      ASSERT_NEAR(map.distance[i], norm(points[i] - points[first]), 1e-11);
    }
  };
  // Far from a surface.
  const std::vector<Vec3> with_sphere = joined(random_sphere(3000).points, island({16, 0, 0}, 1));
  const SolvedCloud far(with_sphere);
  EXPECT_EQ(far.surface.details().components, 2);
  expect_flat(with_sphere, far, 3000, 30);
  // Far from other islands.
  std::vector<Vec3> four;
  for (unsigned k = 0; k < 4; ++k) four = joined(four, island({15.0 * (k % 2), 15.0 * (k / 2), 3.0 * k}, 7 + k));
  const SolvedCloud islands(four);
  EXPECT_EQ(islands.surface.details().components, 4);
  for (Index k = 0; k < 4; ++k) expect_flat(four, islands, 30 * k, 30);
  // Denser than a volume of points next to it.
  std::vector<Vec3> mixed = joined(island({0, 0, 0}, 3), island({0.4, 0, 0.3}, 3));
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(10, 30);
  for (int i = 0; i < 60; ++i) mixed.push_back({uniform(random), uniform(random), uniform(random)});
  expect_flat(mixed, SolvedCloud(mixed), 0, 60);
}

}  // namespace
}  // namespace ahm::test
