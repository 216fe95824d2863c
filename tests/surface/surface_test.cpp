// Sources, samples, closest points, rows and corners of every surface.
#include "ahm/surface/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "ahm/conformance/clouds.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "ahm/util/vec.hpp"
#include "surfaces.hpp"

namespace ahm::test {
namespace {

using pointcloud::PointCloudSurface;
using trimesh::TriangleMeshSurface;

LogMap map_of(const Surface& surface, const SurfaceSource& source) {
  return LogMapSolver(surface.graph()).solve(source.source);
}

// ------------------------------------------------------------------------------------------------ sources

TEST(Surface, ASourceAtARowIsThatAtACornerOfAFlatFace) {
  const Mesh mesh = holed_square(12);
  const Vec3 along = mesh.positions[1] - mesh.positions[0];
  for_each_surface(polygons(mesh), [&](const Surface& surface) {
    for (std::size_t corner : {0U, 2U}) {
      const Row row(mesh.faces[50][corner]);
      FacePoint point{50, {0, 0, 0}};
      point.barycentric[corner] = 1;
      const SurfaceSource at_row = surface.source(row, along), in_face = surface.source(point, along);
      EXPECT_EQ(at_row.row, row);
      EXPECT_FALSE(in_face.row);
      EXPECT_LT(distance(at_row.position, in_face.position), 1e-14);
      EXPECT_LT(distance(at_row.frame->x, in_face.frame->x), 1e-12);
      const RowLogMap a = surface.to_rows(map_of(surface, at_row)), b = surface.to_rows(map_of(surface, in_face));
      for (std::size_t i = 0; i < a.u.size(); ++i) EXPECT_LT(std::hypot(a.u[i] - b.u[i], a.v[i] - b.v[i]), 1e-10);
    }
  });
}

TEST(Surface, AnEdgePointLiesOnTheEdgeAndItsUAxisPointsAlongIt) {
  const Mesh mesh = holed_square(12);
  for_each_surface(polygons(mesh), [&](const Surface& surface) {
    const auto [a, b, c] = mesh.faces[40];
    const EdgePoint point{Row(c), Row(a), 0.25};
    const SurfaceSource source = surface.source(point);
    const Vec3 edge = mesh.positions[a] - mesh.positions[c], expected = mesh.positions[c] + 0.25 * edge;
    EXPECT_LT(distance(source.position, expected), 1e-14);
    EXPECT_LT(distance(surface.position(point), expected), 1e-14);
    EXPECT_LT(distance(source.frame->x, normalized(edge)), 1e-12);
    const LogMap map = map_of(surface, source);
    const Sample start = surface.at(map, point), end = surface.at(map, Row(a));
    EXPECT_NEAR(std::hypot(start.u, start.v), 0, 1e-10);
    EXPECT_NEAR(end.u, 0.75 * norm(edge), 1e-10);
    EXPECT_NEAR(end.v, 0, 1e-10);
    EXPECT_THROW(surface.source(EdgePoint{Row(a), Row(a), 0.5}), InvalidArgument);
    EXPECT_THROW(surface.source(EdgePoint{Row(a), Row(b), 1.5}), InvalidArgument);
  });
}

TEST(Surface, ATangentPointOfACloudHasItsOffset) {
  std::vector<Vec3> points;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      points.push_back({0.1 * x + 0.01 * std::sin(7 * y), 0.1 * y + 0.01 * std::cos(5 * x), 2});
  const auto cloud = PointCloudSurface::build(points);
  const ClosestPoint found = cloud.closest_point({0.93, 1.02, 2.3});
  EXPECT_NEAR(found.distance, 0.3, 1e-12);
  const SurfaceSource source = cloud.source(found.point, Vec3{1, 0, 0});
  EXPECT_LT(distance(source.position, {0.93, 1.02, 2}), 1e-12);
  const double left = source.frame->normal[2] > 0 ? 1 : -1;
  const LogMap map = LogMapSolver(cloud.graph()).solve(source.source, {.frames = true});
  const RowLogMap rows = cloud.to_rows(map);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_NEAR(rows.u[i], points[i][0] - 0.93, 1e-9);
    ASSERT_NEAR(rows.v[i], left * (points[i][1] - 1.02), 1e-9);
  }
  const Sample sample = cloud.at(map, TangentPoint{Row(0), {0.33, 0.44, 5}});  // the row is far from the point
  EXPECT_NEAR(sample.u, 0.33 - 0.93, 1e-9);
  EXPECT_NEAR(sample.v, left * (0.44 - 1.02), 1e-9);
}

/// Number of rows where the unit sphere accepts a u axis that is tilted from the normal.
std::size_t accepted_axes(const Surface& sphere, double degrees, double scale = 1) {
  std::size_t count = 0;
  for (std::size_t r = 0; r < sphere.positions().size(); ++r) {
    const auto [x, y, z] = sphere.positions()[r];
    if (std::hypot(x, y) < 0.1) continue;
    const double t = std::tan(degrees * std::numbers::pi / 180) / std::hypot(x, y);
    try {
      sphere.source(Row(static_cast<Index>(r)), scale * Vec3{x - t * y, y + t * x, z});
      ++count;
    } catch (const InvalidArgument& e) {
      EXPECT_EQ(e.fault(), "axis_along_normal");
      EXPECT_NE(e.problem().find("row " + std::to_string(r)), std::string::npos) << e.what();
    }
  }
  return count;
}

TEST(Surface, RefusesUAxesCloserToTheNormalThanItsError) {
  const auto mesh = surface_of(icosphere(8));
  const Cloud points = random_sphere(1500, 3);
  const auto estimated = PointCloudSurface::build(points.points),
             exact = PointCloudSurface::build(points.points, points.normals);
  for (double scale : {1e-300, 1.0, 1e300})
    for (double degrees : {0.0, 0.5}) {
      EXPECT_EQ(accepted_axes(mesh, degrees, scale), 0U);
      EXPECT_EQ(accepted_axes(exact, degrees, scale), 0U);
      EXPECT_LE(accepted_axes(estimated, degrees, scale), 3U);  // errors above the 95th percentile of estimated normals
    }
  const std::size_t most = accepted_axes(estimated, 30);
  EXPECT_GT(most, 1400U);
  EXPECT_EQ(accepted_axes(exact, 1.5), most);
  EXPECT_LT(accepted_axes(estimated, 2), most / 50);
  EXPECT_GT(accepted_axes(mesh, 2), 600U);
}

TEST(Surface, NamesTheFaultOfAPoint) {
  Mesh mesh = icosphere(2);
  mesh.positions.push_back({5, 5, 5});  // in no face
  const Row unused(mesh.vertices() - 1);
  const auto surface = surface_of(mesh);
  EXPECT_EQ(fault_of([&] { surface.source(unused); }), "row_unused");
  EXPECT_EQ(fault_of([&] { surface.source(Row(mesh.vertices())); }), "row_out_of_range");
  EXPECT_EQ(fault_of([&] { surface.source(Row(0), mesh.positions[0]); }), "axis_along_normal");
  EXPECT_THROW(surface.closest_point({NAN, 0, 0}), InvalidArgument);
  EXPECT_THROW(surface.nearest_row({0, 0, INFINITY}), InvalidArgument);
  EXPECT_NE(surface.nearest_row({5, 5, 4.9}), unused);
}

// ------------------------------------------------------------------------------------------------ rows

// Three squares share the edge from row 0 to row 1, and the mesh is cut there.
TEST(Surface, ACutRowHasTheValuesOfItsCopyNearestToTheSource) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {-1, 1, 0}, {-1, 1, 1}, {-1, -1, 0}, {-1, -1, 1}};
  for (Index p : {2, 4, 6}) mesh.faces.insert(mesh.faces.end(), {{0, p, p + 1}, {0, p + 1, 1}});
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces, {.non_manifold = NonManifold::split});
  EXPECT_EQ(surface.rows().vertices(Row(0)).size(), 3U);
  for (Index page : {2, 4, 6}) {
    const LogMap map = map_of(surface, surface.source(Row(page)));
    const RowLogMap rows = surface.to_rows(map);
    for (Index r : {0, 1}) {
      ASSERT_EQ(rows.status[r], Status::ok);
      ASSERT_TRUE(rows.vertex[r]);
      EXPECT_EQ(surface.rows().row(*rows.vertex[r]), Row(r));
      EXPECT_EQ(rows.distance[r], map.distance(*rows.vertex[r]));
      for (Vertex v : surface.rows().vertices(Row(r)))
        EXPECT_FALSE(map.status(v) == Status::ok && map.distance(v) < rows.distance[r]);
    }
    EXPECT_NEAR(rows.distance[0], distance(mesh.positions[page], mesh.positions[0]), 1e-9);  // a page is flat
    // Other numbers of vertices are those of the same copies.
    const std::vector<double> by_row = to_rows(rows, map.distances());
    ASSERT_EQ(by_row.size(), mesh.positions.size());
    for (Index r = 0; r < mesh.vertices(); ++r) {
      const bool is_mapped = r < 2 || r == page || r == page + 1;  // the other pages are separate components
      EXPECT_EQ(rows.status[r] == Status::ok, is_mapped);
      EXPECT_TRUE(is_mapped ? by_row[r] == rows.distance[r] : std::isnan(by_row[r])) << r;
    }
    EXPECT_THROW(to_rows(rows, map.distances().first(1)), InvalidArgument);
  }
}

