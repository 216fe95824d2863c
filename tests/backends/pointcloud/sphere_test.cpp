// The error against the sphere's closed form falls with the spacing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ahm/testing/vectors.hpp"
#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

TEST(SphereCloud, ConvergesOnEvenPoints) {
  // Adaptive: bias of the diffusion time, proportional to h = n^-1/2 (docs/method.md).
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

}  // namespace
}  // namespace ahm::test
