// Closed forms on curved surfaces, and unfolded distances on coarse ones against exact distances.
#include "ahm/conformance/closed_forms.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "meshes.hpp"

namespace ahm::test {
namespace {

using std::numbers::pi;

/// Error of the map from the vertex nearest to `center` against the plane that a developable patch was bent from.
double unrolled_error(const Mesh& mesh, Variant variant, const Vec2& center) {
  const SolvedMesh solved(mesh);
  const Index source = nearest(mesh, center);
  const RowLogMap map = solved.map(Row(source), variant);
  Vec2 axis{0, 0};  // fitted to all vertices
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const Vec2 exact = mesh.plane[i] - mesh.plane[source], found{map.u[i], map.v[i]};
    axis = axis + Vec2{ahm::dot(exact, found), ahm::cross(found, exact)};
  }
  return plane_error(mesh, map, mesh.plane[source], normalized(axis));
}

TEST(DevelopablePatch, ConvergesToThePlane) {
  for (Variant variant : all_variants) {
    SCOPED_TRACE(to_string(variant));
    const auto cylinder = [&](Index side) { return unrolled_error(rolled_square(side, 0.3), variant, {0.5, 0.5}); };
    EXPECT_GT(std::log2(cylinder(21) / cylinder(81)) / 2, 1.8);
    // One radian of the plane on a cone of 1.4 radians: straight lines from the middle stay in the patch.
    const auto cone = [&](Index side) { return unrolled_error(cone_patch(side, 1.4), variant, {0.9, 0.5}); };
    EXPECT_LT(cone(81), 5e-3);
    EXPECT_GT(std::log2(cone(21) / cone(81)) / 2, 1.5);
  }
}

struct SphereErrors {
  double l2 = 0, hemisphere = 0, h = 0;
};

/// L2 error within 0.85 pi and largest error on the hemisphere, from a corner of the icosahedron and from the middle of a face.
SphereErrors sphere_errors(Index parts, Variant variant) {
  const Mesh mesh = icosphere(parts);
  const SolvedMesh solved(mesh);
  const CsrGraph& graph = solved.surface.graph();
  SphereErrors errors{.h = mean_edge(solved.surface)};
  double area = 0;
  for (Index source : {0, parts * parts / 3}) {
    const RowLogMap map = solved.map(Row(source), variant);
    const Frame frame = *graph.frame(solved.surface.vertex(Row(source)).index);
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const Vec2 exact = sphere_log(mesh.positions[source], frame.x, frame.y, mesh.positions[i]);
      const double d = length(exact), error = length(Vec2{map.u[i], map.v[i]} - exact);
      if (d < 0.85 * pi) errors.l2 += error * error * graph.mass(i), area += graph.mass(i);
      if (d < pi / 2) errors.hemisphere = std::max(errors.hemisphere, error);
    }
  }
  errors.l2 = std::sqrt(errors.l2 / area);
  return errors;
}

TEST(Sphere, AgreesWithTheMethodsFiguresAndConverges) {
  // Published with the method for t_coef = 1 on 10,242 vertices.
  const auto expect_near = [](const SphereErrors& errors, double l2, double hemisphere) {
    EXPECT_NEAR(errors.l2, l2, 0.1 * l2);
    EXPECT_NEAR(errors.hemisphere, hemisphere, 0.1 * hemisphere);
  };
  const SphereErrors adaptive = sphere_errors(32, Variant::adaptive), localized = sphere_errors(32, Variant::localized);
  expect_near(adaptive, 3.8e-2, 2.0e-2);
  expect_near(localized, 1.2e-2, 6.2e-3);
  const SphereErrors coarse = sphere_errors(16, Variant::adaptive);
  EXPECT_GE(std::log2(coarse.hemisphere / adaptive.hemisphere), 0.75);
  EXPECT_GE(std::log2(coarse.l2 / adaptive.l2), 0.75);
  for (const SphereErrors& errors : {sphere_errors(16, Variant::localized), localized})
    EXPECT_LE(errors.hemisphere, 0.2 * errors.h);
}

TEST(Sphere, FromInsideAFaceIsAsGoodAsFromAVertex) {
  const Mesh mesh = icosphere(24);
  const SolvedMesh solved(mesh);
  for (Index f : {3, 700, 5000}) {
    const FacePoint point{f, {0.5, 0.2, 0.3}};
    const Frame frame = *solved.surface.source(point).frame;
    const Vec3 p = normalized(frame.origin);
    const RowLogMap map = solved.map(point, Variant::localized);
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const Vec2 exact = sphere_log(p, frame.x, frame.y, mesh.positions[i]);
      if (length(exact) > 1.5) continue;
      EXPECT_LT(length(Vec2{map.u[i], map.v[i]} - exact), 0.3 * mean_edge(solved.surface)) << "face " << f;
    }
  }
}

Mesh stretched(Mesh mesh, double factor) {
  for (Vec3& p : mesh.positions) p[0] *= factor;
  return mesh;
}