TEST(Surface, DoesNotContainRowsThatTheCallerLeftOut) {
  std::vector<Vec3> points, remaining;
  for (int x = 0; x < 15; ++x)
    for (int y = 0; y < 15; ++y) points.push_back({0.1 * x, 0.1 * y + 0.02 * (x % 2), 0});
  points[3] = {NAN, 0, 0};
  std::vector<Row> kept;
  for (Index i = 0; i < static_cast<Index>(points.size()); ++i)
    if (i % 7 != 3) kept.emplace_back(i), remaining.push_back(points[i]);
  const auto part = PointCloudSurface::build(points, {}, {.rows = kept}), whole = PointCloudSurface::build(remaining);
  const RowLogMap a = part.to_rows(map_of(part, part.source(kept[9]))),
                  b = whole.to_rows(map_of(whole, whole.source(Row(9))));
  ASSERT_EQ(a.u.size(), points.size());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    EXPECT_EQ(a.u[kept[k].index], b.u[k]);
    EXPECT_EQ(a.v[kept[k].index], b.v[k]);
  }
  EXPECT_EQ(a.status[3], Status::removed);
  const std::vector<Vec3> mapped = mapped_positions(part);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_TRUE(i % 7 == 3 ? std::isnan(mapped[i][0]) : mapped[i] == points[i]) << i;
  EXPECT_EQ(fault_of([&] { part.source(Row(10)); }), "row_left_out");
  const std::vector<Row> not_ascending{Row(5), Row(4), Row(6)};
  EXPECT_THROW(PointCloudSurface::build(points, {}, {.rows = not_ascending}), InvalidArgument);
}

