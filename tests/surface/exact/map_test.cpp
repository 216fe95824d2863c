// Exact maps: sources, targets, statuses, axes, threads; surfaces and arguments that are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "ahm/surface/exact/exact_geodesics.hpp"
#include "polyhedra.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

using exact::ExactMap;
using exact::ExactOptions;
using exact::MeshPoint;
using exact::PolyhedralSurface;

double angle_difference(double a, double b) { return std::remainder(a - b, 2 * std::numbers::pi); }

void expect_same_distances(const ExactMap& a, const ExactMap& b, double tolerance) {
  for (Index v = 0; v < a.size(); ++v) EXPECT_NEAR(a.distance(Vertex(v)), b.distance(Vertex(v)), tolerance) << v;
}

TEST(ExactMap, HasTheAxesOfTheTriangleBackend) {
  for (const Mesh& mesh : {icosphere(5), cone_patch(9, 4.0), moebius_mesh(30, 5)}) {
    const Polyhedron solid(mesh);
    const auto backend = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.intrinsic_delaunay = false});
    for (Index v = 0; v < solid.surface.vertex_count(); v += 7) {
      const ExactMap map = solid.map(v);
      const Star star = backend.graph().star(v);
      for (std::size_t k = 0; k < star.neighbors.size(); ++k) {
        const Vec2 uv = map.coordinates(Vertex(star.neighbors[k]));
        EXPECT_NEAR(uv[0], star.logs[2 * k], 1e-12);
        EXPECT_NEAR(uv[1], star.logs[2 * k + 1], 1e-12);
      }
    }
  }
}

TEST(ExactMap, OfSeveralSourcesIsThatOfTheNearest) {
  const Polyhedron solid(icosphere(8));
  std::mt19937_64 random(2);
  std::vector<MeshPoint> sources = random_points(solid.surface, 3, random);
  sources.insert(sources.begin(), {solid.vertex(3), {10, {0.5, 0.5, 0}}});
  const ExactMap all = exact::exact_map(solid.surface, sources);
  const std::vector<ExactMap> each = exact::exact_maps(solid.surface, sources);
  for (Vertex v(0); v.index < all.size(); ++v.index) {
    double nearest = HUGE_VAL;
    for (const ExactMap& map : each) nearest = std::min(nearest, map.distance(v));
    const ExactMap& own = each[static_cast<std::size_t>(all.source(v))];
    EXPECT_NEAR(all.distance(v), nearest, 1e-13);
    EXPECT_NEAR(own.distance(v), nearest, 1e-13);
    EXPECT_NEAR(angle_difference(all.direction(v), own.direction(v)), 0, 1e-11);
  }
}

// In needles, rays of one source pass close to the other sources.
TEST(ExactMap, OfSeveralSourcesIsThatOfTheNearestInNeedles) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Mesh mesh = sliver_square(150, seed);
    const Polyhedron solid(mesh);
    std::mt19937_64 random(seed);
    const std::vector<MeshPoint> sources = random_points(solid.surface, 12, random);
    const ExactMap map = exact::exact_map(solid.surface, sources);
    for (Index v = 0; v < map.size(); ++v) {
      double nearest = HUGE_VAL;
      for (const MeshPoint& s : sources)
        nearest = std::min(nearest, norm(mesh.plane_point(s.face, s.barycentric) - mesh.plane[v]));
      EXPECT_NEAR(map.distance(Vertex(v)) * solid.mesh.length_unit(), nearest, 1e-12) << seed << ' ' << v;
    }
  }
}

TEST(ExactMap, IsContinuousInItsSource) {
  const Polyhedron solid(icosphere(6));
  const MeshPoint corner = solid.vertex(20);
  MeshPoint in_face = corner, on_edge = corner;
  for (double& b : in_face.barycentric) b = b > 0 ? 1 - 2e-9 : 1e-9;
  for (int s = 0; s < 3; ++s)
    if (corner.barycentric[s] > 0) on_edge.barycentric[s] = 1 - 1e-9, on_edge.barycentric[(s + 1) % 3] = 1e-9;
  for (const MeshPoint& near : {in_face, on_edge})
    expect_same_distances(exact::exact_map(solid.surface, near), solid.map(20), 2e-9);
}

TEST(ExactMap, OfAPointOnAnEdgeDoesNotDependOnItsFace) {
  const Polyhedron solid(icosphere(6));
  for (exact::Half h = 0; h < 120; h += 3) {
    // The left side of h is side h + 2 of this face and side t of the other face.
    const exact::Half t = solid.surface.record(h).beyond_left;
    MeshPoint here{h / 3, {0.3, 0, 0.7}}, there{t / 3, {0, 0, 0}};
    there.barycentric[t % 3] = 0.3;
    there.barycentric[exact::next(t) % 3] = 0.7;
    expect_same_distances(exact::exact_map(solid.surface, here), exact::exact_map(solid.surface, there), 1e-13);
  }
}

