// On planar meshes the map is the identity for any polygons, also where corners coincide and for faces without area.
#include <set>

#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "polygon_graphs.hpp"

namespace ahm::test {
namespace {

std::vector<std::pair<std::string, Polygons>> flat_cases() {
  return {{"Voronoi cells", voronoi_square(300)},
          {"L shapes", l_shapes(10)},
          {"stretched L shapes", l_shapes(10, 30.0)},
          {"U shapes", u_shapes(8)},
          {"bricks", brick_wall(16)},
          {"quads", quad_grid(20)},
          {"triangles", quad_grid(20, true)}};
}

/// Expects the identity, with the u axis from vertex a to vertex b.
/// @param clamped  otherwise vertices whose heat is negative have no coordinates
void expect_identity(const Polygons& mesh, const RowLogMap& map, const Vec2& origin, Index a, Index b,
                     bool clamped = true) {
  const Vec2 axis = normalized(mesh.plane[b] - mesh.plane[a]);
  for (Index i = 0; i < mesh.vertices(); ++i) {
    if (!clamped && map.status[i] == Status::unreached) continue;
    const Vec2 offset = mesh.plane[i] - origin, exact{dot(axis, offset), cross(axis, offset)};
    ASSERT_LT(length(Vec2{map.u[i], map.v[i]} - exact), 1e-11 * mesh.diameter() / std::sqrt(2)) << "vertex " << i;
  }
}

TEST(PolygonPlane, IsTheIdentityFromAVertex) {
  for (const auto& [name, mesh] : flat_cases())
    for (bool clamp : {true, false}) {
      const auto surface = build(mesh, {.clamp_weights = clamp});
      const LogMapSolver solver(surface.graph());
      for (Index source : {Index{0}, mesh.vertices() / 2, mesh.vertices() - 1})
        for (Variant variant : all_variants) {
          // Where negative weights make heat negative, its frames are wrong, and so is the adaptive variant.
          if (!clamp && variant == Variant::adaptive && surface.details().negative_weights > 0) continue;
          SCOPED_TRACE(testing::Message()
                       << name << ", clamped " << clamp << ", " << to_string(variant) << " from " << source);
          const Source at = surface.source(Row(source), mesh.positions[1] - mesh.positions[0]).source;
          const RowLogMap map = surface.to_rows(solver.solve(at, {.variant = variant}));
          expect_identity(mesh, map, mesh.plane[source], 0, 1, clamp);
        }
    }
}

TEST(PolygonPlane, IsTheIdentityFromInsideAFace) {
  auto cases = flat_cases();
  cases.push_back({"reversed", voronoi_square(80)});
  for (Index f = 0; f < cases.back().second.faces(); f += 3) cases.back().second.reverse(f);
  for (const auto& [name, mesh] : cases) {
    const auto surface = build(mesh);
    EXPECT_EQ(surface.details().topology.reoriented > 0, name == "reversed");
    EXPECT_TRUE(surface.details().topology.orientable);
    const LogMapSolver solver(surface.graph());
    for (Index face : {0, 1, 2, 3, mesh.faces() / 3, mesh.faces() - 1}) {
      SCOPED_TRACE(testing::Message() << name << ", face " << face);
      const std::vector<Index> corners = mesh.face(face);
      FacePoint point{face, std::vector<double>(corners.size())};
      double sum = 0;
      for (std::size_t c = 0; c < corners.size(); ++c) sum += point.barycentric[c] = 1.0 + static_cast<double>(c % 3);
      Vec2 origin{0, 0};
      for (std::size_t c = 0; c < corners.size(); ++c)
        origin = origin + (point.barycentric[c] /= sum) * mesh.plane[corners[c]];
      const SurfaceSource source = surface.source(point);
      EXPECT_NEAR(dot(source.frame->x, source.frame->y), 0, 1e-12);
      for (Variant variant : all_variants)
        expect_identity(mesh, surface.to_rows(solver.solve(source.source, {.variant = variant})), origin, corners[0],
                        corners[1]);
    }
  }
}

TEST(PolygonPlane, HasLowQualityBehindASlot) {
  const Polygons whole = quad_grid(20);
  Polygons mesh{whole.positions, {0}, {}, whole.plane};
  std::set<Index> used;
  for (Index f = 0; f < whole.faces(); ++f) {
    const std::vector<Index> face = whole.face(f);
    Vec2 middle{0, 0};
    for (Index v : face) middle = middle + 0.25 * whole.plane[v];
    if (std::abs(middle[0] - 0.5) < 0.06 && middle[1] < 0.8) continue;
    mesh.add(face);
    used.insert(face.begin(), face.end());
  }
  const auto surface = build(mesh);
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(0)).source);
  const std::vector<double> quality = map_quality(surface.graph(), map);
  Index before = 0, behind = 0;
  for (Index i : used) {
    const double q = quality[surface.vertex(Row(i)).index];
    const Vec2 p = mesh.plane[i], end{0.45, 0.75};
    if (p[0] < 0.4) {
      EXPECT_NEAR(q, 1, 1e-9) << i;
      ++before;
    }
    if (p[0] > 0.6 && length(end) + length(p - end) > 1.3 * length(p)) {
      EXPECT_LT(q, reliable_quality) << i;
      ++behind;
    }
  }
  EXPECT_GT(before, 50);
  EXPECT_GT(behind, 50);
}