/// The 95th percentile of the relative errors from all `points` together.
double error_from(const Mesh& mesh, std::initializer_list<SurfacePoint> points) {
  const SolvedMesh solved(mesh);
  std::vector<double> errors;
  for (const SurfacePoint& point : points) {
    const LogMap exact = exact_log_map(solved.surface, point),
                 heat = solved.solver.solve(solved.surface.source(point).source);
    for (Index i = 0; i < exact.size(); ++i)
      if (const double d = exact.distance(Vertex(i)); d > 0)
        errors.push_back(std::abs(heat.distance(Vertex(i)) / d - 1));
  }
  return percentile95(errors);
}

/// A prism of `sides` sides with edges longer than it is wide, so that sides of triangles go around it.
Mesh prism(Index sides, Index rings) {
  Mesh mesh = tube(rings + 1, sides, false, [&](Index i, Index k) {
    const double angle = 2 * pi * k / sides;
    return Vec3{0.1 * std::cos(angle), 0.1 * std::sin(angle), 1.0 * i / rings + 0.03 * std::sin(i)};
  });
  for (Index k = 1; k + 1 < sides; ++k) {
    mesh.faces.push_back({0, k + 1, k});
    mesh.faces.push_back({rings * sides, rings * sides + k, rings * sides + k + 1});
  }
  return mesh;
}

TEST(UnfoldedDistance, IsAccurateOnCoarseSurfaces) {
  EXPECT_LT(error_from(icosphere(8), {Row(0), Row(300), FacePoint{77, {0.2, 0.3, 0.5}}}), 0.0009);
  EXPECT_LT(error_from(stretched(icosphere(12), 20), {Row(0), Row(700), FacePoint{500, {0.2, 0.3, 0.5}}}), 0.0012);
  // Twenty vertices, each a corner.
  EXPECT_LT(error_from(prism(5, 3), {Row(0), Row(9), FacePoint{12, {0.2, 0.3, 0.5}}, EdgePoint{Row(0), Row(1), 0.3}}),
            0.015);
}

TEST(UnfoldedDistance, IsOfSecondOrder) {
  for (const auto& [coarse, stretch] : {std::pair{16, 1.0}, {8, 2.0}}) {
    const auto error = [factor = stretch](int side) {
      return error_from(stretched(icosphere(side), factor), {Row(0), Row(200)});
    };
    EXPECT_LT(error(2 * coarse), error(coarse) / 3) << stretch;
  }
}

TEST(UnfoldedDistance, OfACoarsePartDoesNotDependOnOtherParts) {
  const Mesh part = stretched(icosphere(8), 3);
  const SolvedMesh alone(part), together(joined(part, icosphere(34), {0, 30, 0}));
  ASSERT_GT(together.surface.graph().size(), 10000);
  const LogMapSolver marching(together.surface.graph(), {.strategy = Strategy::march});
  const Vec3 axis{0.3, 0.5, 0.7};
  for (const SurfacePoint& point : {SurfacePoint(Row(17)), SurfacePoint(FacePoint{300, {0.2, 0.3, 0.5}})}) {
    const Source source = together.surface.source(point, axis).source;
    const RowLogMap expected = alone.map(point, axis);
    const LogMap map = together.solver.solve(source), marched = marching.solve(source);
    Wavefront front(together.surface.graph());
    front.add(source);
    front.run();
    for (Index i = 0; i < part.vertices(); ++i) {
      const Vertex vertex = together.surface.vertex(Row(i));
      EXPECT_NEAR(map.distance(vertex), expected.distance[i], 1e-12);
      EXPECT_EQ(marched.distance(vertex), map.distance(vertex));
      EXPECT_EQ(front.distance(vertex), map.distance(vertex));
    }
  }
}

// Next to small faces, a straight path may cross a side of a large face whose ends are both beyond the radius.
TEST(UnfoldedDistance, IsTheSameWithinARadius) {
  const Mesh flat{{{0, 0, 0}, {10, 0, 0}, {5, -8, 0}, {5, 3, 0}, {6, 3.5, 0}, {4, 3.5, 0}},
                  {{0, 2, 1}, {0, 1, 3}, {1, 4, 3}, {0, 3, 5}, {3, 4, 5}},
                  {}};
  for (const Mesh& mesh : {flat, prism(5, 3), stretched(prism(4, 6), 7)}) {
    const auto surface = build(mesh);
    for (Strategy strategy : {Strategy::global, Strategy::march}) {
      const LogMapSolver solver(surface.graph(), {.strategy = strategy});
      for (const std::vector<double>& weights : {std::vector{0.475, 0.05, 0.475}, {0.4, 0.1, 0.5}, {0.1, 0.1, 0.8}})
        for (Index face : {0, 3}) {
          const Source source = surface.source(FacePoint{face, weights}).source;
          const LogMap whole = solver.solve(source);
          const double longest = std::ranges::max(whole.distances());
          for (double radius : {0.3 * longest, 0.6 * longest, 0.9 * longest}) {
            const LogMap part = solver.solve(source, {.radius = radius});
            for (Index i = 0; i < whole.size(); ++i) {
              const double distance = whole.distance(Vertex(i));
              ASSERT_EQ(part.status(Vertex(i)) == Status::ok, distance <= radius) << i << ", radius " << radius;
              if (distance <= radius) ASSERT_NEAR(part.distance(Vertex(i)), distance, 1e-12 * longest) << i;
            }
          }
        }
    }
  }
}

}  // namespace
}  // namespace ahm::test