// The result is independent of the number of queries, also where several rows are equally near.
TEST(Surface, TheNearestRowIsTheFirstOfLeastDistance) {
  for (const double scale : {1.0, 0x1p-800, 0x1p900}) {
    std::vector<Vec3> points;
    for (int x = 0; x < 24; ++x)
      for (int y = 0; y < 24; ++y) points.push_back({scale * x, scale * y, x % 5 == 0 ? scale * 0.25 : 0});
    points.push_back(points[7]);
    points.push_back({NAN, 0, 0});
    const pointcloud::CloudOptions options{.drop_non_finite = true};
    const auto many_queries = PointCloudSurface::build(points, {}, options);
    std::mt19937 random(3);
    std::uniform_int_distribution<int> half(-4, 52);
    for (int group = 0; group < 40; ++group) {
      const auto two_queries = PointCloudSurface::build(points, {}, options);  // compares all points
      for (int k = 0; k < 2; ++k) {
        const Vec3 query{scale * 0.5 * half(random), scale * 0.5 * half(random), scale * 0.125 * (k % 3)};
        const Row row = many_queries.nearest_row(query);
        ASSERT_EQ(row.index, two_queries.nearest_row(query).index) << "group " << group << " at scale " << scale;
        for (const Vec3& p : points)
          ASSERT_FALSE(distance(p, query) < distance(points[row.index], query) * (1 - 1e-15));
      }
    }
  }
}

// ------------------------------------------------------------------------------------------------ closest points

