// Sources and samples anywhere on the mesh, the axes of sources, and textures.
#include "ahm/error.hpp"
#include "ahm/surface/directions.hpp"
#include "meshes.hpp"

namespace ahm::test {
namespace {

TEST(MeshSource, OnAnEdgeIsTheSamePointInBothItsFaces) {
  const Mesh mesh = icosphere(12);
  const SolvedMesh solved(mesh);
  const auto& [a, b, c] = mesh.faces[100];
  const RowLogMap edge = solved.map(EdgePoint{Row(a), Row(b), 0.7});
  EXPECT_LT(largest_difference(edge, solved.map(FacePoint{100, {0.3, 0.7, 0}})), 1e-11);
  int others = 0;
  for (Index f = 0; f < static_cast<Index>(mesh.faces.size()); ++f)
    for (int s = 0; s < 3; ++s)
      if (mesh.faces[f][s] == b && mesh.faces[f][(s + 1) % 3] == a) {
        FacePoint point{f, {0, 0, 0}};
        point.barycentric[s] = 0.7;
        point.barycentric[(s + 1) % 3] = 0.3;
        EXPECT_LT(largest_difference(edge, solved.map(point, mesh.positions[b] - mesh.positions[a])), 1e-11);
        ++others;
      }
  EXPECT_EQ(others, 1);
}

TEST(MeshSource, AtACornerOfAFaceIsNearlyThatAtTheVertex) {
  const Mesh mesh = icosphere(12);
  const SolvedMesh solved(mesh);
  const Vec3 up{0.2, 0.3, 1};
  const RowLogMap vertex = solved.map(Row(mesh.faces[50][1]), up), corner = solved.map(FacePoint{50, {0, 1, 0}}, up);
  expect_near(corner.distance, vertex.distance, 1e-11);
  EXPECT_LT(largest_difference(vertex, corner), 0.1);  // frames of the face and of the vertex differ by curvature
}

TEST(MeshSource, FramesAreRightHandedAndTangent) {
  const auto surface = build(icosphere(6));
  for (Index v = 0; v < surface.graph().size(); ++v) {
    const Frame f = *surface.graph().frame(v);
    EXPECT_NEAR(dot(f.x, f.y), 0, 1e-14);
    EXPECT_NEAR(norm(f.x), 1, 1e-14);
    EXPECT_GT(dot(f.normal, f.origin), 0.99);
    EXPECT_LT(norm(cross(f.x, f.y) - f.normal), 1e-14);
    EXPECT_LT(norm(direction_in_frame(surface.graph(), Vertex(v), f.y) - Vec2{0, 1}), 1e-14);
  }
}

TEST(MeshSource, OutsideTheMeshIsRefused) {
  const Mesh mesh = icosphere(3);
  const auto surface = build(mesh);
  const Index n = mesh.vertices(), faces = static_cast<Index>(mesh.faces.size());
  const SurfacePoint points[] = {Row(-1),
                                 Row(n),
                                 FacePoint{faces, {1, 0, 0}},
                                 FacePoint{-1, {1, 0, 0}},
                                 FacePoint{0, {0.5, 0.5, 0.5}},
                                 FacePoint{0, {1.5, -0.5, 0}},
                                 FacePoint{0, {NAN, 0.5, 0.5}},
                                 EdgePoint{Row(mesh.faces[0][0]), Row(mesh.faces[0][1]), 1.5},
                                 EdgePoint{Row(0), Row(0), 0.5},
                                 EdgePoint{Row(0), Row(n), 0.5}};
  for (const SurfacePoint& point : points) EXPECT_THROW(surface.source(point), InvalidArgument);
  const Vec3 along_normal = mesh.positions[0];
  for (const Vec3& axis : {along_normal, Vec3{0, 0, 0}, Vec3{NAN, 0, 0}})
    EXPECT_THROW(surface.source(Row(0), axis), InvalidArgument);
}

TEST(MeshSampling, IsExactOnThePlane) {
  std::mt19937_64 random(1);
  for (const Mesh& mesh : {sliver_square(600), holed_square(20), maze(5)}) {
    const SolvedMesh solved(mesh);
    const FacePoint source{5, {0.25, 0.25, 0.5}};
    const LogMap map = solved.solver.solve(solved.surface.source(source).source);
    const Vec2 axis = direction(mesh, mesh.faces[5][0], mesh.faces[5][1]);
    const auto exact = [&](const Vec2& p) {
      const Vec2 offset = p - plane_point(mesh, source);
      return Vec2{ahm::dot(axis, offset), ahm::cross(axis, offset)};
    };
    for (int trial = 0; trial < 500; ++trial) {
      const FacePoint point = random_point(mesh, random);
      const Sample sample = solved.surface.at(map, point);
      ASSERT_EQ(sample.status, Status::ok);
      ASSERT_LT(length(Vec2{sample.u, sample.v} - exact(plane_point(mesh, point))), 2e-11);
    }
    const auto corners = solved.surface.to_corners(map);
    ASSERT_EQ(corners.size(), 3 * mesh.faces.size());
    for (std::size_t k = 0; k < corners.size(); ++k)
      ASSERT_LT(length(corners[k] - exact(mesh.plane[mesh.faces[k / 3][k % 3]])), 2e-10);
  }
}

/// Largest ratio between the sides of faces in a texture and in space.
double largest_stretch(const Mesh& mesh, const std::vector<Vec2>& corners) {
  double worst = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t s = 0, next = 1; s < 3; ++s, next = (next + 1) % 3) {
      const double ratio = length(corners[3 * f + s] - corners[3 * f + next]) /
                           distance(mesh.positions[mesh.faces[f][s]], mesh.positions[mesh.faces[f][next]]);
      worst = std::isnan(ratio) ? INFINITY : std::max({worst, ratio, 1 / ratio});
    }
  return worst;
}

TEST(MeshSampling, CutsTheTextureOpenAlongTheCutLocus) {
  // An open cylinder: the cut locus of a point is the line opposite to it. Every face is nearly isometric on both sides of it.
  const Index around = 60, rows = 40;
  const double step = 2 * std::numbers::pi / around;
  const Mesh mesh = tube(rows, around, false, [&](Index i, Index k) {
    const double angle = (k + 0.3 * (i % 2)) * step;
    return Vec3{i * step, std::cos(angle), std::sin(angle)};
  });
  const SolvedMesh solved(mesh);
  const LogMap map = solved.solver.solve(solved.surface.source(Row((rows / 2) * around)).source);
  EXPECT_LE(largest_stretch(mesh, solved.surface.to_corners(map)), 1.6);
  // Without the cut, faces across it are stretched tenfold.
  const RowLogMap of_rows = solved.surface.to_rows(map);
  std::vector<Vec2> uncut;
  for (const Triangle& t : mesh.faces)
    for (Index v : t) uncut.push_back({of_rows.u[v], of_rows.v[v]});
  EXPECT_GT(largest_stretch(mesh, uncut), 5);
}

TEST(MeshSampling, HasTheStatusOfMaskedVertices) {
  const Mesh mesh = icosphere(12);
  const SolvedMesh solved(mesh);
  const LogMap map = solved.solver.solve(solved.surface.source(Row(0)).source, {.radius = 0.5});
  const auto result = solved.surface.to_rows(map);
  const auto corners = solved.surface.to_corners(map);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const bool ok = std::ranges::all_of(mesh.faces[f], [&](Index v) { return result.status[v] == Status::ok; });
    for (int s = 0; s < 3; ++s) ASSERT_EQ(std::isnan(corners[3 * f + s][0]), !ok);
    const Sample sample = solved.surface.at(map, FacePoint{static_cast<Index>(f), {0.4, 0.3, 0.3}});
    ASSERT_EQ(std::isnan(sample.u), sample.status != Status::ok);
  }
}

TEST(MeshSampling, RefusesMapsOfOtherGraphs) {
  const SolvedMesh solved(icosphere(4)), other(icosphere(5));
  const LogMap map = other.solver.solve(other.surface.source(Row(0)).source);
  EXPECT_THROW(solved.surface.to_rows(map), InvalidArgument);
  EXPECT_THROW(solved.surface.to_corners(map), InvalidArgument);
  EXPECT_THROW(solved.surface.at(map, FacePoint{0, {1, 0, 0}}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
