// Maps of clouds on shapes with closed forms. On flat clouds they are exact up to rounding; on cylinders and spheres the error
// decreases with the spacing.
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/maps/wavefront.hpp"
#include "clouds.hpp"

namespace ahm::test {
namespace {

/// Error of the map from a row against positions along the axes of its frame.
double error_from(const SolvedCloud& solved, Index row, Variant variant = Variant::adaptive) {
  const std::span<const Vec3> points = solved.surface.positions();
  const Frame frame = *solved.surface.graph().frame(solved.surface.vertex(Row(row)).index);
  return flat_error(solved.map(row, variant), points, points[row], frame.x, frame.y);
}

TEST(FlatCloud, IsTheIdentityFromInteriorAndBoundary) {
  const Cloud cloud = flat_cloud(4000);
  const SolvedCloud solved(cloud.points);
  // The interior, the four corners of the square and the rim of the hole.
  std::vector<Index> sources{17, 2000};
  for (const Vec2& place : {Vec2{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0.65, 0.5}}) {
    const auto away = [&](const Vec2& p) { return length(p - place); };
    sources.push_back(static_cast<Index>(std::ranges::min_element(cloud.plane, {}, away) - cloud.plane.begin()));
  }
  for (Index row : sources)
    for (Variant variant : all_variants)
      EXPECT_LT(error_from(solved, row, variant), 1e-11 * std::sqrt(2.0)) << "source " << row;
}

TEST(FlatCloud, IsTheIdentityOnARegularGrid) {
  // The corners of every cell lie on a circle: the hardest case for Delaunay triangulations.
  std::vector<Vec3> grid;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) grid.push_back({x * 1.0, y * 1.0, 0.0});
  const SolvedCloud solved(grid);
  for (Index row : {0, 820, 1599}) EXPECT_LT(error_from(solved, row), 1e-11 * 56);
}

TEST(FlatCloud, IsAsGoodFarFromTheOriginAsItsDigitsAllow) {
  for (double far : {1e6, 1e8}) {
    const SolvedCloud solved(joined({}, flat_cloud(1500).points, {far, far, far}));
    EXPECT_LT(error_from(solved, 10), 100 * far * 2.3e-16);
  }
}

TEST(FlatCloud, ScalesWithItsPoints) {
  const std::vector<Vec3> points = flat_cloud(500).points;
  const RowLogMap map = SolvedCloud(points).map(3);
  for (double factor : {0x1p-990, 0x1p-20, 0x1p30, 0x1p1000, 1e-300, 1e-12, 1e12, 1e300}) {
    int exponent;
    const double tolerance = std::frexp(factor, &exponent) == 0.5 ? 0 : 1e-11;  // powers of two: the same bits
    const RowLogMap other = SolvedCloud(scaled(factor, points)).map(3);
    expect_near(other.u, scaled(factor, map).u, factor * tolerance);
  }
}

TEST(FlatCloud, DoesNotDependOnTheOrderOfPoints) {
  const std::vector<Vec3> points = flat_cloud(1000).points;
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(2));
  std::vector<Vec3> shuffled(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) shuffled[order[i]] = points[i];
  const RowLogMap map = SolvedCloud(points).map(3), other = SolvedCloud(shuffled).map(order[3]);
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(other.u[order[i]], map.u[i]);
}

TEST(FlatCloud, HasAboutTheAreaOfTheSquare) {
  // Where local triangulations disagree, they overlap.
  const auto surface = PointCloudSurface::build(flat_cloud(4000).points);
  const CsrGraphData& graph = surface.graph().data();
  const double area = std::accumulate(graph.masses.begin(), graph.masses.end(), 0.0) * std::pow(graph.length_unit, 2);
  EXPECT_NEAR(area, 1 - 0.15 * 0.15 * 3.14159, 0.1);
}

// Heat diffuses around a hole in a straight line; the quality is low where the shortest path bends.
TEST(FlatCloud, HasLowQualityBehindAHole) {
  std::vector<Vec3> points;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  const int side = 60;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y) {
      const Vec3 p{(x + shift(random)) / side, (y + shift(random)) / side, 0};
      if (std::abs(p[0] - 0.5) > 0.3 || std::abs(p[1] - 0.5) > 0.06) points.push_back(p);
    }
  const SolvedCloud solved(points);
  const auto& surface = solved.surface;
  const LogMap map = solved.solver.solve(surface.source(surface.nearest_row({0.5, 0.3, 0})).source);
  const std::vector<double> quality = to_rows(surface.to_rows(map), map_quality(surface.graph(), map));
  int behind = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    if (p[1] < 0.42) EXPECT_GT(quality[i], 0.99) << p[0] << ", " << p[1];
    if (p[1] < 0.6 || std::abs(p[0] - 0.5) > 0.15) continue;
    EXPECT_LT(quality[i], reliable_quality) << p[0] << ", " << p[1];
    ++behind;
  }
  EXPECT_GT(behind, 300);
}

// A line along the diagonals of squares passes between triangles that bend away from it on either side.
TEST(RolledCloud, OfSquaresIsCrossedDiagonally) {
  const int around = 120, rows = 40;
  const double h = 2 * std::numbers::pi / around;
  for (const auto& [turn, shift] : {Vec2{0, 0}, {0.5, 0}, {0, 0.01}, {0.5, 10.5}}) {
    std::vector<Vec3> points;
    for (int y = 0; y < rows; ++y)
      for (int k = 0; k < around; ++k)
        points.push_back({std::cos(h * (k + turn)) + shift, std::sin(h * (k + turn)), h * y});
    const auto surface = PointCloudSurface::build(points);
    Wavefront front(surface.graph());
    front.add(surface.source(Row(0)).source);
    front.run();
    for (int row = 0; row < rows * around; ++row) {
      const int y = row / around, k = row % around;
      const double exact = h * std::hypot(y, std::min(k, around - k));
      ASSERT_NEAR(front.distance(surface.vertex(Row(row))), exact, 0.002 * exact) << y << ", " << k;
    }
  }
}

TEST(RolledCloud, ConvergesToThePlaneWithSecondOrder) {
  const auto error = [](Index rows, Variant variant) {
    const Cloud cloud = rolled_cloud(rows, 0.5);
    const SolvedCloud solved(cloud.points, cloud.normals);
    const Index source = (rows / 2) * rows + rows / 2;
    // u along the axis of the cylinder, which is the plane's u; v is the normal times u.
    const RowLogMap map = solved.surface.to_rows(
        solved.solver.solve(solved.surface.source(Row(source), Vec3{1, 0, 0}).source, {.variant = variant}));
    return plane_error(cloud.plane, map.u, map.v, cloud.plane[source], {1, 0});
  };
  for (Variant variant : all_variants) {
    const double coarse = error(30, variant), fine = error(60, variant);
    EXPECT_GE(std::log2(coarse / fine), 1.8) << coarse << " -> " << fine;
  }
}

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

// Errors of the points farther than five spacings from the source, including the antipode.
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
        SCOPED_TRACE(testing::Message() << scale << ' ' << angle << ' ' << reversed);
        const auto row = [&](Index i) { return reversed ? last - i : i; };
        const RowLogMap found =
            map_from(bumpy_sphere(scale, {0.3 * scale, -2 * scale, scale}, angle, reversed), row(7), row(90));
        expect_same_rows(expected, scaled(1 / scale, found), 1e-9, row);
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
      if (i == source || !(quality[i] >= reliable_quality)) continue;
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