TEST(Surface, TheClosestPointIsTheNearestOfManyInAllFaces) {
  const Mesh mesh = icosphere(4);
  const auto surface = surface_of(mesh);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  constexpr int parts = 12;
  for (int trial = 0; trial < 40; ++trial) {
    const Vec3 query{normal(random), normal(random), normal(random)};
    const ClosestPoint found = surface.closest_point(query);
    EXPECT_NEAR(distance(found.position, query), found.distance, 1e-14);
    EXPECT_LT(distance(surface.position(found.point), found.position), 1e-14);
    double least = HUGE_VAL, longest = 0;
    for (const auto& [a, b, c] : mesh.faces) {
      const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
      longest = std::max(longest, distance(p, q));
      for (int i = 0; i <= parts; ++i)
        for (int j = 0; i + j <= parts; ++j)
          least = std::min(least, distance(1.0 / parts * (i * p + j * q + (parts - i - j) * r), query));
    }
    EXPECT_LE(found.distance, least + 1e-14);
    EXPECT_GE(found.distance, least - longest / parts);
  }
}

TEST(Surface, TheClosestPointOnAnEdgeIsInTheFirstFaceAtAnyRounding) {
  const Mesh mesh = icosphere(4);
  for (double scale : {1.0, 1.1, 3.0, 7.0, 0.3, 1.0000000001}) {
    Mesh scaled = mesh;
    for (Vec3& p : scaled.positions) p = scale * p;
    const auto surface = surface_of(scaled);
    for (const Triangle& face : mesh.faces)
      for (int side = 0; side < 3; ++side) {
        const Index i = face[side], j = face[(side + 1) % 3];
        const auto found =
            std::get<FacePoint>(surface.closest_point(0.7 * scaled.positions[i] + 0.3 * scaled.positions[j]).point);
        const auto first = std::ranges::find_if(
            mesh.faces, [&](const Triangle& t) { return std::ranges::count(t, i) + std::ranges::count(t, j) == 2; });
        ASSERT_EQ(found.face, first - mesh.faces.begin()) << scale;
        ASSERT_EQ(std::ranges::count(found.barycentric, 0.0), 1) << scale;
      }
  }
}

TEST(Surface, TheClosestPointOnASmallComponentIsFound) {
  const Mesh large = icosphere(2);
  Mesh small = large;
  for (Vec3& p : small.positions) p = 1e-12 * p;
  const Mesh mesh = joined(large, small);
  const auto surface = surface_of(mesh);
  for (std::size_t f = large.faces.size(); f < mesh.faces.size(); ++f) {
    const auto [a, b, c] = mesh.faces[f];
    const Vec3 p = 0.5 * mesh.positions[a] + 0.3 * mesh.positions[b] + 0.2 * mesh.positions[c];
    ASSERT_EQ(std::get<FacePoint>(surface.closest_point(p).point).face, static_cast<Index>(f));
  }
}

// The tangent planes of a cloud are bounded: otherwise the closest point of a distant query could lie far from all points.
TEST(Surface, TheClosestPointOfACloudIsNearItsPoints) {
  const auto cloud = PointCloudSurface::build(even_sphere(800).points);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const double far : {1.0, 1.3, 30.0, 1e6})
    for (int trial = 0; trial < 20; ++trial) {
      const Vec3 query = far * normalized(Vec3{normal(random), normal(random), normal(random)});
      const ClosestPoint found = cloud.closest_point(query);
      EXPECT_NEAR(distance(found.position, query), found.distance, 1e-9 * far);
      EXPECT_LT(distance(cloud.position(found.point), found.position), 1e-12);
      EXPECT_NEAR(norm(found.position), 1, 0.02);
    }
}

TEST(Surface, PathsOfACloudStartAndEndAtItsPoints) {
  const Cloud sphere = random_sphere(3000);
  const auto cloud = PointCloudSurface::build(sphere.points);
  for (const Index end : {700, 1500, 2900}) {
    const SurfacePath line = shortest_line(cloud, Row(5), Row(end));
    EXPECT_EQ(line.points.front(), sphere.points[5]);
    EXPECT_EQ(line.points.back(), sphere.points[end]);
  }
}

TEST(Surface, IsValidAfterAMove) {
  TriangleMeshSurface first = surface_of(icosphere(3));
  const ClosestPoint before = first.closest_point({0, 0.3, 2});
  const LogMapSolver solver(first.graph());
  const TriangleMeshSurface second = std::move(first);
  EXPECT_EQ(second.closest_point({0, 0.3, 2}).position, before.position);
  EXPECT_EQ(second.to_rows(solver.solve(second.source(Row(4)).source)).status[0], Status::ok);
}

// ------------------------------------------------------------------------------------------------ corners

