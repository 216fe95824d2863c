// Maps at the corners of faces: cut open at the cut locus, and nowhere else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/util/vec.hpp"
#include "surfaces.hpp"

namespace ahm::test {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

/// A cylinder of radius 1 around the x axis, cut into quads of length `step`.
Polygons cylinder(Index rows, Index around, double step) {
  return quads(rows, around, Columns::closed, [=](Index i, Index j) {
    return Vec3{step * i, std::cos(two_pi * j / around), std::sin(two_pi * j / around)};
  });
}

LogMap map_from(const Surface& surface, Index row) {
  return LogMapSolver(surface.graph()).solve(surface.source(Row(row)).source);
}

struct Corners {
  Index cut = 0;       ///< corners whose values differ from those of their row
  double stretch = 1;  ///< largest ratio of the length of a side in the map and in space, or its inverse

  Corners(const Surface& surface, const LogMap& map) {
    const RowLogMap rows = surface.to_rows(map);
    const std::vector<Vec2> corners = surface.to_corners(map);
    const FaceList faces = surface.faces();
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t c = 0; c < faces[f].size(); ++c) {
        const auto begin = static_cast<std::size_t>(faces.begin[f]), next = (c + 1) % faces[f].size();
        const Index a = faces[f][c], b = faces[f][next];
        const double ratio =
            norm(corners[begin + c] - corners[begin + next]) / distance(surface.positions()[a], surface.positions()[b]);
        EXPECT_FALSE(std::isnan(ratio)) << f;
        stretch = std::max({stretch, ratio, 1 / ratio});
        cut += !(norm(corners[begin + c] - Vec2{rows.u[a], rows.v[a]}) < 1e-12);
      }
  }
};

// The cut locus of a point of a cylinder is the opposite line.
TEST(Corners, AreCutAtTheCutLocus) {
  const Index rows = 21, around = 60;
  for_each_surface(cylinder(rows, around, two_pi / around), [&](const Surface& surface) {
    const LogMap map = map_from(surface, rows / 2 * around);
    const Corners corners(surface, map);
    EXPECT_LT(corners.stretch, 1.6);
    EXPECT_GT(corners.cut, 0);
    const RowLogMap by_row = surface.to_rows(map);
    const std::vector<Vec2> phi = surface.to_corners(map);
    for (std::size_t k = 0; k < phi.size(); ++k)  // only within four faces of that line
      if (const Index row = surface.faces().vertices[k]; std::abs(row % around - around / 2) > 4)
        EXPECT_EQ(phi[k], (Vec2{by_row.u[row], by_row.v[row]})) << row;
  });
}

// All corners of a face lie on one side of the line opposite to the source, so its sides have the lengths of the plane.
TEST(Corners, OfLongFacesLieOnOneSideOfTheCutLocus) {
  const Index rows = 11, around = 60;
  for_each_surface(cylinder(rows, around, 8 * two_pi / around), [&](const Surface& surface) {
    const std::vector<Vec2> phi = surface.to_corners(map_from(surface, rows / 2 * around));
    const FaceList faces = surface.faces();
    Index wrong = 0;
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t c = 1; c < faces[f].size(); ++c) {
        const auto begin = static_cast<std::size_t>(faces.begin[f]);
        const double length = distance(surface.positions()[faces[f][0]], surface.positions()[faces[f][c]]);
        wrong += std::abs(norm(phi[begin] - phi[begin + c]) - length) > 0.3;
      }
    EXPECT_EQ(wrong, 0);
  });
}

// A sphere with a hole around the antipode of the source, where the map stretches circles by r / sin r: 4.4.
TEST(Corners, AreNotCutWhereTheMapIsSmooth) {
  const Index rows = 60, around = 96;
  const double from = 0.02, to = 2.55;
  const Polygons sphere = quads(rows, around, Columns::closed, [=](Index i, Index j) {
    const double r = from + (to - from) * i / (rows - 1), a = two_pi * j / around;
    return Vec3{std::sin(r) * std::cos(a), std::sin(r) * std::sin(a), std::cos(r)};
  });
  for_each_surface(sphere, [&](const Surface& surface) {
    const Corners corners(surface, map_from(surface, 0));
    EXPECT_EQ(corners.cut, 0);
    EXPECT_GT(corners.stretch, 2);
  });
}

// A curved patch. Wide columns of faces alternate with narrow ones, of faces up to forty times as long as wide.
TEST(Corners, OfThinFacesAreNotCut) {
  const Polygons patch = quads(41, 81, Columns::open, [](Index i, Index j) {
    const double x = 0.05 * i, y = 0.05 * (j / 2) + (j % 2 == 0 ? 0 : 0.00125 * (1 + (i * 7 + j * 3) % 5));
    return Vec3{x, y, 0.4 * std::sin(2 * x) * std::cos(2 * y)};
  });
  for_each_surface(
      patch, [&](const Surface& surface) { EXPECT_EQ(Corners(surface, map_from(surface, 20 * 81 + 40)).cut, 0); });
}

// Every face of a cube is distorted. The faces at the source are kept, and the others are laid out next to them.
TEST(Corners, OfACubeAreFinite) {
  Polygons cube;
  cube.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (const std::vector<Index>& face :
       {std::vector<Index>{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}})
    cube.add(face);
  for_each_surface(cube, [&](const Surface& surface) {
    for (Index row = 0; row < 8; ++row) EXPECT_LT(Corners(surface, map_from(surface, row)).stretch, 10) << row;
  });
}

// The angle of the tip of this cone is 0.8 of the full angle. Behind it there is a wedge between the two sheets of the map.
TEST(Corners, AreCutBehindATip) {
  const Index rows = 30, around = 60;
  Mesh mesh = triangles(quads(rows, around, Columns::closed, [=](Index i, Index j) {
    const double r = 0.2 + 0.1 * i, a = two_pi * j / around;
    return Vec3{0.8 * r * std::cos(a), 0.8 * r * std::sin(a), -0.6 * r};
  }));
  mesh.positions.push_back({0, 0, 0});
  for (Index j = 0; j < around; ++j) mesh.faces.push_back({(j + 1) % around, j, rows * around});
  const auto surface = surface_of(mesh);
  const Corners corners(surface, ExactGeodesics(surface).log_map(Row(10 * around + 7)));
  EXPECT_LT(corners.stretch, 1.6);
  EXPECT_GT(corners.cut, 0);
  EXPECT_LT(corners.cut, 6 * rows);
}

}  // namespace
}  // namespace ahm::test
