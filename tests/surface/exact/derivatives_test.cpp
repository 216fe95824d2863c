// Derivatives of the exponential map, distances and log maps, compared with differences.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>

#include "ahm/surface/exact/geodesic_derivatives.hpp"
#include "ahm/util/small_math.hpp"
#include "polyhedra.hpp"

namespace ahm::test {
namespace {

Vec3 product(const TangentMap& map, const Vec3& w) {
  Vec3 result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i] += map[3 * i + j] * w[j];
  return result;
}

/// A sphere with heights from 0.75 to 1.25: as many saddles as tips.
Mesh rough_sphere() {
  Mesh mesh = icosphere(7);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> height(0.75, 1.25);
  for (Vec3& p : mesh.positions) p = height(random) * p;
  return mesh;
}

/// A surface with random points inside its faces, and their geodesics.
struct Shape {
  explicit Shape(std::unique_ptr<const Surface> given) : surface(std::move(given)), geodesics(*surface) {}

  SurfacePoint random_point() {
    std::uniform_int_distribution<Index> face(0, static_cast<Index>(surface->faces().size()) - 1);
    std::uniform_real_distribution<double> weight(0.1, 1);
    FacePoint point{face(random), {}};
    double sum = 0;
    for (std::size_t c = 0; c < surface->faces()[to_size(point.face)].size(); ++c)
      sum += point.barycentric.emplace_back(weight(random));
    for (double& w : point.barycentric) w /= sum;
    return point;
  }
  Vec3 random_vector(double length) {
    std::normal_distribution<double> normal;
    return length * normalized(Vec3{normal(random), normal(random), normal(random)});
  }
  /// The part of a vector in the tangent plane of a point.
  Vec3 tangent(const SurfacePoint& point, const Vec3& w) const {
    return product(exponential_point(geodesics, point, {}).by_vector, w);
  }
  SurfacePoint moved(const SurfacePoint& point, const Vec3& w) const {
    return surface->closest_point(surface->position(point) + w).point;
  }
  GeodesicEnds ends(const SurfacePoint& source, const SurfacePoint& target) const {
    const std::array pair{source, target};
    return geodesic_ends(geodesics, std::span(&pair, 1), {}, 1)[0];
  }
  Vec3 log(const SurfacePoint& source, const SurfacePoint& target) const {
    const GeodesicEnds found = ends(source, target);
    return found.distance * found.departure;
  }

