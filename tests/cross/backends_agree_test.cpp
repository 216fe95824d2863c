// The same vertices of the same surface, seen by one backend after the other: the maps approach each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

/// Coordinates of every vertex, n x 2.
using Map = std::vector<double>;

/// A graph surface z = f(x, y) over a jittered grid of `side` x `side` points of the unit square.
struct WavySquare {
  explicit WavySquare(Index side) : side(side), h(1.0 / (side - 1)) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> jitter(-0.2, 0.2);
    for (Index j = 0; j < side; ++j)
      for (Index i = 0; i < side; ++i) {
        const bool inside = i > 0 && j > 0 && i + 1 < side && j + 1 < side && 2 * i + 1 != side;
        const double x = (i + inside * jitter(random)) * h, y = (j + inside * jitter(random)) * h;
        points.push_back({x, y, 0.25 * std::sin(3 * x) * std::cos(2 * y)});
        const double z_x = 0.75 * std::cos(3 * x) * std::cos(2 * y), z_y = -0.5 * std::sin(3 * x) * std::sin(2 * y),
                     length = std::hypot(z_x, z_y, 1.0);
        normals.push_back({-z_x / length, -z_y / length, 1 / length});
      }
  }
  Index source() const { return (side / 2) * side + side / 2; }

  Index side;
  double h;
  std::vector<Vec3> points;
  std::vector<Vec3> normals;  ///< exact, upward
};

template <class Values>
Map pack(const Values& values) {
  Map map;
  for (std::size_t i = 0; i < values.u.size(); ++i) map.insert(map.end(), {values.u[i], values.v[i]});
  return map;
}

Map on_triangles(const WavySquare& s, const MapOptions& options) {
  std::vector<Triangle> faces;
  std::mt19937 random(2);
  for (Index j = 0; j + 1 < s.side; ++j)
    for (Index i = 0; i + 1 < s.side; ++i) {
      const Index a = j * s.side + i, b = a + 1, c = b + s.side, d = a + s.side;
      if (random() % 2)
        faces.insert(faces.end(), {{a, b, c}, {a, c, d}});
      else
        faces.insert(faces.end(), {{a, b, d}, {b, c, d}});
    }
  const auto mesh = trimesh::TriangleMeshSurface::build(s.points, faces);
  const LogMapSolver solver(mesh.graph());
  return pack(mesh.to_rows(solver.solve(mesh.source(Row(s.source()), Vec3{1, 0, 0}).source, options)));
}

Map on_points(const WavySquare& s, const MapOptions& options) {
  const auto cloud = pointcloud::PointCloudSurface::build(s.points, s.normals);
  const LogMapSolver solver(cloud.graph());
  return pack(cloud.to_rows(solver.solve(cloud.source(Row(s.source()), Vec3{1, 0, 0}).source, options)));
}

/// The same grid as quads, some of them joined to hexagons.
Map on_polygons(const WavySquare& s, const MapOptions& options) {
  std::vector<Offset> begin{0};
  std::vector<Index> corners;
  std::mt19937 random(3);
  for (Index j = 0; j + 1 < s.side; ++j)
    for (Index i = 0; i + 1 < s.side;) {
      const Index a = j * s.side + i, width = i + 2 < s.side && random() % 4 == 0 ? 2 : 1;
      for (Index k = 0; k <= width; ++k) corners.push_back(a + k);
      for (Index k = width; k >= 0; --k) corners.push_back(a + s.side + k);
      begin.push_back(static_cast<Offset>(corners.size()));
      i += width;
    }
  const auto mesh = polymesh::PolygonMeshSurface::build(s.points, begin, corners,
                                                        {.discretization = polymesh::Discretization::polygons});
  const LogMapSolver solver(mesh.graph());
  return pack(mesh.to_rows(solver.solve(mesh.source(Row(s.source()), Vec3{1, 0, 0}).source, options)));
}

/// Every way to discretize the surface; a backend joins by one line.
struct Discretization {
  const char* name;
  double order;  ///< of the difference to a better one
  Map (*solve)(const WavySquare&, const MapOptions&);
};
const Discretization discretizations[] = {
    {"triangles", 1.8, on_triangles}, {"polygons", 0.85, on_polygons}, {"points", 1.8, on_points}};

double rms_difference(const Map& a, const Map& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / (static_cast<double>(a.size()) / 2));
}

/// Largest difference at vertices farther than 0.1 from the border.
double largest_difference_inside(const WavySquare& s, const Map& a, const Map& b) {
  double worst = 0;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const auto& [x, y, z] = s.points[i];
    if (std::min({x, y, 1 - x, 1 - y}) > 0.1)
      worst = std::max(worst, std::hypot(a[2 * i] - b[2 * i], a[2 * i + 1] - b[2 * i + 1]));
  }
  return worst;
}

class Cross : public testing::TestWithParam<Variant> {};

TEST_P(Cross, MapsOfTheSameVerticesApproachEachOther) {
  struct Difference {
    double rms, inside;
  };
  std::vector<Difference> coarser;
  for (Index side : {21, 41, 81}) {
    const WavySquare surface(side);
    std::vector<Map> maps;
    for (const Discretization& d : discretizations) maps.push_back(d.solve(surface, {.variant = GetParam()}));
    std::vector<Difference> differences;
    for (std::size_t a = 0; a < maps.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const std::string pair = std::string(discretizations[a].name) + " and " + discretizations[b].name;
        differences.push_back({rms_difference(maps[a], maps[b]), largest_difference_inside(surface, maps[a], maps[b])});
        const auto [rms, inside] = differences.back();
        EXPECT_LT(inside, 0.05 * surface.h) << pair;
        if (coarser.empty()) continue;
        const double order = std::min(discretizations[a].order, discretizations[b].order);
        EXPECT_GE(std::log2(coarser[differences.size() - 1].rms / rms), order) << pair << ", side " << side;
        if (order < 1) continue;  // clamped weights lean with the polygons; inside, the bound above is what remains
        EXPECT_GE(std::log2(coarser[differences.size() - 1].inside / inside), order) << pair << ", side " << side;
      }
    coarser = differences;
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, Cross, testing::ValuesIn(all_variants),
                         [](const auto& info) { return std::string(to_string(info.param)); });

}  // namespace
}  // namespace ahm::test
