// Distances and vectors against exact ones, and how well the quality tells the right vectors from the wrong ones.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>

#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_map.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/testing/triangle_meshes.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

using Complex = std::complex<double>;
constexpr int source_count = 3;
/// A vector is right when it is off by less than this share of the distance.
constexpr double right = 0.1;

/// Of all vertices and sources together.
struct Found {
  std::vector<double> length_error, distance_error;  ///< relative: |phi|, and the distance
  std::vector<double> quality, by_length;            ///< the second compares |phi| with the distance instead of vectors
  std::vector<char> is_right;
};

/// Where exact maps run, and which of its vertices are compared.
struct Ground {
  std::string name;
  const exact::PolyhedralSurface& polyhedral;
  double unit;       ///< of its lengths
  double mean_edge;  ///< world units
  std::vector<Vertex> vertices;
};

/// A graph of the same surface, and which of its vertices is the k-th that is compared.
struct View {
  std::string name;
  const TangentGraph& graph;
  std::function<Vertex(Index k)> vertex;
};

/// Vertices nearer than two edges are left out: there the vectors are short and the edges few.
void compare(const Ground& ground, const exact::ExactMap& truth, const View& view, const LogMap& map, Found& found) {
  const double unit = ground.unit, near = 2 * ground.mean_edge;
  const std::vector<double> quality = map_quality(view.graph, map);
  std::vector<Complex> exact, ours;
  std::vector<std::size_t> vertices;
  for (Index k = 0; k < std::ssize(ground.vertices); ++k) {
    const Vertex own = ground.vertices[k], v = view.vertex(k);
    if (map.status(v) != Status::ok || !(truth.distance(own) * unit > near)) continue;
    vertices.push_back(static_cast<std::size_t>(v.index));
    exact.emplace_back(unit * truth.coordinates(own)[0], unit * truth.coordinates(own)[1]);
    ours.emplace_back(map.coordinates(v)[0], map.coordinates(v)[1]);
  }
  // The axes of the two differ by a turn, and those of points perhaps by a reflection: what fits best near the source.
  std::vector<double> away;
  for (Complex z : exact) away.push_back(std::abs(z));
  const double third = away.empty() ? 0 : quantile(away, 0.3);
  Complex turn = 0, turn_back = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    if (!(away[k] < third)) continue;
    turn += ours[k] * std::conj(exact[k]);
    turn_back += ours[k] * exact[k];
  }
  if (std::abs(turn_back) > std::abs(turn)) {
    turn = turn_back;
    for (Complex& z : exact) z = std::conj(z);
  }
  turn /= std::abs(turn);
  for (std::size_t k = 0; k < exact.size(); ++k) {
    found.length_error.push_back(std::abs(std::abs(ours[k]) - away[k]) / away[k]);
    found.distance_error.push_back(std::abs(map.distances()[vertices[k]] - away[k]) / away[k]);
    found.quality.push_back(quality[vertices[k]]);
    const double d = map.distances()[vertices[k]],
                 by_length = std::hypot(map.spread()[vertices[k]] / 0.3, (std::abs(ours[k]) - d) / 0.1) / d;
    found.by_length.push_back(1 / (1 + by_length * by_length));
    found.is_right.push_back(std::abs(ours[k] - turn * exact[k]) < right * away[k]);
  }
}

/// Shares of the wrong ones that are trusted, at which the curve of the right ones is told.
constexpr std::array wrong_shares{0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7};

/// Receiver operating characteristic of a quality: of the right ones, those that are trusted where so many of the wrong ones are.
struct Curve {
  double area;                                      ///< how often a right vertex has the higher quality of a pair
  std::array<double, wrong_shares.size()> trusted;  ///< shares of the right ones
};

/// Nothing where all are of one kind.
std::optional<Curve> curve_of(std::span<const double> quality, const Found& found) {
  std::vector<std::size_t> order(quality.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return quality[a] > quality[b]; });
  const auto all = static_cast<double>(order.size());
  const auto all_right = static_cast<double>(std::count(found.is_right.begin(), found.is_right.end(), 1));
  if (all_right == 0 || all_right == all) return std::nullopt;
  Curve curve{};
  double above = 0, wrong = 0, right_ones = 0;
  std::size_t share = 0;
  for (std::size_t k : order) {
    if (found.is_right[k]) {
      ++right_ones;
      above += all - all_right - wrong;
      continue;
    }
    ++wrong;
    while (share < wrong_shares.size() && wrong > wrong_shares[share] * (all - all_right))
      curve.trusted[share++] = right_ones / all_right;
  }
  curve.area = above / (all_right * (all - all_right));
  return curve;
}

