// What is told about any mesh, also about one that cannot be built.
#include <gtest/gtest.h>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/surface/mesh_topology.hpp"

namespace ahm::test {
namespace {

MeshInspection inspect(Index vertices, const std::vector<std::vector<Index>>& faces) {
  std::vector<Offset> begin{0};
  std::vector<Index> corners;
  for (const auto& face : faces) {
    corners.insert(corners.end(), face.begin(), face.end());
    begin.push_back(static_cast<Offset>(corners.size()));
  }
  return inspect_mesh(vertices, {begin, corners});
}

MeshInspection inspect(const Mesh& mesh) {
  std::vector<std::vector<Index>> faces;
  for (const Triangle& t : mesh.faces) faces.emplace_back(t.begin(), t.end());
  return inspect(mesh.vertices(), faces);
}

TEST(InspectMesh, CountsTheHandlesAndHolesOfSoundMeshes) {
  const TopologyReport sphere = inspect(icosphere(3)).topology, ring = inspect(torus(500)).topology,
                       sheet = inspect(holed_square(16)).topology, band = inspect(moebius_mesh(20, 3)).topology;
  EXPECT_EQ(sphere.euler_characteristic, 2);
  EXPECT_EQ(sphere.genus(), 0);
  EXPECT_EQ(sphere.boundary_loops, 0);
  EXPECT_EQ(ring.euler_characteristic, 0);
  EXPECT_EQ(ring.genus(), 1);
  EXPECT_EQ(sheet.boundary_loops, 3);
  EXPECT_EQ(sheet.genus(), 0);
  EXPECT_FALSE(band.orientable);
  EXPECT_EQ(band.euler_characteristic, 0);
  EXPECT_EQ(band.genus(), std::nullopt);
}

TEST(InspectMesh, CountsWhatKeepsAMeshFromBeingAManifold) {
  const MeshInspection pages = inspect(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_EQ(pages.topology.non_manifold_edges, 1);
  EXPECT_EQ(pages.topology.non_manifold_vertices, 2);
  EXPECT_EQ(pages.topology.added_vertices, 4);  // three copies instead of one, at both ends
  EXPECT_EQ(pages.topology.components, 3);
  const MeshInspection bow_tie = inspect(5, {{0, 1, 2}, {0, 3, 4}});
  EXPECT_EQ(bow_tie.topology.non_manifold_edges, 0);
  EXPECT_EQ(bow_tie.topology.non_manifold_vertices, 1);
  EXPECT_EQ(bow_tie.topology.added_vertices, 1);
  EXPECT_EQ(bow_tie.topology.boundary_loops, 2);
}

TEST(InspectMesh, NamesFacesThatCannotBeUsedAndLooksAtTheOthers) {
  const MeshInspection found =
      inspect(5, {{0, 1, 2}, {0, 1, 9}, {2, 1, 3}, {3, 3, 1}, {1, 2, 0}, {0, 1}, {2, 1, 0}, {-1, 0, 1}});
  EXPECT_EQ(found.outside, (std::vector<Index>{1, 7}));
  EXPECT_EQ(found.repeating, std::vector<Index>{3});
  EXPECT_EQ(found.small, std::vector<Index>{5});
  EXPECT_EQ(found.duplicates, (std::vector<Index>{4, 6}));
  EXPECT_EQ(found.topology.faces, 2);
  EXPECT_EQ(found.topology.components, 1);
  EXPECT_EQ(found.topology.unreferenced, 1);
  EXPECT_EQ(found.topology.non_manifold_edges, 0);
}

TEST(InspectMesh, FindsNothingWhereThereIsNothing) {
  EXPECT_EQ(inspect(3, {}).topology.components, 0);
  EXPECT_EQ(inspect(0, {}).topology.faces, 0);
  EXPECT_EQ(inspect(2, {{0, 1, 2}}).topology.faces, 0);
}

}  // namespace
}  // namespace ahm::test
