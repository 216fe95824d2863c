// The error against the sphere's closed form falls with the spacing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ahm/conformance/vectors.hpp"
#include "ahm/maps/quality.hpp"
#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

TEST(SphereCloud, ConvergesOnEvenPoints) {
  // Adaptive: bias of the diffusion time, proportional to h = n^-1/2 (docs/concepts/method.md).
  const SphereError coarse = [] {
    const Cloud c = even_sphere(2500);
    const Solved s(c);
    return sphere_error(c, s.graph, s.map(77), 77);
  }();
  const SphereError fine = [] {
    const Cloud c = even_sphere(40000);
    const Solved s(c);
    return sphere_error(c, s.graph, s.map(77), 77);
  }();
  EXPECT_GE(std::log(coarse.hemisphere / fine.hemisphere) / std::log(4.0), 0.75);
  EXPECT_GE(std::log(coarse.rms / fine.rms) / std::log(4.0), 0.75);
  const double h = std::sqrt(4 * 3.14159 / 40000);
  EXPECT_LE(fine.hemisphere, 0.8 * h);
}

TEST(SphereCloud, ConvergesOnRandomPointsInBothVariants) {
  std::vector<double> angle, rms;
  for (Index n : {10000, 80000}) {
    const Cloud cloud = random_sphere(n);
    const Solved solved(cloud);
    EXPECT_EQ(solved.graph.details().reflections, 0);
    for (Variant variant : all_variants) {
      // The error of one source is partly luck: average over some.
      double angle_sum = 0, rms_sum = 0;
      for (Index p : {5, n / 3, n / 2, n - 9}) {
        const SphereError error = sphere_error(cloud, solved.graph, solved.map(p, variant), p);
        angle_sum += error.angle / 4;
        rms_sum += error.rms / 4;
      }
      angle.push_back(angle_sum);
      rms.push_back(rms_sum);
    }
  }
  for (int variant : {0, 1}) {
    EXPECT_LT(rms[2 + variant], 0.75 * rms[variant]);
    EXPECT_LT(angle[2 + variant], angle[variant]);
    EXPECT_LT(angle[2 + variant], 0.01);
  }
}

// Beyond five spacings, the antipode included, from some sources.
TEST(SphereCloud, HasItsDistancesOutToTheAntipode) {
  std::vector<double> of_fine, of_coarse;
  for (Index n : {2500, 20000}) {
    const Cloud cloud = random_sphere(n);
    const Solved solved(cloud);
    const double h = std::sqrt(4 * std::numbers::pi / n);
    for (Variant variant : all_variants) {
      std::vector<double> errors;
      for (Index p : {5, n / 2, n - 9}) {
        const RowLogMap map = solved.map(p, variant);
        for (Index i = 0; i < n; ++i) {
          const double exact = sphere_distance(cloud.points[p], cloud.points[i]);
          if (exact < 5 * h) continue;
          errors.push_back(std::abs(map.distance[i] - exact) / exact);
          ASSERT_LT(errors.back() * exact, 4 * h);
        }
      }
      std::sort(errors.begin(), errors.end());
      const double error = errors[errors.size() * 95 / 100];
      EXPECT_LT(error, (variant == Variant::adaptive ? 0.15 : 0.5) * h);
      (n == 2500 ? of_coarse : of_fine).push_back(error);
    }
  }
  for (std::size_t v = 0; v < of_fine.size(); ++v) EXPECT_LT(of_fine[v], 0.6 * of_coarse[v]);
}

TEST(SphereCloud, IsPositivelyOrientedOutwardsWithoutNormals) {
  const Cloud cloud = even_sphere(2000);
  const auto graph = pointcloud::PointCloudSurface::build(cloud.points);
  for (Index i = 0; i < graph.graph().size(); ++i) {
    const Frame frame = *graph.graph().frame(i);
    EXPECT_GT(dot(frame.normal, frame.origin), 0.9);
  }
}

TEST(SphereCloud, CoversItsArea) {
  const auto graph = pointcloud::PointCloudSurface::build(even_sphere(5000).points);
  double area = 0;
  for (double m : graph.graph().data().masses) area += m;
  area *= graph.graph().length_unit() * graph.graph().length_unit();
  EXPECT_NEAR(area, 4 * 3.14159265, 0.05);
}

/// A sphere with bumps, sampled at random, moved, turned and scaled, its rows in this order or the other way round.
std::vector<Vec3> bumpy(double scale, const Vec3& shift, double angle, bool reversed) {
  std::vector<Vec3> points = random_sphere(2500, 3).points;
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec3& p : points) {
    const double r = scale * (1 + 0.01 * std::sin(40 * p[0]) * std::cos(37 * p[1] + 11 * p[2]));
    p = {r * (c * p[0] - s * p[1]), r * (0.6 * (s * p[0] + c * p[1]) - 0.8 * p[2]),
         r * (0.8 * (s * p[0] + c * p[1]) + 0.6 * p[2])};
    for (std::size_t a = 0; a < 3; ++a) p[a] += shift[a];
  }
  if (reversed) std::reverse(points.begin(), points.end());
  return points;
}

