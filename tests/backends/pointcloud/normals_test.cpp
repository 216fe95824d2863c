// Signs of normals: they fix the mirror where they can be trusted, and change nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "noisy_clouds.hpp"
#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

/// The axes at the source may differ between two graphs: compare in the basis of two reference points.
void expect_equal_up_to_mirror(const RowLogMap& a, const RowLogMap& b, double gate) {
  // The rotation (and mirror) that takes a to b, from the point farthest out.
  std::size_t far = 0;
  for (std::size_t i = 0; i < a.u.size(); ++i)
    if (a.distance[i] > a.distance[far]) far = i;
  double worst[2] = {0, 0};
  for (int mirror : {0, 1}) {
    const double sign = mirror ? -1.0 : 1.0;
    const double turn = b.angle[far] - sign * a.angle[far];
    for (std::size_t i = 0; i < a.u.size(); ++i) {
      const double u = a.u[i], v = sign * a.v[i];
      worst[mirror] = std::max(worst[mirror], std::hypot(b.u[i] - (std::cos(turn) * u - std::sin(turn) * v),
                                                         b.v[i] - (std::sin(turn) * u + std::cos(turn) * v)));
    }
  }
  EXPECT_LT(std::min(worst[0], worst[1]), gate);
}

TEST(Normals, FlippedAtRandomGiveTheSameMapUpToItsMirrorImage) {
  Cloud cloud = random_sphere(4000);
  const RowLogMap clean = Solved(cloud, true).map(11);
  std::mt19937 random(1);
  for (Vec3& n : cloud.normals)
    if (random() % 2)
      for (double& c : n) c = -c;
  const Solved flipped(cloud, true);
  EXPECT_FALSE(flipped.graph.details().oriented);
  EXPECT_EQ(flipped.graph.graph().transport_kind(), TransportKind::rotation2);
  expect_equal_up_to_mirror(clean, flipped.map(11), 1e-10);
}

TEST(Normals, OfWhichSomeAreFlippedLoseNoPoint) {
  const Cloud clean = random_sphere(4000);
  const RowLogMap expected = Solved(clean, true).map(11);
  for (unsigned percent : {1, 5, 10, 15, 30}) {
    Cloud cloud = clean;
    std::mt19937 random(percent);
    for (std::size_t i = 0; i < cloud.normals.size(); ++i)
      if (random() % 100 < percent)
        for (double& c : cloud.normals[i]) c = -c;
    const Solved solved(cloud, true);
    EXPECT_GT(solved.graph.details().turned, 0);
    EXPECT_EQ(solved.graph.details().components, 1);
    // The majority still points outwards, so that not even the mirror changes; only the axes at the source may turn over.
    expect_equal_up_to_mirror(expected, solved.map(11), 1e-10);
  }
}

TEST(Normals, TurnedToAViewpointDoNotCutTheSurface) {
  Cloud cloud = random_sphere(4000);
  const RowLogMap expected = Solved(cloud, true).map(11);
  for (Vec3& n : cloud.normals)
    if (n[2] < 0)
      for (double& c : n) c = -c;
  const Solved solved(cloud, true);
  EXPECT_EQ(solved.graph.details().components, 1);
  expect_equal_up_to_mirror(expected, solved.map(11), 1e-10);
}

TEST(Normals, GivenAndOrientedFixTheMirror) {
  Cloud cloud = random_sphere(2000);
  const RowLogMap outward = Solved(cloud, true).map(11);
  for (Vec3& n : cloud.normals)
    for (double& c : n) c = -c;
  const Solved inside(cloud, true);
  EXPECT_TRUE(inside.graph.details().oriented);
  const RowLogMap inward = inside.map(11);
  // Seen from inside, u keeps its direction and v turns round.
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    ASSERT_NEAR(inward.u[i], outward.u[i], 1e-10);
    ASSERT_NEAR(inward.v[i], -outward.v[i], 1e-10);
  }
}

TEST(Normals, OfAnyLengthCount) {
  Cloud cloud = random_sphere(1000);
  const RowLogMap unit = Solved(cloud, true).map(11);
  for (std::size_t i = 0; i < cloud.normals.size(); ++i)
    for (double& c : cloud.normals[i]) c *= std::pow(10.0, static_cast<double>(i % 9) - 4.0);
  const RowLogMap other = Solved(cloud, true).map(11);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) ASSERT_NEAR(other.u[i], unit.u[i], 1e-10);
}

