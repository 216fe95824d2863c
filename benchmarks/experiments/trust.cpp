// Vectors and distances of polar maps and of maps by heat compared with exact ones, and the share of right vectors among
// those of high quality.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/exact/exact_map.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "experiments/comparison.hpp"
#include "measure.hpp"

namespace ahm::bench {
namespace {

using Complex = std::complex<double>;
constexpr int source_count = 5;
constexpr Index largest_mesh = 200'000;
/// A vector is right if its error is less than this share of the distance.
constexpr double right = 0.1;
/// Standard deviation of the coordinates of noisy points, in mean edge lengths.
constexpr double noise = 0.2;

/// The errors of one map, with one entry per compared vertex.
struct MapErrors {
  std::vector<double> vector_error, distance_error;  ///< relative to the distance
  std::vector<double> quality;
};

/// The surface on which exact maps are computed.
struct GroundTruth {
  std::string name;
  const exact::PolyhedralSurface& polyhedral;
  double unit;       ///< length unit of `polyhedral`, world units
  double mean_edge;  ///< world units
};

/// A discretization of the same surface: the compared points on the ground, and the row of the k-th one.
struct ComparedSurface {
  std::string name;
  const ahm::Surface& surface;
  const std::vector<exact::MeshPoint>& points;
  std::function<Row(Index k)> row;

  Index size() const { return static_cast<Index>(points.size()); }
  Vertex vertex(Index k) const { return surface.vertex(row(k)); }
};

/// Leaves out vertices nearer than two edges or 3 % of the largest distance, where vectors are short and edges few.
MapErrors compare(const GroundTruth& ground, const exact::ExactMap& truth, const ComparedSurface& view,
                  const LogMap& map) {
  const std::vector<double> quality = map_quality(view.surface.graph(), map);
  double farthest = 0;
  for (std::size_t k = 0; k < truth.targets(); ++k)
    if (truth.target_status(k) == Status::ok) farthest = std::max(farthest, ground.unit * truth.target_distance(k));
  const double near = std::max(2 * ground.mean_edge, 0.03 * farthest);
  std::vector<Complex> exact, ours;
  MapErrors found;
  for (Index k = 0; k < view.size(); ++k) {
    const Vertex v = view.vertex(k);
    const double d = ground.unit * truth.target_distance(k);
    if (map.status(v) != Status::ok || !(d > near)) continue;
    const Vec2 vector = truth.target_coordinates(k);
    exact.emplace_back(ground.unit * vector[0], ground.unit * vector[1]);
    ours.emplace_back(map.coordinates(v)[0], map.coordinates(v)[1]);
    found.distance_error.push_back(std::abs(map.distance(v) - d) / d);
    found.quality.push_back(quality[v.index]);
  }
  found.vector_error = relative_errors(ours, exact);
  return found;
}

/// Area under the curve: how often, in a pair of a right and a wrong vector, the right one has the higher quality. Empty if
/// all vectors are right or all are wrong.
std::optional<double> area_under_curve(const MapErrors& found) {
  std::vector<std::size_t> order(found.quality.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return found.quality[a] > found.quality[b]; });
  double above = 0, wrong = 0, right_ones = 0;
  for (std::size_t k : order) {
    if (found.vector_error[k] < right)
      ++right_ones, above += wrong;
    else
      ++wrong;
  }
  return right_ones > 0 && wrong > 0 ? std::optional(1 - above / (right_ones * wrong)) : std::nullopt;
}

/// Shares of the vectors: right ones, those of quality >= `reliable_quality`, and the right ones among the latter.
struct Shares {
  double right, kept, right_among_kept;
};

Shares shares_of(const MapErrors& found) {
  double right_ones = 0, kept = 0, both = 0;
  for (std::size_t k = 0; k < found.quality.size(); ++k) {
    const bool is_right = found.vector_error[k] < right, is_kept = found.quality[k] >= reliable_quality;
    right_ones += is_right, kept += is_kept, both += is_right && is_kept;
  }
  const auto all = static_cast<double>(found.quality.size());
  return {right_ones / all, kept / all, kept > 0 ? both / kept : 1};
}

void append(MapErrors& all, const MapErrors& one) {
  all.vector_error.insert(all.vector_error.end(), one.vector_error.begin(), one.vector_error.end());
  all.distance_error.insert(all.distance_error.end(), one.distance_error.begin(), one.distance_error.end());
  all.quality.insert(all.quality.end(), one.quality.begin(), one.quality.end());
}

void measure(const GroundTruth& ground, const ComparedSurface& view, Table& table) {
  const PolarMapSolver polar(view.surface);
  const LogMapSolver heat(view.surface.graph());
  const Index size = view.size();
  std::vector<Index> sources;
  std::vector<exact::ExactMap> truths;
  for (int s = 0; s < source_count; ++s) {
    sources.push_back(size / 11 + s * (size / source_count));
    truths.push_back(exact::exact_map(ground.polyhedral, view.points[sources.back()], {.targets = view.points}));
  }
  for (const Method method : {Method::polar, Method::heat}) {
    MapErrors all;
    double worst = 1, time = 0;
    for (int s = 0; s < source_count; ++s) {
      const Index source = sources[s];
      std::optional<LogMap> map;
      time += seconds([&] {
        map = method == Method::polar ? polar.log_map(view.row(source))
                                      : heat.solve(view.surface.source(view.row(source)).source, {.threads = 1});
      });
      const MapErrors found = compare(ground, truths[s], view, *map);
      if (found.quality.empty()) continue;
      worst = std::min(worst, shares_of(found).right_among_kept);
      append(all, found);
    }
    if (all.quality.empty()) continue;
    const auto [is_right, kept, right_among_kept] = shares_of(all);
    const auto area = area_under_curve(all);
    table.add({ground.name, view.name, size, std::string(to_string(method)), quantile(all.vector_error, 0.5),
               quantile(all.vector_error, 0.95), quantile(all.distance_error, 0.95), is_right,
               area ? Cell(*area) : Cell(), kept, right_among_kept, worst, 1e3 * time / source_count});
  }
}

/// Measures points as a cloud, if no point is removed or merged.
void measure_points(const GroundTruth& ground, std::string name, std::span<const Vec3> points,
                    const std::vector<exact::MeshPoint>& on_ground, Table& table) {
  const auto cloud = pointcloud::PointCloudSurface::build(points);
  if (cloud.graph().size() != std::ssize(points))
    return fmt::print(stderr, "left out: {} as {}: {} of {} points are vertices of the graph\n", ground.name, name,
                      cloud.graph().size(), points.size());
  measure(ground, {std::move(name), cloud, on_ground, [](Index k) { return Row(k); }}, table);
}

/// Noise also moves points along the surface, so the exact values are those of the nearest point of the mesh.
void measure_noisy_points(const GroundTruth& ground, const Surface& surface, Table& table) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> off(0, noise * surface.mean_edge());
  std::vector<Vec3> noisy(surface.points().begin(), surface.points().end());
  for (Vec3& p : noisy)
    for (double& x : p) x += off(random);
  const ExactGeodesics geodesics(surface.mesh());
  std::vector<exact::MeshPoint> nearest;
  for (const Vec3& p : noisy) nearest.push_back(geodesics.point(surface.mesh().closest_point(p).point));
  measure_points(ground, fmt::format("points, noise {}", noise), noisy, nearest, table);
}

