// A mesh that was spoilt and repaired maps as it did before, on the rows that were given.
#include "ahm/surface/mesh_repair.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {
namespace {

struct Soup {
  std::vector<Vec3> points;
  std::vector<Offset> begin{0};
  std::vector<Index> corners;

  void add(const std::vector<Index>& face) {
    corners.insert(corners.end(), face.begin(), face.end());
    begin.push_back(static_cast<Offset>(corners.size()));
  }
  FaceList faces() const { return {begin, corners}; }
};

Soup soup_of(const Mesh& mesh) {
  Soup soup{mesh.positions, {0}, {}};
  for (const Triangle& t : mesh.faces) soup.add({t[0], t[1], t[2]});
  return soup;
}

/// Every triangle with corners of its own.
Soup torn(const Mesh& mesh) {
  Soup soup;
  for (const Triangle& t : mesh.faces) {
    const auto first = static_cast<Index>(soup.points.size());
    for (Index v : t) soup.points.push_back(mesh.positions[v]);
    soup.add({first, first + 1, first + 2});
  }
  return soup;
}

std::vector<Triangle> triangles(const RepairedMesh& mesh) {
  std::vector<Triangle> result;
  for (std::size_t f = 0; f < mesh.given_face.size(); ++f)
    result.push_back({mesh.faces()[f][0], mesh.faces()[f][1], mesh.faces()[f][2]});
  return result;
}

RepairedSurface surface_of(const Soup& soup, const RepairedMesh& mesh) {
  return {std::make_unique<trimesh::TriangleMeshSurface>(
              trimesh::TriangleMeshSurface::build(soup.points, triangles(mesh), {.non_manifold = NonManifold::split})),
          soup.points, mesh};
}

TEST(MeshRepair, LeavesASoundMeshAsItIs) {
  const Soup soup = soup_of(icosphere(2));
  const RepairedMesh mesh = repair_mesh(soup.points, soup.faces(), RepairOptions::all());
  EXPECT_EQ(mesh.counts, RepairCounts{});
  EXPECT_EQ(mesh.face_begin, soup.begin);
  EXPECT_EQ(mesh.face_vertices, soup.corners);
  for (std::size_t v = 0; v < soup.points.size(); ++v) EXPECT_EQ(mesh.joined[v], static_cast<Index>(v));
  for (std::size_t f = 0; f < mesh.given_face.size(); ++f) EXPECT_EQ(mesh.given_face[f], static_cast<Index>(f));
}

TEST(MeshRepair, DoesNothingThatIsNotAskedFor) {
  Soup soup = torn(icosphere(1));
  soup.add({0, 1, 2});
  soup.add({3, 3, 4});
  const RepairedMesh mesh = repair_mesh(soup.points, soup.faces(), {});
  EXPECT_EQ(mesh.counts, RepairCounts{});
  EXPECT_EQ(mesh.face_vertices, soup.corners);
}

TEST(MeshRepair, SewsATornMeshTogetherAndMapsEveryRowAsBefore) {
  const Mesh whole = icosphere(3);
  const Soup soup = torn(whole);
  const RepairedMesh mesh = repair_mesh(soup.points, soup.faces(), RepairOptions::all());
  EXPECT_EQ(mesh.counts.welded, static_cast<Index>(soup.points.size() - whole.positions.size()));
  const RepairedSurface surface = surface_of(soup, mesh);
  const auto before = trimesh::TriangleMeshSurface::build(whole.positions, whole.faces);
  const Vec3 axis{0.3, 0.2, 0.9};
  const LogMapSolver solver(surface.graph()), solver_before(before.graph());
  const RowLogMap map = surface.to_rows(solver.solve(surface.source(Row(0), axis).source));
  const RowLogMap map_before = before.to_rows(solver_before.solve(before.source(Row(whole.faces[0][0]), axis).source));
  std::size_t row = 0;
  for (const Triangle& t : whole.faces)
    for (Index v : t) {
      ASSERT_EQ(map.status[row], Status::ok);
      EXPECT_NEAR(map.u[row], map_before.u[v], 1e-9);
      EXPECT_NEAR(map.v[row], map_before.v[v], 1e-9);
      EXPECT_NEAR(map.distance[row], map_before.distance[v], 1e-9);
      ++row;
    }
  // Any of the rows at a place is a source there, and so is its face.
  const auto twin = static_cast<Index>(std::find(mesh.joined.begin() + 1, mesh.joined.end(), 0) - mesh.joined.begin());
  EXPECT_EQ(surface.vertex(Row(twin)), surface.vertex(Row(0)));
  const FacePoint inside{5, {0.2, 0.3, 0.5}};
  const Vec3 place = surface.position(inside);
  Vec3 expected{};
  for (std::size_t c = 0; c < 3; ++c) expected = expected + inside.barycentric[c] * soup.points[15 + c];
  EXPECT_LT(distance(place, expected), 1e-15);
  EXPECT_LT(distance(surface.source(inside).position, expected), 1e-12);
}

TEST(MeshRepair, ExactMapsAndEdgesOfRepairedSurfacesAreThoseOfTheWholeMesh) {
  const Mesh whole = icosphere(2);
  const Soup soup = torn(whole);
  const RepairedSurface surface = surface_of(soup, repair_mesh(soup.points, soup.faces(), RepairOptions::all()));
  const auto before = trimesh::TriangleMeshSurface::build(whole.positions, whole.faces);
  const RowLogMap map = surface.to_rows(ExactGeodesics(surface).log_map(FacePoint{7, {0.2, 0.3, 0.5}}));
  const RowLogMap map_before = before.to_rows(ExactGeodesics(before).log_map(FacePoint{7, {0.2, 0.3, 0.5}}));
  std::size_t row = 0;
  for (const Triangle& t : whole.faces)
    for (Index v : t) EXPECT_NEAR(map.distance[row++], map_before.distance[v], 1e-12);
  // The side from corner 0 to corner 1 of face 4, by rows of which one was joined.
  const EdgePoint on_edge{Row(12), Row(13), 0.25};
  const Vec3 expected = 0.75 * soup.points[12] + 0.25 * soup.points[13];
  EXPECT_LT(distance(surface.source(on_edge).position, expected), 1e-12);
}

TEST(MeshRepair, DropsWhatIsNoFaceAndWhatIsGivenTwice) {
  Soup soup = soup_of(icosphere(1));
  const std::size_t sound = soup.begin.size() - 1;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  soup.points.push_back({nan, 0, 0});
  const auto bad = static_cast<Index>(soup.points.size()) - 1;
  soup.add({0, 1, 1});                                            // nothing is left
  soup.add({0, 1});                                               // too few
  soup.add({0, 1, bad});                                          // not finite
  soup.add({soup.corners[4], soup.corners[3], soup.corners[5]});  // the second, turned over
  soup.add({soup.corners[0], soup.corners[0], soup.corners[1], soup.corners[2], soup.corners[0]});  // the first
  const RepairedMesh mesh = repair_mesh(soup.points, soup.faces(), RepairOptions::all());
  EXPECT_EQ(mesh.counts, (RepairCounts{.shortened = 1, .degenerate = 2, .not_finite = 1, .duplicates = 2}));
  EXPECT_EQ(mesh.given_face.size(), sound);
  EXPECT_EQ(mesh.remaining(static_cast<Index>(sound) - 1), static_cast<Index>(sound) - 1);
  EXPECT_EQ(mesh.remaining(static_cast<Index>(sound)), std::nullopt);
  EXPECT_EQ(mesh.remaining(-1), std::nullopt);
}

TEST(MeshRepair, KeepsPolygonsWithoutTheirRepeatedCorners) {
  Soup soup{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}}, {0}, {}};
  soup.add({0, 1, 1, 2, 3});
  soup.add({1, 4, 5, 2});
  const RepairedMesh mesh = repair_mesh(soup.points, soup.faces(), RepairOptions::all());
  EXPECT_EQ(mesh.counts, RepairCounts{.shortened = 1});
  const auto built = polymesh::PolygonMeshSurface::build(soup.points, mesh.face_begin, mesh.face_vertices);
  EXPECT_EQ(built.faces().size(), 2u);
}

