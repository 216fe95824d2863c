// Maps at the corners of faces: cut open where they tear, and nowhere else.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

constexpr double pi = std::numbers::pi;

using polymesh::Discretization;
using polymesh::PolygonMeshSurface;
using trimesh::TriangleMeshSurface;

double length(const Vec2& a, const Vec2& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }
double length(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// Quads in rows, given by where their corners lie; `closed` joins the last of a row to its first.
Polygons quads(Index rows, Index columns, bool closed, const std::function<Vec3(Index, Index)>& at) {
  Polygons mesh;
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < columns; ++j) mesh.positions.push_back(at(i, j));
  for (Index i = 0; i + 1 < rows; ++i)
    for (Index j = 0; j + (closed ? 0 : 1) < columns; ++j) {
      const Index a = i * columns + j, b = i * columns + (j + 1) % columns;
      mesh.add({a, b, b + columns, a + columns});
    }
  return mesh;
}

/// The quads of a cylinder of radius 1.
Polygons cylinder(Index rows, Index around, double along) {
  const double step = 2 * pi / around;
  return quads(rows, around, true, [=](Index i, Index j) {
    return Vec3{along * i * step, std::cos(j * step), std::sin(j * step)};
  });
}

/// Each quad cut in two.
Mesh triangles(const Polygons& quads) {
  Mesh mesh;
  mesh.positions = quads.positions;
  for (Index f = 0; f < quads.faces(); ++f) {
    const std::vector<Index> q = quads.face(f);
    mesh.faces.push_back({q[0], q[1], q[2]});
    mesh.faces.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

/// Calls visit(surface) with every kind of surface made of these quads.
void for_each_surface(const Polygons& quads, const std::function<void(const Surface&)>& visit) {
  const Mesh cut = triangles(quads);
  visit(TriangleMeshSurface::build(cut.positions, cut.faces));
  for (const Discretization discretization : {Discretization::polygons, Discretization::refined})
    visit(PolygonMeshSurface::build(quads.positions, quads.begin, quads.corners, {.discretization = discretization}));
}

struct Corners {
  Index cracked = 0;   ///< corners that do not have the values of their row
  double stretch = 1;  ///< of the sides of the faces, or its inverse

  Corners(const Surface& surface, const LogMap& map) {
    const RowLogMap rows = surface.to_rows(map);
    const std::vector<Vec2> corners = surface.to_corners(map);
    const FaceList faces = surface.faces();
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t c = 0; c < faces[f].size(); ++c) {
        const auto begin = static_cast<std::size_t>(faces.begin[f]), next = (c + 1) % faces[f].size();
        const Index a = faces[f][c], b = faces[f][next];
        const double flat = length(corners[begin + c], corners[begin + next]);
        const double ratio = flat / length(surface.positions()[a], surface.positions()[b]);
        EXPECT_FALSE(std::isnan(ratio)) << f;
        stretch = std::max({stretch, ratio, 1 / ratio});
        cracked += !(length(corners[begin + c], Vec2{rows.u[a], rows.v[a]}) < 1e-12);
      }
  }
};

TEST(Corners, PolygonsAreCutOpenBetweenThem) {
  // The cut locus of a point of a cylinder is the line opposite to it.
  const Index rows = 21, around = 60;
  for_each_surface(cylinder(rows, around, 1), [&](const Surface& surface) {
    const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row((rows / 2) * around)).source);
    const Corners corners(surface, map);
    EXPECT_LT(corners.stretch, 1.6);
    EXPECT_GT(corners.cracked, 0);
    // Within four faces of that line, on the one side or the other.
    const RowLogMap to_rows = surface.to_rows(map);
    const std::vector<Vec2> phi = surface.to_corners(map);
    for (std::size_t k = 0; k < phi.size(); ++k)
      if (const Index row = surface.faces().vertices[k]; std::abs(row % around - around / 2) > 4) {
        EXPECT_EQ(phi[k][0], to_rows.u[row]) << row;
        EXPECT_EQ(phi[k][1], to_rows.v[row]) << row;
      }
  });
}

