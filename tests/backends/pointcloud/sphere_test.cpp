// On spheres the error against the closed form decreases with the spacing.
#include "ahm/maps/quality.hpp"
#include "clouds.hpp"

namespace ahm::test {
namespace {

TEST(SphereCloud, ConvergesOnEvenPoints) {
  // Adaptive: the bias of the diffusion time is proportional to h = n^-1/2 (docs/concepts/method.md).
  const auto error = [](Index n) {
    const Cloud cloud = even_sphere(n);
    const SolvedCloud solved(cloud.points);
    return sphere_error(cloud, solved.surface, solved.map(77), 77);
  };
  const SphereError coarse = error(2500), fine = error(40000);
  EXPECT_GE(std::log(coarse.hemisphere / fine.hemisphere) / std::log(4.0), 0.75);
  EXPECT_GE(std::log(coarse.rms / fine.rms) / std::log(4.0), 0.75);
  EXPECT_LE(fine.hemisphere, 0.8 * sphere_spacing(40000));
}

TEST(SphereCloud, ConvergesOnRandomPointsInBothVariants) {
  std::vector<double> angle, rms;
  for (Index n : {10000, 80000}) {
    const Cloud cloud = random_sphere(n);
    const SolvedCloud solved(cloud.points);
    EXPECT_EQ(solved.surface.details().reflections, 0);
    for (Variant variant : all_variants) {
      // The error of one source depends on the sample: average over some.
      angle.push_back(0), rms.push_back(0);
      for (Index row : {5, n / 3, n / 2, n - 9}) {
        const SphereError error = sphere_error(cloud, solved.surface, solved.map(row, variant), row);
        angle.back() += error.angle / 4;
        rms.back() += error.rms / 4;
      }
    }
  }
  for (int variant : {0, 1}) {
    EXPECT_LT(rms[2 + variant], 0.75 * rms[variant]);
    EXPECT_LT(angle[2 + variant], angle[variant]);
    EXPECT_LT(angle[2 + variant], 0.01);
  }
}

// Of points farther than five spacings, including the antipode.
TEST(SphereCloud, HasItsDistancesOutToTheAntipode) {
  std::vector<double> errors95;
  for (Index n : {2500, 20000}) {
    const Cloud cloud = random_sphere(n);
    const SolvedCloud solved(cloud.points);
    const double h = sphere_spacing(n);
    for (Variant variant : all_variants) {
      std::vector<double> errors;
      for (Index row : {5, n / 2, n - 9}) {
        const RowLogMap map = solved.map(row, variant);
        for (Index i = 0; i < n; ++i) {
          const double exact = sphere_distance(cloud.points[row], cloud.points[i]);
          if (exact < 5 * h) continue;
          errors.push_back(std::abs(map.distance[i] - exact) / exact);
          ASSERT_LT(errors.back() * exact, 4 * h);
        }
      }
      errors95.push_back(percentile95(errors));
      EXPECT_LT(errors95.back(), (variant == Variant::adaptive ? 0.15 : 0.5) * h);
    }
  }
  for (int variant : {0, 1}) EXPECT_LT(errors95[2 + variant], 0.6 * errors95[variant]);
}

TEST(SphereCloud, IsOrientedOutwardsAndHasItsArea) {
  const auto surface = PointCloudSurface::build(even_sphere(5000).points);
  double area = 0;
  for (Index i = 0; i < surface.graph().size(); ++i) {
    const Frame frame = *surface.graph().frame(i);
    EXPECT_GT(dot(frame.normal, frame.origin), 0.9);
    area += surface.graph().mass(i);
  }
  EXPECT_NEAR(area * std::pow(surface.graph().length_unit(), 2), 4 * 3.14159265, 0.05);
}

/// A sphere with bumps, sampled at random, moved, rotated and scaled, with its rows in this order or reversed.
std::vector<Vec3> bumpy_sphere(double scale, const Vec3& shift, double angle, bool reversed) {
  std::vector<Vec3> points = random_sphere(2500, 3).points;
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec3& p : points) {
    const double r = scale * (1 + 0.01 * std::sin(40 * p[0]) * std::cos(37 * p[1] + 11 * p[2]));
    const double x = c * p[0] - s * p[1], y = s * p[0] + c * p[1];
    p = shift + r * Vec3{x, 0.6 * y - 0.8 * p[2], 0.8 * y + 0.6 * p[2]};
  }
  if (reversed) std::reverse(points.begin(), points.end());
  return points;
}

// Positions, scale and order of the rows decide only exact ties.
TEST(SphereCloud, HasTheSameMapMovedRotatedAndScaled) {
  const auto map_from = [](const std::vector<Vec3>& points, Index source, Index towards) {
    return map_of(PointCloudSurface::build(points), Row(source), points[towards] - points[source]);
  };
  const Index last = 2499;
  const RowLogMap expected = map_from(bumpy_sphere(1, {0, 0, 0}, 0, false), 7, 90);
  for (double scale : {1.0, 1.1, 1.7, 300.0})
    for (double angle : {0.0, 0.7})
      for (bool reversed : {false, true}) {
        const auto row = [&](Index i) { return reversed ? last - i : i; };
        const RowLogMap found =
            map_from(bumpy_sphere(scale, {0.3 * scale, -2 * scale, scale}, angle, reversed), row(7), row(90));
        double worst = 0;
        for (Index i = 0; i <= last; ++i)
          worst = std::max({worst, std::abs(found.u[row(i)] / scale - expected.u[i]),
                            std::abs(found.v[row(i)] / scale - expected.v[i]),
                            std::abs(found.distance[row(i)] / scale - expected.distance[i])});
        EXPECT_LT(worst, 1e-9) << scale << ' ' << angle << ' ' << reversed;
      }
}

/// Counts the vectors of good quality on a sphere that is `factor` times sparser below its equator, from a point of the
/// equator, and those of them that are wrong.
struct SteppedSphere {
  /// @param is_wrong  (computed vector, exact vector)
  template <class IsWrong>
  SteppedSphere(std::size_t factor, const IsWrong& is_wrong) {
    const Cloud all = random_sphere(12000, 3);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < all.points.size(); ++i)
      if (all.points[i][2] > 0 || i % factor == 0) points.push_back(all.points[i]);
    const auto height = [](const Vec3& p) { return std::abs(p[2]); };
    const auto source = static_cast<std::size_t>(std::ranges::min_element(points, {}, height) - points.begin());
    const SolvedCloud solved(points);
    const SurfaceSource placed = solved.surface.source(Row(static_cast<Index>(source)));
    const LogMap map = solved.solver.solve(placed.source);
    const RowLogMap rows = solved.surface.to_rows(map);
    const std::vector<double> quality = to_rows(rows, map_quality(solved.surface.graph(), map));
    total = static_cast<int>(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == source || !(quality[i] >= trusted_quality)) continue;
      ++good;
      const Vec2 along{dot(points[i], placed.frame->x), dot(points[i], placed.frame->y)};
      const Vec2 exact = sphere_distance(points[i], points[source]) / length(along) * along;
      wrong += is_wrong(Vec2{rows.u[i], rows.v[i]}, exact);
    }
  }
  int total = 0, good = 0, wrong = 0;
};

// Where the spacing steps by ten, heat reaches the dense half through the sparse one, on paths that are half again too long.
TEST(SphereCloud, WhoseSpacingStepsHasFewGoodVectorsThatAreTooLong) {
  const SteppedSphere sphere(
      100, [](const Vec2& found, const Vec2& exact) { return length(found) > 1.25 * length(exact) + 0.1; });
  EXPECT_GT(3 * sphere.good, sphere.total);
  EXPECT_LT(200 * sphere.wrong, sphere.good);
}

// Smaller steps bend directions at nearly correct lengths: one-rings at the step are open, so that paths next to them are no
// detours.
TEST(SphereCloud, WhoseSpacingStepsHasFewGoodVectorsThatPointElsewhere) {
  for (const std::size_t factor : {9, 16, 25}) {
    const SteppedSphere sphere(
        factor, [](const Vec2& found, const Vec2& exact) { return length(found - exact) > 0.3 * length(exact); });
    EXPECT_GT(3 * sphere.good, 2 * sphere.total);
    EXPECT_LT(100 * sphere.wrong, sphere.good) << "spacing steps by the root of " << factor;
  }
}

}  // namespace
}  // namespace ahm::test