TEST(MeshRepair, WeldsNoFartherThanItIsToldHoweverLongTheChain) {
  Soup soup;
  for (int i = 0; i < 40; ++i) soup.points.push_back({0.4 * i, 0, 0});
  soup.points.push_back({0, 5, 0});
  soup.add({0, 39, 40});
  const RepairedMesh mesh = repair_mesh(soup.points, soup.faces(), {.weld = 1.0});
  for (std::size_t v = 0; v < soup.points.size(); ++v) {
    const Vec3& to = soup.points[mesh.joined[v]];
    EXPECT_LE(distance(soup.points[v], to), 1.0);
    EXPECT_EQ(mesh.joined[mesh.joined[v]], mesh.joined[v]);
  }
  EXPECT_EQ(mesh.joined[2], 0);
  EXPECT_EQ(mesh.joined[3], 3);
}

TEST(MeshRepair, WeldsEqualPositionsAtAnyScaleAndReach) {
  const Mesh whole = icosphere(1);
  for (const double scale : {1e-300, 1.0, 1e300})
    for (const double reach : {0.0, 1e-305, 1e-20}) {
      Soup soup = torn(whole);
      for (Vec3& p : soup.points) p = scale * p;
      if (reach > 1e-10 * scale) continue;
      EXPECT_EQ(repair_mesh(soup.points, soup.faces(), {.weld = reach}).counts.welded,
                static_cast<Index>(soup.points.size() - whole.positions.size()))
          << scale << " " << reach;
    }
}

