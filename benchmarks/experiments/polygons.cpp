// The unit sphere as polygon meshes of many kinds, refined or as polygons, compared with the closed form.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "experiments/experiment.hpp"

namespace ahm::bench {
namespace {

using polymesh::Discretization;
using std::numbers::pi;
using test::Polygons;

constexpr int source_count = 6;

/// Quads between parallels and meridians, triangles at the poles. With sectors = 2 rings, quads at the equator are square.
Polygons globe(Index rings, Index sectors) {
  Polygons mesh;
  const auto at = [&](Index ring, Index sector) { return 1 + (ring - 1) * sectors + sector % sectors; };
  mesh.positions.push_back({0, 0, 1});
  for (Index r = 1; r < rings; ++r)
    for (Index s = 0; s < sectors; ++s) {
      const double polar = pi * r / rings, turn = 2 * pi * s / sectors;
      mesh.positions.push_back({std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)});
    }
  const Index south = mesh.vertices();
  mesh.positions.push_back({0, 0, -1});
  for (Index s = 0; s < sectors; ++s) {
    mesh.add({0, at(1, s), at(1, s + 1)});
    mesh.add({south, at(rings - 1, s + 1), at(rings - 1, s)});
    for (Index r = 1; r + 1 < rings; ++r) mesh.add({at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1)});
  }
  return mesh;
}

/// The boundary loop of faces that form a disk.
std::vector<Index> outline(const Polygons& mesh, std::span<const Index> faces) {
  std::map<std::pair<Index, Index>, int> sides;
  for (Index f : faces) {
    const std::vector<Index> face = mesh.face(f);
    for (std::size_t c = 0; c < face.size(); ++c) {
      const Index a = face[c], b = face[(c + 1) % face.size()];
      if (sides.erase({b, a}) == 0) sides[{a, b}] = 1;
    }
  }
  std::map<Index, Index> next;
  for (const auto& [side, once] : sides) next[side.first] = side.second;
  std::vector<Index> result;
  for (Index a = next.begin()->first; result.empty() || a != result.front(); a = next[a]) result.push_back(a);
  return result;
}

/// A cube-sphere of 6 x side x side quads. Of each block of four quads, three are joined to an L of eight corners.
Polygons concave_sphere(Index side) {
  const Polygons quads = test::cube_sphere(side);
  Polygons mesh;
  mesh.positions = quads.positions;
  for (Index k = 0; k < 6 * side * side; ++k) {
    const Index x = k % side, y = k / side % side;
    if (x % 2 == 1 || y % 2 == 1) continue;
    mesh.add(outline(quads, std::array{k, k + 1, k + side}));
    mesh.add(quads.face(k + side + 1));
  }
  return mesh;
}

struct Errors {
  test::SphereError vectors;
  double distance_rms = 0, distance_hemisphere = 0;
};

/// Means over the sources; for `hemisphere` the largest errors over the sources.
Errors errors(const Polygons& mesh, const Surface& surface, const LogMapSolver& solver, Variant variant) {
  Errors mean;
  for (Index s = 0; s < source_count; ++s) {
    const Index p = 7 + s * (mesh.vertices() / source_count);
    const RowLogMap map = surface.to_rows(solver.solve(surface.source(Row(p)).source, {.variant = variant}));
    const Frame frame = *surface.graph().frame(surface.vertex(Row(p)).index);
    const test::SphereError e = test::sphere_error(mesh.positions, map.u, map.v, p, frame.x, frame.y);
    mean.vectors.rms += e.rms / source_count;
    mean.vectors.hemisphere = std::max(mean.vectors.hemisphere, e.hemisphere);
    mean.vectors.missing += e.missing;
    double squares = 0;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const double exact = test::sphere_distance(mesh.positions[p], mesh.positions[i]), off = map.distance[i] - exact;
      if (!std::isfinite(off)) continue;
      squares += off * off / mesh.vertices();
      if (exact < pi / 2) mean.distance_hemisphere = std::max(mean.distance_hemisphere, std::abs(off));
    }
    mean.distance_rms += std::sqrt(squares) / source_count;
  }
  return mean;
}

void measure(const char* name, const Polygons& mesh, Table& table) {
  for (Discretization how : {Discretization::refined, Discretization::polygons}) {
    const auto surface =
        polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners, {.discretization = how});
    const LogMapSolver solver(surface.graph());
    for (Variant variant : {Variant::adaptive, Variant::localized}) {
      const Errors e = errors(mesh, surface, solver, variant);
      table.add({name, mesh.vertices(), how == Discretization::refined ? "refined" : "polygons", to_string(variant),
                 e.vectors.rms, e.vectors.hemisphere, e.distance_rms, e.distance_hemisphere, e.vectors.missing});
    }
  }
}

}  // namespace

Table polygons(const Settings& settings) {
  Table table({"mesh", "vertices", "discretization", "variant", "rms", "largest, hemisphere", "distance rms",
               "distance, hemisphere", "missing"});
  for (Index k : settings.toy ? std::vector<Index>{1} : std::vector<Index>{2, 4, 8}) {
    measure("quads", test::cube_sphere(10 * k), table);
    measure("globe", globe(35 * k / 2, 35 * k), table);
    if (k == 8) continue;
    measure("globe, stretched along", globe(35 * k, 35 * k / 2), table);
    measure("globe, stretched across", globe(9 * k, 70 * k), table);
    measure("L and squares", concave_sphere(10 * k), table);
    measure("hexagons", test::dual_sphere(static_cast<Index>(5.5 * k)), table);
    measure("Voronoi cells", test::voronoi_sphere(1250 * k * k / 4), table);
  }
  const auto smallest = [&](const char* how, const char* number) {
    return table.where("discretization", how).smallest(number);
  };
  table.seen = fmt::format(
      "Least root mean square error of vectors / distances: refined {:.3f} / {:.3f}, polygons {:.3f} / {:.3f}.",
      smallest("refined", "rms"), smallest("refined", "distance rms"), smallest("polygons", "rms"),
      smallest("polygons", "distance rms"));
  return table;
}

}  // namespace ahm::bench