TEST(ExactMap, DoesNotReachOtherComponents) {
  const Mesh one = icosphere(3);
  const Index n = one.vertices();
  const Polyhedron solid(joined(one, one, {5, 0, 0}));
  ExactOptions options;
  options.targets = {solid.vertex(n + 1), {0, {0.2, 0.3, 0.5}}};
  const ExactMap map = solid.map(n - 1, options);
  for (Index v = 0; v < map.size(); ++v) EXPECT_EQ(map.status(Vertex(v)), v < n ? Status::ok : Status::disconnected);
  EXPECT_EQ(map.target_status(0), Status::disconnected);
  EXPECT_EQ(map.target_status(1), Status::ok);
  const auto path = exact::path_to_vertex(solid.surface, map, Vertex(n));
  EXPECT_EQ(path.status, Status::disconnected);
  EXPECT_TRUE(path.points.empty());
}

/// Bumps over a square: a boundary, and angle sums above and below 2 pi.
Mesh bumps(Index side) {
  Mesh mesh = flat_square(side);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto [x, y] = mesh.plane[v];
    mesh.positions[v] = {x, y, 0.1 * std::sin(9 * x) * std::cos(11 * y)};
  }
  return mesh;
}

TEST(ExactMap, DoesNotDependOnTheNumberOfThreads) {
  const Polyhedron solid(bumps(15));
  std::vector<MeshPoint> sources;
  for (Index v = 0; v < 20; ++v) sources.push_back(solid.vertex(9 * v));
  const auto one = exact::exact_maps(solid.surface, sources, {}, 1),
             four = exact::exact_maps(solid.surface, sources, {}, 4);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_TRUE(std::ranges::equal(one[k].distances(), four[k].distances()));
    EXPECT_TRUE(std::ranges::equal(one[k].directions(), four[k].directions()));
  }
}

TEST(ExactMap, EndsAtTheRadius) {
  const Polyhedron solid(split_icosphere(2500));
  const ExactMap whole = solid.map(7), part = solid.map(7, {.radius = 1});
  EXPECT_LT(part.statistics().windows, 0.5 * whole.statistics().windows);
  for (Vertex v(0); v.index < part.size(); ++v.index) {
    if (whole.distance(v) <= 1) {
      ASSERT_EQ(part.status(v), Status::ok);
      EXPECT_EQ(part.distance(v), whole.distance(v));
      EXPECT_EQ(part.direction(v), whole.direction(v));
    } else {
      EXPECT_EQ(part.status(v), Status::beyond_radius);
      EXPECT_TRUE(std::isnan(part.distance(v)));
    }
  }
}

// ------------------------------------------------------------------------------------------------ refusals

/// Two triangles 0 1 2 and 2 1 3.
struct TwoFaces {
  std::vector<Index> tails{0, 1, 2, 2, 1, 3};
  std::vector<exact::Half> twins{-1, 3, -1, 1, -1, -1};
  std::vector<std::array<double, 3>> lengths{{1, 1, 1}, {1, 1, 1}};
  PolyhedralSurface build() const { return PolyhedralSurface::from_lengths({tails, twins}, lengths); }
};

TEST(PolyhedralSurface, RefusesDegenerateFacesAndInconsistentEdges) {
  struct Case {
    const char* text;
    std::function<void(TwoFaces&)> damage;
  };
  const Case cases[] = {
      {"face 1 is degenerate",
       [](TwoFaces& f) {
         f.lengths[1] = {1, 0.5, 0.5};
       }},
      {"face 1 has a side",
       [](TwoFaces& f) {
         f.lengths[1] = {1, 0, 1};
       }},
      {"face 0 breaks the triangle inequality",
       [](TwoFaces& f) {
         f.lengths[0] = {3, 1, 1};
       }},
      {"face 0 has a side",
       [](TwoFaces& f) {
         f.lengths[0] = {1, 1, INFINITY};
       }},
      {"not mutual", [](TwoFaces& f) { f.twins[3] = -1; }},
      {"between other vertices", [](TwoFaces& f) { f.twins = {3, -1, -1, 0, -1, -1}; }},
      {"faces 0 and 1",
       [](TwoFaces& f) {
         f.lengths[1] = {1.1, 1, 1};
       }},
      {"several fans", [](TwoFaces& f) { f.twins = {-1, -1, -1, -1, -1, -1}; }},
  };
  for (const auto& [text, damage] : cases) {
    TwoFaces faces;
    damage(faces);
    expect_error<InvalidGeometry>([&] { faces.build(); }, text);
  }
}

// A square with a vertex at 1e-9 from one of its diagonals.
TEST(PolyhedralSurface, KeepsTrianglesThatAreNearlyFlat) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5 + 1e-9, 0.5 - 1e-9, 0}};
  mesh.faces = {{0, 1, 4}, {1, 2, 4}, {2, 0, 4}, {0, 2, 3}};
  const Polyhedron solid(mesh);
  for (Index a = 0; a < 5; ++a)
    for (Index b = 0; b < 5; ++b)
      EXPECT_NEAR(solid.map(a).distance(Vertex(b)), distance(solid.position(a), solid.position(b)), 1e-15);
}

