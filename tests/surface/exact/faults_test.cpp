#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"
#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::MeshPoint;
using exact::PolyhedralSurface;

/// Two triangles 0 1 2 and 2 1 3.
struct TwoFaces {
  std::vector<Index> tails{0, 1, 2, 2, 1, 3};
  std::vector<exact::Half> twins{-1, 3, -1, 1, -1, -1};
  std::vector<std::array<double, 3>> lengths{{1, 1, 1}, {1, 1, 1}};
  PolyhedralSurface build() const { return PolyhedralSurface::from_lengths({tails, twins}, lengths); }
};

void expect_refused(const TwoFaces& faces, const std::string& words) {
  try {
    faces.build();
    ADD_FAILURE() << "not refused: " << words;
  } catch (const InvalidGeometry& e) {
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
  }
}

TEST(PolyhedralSurface, NamesTheFaceThatIsDegenerate) {
  TwoFaces flat;
  flat.lengths[1] = {1, 0.5, 0.5};
  expect_refused(flat, "face 1 is degenerate");
  TwoFaces point;
  point.lengths[1] = {1, 0, 1};
  expect_refused(point, "face 1 has a side whose length");
  TwoFaces open;
  open.lengths[0] = {3, 1, 1};
  expect_refused(open, "face 0 breaks the triangle inequality");
  TwoFaces endless;
  endless.lengths[0] = {1, 1, std::numeric_limits<double>::infinity()};
  expect_refused(endless, "face 0 has a side");
}

TEST(PolyhedralSurface, RefusesGluingThatDoesNotFit) {
  TwoFaces one_way;
  one_way.twins[3] = -1;
  expect_refused(one_way, "not mutual");
  TwoFaces elsewhere;
  elsewhere.twins = {3, -1, -1, 0, -1, -1};
  expect_refused(elsewhere, "between other vertices");
  TwoFaces unequal;
  unequal.lengths[1] = {1.1, 1, 1};
  expect_refused(unequal, "faces 0 and 1");
  TwoFaces pinched;
  pinched.twins = {-1, -1, -1, -1, -1, -1};
  expect_refused(pinched, "several fans");
}

TEST(PolyhedralSurface, KeepsCapsThatAreNearlyFlat) {
  // A square with a vertex 1e-9 beside one of its diagonals.
  Mesh mesh;
  mesh.plane = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5 + 1e-9, 0.5 - 1e-9}};
  mesh.faces = {{0, 1, 4}, {1, 2, 4}, {2, 0, 4}, {0, 2, 3}};
  for (const Vec2& p : mesh.plane) mesh.positions.push_back({p[0], p[1], 0});
  const Polyhedron solid(mesh);
  for (Index a = 0; a < 5; ++a) {
    const exact::ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(a)));
    for (Index b = 0; b < 5; ++b)
      EXPECT_NEAR(map.distance(Vertex(b)), distance(solid.mesh.position(Vertex(a)), solid.mesh.position(Vertex(b))),
                  1e-15);
  }
}