TEST(MeshRepair, WeldsWhatNoiseHasMovedApart) {
  const Mesh whole = icosphere(2);
  Soup soup = torn(whole);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1e-7, 1e-7);
  for (Vec3& p : soup.points)
    for (double& x : p) x += noise(random);
  const RepairedMesh mesh = repair_mesh(soup.points, soup.faces(), {.weld = 1e-6});
  EXPECT_EQ(mesh.counts.welded, static_cast<Index>(soup.points.size() - whole.positions.size()));
  EXPECT_EQ(mesh.given_face.size(), whole.faces.size());
  EXPECT_EQ(repair_mesh(soup.points, soup.faces(), {.weld = 0.0}).counts.welded, 0);
}

TEST(MeshRepair, TurnsClosedPartsOutwardsHoweverTheyWereTurned) {
  Soup soup = soup_of(icosphere(2));
  for (std::size_t f = 0; f + 1 < soup.begin.size(); ++f)
    if (f % 3 != 0) std::swap(soup.corners[3 * f + 1], soup.corners[3 * f + 2]);  // most look inwards
  for (Vec3& p : soup.points) p = p + Vec3{1e3, -1e3, 1e3};
  const RepairedMesh mesh = repair_mesh(soup.points, soup.faces(), {.orient = true});
  for (std::size_t f = 0; f < mesh.given_face.size(); ++f) {
    const auto face = mesh.faces()[f];
    const Vec3 &a = soup.points[face[0]], &b = soup.points[face[1]], &c = soup.points[face[2]];
    EXPECT_EQ(face[0], soup.corners[3 * f]);
    EXPECT_GT(dot(cross(b - a, c - a), a - Vec3{1e3, -1e3, 1e3}), 0);
  }
}

TEST(MeshRepair, WhateverComesInWhatRemainsIsSoundAndStaysSo) {
  std::mt19937 random(11);
  const auto below = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  int remaining = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Soup soup;
    const int n = 1 + below(12);
    for (int v = 0; v < n; ++v)  // many at the same place, some nowhere
      soup.points.push_back(below(20) == 0 ? Vec3{std::nan(""), 0, 0}
                                           : Vec3{1.0 * below(3), 1.0 * below(2), 1.0 * below(2)});
    for (int f = 1 + below(15); f > 0; --f) {
      std::vector<Index> face;
      for (int c = below(6); c > 0; --c) face.push_back(below(n));
      soup.add(face);
    }
    const RepairedMesh mesh = repair_mesh(soup.points, soup.faces(), RepairOptions::all());
    const auto& c = mesh.counts;
    ASSERT_EQ(mesh.given_face.size() + static_cast<std::size_t>(c.degenerate + c.not_finite + c.duplicates),
              soup.faces().size());
    if (mesh.given_face.empty()) continue;
    ++remaining;
    const MeshInspection found = inspect_mesh(n, mesh.faces());
    ASSERT_TRUE(found.outside.empty() && found.small.empty() && found.repeating.empty() && found.duplicates.empty());
    for (Index v : mesh.face_vertices) ASSERT_TRUE(is_finite(soup.points[v]) && mesh.joined[v] == v);
    RepairCounts again = repair_mesh(soup.points, mesh.faces(), RepairOptions::all()).counts;
    again.welded = 0;  // joined vertices are still where they were
    ASSERT_EQ(again, RepairCounts{}) << trial;
  }
  EXPECT_GT(remaining, 500);
}

TEST(MeshRepair, LeavesPartsThatCannotBeOriented) {
  const Soup soup = soup_of(moebius_mesh(20, 3));
  EXPECT_EQ(repair_mesh(soup.points, soup.faces(), {.orient = true}).counts.turned, 0);
}

TEST(MeshRepair, RefusesWhatItCannotUnderstand) {
  const Soup soup = soup_of(icosphere(1));
  EXPECT_THROW(repair_mesh(soup.points, soup.faces(), {.weld = -1.0}), InvalidArgument);
  EXPECT_THROW(repair_mesh(soup.points, soup.faces(), {.weld = std::nan("")}), InvalidArgument);
  Soup outside = soup;
  outside.add({0, 1, 99});
  EXPECT_THROW(repair_mesh(outside.points, outside.faces(), RepairOptions::all()), InvalidGeometry);
  EXPECT_THROW(RepairedSurface(std::make_unique<trimesh::TriangleMeshSurface>(
                                   trimesh::TriangleMeshSurface::build(soup.points, icosphere(1).faces)),
                               {}, repair_mesh(soup.points, soup.faces(), {})),
               InvalidArgument);
}

TEST(MeshRepair, TellsOfUnusedVerticesOnlyWhereNothingStandsForThem) {
  Soup soup = torn(icosphere(1));
  soup.points.push_back({9, 9, 9});
  const RepairedSurface surface = surface_of(soup, repair_mesh(soup.points, soup.faces(), RepairOptions::all()));
  for (const Warning& warning : surface.warnings())
    if (warning.id == "unreferenced") EXPECT_EQ(warning.numbers[0], 1);
  EXPECT_TRUE(std::ranges::any_of(surface.warnings(), [](const Warning& w) { return w.id == "unreferenced"; }));
  EXPECT_THROW(surface.vertex(Row(static_cast<Index>(soup.points.size()) - 1)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