// Sides from 1e-320 to 1e300: windows circle around corners that are far smaller than the rounding of their distances.
TEST(ExactMap, NamesMeshesOnWhichWindowsDoNotEnd) {
  Mesh mesh = flat_square(5, 0.0);
  const Vec3 scattered[] = {
      {-8.7e-255, 1.2e-90, -6.5e-280}, {-1.6e97, 7.9e-296, -3.3e-99},    {-1.1e129, 2.0e86, 2.0e288},
      {-3.2e98, 1.5e-123, -7.5e-82},   {-4.2e186, -4.1e-258, 3.6e30},    {-1.3e36, -2.9e-123, 2.1e-29},
      {-3.2e-290, -1.1e279, -1.1e300}, {-6.6e-235, -3.1e290, -1.5e-103}, {4.2e62, 3.5e151, -1.3e-286},
      {-2.0e-76, -1.8e-281, -8.0e276}, {3.5e117, -6.5e272, 4.8e-268},    {5.2e132, -6.2e-217, -1.6e-274},
      {-1.5e59, -7.0e210, -4.2e-20},   {3.2e-308, 1.7e-289, 1.3e-284},   {2.1e-289, 5.8e-275, 0}};
  std::copy(std::begin(scattered), std::end(scattered), mesh.positions.begin() + 5);
  const auto surface = surface_of(mesh);
  const ExactGeodesics exact(surface);
  int refused = 0, lost = 0;
  const auto count = [](int& counter, const char* expected, const std::function<void()>& call) {
    const std::string fault = fault_of(call);
    EXPECT_TRUE(fault == expected || fault == "none") << fault;
    counter += fault == expected;
  };
  for (Index face = 0; face < static_cast<Index>(mesh.faces.size()); ++face)
    count(refused, "windows_without_end", [&] { (void)exact.log_map(FacePoint{face, {0.25, 0.25, 0.5}}); });
  for (Index face = 0; face < exact.triangles().surface.face_count(); face += 4)
    count(lost, "line_too_long", [&] {
      (void)exact::trace(exact.triangles().surface, {face, {0.25, 0.25, 0.5}}, 0.3 * face, 1);
    });
  EXPECT_GT(refused, 0);
  EXPECT_GT(lost, 0);
}

// Where angles are as small as rounding errors, a map is refused or every vertex has a distance.
TEST(ExactMap, IsRefusedWhereNeedlesLoseWindows) {
  int refused = 0, maps = 0;
  const auto is_complete = [](const exact::ExactMap& map) {
    return std::ranges::all_of(map.status(), [](Status status) { return status == Status::ok; });
  };
  for (unsigned seed = 20; seed < 28; ++seed) {
    const auto flat = nested_needles(seed);
    if (!flat) continue;
    for (Index source = 0; source < flat->surface.vertex_count(); source += 5) {
      const MeshPoint from = flat->surface.vertex_point(Vertex(source));
      try {
        EXPECT_TRUE(is_complete(exact::exact_map(flat->surface, from)));
        ++maps;
      } catch (const InvalidGeometry& e) {
        EXPECT_EQ(e.fault(), "windows_lost") << e.what();
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(maps, 50 * refused);
}

TEST(ExactMap, RefusesArgumentsOutOfRange) {
  const PolyhedralSurface surface = TwoFaces{}.build();
  const double nan = std::nan("");
  const MeshPoint inside{0, {0.2, 0.3, 0.5}};
  for (const MeshPoint& point : {MeshPoint{2, {1, 0, 0}}, MeshPoint{-1, {1, 0, 0}}, MeshPoint{0, {0.5, 0.6, 0}},
                                 MeshPoint{0, {1.5, -0.5, 0}}, MeshPoint{0, {nan, 1, 0}}}) {
    EXPECT_THROW(exact::exact_map(surface, point), InvalidArgument);
    EXPECT_THROW(exact::geodesic_path(surface, {0, {1, 0, 0}}, point), InvalidArgument);
    EXPECT_THROW(exact::trace(surface, point, 0, 1), InvalidArgument);
  }
  EXPECT_THROW(exact::exact_map(surface, std::span<const MeshPoint>()), InvalidArgument);
  EXPECT_THROW(exact::exact_map(surface, MeshPoint{}, {.radius = 0}), InvalidArgument);
  EXPECT_THROW(exact::trace(surface, inside, nan, 1), InvalidArgument);
  EXPECT_THROW(exact::trace(surface, inside, 0, -1), InvalidArgument);
  EXPECT_THROW(exact::trace(surface, {0, {1, 0, 0}}, 3, 1), InvalidArgument);
  const exact::ExactMap map = exact::exact_map(surface, MeshPoint{});
  EXPECT_THROW(exact::path_to_vertex(surface, map, Vertex(4)), InvalidArgument);
  EXPECT_THROW(exact::path_to_target(surface, map, 0), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
