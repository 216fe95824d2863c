// Signs of normals fix the mirror where they agree with the points, and change nothing else.
#include "clouds.hpp"

namespace ahm::test {
namespace {

/// Expects equal maps up to a rotation and a reflection: axes at the source may differ between two graphs.
void expect_congruent(const RowLogMap& a, const RowLogMap& b, double tolerance = 1e-10) {
  const auto far = static_cast<std::size_t>(std::ranges::max_element(a.distance) - a.distance.begin());
  double worst[2] = {0, 0};
  for (int mirror : {0, 1}) {
    const double sign = mirror ? -1.0 : 1.0, turn = b.angle[far] - sign * a.angle[far];
    for (std::size_t i = 0; i < a.u.size(); ++i) {
      const double u = a.u[i], v = sign * a.v[i];
      worst[mirror] = std::max(worst[mirror], std::hypot(b.u[i] - (std::cos(turn) * u - std::sin(turn) * v),
                                                         b.v[i] - (std::sin(turn) * u + std::cos(turn) * v)));
    }
  }
  EXPECT_LT(std::min(worst[0], worst[1]), tolerance);
}

/// Reverses the normals of rows for which `is_flipped(row)` is true.
template <class IsFlipped>
Cloud flipped(Cloud cloud, const IsFlipped& is_flipped) {
  for (std::size_t i = 0; i < cloud.normals.size(); ++i)
    if (is_flipped(i)) cloud.normals[i] = -cloud.normals[i];
  return cloud;
}

/// As `flipped`, for this percentage of the rows at random.
Cloud flipped_at_random(const Cloud& cloud, unsigned percent, unsigned seed) {
  std::mt19937 random(seed);
  return flipped(cloud, [&](std::size_t) { return random() % 100 < percent; });
}

TEST(Normals, WithWrongSignsChangeTheMapAtMostByAReflection) {
  const Cloud clean = random_sphere(4000);
  const RowLogMap expected = SolvedCloud(clean.points, clean.normals).map(11);
  for (unsigned percent : {1, 5, 10, 15, 30, 50}) {
    const Cloud cloud = flipped_at_random(clean, percent, percent);
    const SolvedCloud solved(cloud.points, cloud.normals);
    if (percent < 50) EXPECT_GT(solved.surface.details().flipped_normals, 0);
    if (percent == 50) EXPECT_FALSE(solved.surface.details().oriented);
    EXPECT_EQ(solved.surface.graph().transport_kind(), TransportKind::rotation2);
    EXPECT_EQ(solved.surface.details().components, 1);
    expect_congruent(expected, solved.map(11));
  }
  // Normals turned to a viewpoint do not cut the surface.
  const Cloud towards = flipped(clean, [&](std::size_t i) { return clean.normals[i][2] < 0; });
  const SolvedCloud solved(towards.points, towards.normals);
  EXPECT_EQ(solved.surface.details().components, 1);
  expect_congruent(expected, solved.map(11));
}

TEST(Normals, ThatAgreeFixTheMirror) {
  const Cloud cloud = random_sphere(2000), inward = flipped(cloud, [](std::size_t) { return true; });
  const RowLogMap outside = SolvedCloud(cloud.points, cloud.normals).map(11);
  const SolvedCloud solved(inward.points, inward.normals);
  EXPECT_TRUE(solved.surface.details().oriented);
  RowLogMap inside = solved.map(11);
  for (double& v : inside.v) v = -v;  // from inside, u keeps its direction
  EXPECT_LT(largest_difference(inside, outside), 1e-10);
}

TEST(Normals, MayHaveAnyLength) {
  Cloud cloud = random_sphere(1000);
  const RowLogMap unit = SolvedCloud(cloud.points, cloud.normals).map(11);
  for (std::size_t i = 0; i < cloud.normals.size(); ++i)
    cloud.normals[i] = std::pow(10.0, static_cast<double>(i % 9) - 4.0) * cloud.normals[i];
  EXPECT_LT(largest_difference(SolvedCloud(cloud.points, cloud.normals).map(11), unit), 1e-10);
}

TEST(Normals, ThatAreMissingAreEstimated) {
  const Cloud exact = even_sphere(3000);
  std::vector<Vec3> normals = exact.normals;
  for (std::size_t i = 0; i < normals.size(); i += 10) normals[i] = {0, 0, 0};
  normals[1] = {NAN, 0, 0};
  const SolvedCloud some(exact.points, normals);
  EXPECT_EQ(find_warning(some.surface, "normals_estimated").value().numbers, std::vector<double>{301});
  EXPECT_LT(sphere_error(exact, some.surface, some.map(5), 5).angle, 0.05);
  EXPECT_EQ(SolvedCloud(exact.points, std::vector<Vec3>(3000, Vec3{0, 0, 0})).map(5).u,
            SolvedCloud(exact.points).map(5).u);
}

TEST(Normals, WithNoiseAreNoWorseThanNone) {
  const Cloud exact = random_sphere(10000);
  for (double points_noise : {0.0, 0.004}) {
    const Cloud points = with_noise(exact, points_noise);
    const auto angle = [&](const std::vector<Vec3>& normals) {
      const SolvedCloud solved(points.points, normals);
      double sum = 0;
      for (Index row = 500; row < 10000; row += 1000)
        sum += sphere_error(exact, solved.surface, solved.map(row), row).angle / 10;
      return sum;
    };
    const double estimated = angle({});
    for (double noise : {0.02, 0.05, 0.1, 0.2, 0.5})
      EXPECT_LT(angle(with_noisy_normals(points, noise).normals), 1.1 * estimated) << points_noise << ", " << noise;
  }
}

/// Two jittered half planes that meet at the line u = 0, with an angle `fold` between their outward normals.
Cloud roof(double fold) {
  Cloud cloud;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> jitter(0.1, 0.9);
  constexpr int side = 50;
  const double c = std::cos(fold / 2), s = std::sin(fold / 2);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double u = 2 * (i + jitter(random)) / side - 1, v = 2 * (j + jitter(random)) / side - 1;
      cloud.plane.push_back({u, v});
      cloud.points.push_back({u * c, v, -std::abs(u) * s});
      cloud.normals.push_back({u < 0 ? -s : s, 0, c});
    }
  return cloud;
}

// Where planes meet at a right angle, the sign of a cosine is that of a rounded zero; beyond, it is that of the wrong side.
TEST(Normals, AcrossSharpCreasesLieOnOneSide) {
  const Vec3 axis = normalized(Vec3{0.3, 0.5, 0.8});
  const auto rotated = [&](std::vector<Vec3> vectors) {  // by a radian
    for (Vec3& p : vectors)
      p = std::cos(1.0) * p + std::sin(1.0) * cross(axis, p) + ((1 - std::cos(1.0)) * dot(axis, p)) * axis;
    return vectors;
  };
  constexpr Index source = 50 * 12 + 25;
  for (const double degrees : {60.0, 85.0, 90.0, 91.0, 100.0, 110.0}) {
    const Cloud cloud = roof(degrees * std::numbers::pi / 180);
    const SolvedCloud solved(cloud.points, cloud.normals);
    EXPECT_EQ(solved.surface.details().flipped_normals, 0) << degrees;
    const RowLogMap map = solved.map(source),
                    of_rotated = SolvedCloud(rotated(cloud.points), rotated(cloud.normals)).map(source),
                    of_flipped = SolvedCloud(cloud.points, flipped_at_random(cloud, 30, 7).normals).map(source);
    double worst = 0, mean = 0;
    for (std::size_t i = 0; i < cloud.plane.size(); ++i) {
      const double d = length(cloud.plane[i] - cloud.plane[source]);
      const double error = std::abs(map.distance[i] - d) / std::max(d, 0.2);
      worst = std::max(worst, error);
      mean += error / static_cast<double>(cloud.plane.size());
    }
    expect_near(of_rotated.distance, map.distance, 1e-6);
    expect_near(of_flipped.distance, map.distance, 1e-6);
    EXPECT_LT(worst, 0.1) << degrees;
    EXPECT_LT(mean, 0.02) << degrees;
  }
}

TEST(Normals, EstimatedConvergeToTheExactOnes) {
  for (Index n : {300, 1000, 3000, 10000}) {
    const Cloud cloud = random_sphere(n);
    const auto surface = PointCloudSurface::build(cloud.points);
    std::vector<double> degrees;
    for (Index i = 0; i < n; ++i) {
      const Frame frame = *surface.graph().frame(surface.vertex(Row(i)).index);
      degrees.push_back(sphere_distance(cross(frame.x, frame.y), cloud.normals[i]) * 180 / std::numbers::pi);
    }
    EXPECT_LT(percentile95(degrees), 100 / std::sqrt(n)) << n;
  }
}

TEST(Normals, ThatContradictThePointsAreCountedAndNamed) {
  const auto contradicted = [](const Cloud& cloud) {
    const auto surface = PointCloudSurface::build(cloud.points, cloud.normals);
    const auto warning = find_warning(surface, "normals_contradicted");
    EXPECT_EQ(warning ? warning->numbers.at(0) : 0, surface.details().contradicted);
    EXPECT_TRUE(surface.details().oriented);
    return surface.details().contradicted;
  };
  const Cloud sphere = random_sphere(5000);
  EXPECT_EQ(contradicted(sphere), 0);
  EXPECT_GT(contradicted(with_noisy_normals(sphere, 0.1)), 4900);
  // At corners planes fitted to the points are wrong: exact normals are used.
  EXPECT_LT(contradicted(folded_cloud(60, 6, std::numbers::pi / 2)), 36);  // of 3600
  Cloud rounded = flat_cloud(3000);
  for (Vec3& n : rounded.normals)
    for (double& c : n) c = std::round(1000 * c) / 1000;
  EXPECT_EQ(contradicted(rounded), 0);
}

TEST(Normals, OfAMoebiusBandMakeReflections) {
  const Cloud band = moebius_cloud(6000);
  const SolvedCloud solved(band.points);
  EXPECT_EQ(solved.surface.graph().transport_kind(), TransportKind::block);
  EXPECT_GT(solved.surface.details().reflections, 0);
  EXPECT_EQ(solved.surface.details().components, 1);
  for (Variant variant : all_variants) {
    const RowLogMap map = solved.map(0, variant);
    EXPECT_EQ(std::ranges::count(map.status, Status::ok), 6000);
    // Halfway around the band: the seam of the orientation is no wall.
    EXPECT_GT(std::ranges::max(map.distance),
              2.4);  // measured 2.6 in both variants: less than pi, where two fronts meet
    EXPECT_LT(std::ranges::max(map.distance), 2.8);
  }
}

}  // namespace
}  // namespace ahm::test