  std::unique_ptr<const Surface> surface;
  ExactGeodesics geodesics;
  std::mt19937_64 random{3};
};

Shape shape(const Mesh& mesh) { return Shape(std::make_unique<const trimesh::TriangleMeshSurface>(surface_of(mesh))); }

/// Convex, with saddles, with folds, with holes, and of polygons.
std::vector<std::function<Shape()>> curved_shapes() {
  return {[] { return shape(icosphere(7)); }, [] { return shape(rough_sphere()); },
          [] { return shape(folded_strip(11)); }, [] { return shape(holed_square(14)); },
          [] { return Shape(std::make_unique<const polymesh::PolygonMeshSurface>(surface_of(voronoi_square(60)))); }};
}

constexpr double step = 1e-6;

/// Expects a derivative, times w, to be the central difference of a function of the step along w.
void expect_difference(const Vec3& derivative, const std::function<Vec3(double)>& value, double tolerance) {
  const Vec3 difference = (0.5 / step) * (value(step) - value(-step));
  EXPECT_LT(norm(difference - derivative), tolerance * (1 + norm(derivative)));
}

TEST(GeodesicDerivatives, OfTheExponentialMapAreDifferences) {
  int stopped = 0;
  for (const auto& make : curved_shapes()) {
    Shape on = make();
    for (int k = 0; k < 60; ++k) {
      SCOPED_TRACE(testing::Message() << on.surface->rows().row_count() << " rows, trial " << k);
      const SurfacePoint start = on.random_point();
      const Vec3 v = on.random_vector(0.1 + 0.02 * k), w = on.tangent(start, on.random_vector(1));
      const ExponentialPoint end = exponential_point(on.geodesics, start, v);
      stopped += !end.complete;
      expect_difference(
          product(end.by_start, w),
          [&](double t) { return exponential_point(on.geodesics, on.moved(start, t * w), v).position; }, 1e-7);
      expect_difference(
          product(end.by_vector, w),
          [&](double t) { return exponential_point(on.geodesics, start, v + t * w).position; }, 1e-7);
    }
  }
  EXPECT_GT(stopped, 20);
}

TEST(GeodesicDerivatives, OfTheExponentialMapAtVerticesAreDifferences) {
  for (const Mesh& mesh : {icosphere(7), rough_sphere()}) {
    Shape on = shape(mesh);
    for (Index row = 0; row < 40; ++row) {
      const Vec3 v = on.random_vector(0.5), w = on.tangent(Row(row), on.random_vector(1));
      expect_difference(
          product(exponential_point(on.geodesics, Row(row), v).by_vector, w),
          [&](double t) { return exponential_point(on.geodesics, Row(row), v + t * w).position; }, 1e-7);
    }
  }
}

TEST(GeodesicDerivatives, OfDistancesAndLogMapsAreDifferences) {
  for (const auto& make : curved_shapes()) {
    Shape on = make();
    for (int k = 0; k < 40; ++k) {
      SCOPED_TRACE(testing::Message() << on.surface->rows().row_count() << " rows, trial " << k);
      const SurfacePoint p = on.random_point(), q = on.random_point();
      const GeodesicEnds found = on.ends(p, q);
      const Vec3 w = on.tangent(p, on.random_vector(1)), z = on.tangent(q, on.random_vector(1));
      expect_difference(
          {dot(found.departure, w), 0, 0},
          [&](double t) {
            return Vec3{-on.ends(on.moved(p, t * w), q).distance, 0, 0};
          },
          1e-7);
      expect_difference(
          {dot(found.arrival, z), 0, 0},
          [&](double t) {
            return Vec3{on.ends(p, on.moved(q, t * z)).distance, 0, 0};
          },
          1e-7);
      expect_difference(
          product(found.log_by_source, w), [&](double t) { return on.log(on.moved(p, t * w), q); }, 1e-6);
      expect_difference(
          product(found.log_by_target, z), [&](double t) { return on.log(p, on.moved(q, t * z)); }, 1e-6);
    }
  }
}

TEST(GeodesicDerivatives, OfLogMapsAtVerticesAreDifferences) {
  for (const Mesh& mesh : {icosphere(7), rough_sphere()}) {
    Shape on = shape(mesh);
    for (Index row = 0; row < 30; ++row) {
      const SurfacePoint q = on.random_point();
      const Vec3 z = on.tangent(q, on.random_vector(1));
      expect_difference(
          product(on.ends(Row(row), q).log_by_target, z),
          [&](double t) { return on.log(Row(row), on.moved(q, t * z)); }, 1e-6);
    }
  }
}

TEST(GeodesicDerivatives, OfALogMapAndItsInverseAreInverse) {
  for (const Mesh& mesh : {icosphere(7), rough_sphere()}) {
    Shape on = shape(mesh);
    int shortest = 0;
    for (int k = 0; k < 90; ++k) {
      const SurfacePoint start = k % 3 == 0 ? SurfacePoint(Row(k)) : on.random_point();
      const Vec3 v = on.tangent(start, on.random_vector(0.3)), w = on.tangent(start, on.random_vector(1));
      const ExponentialPoint end = exponential_point(on.geodesics, start, v);
      const GeodesicEnds back = on.ends(start, on.surface->closest_point(end.position).point);
      if (back.distance < norm(v) - 1e-9) continue;  // beyond the cut locus
      ++shortest;
      EXPECT_LT(norm(back.distance * back.departure - v), 1e-9);
      EXPECT_LT(norm(product(back.log_by_target, product(end.by_vector, w)) - w), 1e-9);
    }
    EXPECT_GT(shortest, 50);
  }
}

TEST(GeodesicDerivatives, AreThoseOfThePlane) {
  Shape on = shape(flat_square(9));
  for (int k = 0; k < 50; ++k) {
    const SurfacePoint p = on.random_point(), q = on.random_point();
    const GeodesicEnds found = on.ends(p, q);
    const Vec3 w = on.tangent(p, on.random_vector(1)), v = on.surface->position(q) - on.surface->position(p);
    EXPECT_LT(norm(found.distance * found.departure - v), 1e-12);
    EXPECT_LT(norm(found.arrival - found.departure), 1e-12);
    EXPECT_LT(norm(product(found.log_by_target, w) - w), 1e-12);
    EXPECT_LT(norm(product(found.log_by_source, w) + w), 1e-12);
    EXPECT_LT(norm(exponential_point(on.geodesics, p, v).position - on.surface->position(q)), 1e-12);
  }
}

TEST(GeodesicDerivatives, AtTheDistanceZero) {
  Shape on = shape(icosphere(3));
  const SurfacePoint p = on.random_point();
  const GeodesicEnds found = on.ends(p, p);
  const Vec3 w = on.tangent(p, on.random_vector(1));
  EXPECT_EQ(found.distance, 0);
  EXPECT_EQ(found.departure, Vec3{});
  EXPECT_EQ(found.arrival, Vec3{});
  EXPECT_LT(norm(product(found.log_by_target, w) - w), 1e-14);
  EXPECT_LT(norm(product(found.log_by_source, w) + w), 1e-14);
}

TEST(GeodesicDerivatives, RefuseWhatTheyDoNotSupport) {
  Shape band = shape(moebius_mesh(40, 6)), sphere = shape(icosphere(3));
  const SurfacePoint p = band.random_point();
  try {
    exponential_point(band.geodesics, p, {0.1, 0, 0});
    FAIL();
  } catch (const InvalidArgument& e) {
    EXPECT_EQ(e.fault(), "not_orientable");
  }
  const std::array pair{p, p};
  EXPECT_THROW(geodesic_ends(band.geodesics, std::span(&pair, 1)), InvalidArgument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(exponential_point(sphere.geodesics, Row(0), {nan, 0, 0}), InvalidArgument);
  const Shape parts = shape(joined(icosphere(2), icosphere(2), {5, 0, 0}));
  EXPECT_EQ(parts.ends(Row(0), Row(60)).status, Status::disconnected);
}

}  // namespace
}  // namespace ahm::test
