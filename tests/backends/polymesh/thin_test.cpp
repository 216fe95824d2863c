// Corners that coincide and polygons without area: the map does not change, and what they are is said.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "polygon_graphs.hpp"

namespace ahm::test {
namespace {

using polymesh::Discretization;
using polymesh::PolygonMeshSurface;

PolygonMeshSurface surface_of(const Polygons& mesh, Discretization discretization) {
  return PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners, {.discretization = discretization});
}

/// Puts vertices on one or both sides of an edge of two faces, between its ends. With vertices of one side that the other
/// does not have, a face without area closes the gap.
/// @param left, right  where they lie on the edge, ascending in [0, 1]; the same ones, or not
Polygons with_vertices_on_edge(const Polygons& mesh, Index a, Index b, const std::vector<double>& left,
                               const std::vector<double>& right) {
  Polygons result{mesh.positions, {0}, {}, mesh.plane};
  auto make = [&](const std::vector<double>& places) {
    std::vector<Index> made;
    for (double t : places) {
      made.push_back(result.vertices());
      Vec3 p;
      for (int k = 0; k < 3; ++k) p[k] = mesh.positions[a][k] + t * (mesh.positions[b][k] - mesh.positions[a][k]);
      const Vec2 &q = mesh.plane[a], &r = mesh.plane[b];
      result.positions.push_back(p);
      result.plane.push_back({q[0] + t * (r[0] - q[0]), q[1] + t * (r[1] - q[1])});
    }
    return made;
  };
  const std::vector<Index> on_left = make(left), on_right = left == right ? on_left : make(right);
  for (Index f = 0; f < mesh.faces(); ++f) {
    std::vector<Index> face;
    const std::vector<Index> corners = mesh.face(f);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Index next = corners[(c + 1) % corners.size()];
      face.push_back(corners[c]);
      if (corners[c] == a && next == b) face.insert(face.end(), on_left.begin(), on_left.end());
      if (corners[c] == b && next == a) face.insert(face.end(), on_right.rbegin(), on_right.rend());
    }
    result.add(face);
  }
  if (left == right) return result;
  std::vector<Index> thin{b};
  thin.insert(thin.end(), on_left.rbegin(), on_left.rend());
  thin.push_back(a);
  thin.insert(thin.end(), on_right.begin(), on_right.end());
  result.add(thin);
  return result;
}

/// An edge of two faces somewhere in the mesh.
std::pair<Index, Index> inner_edge(const Polygons& mesh, Index f) {
  const std::vector<Index> corners = mesh.face(f);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Index a = corners[c], b = corners[(c + 1) % corners.size()];
    for (Index g = 0; g < mesh.faces(); ++g) {
      const std::vector<Index> other = mesh.face(g);
      for (std::size_t k = 0; k < other.size(); ++k)
        if (other[k] == b && other[(k + 1) % other.size()] == a) return {a, b};
    }
  }
  return {-1, -1};
}

void expect_identity(const Polygons& mesh, const std::string& name) {
  for (Discretization how : {Discretization::refined, Discretization::polygons}) {
    const auto surface = surface_of(mesh, how);
    EXPECT_NO_THROW(validate(surface.graph())) << name;
    const LogMapSolver solver(surface.graph());
    for (Index source : {Index{0}, mesh.vertices() / 2, mesh.vertices() - 1})
      for (Variant variant : all_variants) {
        const RowLogMap map = surface.to_rows(solver.solve(surface.source(Row(source)).source, {.variant = variant}));
        for (Index i = 0; i < mesh.vertices(); ++i) {
          const Vec2 &p = mesh.plane[i], &q = mesh.plane[source];
          ASSERT_NEAR(std::hypot(map.u[i], map.v[i]), std::hypot(p[0] - q[0], p[1] - q[1]), 1e-9 * mesh.diameter())
              << name << (how == Discretization::refined ? ", refined" : "") << ", from " << source << " to " << i;
        }
      }
  }
}

TEST(CoincidentCorners, LeaveThePlaneExact) {
  for (const Polygons& mesh : {voronoi_square(120), quad_grid(12), brick_wall(8), l_shapes(4)}) {
    const auto [a, b] = inner_edge(mesh, mesh.faces() / 2);
    for (const std::vector<double>& places :
         {std::vector{0.0}, std::vector{0.0, 0.0}, std::vector{0.4, 0.4}, std::vector{1e-12}, std::vector{1e-7, 1.0}}) {
      const Polygons other = with_vertices_on_edge(mesh, a, b, places, places);
      expect_identity(other, "places on an edge");
      const auto refined = surface_of(other, Discretization::refined);
      EXPECT_EQ(refined.details().mollification, 0);
      EXPECT_EQ(refined.rows().row_count(), other.vertices());
      const RowLogMap map = refined.to_rows(LogMapSolver(refined.graph()).solve(refined.source(Row(a)).source));
      EXPECT_NEAR(map.distance[mesh.vertices()], places[0] * map.distance[b], 1e-9 * mesh.diameter());
    }
  }
}

TEST(CollinearPolygons, LeaveThePlaneExactAndAreNamed) {
  for (const Polygons& mesh : {voronoi_square(120), quad_grid(12), brick_wall(8)}) {
    const auto [a, b] = inner_edge(mesh, mesh.faces() / 2);
    const std::pair<std::vector<double>, std::vector<double>> cases[] = {
        {{0.3}, {}}, {{0.3}, {0.6}}, {{0.2, 0.5, 0.7}, {0.1}}, {{0.2, 0.4}, {0.3, 0.8}}};
    for (const auto& [left, right] : cases) {
      const Polygons other = with_vertices_on_edge(mesh, a, b, left, right);
      expect_identity(other, "collinear polygon");
      const auto surface = surface_of(other, Discretization::automatic);
      EXPECT_TRUE(surface.details().twisted.empty());
      EXPECT_EQ(surface.details().collinear, std::vector<Index>{other.faces() - 1});
      const auto warnings = surface.warnings();
      const auto warning = std::ranges::find(warnings, "collinear_faces", &Warning::id);
      ASSERT_NE(warning, warnings.end());
      EXPECT_EQ(warning->numbers, (std::vector<double>{1, static_cast<double>(other.faces() - 1)}));
      try {
        surface_of(other, Discretization::refined).flat_triangles();
        ADD_FAILURE() << "flat triangles of a face without area";
      } catch (const InvalidGeometry& e) {
        EXPECT_EQ(e.fault(), "collinear_faces");
        EXPECT_NE(std::string(e.what()).find("face " + std::to_string(other.faces() - 1)), std::string::npos)
            << e.what();
      }
    }
  }
}

}  // namespace
}  // namespace ahm::test