// Nothing but ties in truth may be decided by where the points lie, how large they are, and how they are numbered.
TEST(SphereCloud, HasTheSameMapMovedTurnedAndScaled) {
  const auto map_of = [](const std::vector<Vec3>& points, Index source, Index towards) {
    const auto surface = pointcloud::PointCloudSurface::build(points);
    const LogMapSolver solver(surface.graph());
    const Vec3 axis = minus(points[towards], points[source]);
    return surface.to_rows(solver.solve(surface.source(Row(source), axis).source));
  };
  const Index last = 2499;
  const RowLogMap expected = map_of(bumpy(1, {0, 0, 0}, 0, false), 7, 90);
  for (double scale : {1.0, 1.1, 1.7, 300.0})
    for (double angle : {0.0, 0.7})
      for (bool reversed : {false, true}) {
        const RowLogMap found = map_of(bumpy(scale, {0.3 * scale, -2 * scale, scale}, angle, reversed),
                                       reversed ? last - 7 : 7, reversed ? last - 90 : 90);
        double worst = 0;
        for (Index i = 0; i <= last; ++i) {
          const Index k = reversed ? last - i : i;
          worst = std::max({worst, std::abs(found.u[k] / scale - expected.u[i]),
                            std::abs(found.v[k] / scale - expected.v[i]),
                            std::abs(found.distance[k] / scale - expected.distance[i])});
        }
        EXPECT_LT(worst, 1e-9) << scale << ' ' << angle << ' ' << reversed;
      }
}

/// A sphere that is `factor` times sparser below its equator, and a map from a point of the equator.
struct SteppedSphere {
  explicit SteppedSphere(int factor) {
    const Cloud all = random_sphere(12000, 3);
    for (std::size_t i = 0; i < all.points.size(); ++i)
      if (all.points[i][2] > 0 || i % static_cast<std::size_t>(factor) == 0) cloud.points.push_back(all.points[i]);
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
      if (std::abs(cloud.points[i][2]) < std::abs(cloud.points[source][2])) source = i;
    const Solved solved(cloud);
    const SurfaceSource placed = solved.graph.source(Row(static_cast<Index>(source)));
    const LogMap map = solved.solver.solve(placed.source);
    rows = solved.graph.to_rows(map);
    quality = to_rows(rows, map_quality(solved.graph.graph(), map));
    frame = *placed.frame;
  }
  /// Geodesic polar coordinates.
  Vec2 exact(std::size_t i) const {
    const Vec3 &p = cloud.points[i], &s = cloud.points[source];
    const double d = std::acos(std::clamp(dot(p, s), -1.0, 1.0));
    const Vec2 there{dot(p, frame.x), dot(p, frame.y)};
    const double r = std::hypot(there[0], there[1]);
    return {d / r * there[0], d / r * there[1]};
  }

  Cloud cloud;
  std::size_t source = 0;
  RowLogMap rows;
  std::vector<double> quality;
  Frame frame;
};

double size_of(const Vec2& v) { return std::hypot(v[0], v[1]); }

// Where the spacing steps by ten, heat comes to the dense half through the sparse one, along ways that are too long by a half.
TEST(SphereCloud, WhoseSpacingStepsHasNoTrustedVectorThatIsMuchTooLong) {
  const SteppedSphere sphere(100);
  Index trusted = 0, too_long = 0;
  for (std::size_t i = 0; i < sphere.quality.size(); ++i) {
    if (i == sphere.source || !(sphere.quality[i] >= trusted_quality)) continue;
    ++trusted;
    too_long += std::hypot(sphere.rows.u[i], sphere.rows.v[i]) > 1.25 * size_of(sphere.exact(i)) + 0.1;
  }
  EXPECT_GT(3 * trusted, std::ssize(sphere.quality));
  EXPECT_LT(200 * too_long, trusted);
}

// And from the wrong side, with lengths that are nearly right: stars at the step are open, and ways beside them are no detours.
TEST(SphereCloud, WhoseSpacingStepsHasNoTrustedVectorThatPointsElsewhere) {
  for (const int factor : {9, 16, 25}) {
    const SteppedSphere sphere(factor);
    Index trusted = 0, elsewhere = 0;
    for (std::size_t i = 0; i < sphere.quality.size(); ++i) {
      if (i == sphere.source || !(sphere.quality[i] >= trusted_quality)) continue;
      const Vec2 exact = sphere.exact(i);
      ++trusted;
      elsewhere += std::hypot(sphere.rows.u[i] - exact[0], sphere.rows.v[i] - exact[1]) > 0.3 * size_of(exact);
    }
    EXPECT_GT(3 * trusted, 2 * std::ssize(sphere.quality));
    EXPECT_LT(100 * elsewhere, trusted) << "spacing steps by the root of " << factor;
  }
}

}  // namespace
}  // namespace ahm::test