constexpr double two_pi = 2 * std::numbers::pi;

struct Corners {
  Index cut = 0;       ///< corners whose values differ from those of their row
  double stretch = 1;  ///< largest ratio of the length of a side in the map and in space, or its inverse
  double change = 0;   ///< largest difference of distances from the first corner of a face in the map and in space

  Corners(const Surface& surface, const LogMap& map) {
    const RowLogMap rows = surface.to_rows(map);
    const std::vector<Vec2> phi = surface.to_corners(map);
    const FaceList faces = surface.faces();
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t c = 0; c < faces[f].size(); ++c) {
        const auto begin = static_cast<std::size_t>(faces.begin[f]), next = (c + 1) % faces[f].size();
        const auto in_map = [&](std::size_t a, std::size_t b) { return norm(phi[begin + a] - phi[begin + b]); };
        const auto in_space = [&](std::size_t a, std::size_t b) {
          return distance(surface.positions()[faces[f][a]], surface.positions()[faces[f][b]]);
        };
        const double ratio = in_map(c, next) / in_space(c, next);
        EXPECT_FALSE(std::isnan(ratio)) << f;
        stretch = std::max({stretch, ratio, 1 / ratio});
        change = std::max(change, std::abs(in_map(0, c) - in_space(0, c)));
        cut += !(norm(phi[begin + c] - Vec2{rows.u[faces[f][c]], rows.v[faces[f][c]]}) < 1e-12);
      }
  }
};

TEST(Corners, HaveTheValuesOfTheirRowsOnAFlatMesh) {
  Mesh mesh = holed_square(10);
  for (std::size_t f = 0; f < mesh.faces.size(); f += 3) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
  for_each_surface(polygons(mesh), [&](const Surface& surface) {
    const LogMap map = map_of(surface, surface.source(Row(5)));
    const RowLogMap rows = surface.to_rows(map);
    const std::vector<Vec2> corners = surface.to_corners(map);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Index row = mesh.faces[k / 3][k % 3];
      ASSERT_LT(norm(corners[k] - Vec2{rows.u[row], rows.v[row]}), 1e-9);
    }
  });
}

// The cut locus of a point of a cylinder is the opposite line. No face has corners on both sides of that line.
TEST(Corners, AreCutAtTheCutLocus) {
  const Index around = 60;
  for (const Index length : {1, 8}) {  // of the faces, relative to their width
    SCOPED_TRACE(length);
    const Index rows = length == 1 ? 21 : 11;
    const Polygons cylinder = quads(rows, around, Columns::closed, [&](Index i, Index j) {
      return Vec3{length * two_pi / around * i, std::cos(two_pi * j / around), std::sin(two_pi * j / around)};
    });
    for_each_surface(cylinder, [&](const Surface& surface) {
      const LogMap map = map_of(surface, surface.source(Row(rows / 2 * around)));
      const Corners corners(surface, map);
      EXPECT_LE(corners.change, 0.3);
      EXPECT_GT(corners.cut, 0);
      if (length > 1) return;
      EXPECT_LT(corners.stretch, 1.6);
      const RowLogMap by_row = surface.to_rows(map);
      const std::vector<Vec2> phi = surface.to_corners(map);
      for (std::size_t k = 0; k < phi.size(); ++k)  // only corners within four columns of that line may be cut
        if (const Index row = surface.faces().vertices[k]; std::abs(row % around - around / 2) > 4)
          EXPECT_EQ(phi[k], (Vec2{by_row.u[row], by_row.v[row]})) << row;
    });
  }
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
    const Corners corners(surface, map_of(surface, surface.source(Row(0))));
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
  for_each_surface(patch, [&](const Surface& surface) {
    EXPECT_EQ(Corners(surface, map_of(surface, surface.source(Row(20 * 81 + 40)))).cut, 0);
  });
}

// Every face of a cube is distorted. The faces at the source are kept, and the others are laid out next to them.
TEST(Corners, OfACubeAreFinite) {
  Polygons cube;
  cube.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (const std::vector<Index>& face :
       {std::vector<Index>{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}})
    cube.add(face);
  for_each_surface(cube, [&](const Surface& surface) {
    for (Index row = 0; row < 8; ++row)
      EXPECT_LT(Corners(surface, map_of(surface, surface.source(Row(row)))).stretch, 10) << row;
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
