// Triangles read off the stars of a graph, and normals on the side of the source.
#include <gtest/gtest.h>

#include <algorithm>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/error.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

LogMap map_with_frames(const SolvedMesh& mesh, Vertex source) {
  return mesh.solver.solve(Source::at_vertex(source), {.frames = true});
}

TEST(SourceSideNormals, OfASphereAreOutwardEverywhereOrNowhere) {
  const Mesh mesh = icosphere(8);
  const SolvedMesh sphere(mesh);
  const std::vector<Vec3> normals = source_side_normals(sphere.surface.graph(), map_with_frames(sphere, Vertex{5}));
  for (Index i = 0; i < mesh.vertices(); ++i)
    ASSERT_GT(dot(normals[i], sphere.surface.graph().frame(i)->origin), 0.9) << "vertex " << i;
}

TEST(SourceSideNormals, OfAMoebiusBandChangeSideOnlyFarFromTheSource) {
  const SolvedMesh band(moebius_mesh(80, 6));
  const CsrGraph& graph = band.surface.graph();
  const LogMap map = map_with_frames(band, Vertex{0});
  const std::vector<Vec3> normals = source_side_normals(graph, map);
  auto is_near = [](Index i) { return std::min(i / 7, 80 - i / 7) <= 20; };  // within a quarter of the way round
  int far_turns = 0;
  for (Index i = 0; i < graph.size(); ++i)
    for (Index j : graph.star(i).neighbors) {
      const bool same_side = dot(normals[i], normals[j]) > 0;
      if (is_near(i) && is_near(j))
        ASSERT_TRUE(same_side) << i << ", " << j;
      else
        far_turns += !same_side;
    }
  EXPECT_GT(far_turns, 0);  // half way round the sides meet: there is no way to choose one
}

TEST(SourceSideNormals, NeedFramesInSpace) {
  const CsrGraph graph(sphere_graph(60));
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{3}), {.frames = true});
  EXPECT_THROW(source_side_normals(graph, map), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