TEST(Corners, FacesLongerThanWideAreCutAtTheSamePlaces) {
  const Index rows = 11, around = 60;
  for_each_surface(cylinder(rows, around, 8), [&](const Surface& surface) {
    const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row((rows / 2) * around)).source);
    const std::vector<Vec2> phi = surface.to_corners(map);
    Index wrong = 0;
    for (std::size_t f = 0; f < surface.faces().size(); ++f) {
      // On one sheet all corners of a face lie at once on one side of the line opposite to the source.
      const auto begin = static_cast<std::size_t>(surface.faces().begin[f]);
      for (std::size_t c = 1; c < surface.faces()[f].size(); ++c)
        wrong +=
            std::abs(length(phi[begin], phi[begin + c]) - length(surface.positions()[surface.faces()[f][0]],
                                                                 surface.positions()[surface.faces()[f][c]])) > 0.3;
    }
    EXPECT_EQ(wrong, 0);
  });
}

TEST(Corners, SmoothMapsAreNotCutHoweverTheyStretch) {
  // A sphere with a hole around the antipode of the source, where the map stretches circles by r / sin r: 4.4.
  const Index rows = 60, around = 96;
  const double from = 0.02, to = 2.55;
  const Polygons sphere = quads(rows, around, true, [=](Index i, Index j) {
    const double r = from + (to - from) * i / (rows - 1), a = 2 * pi * j / around;
    return Vec3{std::sin(r) * std::cos(a), std::sin(r) * std::sin(a), std::cos(r)};
  });
  for_each_surface(sphere, [&](const Surface& surface) {
    const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(0)).source);
    const Corners corners(surface, map);
    EXPECT_EQ(corners.cracked, 0);
    EXPECT_GT(corners.stretch, 2);
  });
}

TEST(Corners, ThinFacesAreNotCutOut) {
  // Faces of a curved patch forty times as long as wide, in random turns of long and short.
  const Polygons patch = quads(41, 81, false, [](Index i, Index j) {
    const double x = 0.05 * i, y = 0.05 * (j / 2) + (j % 2 == 0 ? 0 : 0.00125 * (1 + (i * 7 + j * 3) % 5));
    return Vec3{x, y, 0.4 * std::sin(2 * x) * std::cos(2 * y)};
  });
  for_each_surface(patch, [&](const Surface& surface) {
    const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(20 * 81 + 40)).source);
    EXPECT_EQ(Corners(surface, map).cracked, 0);
  });
}

// Where every face is strained, as on a cube, those at the source are kept, and the others laid out beside them.
TEST(Corners, CoarseClosedMeshesAreLaidOutWhole) {
  Polygons cube;
  cube.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (const std::vector<Index>& face :
       {std::vector<Index>{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}})
    cube.add(face);
  for_each_surface(cube, [&](const Surface& surface) {
    const LogMapSolver solver(surface.graph());
    for (Index row = 0; row < 8; ++row)
      EXPECT_LT(Corners(surface, solver.solve(surface.source(Row(row)).source)).stretch, 10) << row;  // and finite
  });
}

TEST(Corners, GapsBehindATipAreCutOpen) {
  // Of a cone whose tip lacks a fifth of the full angle: behind it, the two sheets lie a wedge apart, turned over nowhere.
  const Index rows = 30, around = 60;
  const double sine = 0.8, cosine = 0.6;
  const Polygons cone = quads(rows, around, true, [=](Index i, Index j) {
    const double r = 0.2 + 0.1 * i, a = 2 * pi * j / around;
    return Vec3{r * sine * std::cos(a), r * sine * std::sin(a), -r * cosine};
  });
  Mesh mesh = triangles(cone);
  mesh.positions.push_back({0, 0, 0});
  for (Index j = 0; j < around; ++j) mesh.faces.push_back({(j + 1) % around, j, rows * around});
  const TriangleMeshSurface surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const LogMap map = ExactGeodesics(surface).log_map(Row(10 * around + 7));
  const Corners corners(surface, map);
  EXPECT_LT(corners.stretch, 1.6);
  EXPECT_GT(corners.cracked, 0);
  EXPECT_LT(corners.cracked, 6 * rows);
}

}  // namespace
}  // namespace ahm::test