TEST(Normals, MissingAmongGivenOnesAreEstimatedAndCounted) {
  Cloud cloud = even_sphere(3000);
  for (std::size_t i = 0; i < cloud.normals.size(); i += 10) cloud.normals[i] = {0, 0, 0};
  cloud.normals[1] = {NAN, 0, 0};
  const Solved solved(cloud, true);
  ASSERT_FALSE(solved.graph.warnings().empty());
  EXPECT_EQ(solved.graph.warnings()[0].id, "normals_estimated");
  EXPECT_EQ(solved.graph.warnings()[0].numbers, std::vector<double>{301});
  cloud.normals = cloud.points;
  EXPECT_LT(sphere_error(cloud, solved.graph, solved.map(5), 5).angle, 0.05);
}

TEST(Normals, WithNoiseAreNoWorseThanNone) {
  for (double points_noise : {0.0, 0.004}) {
    const Cloud exact = random_sphere(10000);
    const Cloud points = with_noise(exact, points_noise);
    auto angle = [&](const Cloud& cloud, bool with_normals) {
      const Solved solved(cloud, with_normals);
      double sum = 0;
      for (Index p = 500; p < 10000; p += 1000) sum += sphere_error(exact, solved.graph, solved.map(p), p).angle / 10;
      return sum;
    };
    const double estimated = angle(points, false);
    RecordProperty("points " + std::to_string(points_noise), std::to_string(estimated));
    for (double noise : {0.02, 0.05, 0.1, 0.2, 0.5}) {
      const double given = angle(with_noisy_normals(points, noise), true);
      RecordProperty("points " + std::to_string(points_noise) + " normals " + std::to_string(noise),
                     std::to_string(given));
      EXPECT_LT(given, 1.1 * estimated) << points_noise << ", " << noise;
    }
  }
}

/// Two half planes that meet at the line u = 0, whose normals are an angle apart, jittered in (u, v), outward normals.
Cloud roof(double fold, std::vector<Vec2>& flat) {
  Cloud cloud;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> jitter(0.1, 0.9);
  constexpr int side = 50;
  const double c = std::cos(fold / 2), s = std::sin(fold / 2);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double u = 2 * (i + jitter(random)) / side - 1, v = 2 * (j + jitter(random)) / side - 1;
      flat.push_back({u, v});
      cloud.points.push_back({u * c, v, -std::abs(u) * s});
      cloud.normals.push_back({u < 0 ? -s : s, 0, c});
    }
  return cloud;
}

// Where planes meet at a right angle the sign of a cosine is that of a rounded zero, and beyond it is that of the wrong side.
TEST(Normals, AcrossSharpCreasesLieOnOneSideHoweverTheyAreTurned) {
  for (const double degrees : {60.0, 85.0, 90.0, 91.0, 100.0, 110.0}) {
    std::vector<Vec2> flat;
    const Cloud cloud = roof(degrees * std::numbers::pi / 180, flat);
    Cloud turned = cloud, flipped = cloud;
    const Vec3 axis = normalized(Vec3{0.3, 0.5, 0.8});
    const auto turn = [&](const Vec3& p) {  // by a radian
      return std::cos(1.0) * p + std::sin(1.0) * cross(axis, p) + ((1 - std::cos(1.0)) * dot(axis, p)) * axis;
    };
    std::mt19937 random(7);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      turned.points[i] = turn(cloud.points[i]), turned.normals[i] = turn(cloud.normals[i]);
      if (random() % 10 < 3) flipped.normals[i] = -1.0 * flipped.normals[i];
    }
    constexpr Index source = 50 * 12 + 25;
    const Solved solved(cloud, true);
    const RowLogMap map = solved.map(source), of_turned = Solved(turned, true).map(source),
                    of_flipped = Solved(flipped, true).map(source);
    EXPECT_EQ(solved.graph.details().turned, 0) << degrees;
    double worst = 0, mean = 0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
      const double d = length(flat[i] - flat[source]), off = std::abs(map.distance[i] - d);
      worst = std::max(worst, off / std::max(d, 0.2));
      mean += off / std::max(d, 0.2) / static_cast<double>(flat.size());
      ASSERT_NEAR(of_turned.distance[i], map.distance[i], 1e-6) << degrees << ", row " << i;
      ASSERT_NEAR(of_flipped.distance[i], map.distance[i], 1e-6) << degrees << ", row " << i;
    }
    EXPECT_LT(worst, 0.1) << degrees;
    EXPECT_LT(mean, 0.02) << degrees;
  }
}