/// A mesh with vertices added on an edge of two faces, at these fractions of it in ascending order. Where the two sides have
/// different vertices, a face without area closes the gap.
struct SplitEdge {
  SplitEdge(const Polygons& original, const std::vector<double>& left, const std::vector<double>& right)
      : mesh{original.positions, {0}, {}, original.plane} {
    std::set<std::pair<Index, Index>> sides;
    for (Index f = 0; f < original.faces(); ++f)
      each_side(original, f, [&](Index p, Index q) { sides.insert({p, q}); });
    each_side(original, original.faces() / 2, [&](Index p, Index q) {
      if (b < 0 && sides.contains({q, p})) a = p, b = q;
    });
    const std::vector<Index> on_left = add_vertices(left), on_right = left == right ? on_left : add_vertices(right);
    for (Index f = 0; f < original.faces(); ++f) {
      std::vector<Index> face;
      each_side(original, f, [&](Index p, Index q) {
        face.push_back(p);
        if (p == a && q == b) face.insert(face.end(), on_left.begin(), on_left.end());
        if (p == b && q == a) face.insert(face.end(), on_right.rbegin(), on_right.rend());
      });
      mesh.add(face);
    }
    if (left == right) return;
    std::vector<Index> thin{b};
    thin.insert(thin.end(), on_left.rbegin(), on_left.rend());
    thin.push_back(a);
    thin.insert(thin.end(), on_right.begin(), on_right.end());
    mesh.add(thin);
  }

  Polygons mesh;
  Index a = -1, b = -1;  ///< ends of the edge

 private:
  template <class Visit>
  static void each_side(const Polygons& polygons, Index f, const Visit& visit) {
    const std::vector<Index> corners = polygons.face(f);
    for (std::size_t c = 0; c < corners.size(); ++c) visit(corners[c], corners[(c + 1) % corners.size()]);
  }
  std::vector<Index> add_vertices(const std::vector<double>& fractions) {
    std::vector<Index> added;
    for (double t : fractions) {
      added.push_back(mesh.vertices());
      mesh.positions.push_back(mesh.positions[a] + t * (mesh.positions[b] - mesh.positions[a]));
      mesh.plane.push_back(mesh.plane[a] + t * (mesh.plane[b] - mesh.plane[a]));
    }
    return added;
  }
};

void expect_plane_distances(const Polygons& mesh) {
  for (Discretization how : {Discretization::refined, Discretization::polygons}) {
    const auto surface = build(mesh, how);
    EXPECT_NO_THROW(validate(surface.graph()));
    const LogMapSolver solver(surface.graph());
    for (Index source : {Index{0}, mesh.vertices() / 2, mesh.vertices() - 1})
      for (Variant variant : all_variants) {
        const RowLogMap map = surface.to_rows(solver.solve(surface.source(Row(source)).source, {.variant = variant}));
        for (Index i = 0; i < mesh.vertices(); ++i)
          ASSERT_NEAR(std::hypot(map.u[i], map.v[i]), length(mesh.plane[i] - mesh.plane[source]),
                      1e-9 * mesh.diameter())
              << "refined " << (how == Discretization::refined) << ", from " << source << " to " << i;
      }
  }
}

TEST(CoincidentCorners, LeaveThePlaneExact) {
  for (const Polygons& mesh : {voronoi_square(120), quad_grid(12), brick_wall(8), l_shapes(4)})
    for (const std::vector<double>& fractions :
         {std::vector{0.0}, std::vector{0.0, 0.0}, std::vector{0.4, 0.4}, std::vector{1e-12}, std::vector{1e-7, 1.0}}) {
      const SplitEdge split(mesh, fractions, fractions);
      expect_plane_distances(split.mesh);
      const auto surface = build(split.mesh, Discretization::refined);
      EXPECT_EQ(surface.details().mollification, 0);
      EXPECT_EQ(surface.rows().row_count(), split.mesh.vertices());
      const RowLogMap map = map_of(surface, Row(split.a));
      EXPECT_NEAR(map.distance[mesh.vertices()], fractions[0] * map.distance[split.b], 1e-9 * mesh.diameter());
    }
}

TEST(CollinearPolygons, LeaveThePlaneExactAndAreNamed) {
  const std::pair<std::vector<double>, std::vector<double>> cases[] = {
      {{0.3}, {}}, {{0.3}, {0.6}}, {{0.2, 0.5, 0.7}, {0.1}}, {{0.2, 0.4}, {0.3, 0.8}}};
  for (const Polygons& mesh : {voronoi_square(120), quad_grid(12), brick_wall(8)})
    for (const auto& [left, right] : cases) {
      const SplitEdge split(mesh, left, right);
      expect_plane_distances(split.mesh);
      const auto surface = build(split.mesh, Discretization::automatic);
      EXPECT_TRUE(surface.details().twisted.empty());
      EXPECT_EQ(surface.details().collinear, std::vector<Index>{mesh.faces()});
      EXPECT_EQ(find_warning(surface, "collinear_faces").value().numbers,
                (std::vector<double>{1, static_cast<double>(mesh.faces())}));
      try {
        build(split.mesh, Discretization::refined).flat_triangles();
        ADD_FAILURE() << "flat triangles of a face without area";
      } catch (const InvalidGeometry& e) {
        EXPECT_EQ(e.fault(), "collinear_faces");
        EXPECT_NE(std::string(e.what()).find("face " + std::to_string(mesh.faces())), std::string::npos) << e.what();
      }
    }
}

}  // namespace
}  // namespace ahm::test
