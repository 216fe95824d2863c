// On planar meshes the map is the identity, whatever the polygons.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ahm/maps/quality.hpp"
#include "polygon_graphs.hpp"

namespace ahm::test {
namespace {

struct FlatCase {
  const char* name;
  Polygons mesh;
};

std::vector<FlatCase> flat_meshes() {
  return {{"Voronoi cells", voronoi_square(300)},
          {"L shapes", l_shapes(10)},
          {"stretched L shapes", l_shapes(10, 30.0)},
          {"U shapes", u_shapes(8)},
          {"bricks", brick_wall(16)},
          {"quads", quad_grid(20)},
          {"triangles", quad_grid(20, true)}};
}

TEST(PolygonPlane, IsTheIdentityFromAVertex) {
  for (const auto& [name, mesh] : flat_meshes())
    for (bool clamp : {true, false}) {
      const auto surface = build(mesh, {.clamp_weights = clamp});
      const LogMapSolver solver(surface.graph());
      for (Index source : {Index{0}, mesh.vertices() / 2, mesh.vertices() - 1})
        for (Variant variant : all_variants) {
          // Where heat has lost its sign its frames are wrong, and the adaptive variant takes them along.
          if (!clamp && variant == Variant::adaptive && surface.details().negative_weights > 0) continue;
          const Vec3 u{mesh.positions[1][0] - mesh.positions[0][0], mesh.positions[1][1] - mesh.positions[0][1],
                       mesh.positions[1][2] - mesh.positions[0][2]};
          const auto map = surface.to_rows(solver.solve(surface.source(Row(source), u).source, {.variant = variant}));
          double ux = mesh.plane[1][0] - mesh.plane[0][0], uy = mesh.plane[1][1] - mesh.plane[0][1];
          const double length = std::hypot(ux, uy);
          EXPECT_LT(plane_error(mesh, map, mesh.plane[source], {ux / length, uy / length}, !clamp),
                    1e-11 * mesh.diameter())
              << name << (clamp ? "" : ", as published") << ", " << to_string(variant) << " from " << source;
        }
    }
}

TEST(PolygonPlane, IsTheIdentityFromInsideAFace) {
  for (const auto& [name, mesh] : flat_meshes()) {
    const auto surface = build(mesh);
    const LogMapSolver solver(surface.graph());
    for (Index face : {Index{0}, mesh.faces() / 3, mesh.faces() - 1}) {
      const auto corners = mesh.face(face);
      std::vector<double> weights(corners.size());
      double sum = 0;
      for (std::size_t c = 0; c < weights.size(); ++c) sum += weights[c] = 1.0 + static_cast<double>(c % 3);
      std::array<double, 2> origin{0, 0};
      for (std::size_t c = 0; c < weights.size(); ++c) {
        weights[c] /= sum;
        for (int a = 0; a < 2; ++a) origin[a] += weights[c] * mesh.plane[corners[c]][a];
      }
      const auto &p = mesh.plane[corners[0]], &q = mesh.plane[corners[1]];
      const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
      const std::array<double, 2> u{(q[0] - p[0]) / length, (q[1] - p[1]) / length};
      for (Variant variant : all_variants) {
        const auto map =
            surface.to_rows(solver.solve(surface.source(FacePoint{face, weights}).source, {.variant = variant}));
        EXPECT_LT(plane_error(mesh, map, origin, u), 1e-11 * mesh.diameter()) << name << ", " << to_string(variant);
      }
      const Frame frame = *surface.source(FacePoint{face, weights}).frame;
      EXPECT_NEAR(frame.x[0] * frame.y[0] + frame.x[1] * frame.y[1] + frame.x[2] * frame.y[2], 0, 1e-12);
    }
  }
}

TEST(PolygonPlane, DoesNotDependOnTheOrderOfCorners) {
  Polygons mesh = voronoi_square(80);
  for (Index f = 0; f < mesh.faces(); f += 3) mesh.reverse(f);
  const auto surface = build(mesh);
  EXPECT_GT(surface.details().topology.reoriented, 0);
  EXPECT_TRUE(surface.details().topology.orientable);
  const LogMapSolver solver(surface.graph());
  for (Index face : {0, 1, 2, 3}) {  // some of them turned over
    const auto corners = mesh.face(face);
    std::vector<double> weights(corners.size(), 0.0);
    weights[0] = 0.5, weights[1] = 0.2, weights[2] = 0.3;
    std::array<double, 2> origin{0, 0};
    for (std::size_t c = 0; c < 3; ++c)
      for (int a = 0; a < 2; ++a) origin[a] += weights[c] * mesh.plane[corners[c]][a];
    const auto &p = mesh.plane[corners[0]], &q = mesh.plane[corners[1]];
    const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
    const auto map = surface.to_rows(solver.solve(surface.source(FacePoint{face, weights}).source));
    EXPECT_LT(plane_error(mesh, map, origin, {(q[0] - p[0]) / length, (q[1] - p[1]) / length}), 1e-11);
  }
}

TEST(PolygonPlane, QualitySeesASlot) {
  const Polygons whole = quad_grid(20);
  Polygons mesh{whole.positions, {0}, {}, whole.plane};
  for (Index f = 0; f < whole.faces(); ++f) {
    Vec2 middle{0, 0};
    for (Index v : whole.face(f)) middle = {middle[0] + whole.plane[v][0] / 4, middle[1] + whole.plane[v][1] / 4};
    if (!(std::abs(middle[0] - 0.5) < 0.06 && middle[1] < 0.8)) mesh.add(whole.face(f));
  }
  const auto surface = build(mesh);
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(0)).source);
  const std::vector<double> quality = map_quality(surface.graph(), map);
  Index before = 0, behind = 0;
  for (Index i = 0; i < mesh.vertices(); ++i) {
    if (std::find(mesh.corners.begin(), mesh.corners.end(), i) == mesh.corners.end()) continue;
    const double q = quality[surface.vertex(Row(i)).index];
    const Vec2& p = mesh.plane[i];
    const double around = std::hypot(0.45, 0.75) + std::hypot(p[0] - 0.45, p[1] - 0.75);
    if (p[0] < 0.4) {
      EXPECT_NEAR(q, 1, 1e-9) << i;
      ++before;
    }
    if (p[0] > 0.6 && around > 1.3 * std::hypot(p[0], p[1])) {
      EXPECT_LT(q, trusted_quality) << i;
      ++behind;
    }
  }
  EXPECT_GT(before, 50);
  EXPECT_GT(behind, 50);
}

}  // namespace
}  // namespace ahm::test