void measure(const Ground& ground, const View& view, Table& table) {
  const auto size = static_cast<Index>(ground.vertices.size());
  for (Variant variant : all_variants) {
    const LogMapSolver solver(view.graph, {.variant = variant});
    Found found;
    for (int s = 0; s < source_count; ++s) {
      const Index source = size / 11 + s * (size / source_count);
      compare(ground, exact::exact_map(ground.polyhedral, ground.polyhedral.vertex_point(ground.vertices[source])),
              view, solver.solve(Source::at_vertex(view.vertex(source))), found);
    }
    const auto count = static_cast<double>(found.quality.size());
    const double all_right = static_cast<double>(std::count(found.is_right.begin(), found.is_right.end(), 1));
    std::vector<Cell> row{ground.name,
                          view.name,
                          size,
                          std::string(to_string(variant)),
                          mean(found.distance_error),
                          quantile(found.distance_error, 0.95),
                          quantile(found.distance_error, 1),
                          mean(found.length_error),
                          quantile(found.length_error, 0.95),
                          quantile(found.length_error, 1),
                          all_right / count};
    for (const auto* quality : {&found.quality, &found.by_length}) {
      double trusted = 0, right_trusted = 0;
      for (std::size_t k = 0; k < quality->size(); ++k) {
        const bool is_trusted = (*quality)[k] >= trusted_quality;
        trusted += is_trusted;
        right_trusted += is_trusted && found.is_right[k];
      }
      const auto curve = curve_of(*quality, found);
      row.push_back(curve ? Cell(curve->area) : Cell());
      row.push_back(trusted / count);
      row.push_back(trusted > 0 ? Cell(right_trusted / trusted) : Cell());
      for (std::size_t k = 0; k < wrong_shares.size(); ++k) row.push_back(curve ? Cell(curve->trusted[k]) : Cell());
    }
    table.add(std::move(row));
  }
}

/// As triangles, and where no vertex is dropped or joined to another, its vertices as points.
void measure(const Surface& surface, Table& table) {
  const exact::PolyhedralSurface polyhedral = surface.polyhedron();
  Ground ground{surface.name(), polyhedral, surface.graph().length_unit(), surface.mean_edge(), {}};
  for (Index i = 0; i < surface.size(); ++i) ground.vertices.emplace_back(i);
  measure(ground, {"triangles", surface.graph(), [](Index k) { return Vertex(k); }}, table);
  const auto cloud = pointcloud::PointCloudSurface::build(surface.points());
  if (cloud.graph().size() != surface.size()) return;
  measure(ground, {"points", cloud.graph(), [&](Index k) { return *cloud.rows().vertex(Row(k)); }}, table);
}

/// Refined, and as polygons. Exact maps run over the triangles of the refinement.
void measure(const NamedPolygons& mesh, Table& table) {
  using polymesh::Discretization;
  const auto build = [&](Discretization how) {
    return polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners,
                                               {.discretization = how, .non_manifold = NonManifold::split});
  };
  const auto refined = build(Discretization::refined), polygons = build(Discretization::polygons);
  const FlatTriangles flat = refined.flat_triangles();
  Ground ground{mesh.name,
                flat.surface,
                flat.length_unit,
                refined.graph().mean_edge_length() * refined.graph().length_unit(),
                {}};
  std::vector<Row> rows;
  for (Index r = 0; r < mesh.vertices(); ++r)
    if (const auto vertex = refined.rows().vertex(Row(r)); vertex && polygons.rows().vertex(Row(r))) {
      rows.emplace_back(r);
      ground.vertices.push_back(*vertex);
    }
  for (const auto& [name, surface] : {std::pair{"refined", &refined}, std::pair{"polygons", &polygons}})
    measure(ground, {name, surface->graph(), [&](Index k) { return *surface->rows().vertex(rows[k]); }}, table);
}

}  // namespace

Table trust(const Settings& settings) {
  std::vector<std::string> columns{"mesh",          "as",           "vertices",     "variant",
                                   "distance mean", "distance 95%", "distance max", "|phi| mean",
                                   "|phi| 95%",     "|phi| max",    "right"};
  for (const char* by : {"", ", by length"}) {
    for (const char* name : {"area under curve", "trusted", "right among trusted"})
      columns.push_back(fmt::format("{}{}", name, by));
    for (double share : wrong_shares) columns.push_back(fmt::format("right at {} of wrong{}", share, by));
  }
  Table table(columns);
  const Index n = settings.toy ? 640 : 10000;
  measure(Surface("sphere", test::split_icosphere(n)), table);
  measure(Surface("torus", torus(n)), table);
  for (double degrees : {60.0, 150.0, 250.0, 320.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    measure(Surface(fmt::format("cone {:.0f}", degrees), cone(angle, static_cast<int>(std::sqrt(2 * n / angle)))),
            table);
  }
  measure(NamedPolygons{test::cube_sphere(static_cast<Index>(std::sqrt(n / 6.0))), "sphere of quads"}, table);
  measure(NamedPolygons{test::voronoi_sphere(n / 2), "sphere of Voronoi cells"}, table);
  for_user_surfaces(settings, 60000, [&](const Surface& surface) { measure(surface, table); });
  for (const NamedPolygons& mesh : user_polygons(settings, 60000)) try {
      measure(mesh, table);
    } catch (const Error& e) {
      fmt::print(stderr, "left out: {}: {}\n", mesh.name, e.what());
    }
  table.seen = fmt::format("95th percentile of the relative error, medians over meshes: distance {:.3f}, |phi| {:.2f}.",
                           quantile(table.numbers("distance 95%"), 0.5), quantile(table.numbers("|phi| 95%"), 0.5));
  return table;
}

}  // namespace ahm::bench
