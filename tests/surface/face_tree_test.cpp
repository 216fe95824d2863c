#include "ahm/surface/detail/face_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "ahm/util/vec.hpp"

namespace ahm::detail {
namespace {

/// Triangles of random corners. Every third one is a needle: a corner is almost on the opposite side.
struct Triangles {
  std::vector<Vec3> points;
  std::vector<Offset> begin{0};
  std::vector<Index> corners;

  Triangles(int n, double scale, std::mt19937& random) {
    std::normal_distribution<double> normal;
    const auto vector = [&](double length) { return length * Vec3{normal(random), normal(random), normal(random)}; };
    for (int k = 0; k < n; ++k) {
      const Vec3 a = vector(scale), b = a + vector(scale);
      points.insert(points.end(), {a, b, k % 3 == 0 ? 0.3 * a + 0.7 * b + vector(1e-15 * scale) : a + vector(scale)});
      for (int c = 0; c < 3; ++c) corners.push_back(3 * k + c);
      begin.push_back(3 * (k + 1));
    }
  }
  FaceTree tree() const { return {points, {begin, corners}}; }
  /// Distance of the nearest triangle, from trees of one triangle.
  double distance_of(const Vec3& position) const {
    double least = std::numeric_limits<double>::infinity();
    const std::vector<Offset> one{0, 3};
    for (std::size_t k = 0; k < corners.size(); k += 3)
      least = std::min(least, FaceTree(points, {one, std::span(corners).subspan(k, 3)}).nearest(position).distance);
    return least;
  }
};

/// The nearest of all triangles is found, at any scale; with a bound, if it is nearer.
TEST(FaceTree, FindsTheNearestOfAllTriangles) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const double scale : {1.0, 1e-200, 1e200}) {
    const Triangles triangles(100, scale, random);
    const FaceTree tree = triangles.tree();
    for (int k = 0; k < 100; ++k) {
      const double reach = k % 2 == 0 ? 1 : 100;
      const Vec3 position = reach * scale * Vec3{normal(random), normal(random), normal(random)};
      const double expected = triangles.distance_of(position), tolerance = 1e-14 * reach * scale;
      const FaceTree::Hit hit = tree.nearest(position);
      EXPECT_NEAR(hit.distance, expected, tolerance);
      EXPECT_NEAR(distance(position, hit.position), expected, tolerance);
      EXPECT_NEAR(distance(position, tree.nearest_position(position).value()), expected, tolerance);
      EXPECT_NEAR(distance(position, tree.nearest_position(position, 1.001 * expected).value()), expected, tolerance);
      EXPECT_FALSE(tree.nearest_position(position, 0.999 * expected));
    }
  }
}

}  // namespace
}  // namespace ahm::detail