void measure(const Surface& surface, Table& table) {
  const exact::PolyhedralSurface polyhedral = surface.polyhedron();
  const GroundTruth ground{surface.name(), polyhedral, surface.graph().length_unit(), surface.mean_edge()};
  std::vector<exact::MeshPoint> vertices;
  for (Index i = 0; i < surface.size(); ++i) vertices.push_back(polyhedral.vertex_point(Vertex(i)));
  measure(ground,
          {"triangles", surface.mesh(), vertices, [&](Index k) { return *surface.mesh().rows().row(Vertex(k)); }},
          table);
  measure_points(ground, "points", surface.points(), vertices, table);
  measure_noisy_points(ground, surface, table);
}

/// Measures a polygon mesh, refined and as polygons. Exact maps use the triangles of the refinement.
void measure(const NamedPolygons& mesh, Table& table) {
  using polymesh::Discretization;
  const auto build = [&](Discretization how) {
    return polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners,
                                               {.discretization = how, .non_manifold = NonManifold::split});
  };
  const auto refined = build(Discretization::refined), polygons = build(Discretization::polygons);
  const FlatTriangles flat = refined.flat_triangles();
  const GroundTruth ground{mesh.name, flat.surface, flat.length_unit,
                           refined.graph().mean_edge_length() * refined.graph().length_unit()};
  std::vector<Row> rows;
  std::vector<exact::MeshPoint> vertices;
  for (Index r = 0; r < mesh.vertices(); ++r)
    if (const auto vertex = refined.rows().vertex(Row(r)); vertex && polygons.rows().vertex(Row(r))) {
      rows.emplace_back(r);
      vertices.push_back(flat.surface.vertex_point(*vertex));
    }
  for (const auto& [name, surface] : {std::pair{"refined", &refined}, std::pair{"polygons", &polygons}})
    measure(ground, {name, *surface, vertices, [&](Index k) { return rows[k]; }}, table);
}

}  // namespace

Table trust(const Settings& settings) {
  Table table({"mesh", "as", "vertices", "method", "vector 50%", "vector 95%", "distance 95%", "right",
               "area under curve", "kept", "right among kept", "right among kept, worst map", "ms a map"});
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
  const UserSurfaces user = user_surfaces(settings, largest_mesh);
  for (const NamedMesh& mesh : user.triangles)
    run_or_leave_out(mesh.name, [&] { measure(Surface(mesh.name, mesh), table); });
  for (const NamedPolygons& mesh : user.polygons) run_or_leave_out(mesh.name, [&] { measure(mesh, table); });
  table.seen = vector_error_summary(table);
  return table;
}

}  // namespace ahm::bench
