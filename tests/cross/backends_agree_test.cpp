// Maps of different backends on the same vertices of a surface approach each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/util/vec.hpp"
#include "surface/surfaces.hpp"

namespace ahm::test {
namespace {

/// The surface z = f(x, y) over a jittered grid of `side` x `side` points of the unit square.
struct WavySquare {
  explicit WavySquare(Index side) : side(side), h(1.0 / (side - 1)) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> jitter(-0.2, 0.2);
    for (Index j = 0; j < side; ++j)
      for (Index i = 0; i < side; ++i) {
        const bool inside = i > 0 && j > 0 && i + 1 < side && j + 1 < side && 2 * i + 1 != side;
        const double x = (i + inside * jitter(random)) * h, y = (j + inside * jitter(random)) * h;
        points.push_back({x, y, 0.25 * std::sin(3 * x) * std::cos(2 * y)});
        normals.push_back(
            normalized(Vec3{-0.75 * std::cos(3 * x) * std::cos(2 * y), 0.5 * std::sin(3 * x) * std::sin(2 * y), 1.0}));
      }
  }

  Index side;
  double h;
  std::vector<Vec3> points;
  std::vector<Vec3> normals;  ///< exact, upward
};

std::unique_ptr<Surface> triangle_surface(const WavySquare& s) {
  Mesh mesh{s.points, {}, {}};
  std::mt19937 random(2);
  for (Index j = 0; j + 1 < s.side; ++j)
    for (Index i = 0; i + 1 < s.side; ++i) {
      const Index a = j * s.side + i, b = a + 1, c = b + s.side, d = a + s.side;
      if (random() % 2)
        mesh.faces.insert(mesh.faces.end(), {{a, b, c}, {a, c, d}});
      else
        mesh.faces.insert(mesh.faces.end(), {{a, b, d}, {b, c, d}});
    }
  return std::make_unique<trimesh::TriangleMeshSurface>(surface_of(mesh));
}

/// The grid as quads. Some pairs of quads are hexagons.
std::unique_ptr<Surface> polygon_surface(const WavySquare& s) {
  Polygons mesh;
  mesh.positions = s.points;
  std::mt19937 random(3);
  for (Index j = 0; j + 1 < s.side; ++j)
    for (Index i = 0; i + 1 < s.side;) {
      const Index a = j * s.side + i, width = i + 2 < s.side && random() % 4 == 0 ? 2 : 1;
      std::vector<Index> face;
      for (Index k = 0; k <= width; ++k) face.push_back(a + k);
      for (Index k = width; k >= 0; --k) face.push_back(a + s.side + k);
      mesh.add(face);
      i += width;
    }
  return std::make_unique<polymesh::PolygonMeshSurface>(surface_of(mesh, polymesh::Discretization::polygons));
}

std::unique_ptr<Surface> point_surface(const WavySquare& s) {
  return std::make_unique<pointcloud::PointCloudSurface>(pointcloud::PointCloudSurface::build(s.points, s.normals));
}

struct Backend {
  const char* name;
  double order;  ///< order of convergence of the difference to a better discretization
  std::unique_ptr<Surface> (*build)(const WavySquare&);
};
const Backend backends[] = {
    {"triangles", 1.8, triangle_surface}, {"polygons", 0.85, polygon_surface}, {"points", 1.8, point_surface}};

RowLogMap map_from_center(const WavySquare& square, const Surface& surface, Variant variant) {
  const Row center((square.side / 2) * square.side + square.side / 2);
  const LogMapSolver solver(surface.graph());
  return surface.to_rows(solver.solve(surface.source(center, Vec3{1, 0, 0}).source, {.variant = variant}));
}

struct Difference {
  double rms = 0;
  double inside = 0;  ///< the largest at vertices farther than 0.1 from the boundary
};
Difference difference(const WavySquare& square, const RowLogMap& a, const RowLogMap& b) {
  Difference result;
  for (std::size_t i = 0; i < square.points.size(); ++i) {
    const auto& [x, y, z] = square.points[i];
    const double d = std::hypot(a.u[i] - b.u[i], a.v[i] - b.v[i]);
    result.rms += d * d / static_cast<double>(square.points.size());
    if (std::min({x, y, 1 - x, 1 - y}) > 0.1) result.inside = std::max(result.inside, d);
  }
  result.rms = std::sqrt(result.rms);
  return result;
}

class Cross : public testing::TestWithParam<Variant> {};

TEST_P(Cross, MapsOfTheSameVerticesApproachEachOther) {
  std::vector<Difference> coarser;
  for (Index side : {21, 41, 81}) {
    const WavySquare square(side);
    std::vector<RowLogMap> maps;
    for (const Backend& backend : backends) maps.push_back(map_from_center(square, *backend.build(square), GetParam()));
    std::vector<Difference> differences;
    for (std::size_t a = 0; a < maps.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        SCOPED_TRACE(testing::Message() << backends[a].name << " and " << backends[b].name << ", side " << side);
        const Difference d = differences.emplace_back(difference(square, maps[a], maps[b]));
        EXPECT_LT(d.inside, 0.05 * square.h);
        if (coarser.empty()) continue;
        const Difference& before = coarser[differences.size() - 1];
        const double order = std::min(backends[a].order, backends[b].order);
        EXPECT_GE(std::log2(before.rms / d.rms), order);
        // Clamped weights of polygons depend on the shapes of the polygons; there, only the bound above holds.
        if (order >= 1) EXPECT_GE(std::log2(before.inside / d.inside), order);
      }
    coarser = differences;
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, Cross, testing::ValuesIn(all_variants),
                         [](const auto& info) { return std::string(to_string(info.param)); });

}  // namespace
}  // namespace ahm::test
