// Closed forms on curved surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ahm/conformance/closed_forms.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

using std::numbers::pi;

/// Largest error against the plane a developable patch was bent from, up to the turn of the frame, which is fitted.
double unrolled_error(const Mesh& mesh, Variant variant, const std::array<double, 2>& center) {
  const SolvedMesh solved(mesh);
  Index source = 0;
  auto distance = [&](Index i) { return std::hypot(mesh.plane[i][0] - center[0], mesh.plane[i][1] - center[1]); };
  for (Index i = 0; i < mesh.vertices(); ++i)
    if (distance(i) < distance(source)) source = i;
  const RowLogMap map = solved.map(solved.surface.source(Row(source)).source, variant);
  double c = 0, s = 0;
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double x = mesh.plane[i][0] - mesh.plane[source][0], y = mesh.plane[i][1] - mesh.plane[source][1];
    c += x * map.u[i] + y * map.v[i];
    s += y * map.u[i] - x * map.v[i];
  }
  return plane_error(mesh, map, mesh.plane[source], {c / std::hypot(c, s), s / std::hypot(c, s)});
}

TEST(Cylinder, ConvergesWithSecondOrderToThePlane) {
  for (Variant variant : all_variants) {
    const double coarse = unrolled_error(rolled_square(21, 0.3), variant, {0.5, 0.5});
    const double fine = unrolled_error(rolled_square(81, 0.3), variant, {0.5, 0.5});
    EXPECT_GT(std::log2(coarse / fine) / 2, 1.8) << to_string(variant) << ": " << coarse << ", " << fine;
  }
}

TEST(Cone, ConvergesToThePlaneItIsRolledFrom) {
  for (Variant variant : all_variants) {
    // One radian of the plane on a cone of 1.4 radians: seen from its middle the patch is convex enough for straight
    // lines.
    const double coarse = unrolled_error(cone_patch(21, 1.4), variant, {0.9, 0.5});
    const double fine = unrolled_error(cone_patch(81, 1.4), variant, {0.9, 0.5});
    EXPECT_LT(fine, 5e-3);
    EXPECT_GT(std::log2(coarse / fine) / 2, 1.5) << to_string(variant) << ": " << coarse << ", " << fine;
  }
}

struct SphereErrors {
  double l2, hemisphere, h;
};

/// L2 error within 0.85 pi and largest error on the hemisphere, from a corner of the icosahedron and from the middle of
/// a face.
SphereErrors sphere_errors(Index parts, Variant variant) {
  const Mesh mesh = icosphere(parts);
  const SolvedMesh solved(mesh);
  const CsrGraph& graph = solved.surface.graph();
  SphereErrors e{0, 0, graph.mean_edge_length() * graph.length_unit()};
  double area = 0;
  for (Index source : {0, parts * parts / 3}) {
    const RowLogMap map = solved.map(solved.surface.source(Row(source)).source, variant);
    const Frame frame = *graph.frame(solved.surface.vertex(Row(source)).index);
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const auto exact = sphere_log(mesh.positions[source], frame.x, frame.y, mesh.positions[i]);
      const double d = std::hypot(exact[0], exact[1]), off = std::hypot(map.u[i] - exact[0], map.v[i] - exact[1]);
      if (d < 0.85 * pi) e.l2 += off * off * graph.mass(i), area += graph.mass(i);
      if (d < pi / 2) e.hemisphere = std::max(e.hemisphere, off);
    }
  }
  e.l2 = std::sqrt(e.l2 / area);
  return e;
}

TEST(Sphere, LocalizedIsWithinAFifthOfAnEdgeOnTheHemisphere) {
  for (Index parts : {16, 32}) {
    const SphereErrors e = sphere_errors(parts, Variant::localized);
    EXPECT_LE(e.hemisphere, 0.2 * e.h) << parts;
  }
}

TEST(Sphere, ConvergesWithFirstOrder) {
  const SphereErrors coarse = sphere_errors(16, Variant::adaptive), fine = sphere_errors(32, Variant::adaptive);
  EXPECT_GE(std::log2(coarse.hemisphere / fine.hemisphere), 0.75) << coarse.hemisphere << ", " << fine.hemisphere;
  EXPECT_GE(std::log2(coarse.l2 / fine.l2), 0.75) << coarse.l2 << ", " << fine.l2;
}

TEST(Sphere, AgreesWithTheMethodsFigures) {
  // 10,242 vertices: published with the method for t_coef = 1, L2 within 0.85 pi / largest error on the hemisphere.
  const SphereErrors adaptive = sphere_errors(32, Variant::adaptive), localized = sphere_errors(32, Variant::localized);
  EXPECT_NEAR(adaptive.l2, 3.8e-2, 0.1 * 3.8e-2);
  EXPECT_NEAR(adaptive.hemisphere, 2.0e-2, 0.1 * 2.0e-2);
  EXPECT_NEAR(localized.l2, 1.2e-2, 0.1 * 1.2e-2);
  EXPECT_NEAR(localized.hemisphere, 6.2e-3, 0.1 * 6.2e-3);
}

}  // namespace
}  // namespace ahm::test