/// Sides from 1e-320 to 1e300: windows go in circles about corners far smaller than the rounding of their distances.
TEST(ExactMap, NamesMeshesOnWhichWindowsDoNotEnd) {
  Mesh mesh = flat_square(5, 0.0);
  const Vec3 scattered[] = {
      {-8.7e-255, 1.2e-90, -6.5e-280}, {-1.6e97, 7.9e-296, -3.3e-99},    {-1.1e129, 2.0e86, 2.0e288},
      {-3.2e98, 1.5e-123, -7.5e-82},   {-4.2e186, -4.1e-258, 3.6e30},    {-1.3e36, -2.9e-123, 2.1e-29},
      {-3.2e-290, -1.1e279, -1.1e300}, {-6.6e-235, -3.1e290, -1.5e-103}, {4.2e62, 3.5e151, -1.3e-286},
      {-2.0e-76, -1.8e-281, -8.0e276}, {3.5e117, -6.5e272, 4.8e-268},    {5.2e132, -6.2e-217, -1.6e-274},
      {-1.5e59, -7.0e210, -4.2e-20},   {3.2e-308, 1.7e-289, 1.3e-284},   {2.1e-289, 5.8e-275, 0}};
  std::copy(std::begin(scattered), std::end(scattered), mesh.positions.begin() + 5);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const ExactGeodesics exact(surface);
  int refused = 0;
  for (Index face = 0; face < static_cast<Index>(mesh.faces.size()); ++face) try {
      (void)exact.log_map(FacePoint{face, {0.25, 0.25, 0.5}});
    } catch (const InvalidGeometry& e) {
      EXPECT_EQ(e.fault(), "windows_without_end") << e.what();
      ++refused;
    }
  EXPECT_GT(refused, 0);
  // Lines end, or say that they do not.
  int lost = 0;
  for (Index face = 0; face < exact.triangles().surface.face_count(); face += 4) try {
      (void)exact::trace(exact.triangles().surface, {face, {0.25, 0.25, 0.5}}, 0.3 * face, 1);
    } catch (const InvalidArgument& e) {
      EXPECT_EQ(e.fault(), "line_too_long") << e.what();
      ++lost;
    }
  EXPECT_GT(lost, 0);
}

/// Where angles are those of rounding, surfaces or maps are refused, or every vertex has a distance; within a tolerance it
/// always has one.
TEST(ExactMap, IsRefusedWhereNeedlesLoseWindows) {
  int refused = 0, maps = 0;
  for (unsigned seed = 20; seed < 28; ++seed) {
    std::optional<FlatTriangles> flat;
    try {
      flat = flat_triangles(nested_needles(seed));
    } catch (const InvalidGeometry&) {
      continue;  // a face without area
    }
    const PolyhedralSurface& surface = flat->surface;
    for (Index source = 0; source < surface.vertex_count(); source += 5) {
      const MeshPoint from = surface.vertex_point(Vertex(source));
      try {
        const exact::ExactMap map = exact::exact_map(surface, from);
        ++maps;
        for (Status status : map.status()) EXPECT_EQ(status, Status::ok);
      } catch (const InvalidGeometry& e) {
        EXPECT_EQ(e.fault(), "windows_lost") << e.what();
        ++refused;
      }
      if (source % 50 != 0) continue;
      exact::ExactOptions options;
      options.tolerance = 1e-6;
      const exact::ExactMap within = exact::exact_map(surface, from, options);
      for (Status status : within.status()) EXPECT_EQ(status, Status::ok);
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(maps, 50 * refused);
}

TEST(ExactMap, RefusesArgumentsOutOfRange) {
  const PolyhedralSurface surface = TwoFaces{}.build();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<MeshPoint> bad{
      {2, {1, 0, 0}}, {-1, {1, 0, 0}}, {0, {0.5, 0.6, 0}}, {0, {1.5, -0.5, 0}}, {0, {nan, 1, 0}}};
  for (const MeshPoint& point : bad) {
    EXPECT_THROW(exact::exact_map(surface, point), InvalidArgument);
    EXPECT_THROW(exact::geodesic_path(surface, {0, {1, 0, 0}}, point), InvalidArgument);
    EXPECT_THROW(exact::trace(surface, point, 0, 1), InvalidArgument);
  }
  EXPECT_THROW(exact::exact_map(surface, std::span<const MeshPoint>()), InvalidArgument);
  exact::ExactOptions options;
  options.radius = 0;
  EXPECT_THROW(exact::exact_map(surface, MeshPoint{}, options), InvalidArgument);
  EXPECT_THROW(exact::trace(surface, {0, {0.2, 0.3, 0.5}}, nan, 1), InvalidArgument);
  EXPECT_THROW(exact::trace(surface, {0, {0.2, 0.3, 0.5}}, 0, -1), InvalidArgument);
  EXPECT_THROW(exact::trace(surface, {0, {1, 0, 0}}, 3, 1), InvalidArgument);
  const exact::ExactMap map = exact::exact_map(surface, MeshPoint{});
  EXPECT_THROW(exact::path_to_vertex(surface, map, Vertex(4)), InvalidArgument);
  EXPECT_THROW(exact::path_to_target(surface, map, 0), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