TEST(Normals, EstimatedAreTheNearerTheMorePoints) {
  for (Index n : {300, 1000, 3000, 10000}) {
    const Cloud cloud = random_sphere(n);
    const auto surface = pointcloud::PointCloudSurface::build(cloud.points);
    std::vector<double> degrees;
    double sum = 0;
    for (Index i = 0; i < n; ++i) {
      const Frame frame = *surface.graph().frame(surface.rows().vertex(Row(i))->index);
      degrees.push_back(std::acos(std::min(1.0, dot(cross(frame.x, frame.y), cloud.normals[i]))) * 180 /
                        std::numbers::pi);
      sum += degrees.back();
    }
    std::sort(degrees.begin(), degrees.end());
    const double near = degrees[static_cast<std::size_t>(0.95 * n)];
    RecordProperty(std::to_string(n) + " points: mean, 95 %, largest",
                   std::to_string(sum / n) + ", " + std::to_string(near) + ", " + std::to_string(degrees.back()));
    EXPECT_LT(near, 100 / std::sqrt(n)) << n;
  }
}

TEST(Normals, ThatThePointsContradictAreCountedAndNamed) {
  auto contradicted = [](const Cloud& cloud) {
    const auto surface = pointcloud::PointCloudSurface::build(cloud.points, cloud.normals);
    double told = 0;
    for (const Warning& warning : surface.warnings())
      if (warning.id == "normals_contradicted") told = warning.numbers.at(0);
    EXPECT_EQ(told, surface.details().contradicted);
    EXPECT_TRUE(surface.details().oriented);
    return surface.details().contradicted;
  };
  const Cloud sphere = random_sphere(5000);
  EXPECT_EQ(contradicted(sphere), 0);
  EXPECT_GT(contradicted(with_noisy_normals(sphere, 0.1)), 4900);
  // Exact normals at corners, where planes fitted to the points are wrong, stand.
  const Cloud folds = folded_cloud(60, 6, std::numbers::pi / 2);
  EXPECT_LT(contradicted(folds), 36);  // of 3600
  // So do normals written with few digits.
  Cloud rounded = flat_cloud(3000);
  for (Vec3& n : rounded.normals)
    for (double& c : n) c = std::round(1000 * c) / 1000;
  EXPECT_EQ(contradicted(rounded), 0);
}

TEST(Normals, ThatAreAllMissingAreNoNormals) {
  Cloud cloud = even_sphere(1000);
  const RowLogMap without = Solved(cloud).map(5);
  std::fill(cloud.normals.begin(), cloud.normals.end(), Vec3{0, 0, 0});
  const RowLogMap map = Solved(cloud, true).map(5);
  EXPECT_EQ(map.u, without.u);
}

TEST(Normals, OfTwoSheetsOfAThinWallKeepThemApart) {
  // Two parallel squares a tenth of the spacing apart, facing away from each other.
  Cloud wall;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double side = i % 2 ? 1.0 : -1.0;
    wall.points.push_back({uniform(random), uniform(random), side * 0.001});
    wall.normals.push_back({0, 0, side});
  }
  const Solved solved(wall, true);
  EXPECT_TRUE(solved.graph.details().oriented);
  EXPECT_GT(solved.graph.details().rejected_normals, 0);
  EXPECT_EQ(solved.graph.details().components, 2);
  const RowLogMap map = solved.map(0);
  for (std::size_t i = 0; i < wall.points.size(); ++i) {
    ASSERT_EQ(map.status[i], i % 2 ? Status::disconnected : Status::ok);
    if (i % 2 == 0)
      ASSERT_NEAR(map.distance[i],
                  std::hypot(wall.points[i][0] - wall.points[0][0], wall.points[i][1] - wall.points[0][1]), 1e-11);
  }
}

TEST(Normals, OfAMoebiusBandMakeReflections) {
  const Cloud band = moebius_cloud(6000);
  const Solved solved(band);
  EXPECT_EQ(solved.graph.graph().transport_kind(), TransportKind::block);
  EXPECT_GT(solved.graph.details().reflections, 0);
  EXPECT_EQ(solved.graph.details().components, 1);
  for (Variant variant : all_variants) {
    const RowLogMap map = solved.map(0, variant);
    double farthest = 0;
    for (std::size_t i = 0; i < band.points.size(); ++i) {
      ASSERT_EQ(map.status[i], Status::ok);
      farthest = std::max(farthest, map.distance[i]);
    }
    // Half way round the band, no farther: the seam of the orientation is no wall.
    EXPECT_GT(farthest, 2.4);  // measured 2.6 in both variants: short of pi, where heat from both sides meets
    EXPECT_LT(farthest, 2.8);
  }
}

}  // namespace
}  // namespace ahm::test
