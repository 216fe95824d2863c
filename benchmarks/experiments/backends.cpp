// Cost and error of the same surface as triangles, as quads and as points; and the effect of orderings, threads, the march
// and neighbor searches.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "experiments/comparison.hpp"
#include "kernels/quads.hpp"
#include "timing.hpp"
#ifdef AHM_WITH_PCL
#include "ahm/pcl/search.hpp"
#endif

namespace ahm::bench {
namespace {

constexpr Vec3 u_direction{0.3, 0.5, 0.8};  // projected to the tangent plane of the source

/// The same vertices as quads, as triangles and as points.
struct Shape {
  std::string name;
  Quads quads;
  std::vector<Triangle> triangles;
};

Shape cut_at_random(std::string name, Quads quads) {
  Shape shape{std::move(name), std::move(quads), {}};
  std::mt19937 random(1);
  for (std::size_t c = 0; c < shape.quads.corners.size(); c += 4) {
    const Index* q = shape.quads.corners.data() + c;
    if (random() % 2)
      shape.triangles.insert(shape.triangles.end(), {{q[0], q[1], q[2]}, {q[0], q[2], q[3]}});
    else
      shape.triangles.insert(shape.triangles.end(), {{q[0], q[1], q[3]}, {q[1], q[2], q[3]}});
  }
  return shape;
}

/// The unit sphere with points jittered along it. `bumps` is the amplitude of waves of its radius.
Shape sphere(std::string name, Index n, double bumps) {
  const auto side = static_cast<Index>(std::lround(std::sqrt(n / 6.0)));
  const test::Polygons mesh = test::cube_sphere(side);
  Quads quads{mesh.positions, mesh.begin, mesh.corners};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.2 / side, 0.2 / side);
  for (Vec3& p : quads.points) {
    for (double& x : p) x += jitter(random);
    const double r = std::hypot(p[0], p[1], p[2]);
    for (double& x : p) x /= r;
    const double radius = 1 + bumps * std::sin(5 * p[0]) * std::sin(5 * p[1] + 1) * std::sin(5 * p[2] + 2);
    for (double& x : p) x *= radius;
  }
  return cut_at_random(std::move(name), std::move(quads));
}

Shape make_shape(const std::string& name, Index n) {
  if (name == "torus") return cut_at_random(name, quads_of(torus(n)));
  return sphere(name, n, name == "sphere" ? 0.0 : 0.1);
}

/// The settings of a run.
struct Setup {
  const char* name = "";
  unsigned threads = 0;
  Ordering ordering = Ordering::amd;
  Strategy strategy = Strategy::global;
  pointcloud::NeighborSearchFactory search = pointcloud::nanoflann_search;

  LogMapSolver solver(const TangentGraph& graph) const {
    return LogMapSolver(graph, {.strategy = strategy, .ordering = ordering, .threads = threads});
  }
};

/// (u, v) at every point.
struct PointLogs {
  std::vector<double> u, v;
};

/// The three backends with a common interface.
struct Triangles {
  static constexpr const char* name = "triangles";
  trimesh::TriangleMeshSurface surface;
  Triangles(const Shape& shape, const Setup& setup)
      : surface(trimesh::TriangleMeshSurface::build(shape.quads.points, shape.triangles, {.threads = setup.threads})) {}
  Source source(Index point) const { return surface.source(Row(point), u_direction).source; }
  auto on_points(const LogMap& map) const { return surface.to_rows(map); }
};

struct Quadrilaterals {
  static constexpr const char* name = "quads";
  polymesh::PolygonMeshSurface surface;
  Quadrilaterals(const Shape& shape, const Setup& setup)
      : surface(polymesh::PolygonMeshSurface::build(
            shape.quads.points, shape.quads.begin, shape.quads.corners,
            {.discretization = polymesh::Discretization::polygons, .threads = setup.threads})) {}
  Source source(Index point) const { return surface.source(Row(point), u_direction).source; }
  auto on_points(const LogMap& map) const { return surface.to_rows(map); }
};

struct Points {
  static constexpr const char* name = "points";
  pointcloud::PointCloudSurface surface;
  Points(const Shape& shape, const Setup& setup)
      : surface(pointcloud::PointCloudSurface::build(shape.quads.points, {},
                                                     {.search = setup.search, .threads = setup.threads})) {}
  Source source(Index point) const { return surface.source(Row(point), u_direction).source; }
  auto on_points(const LogMap& map) const { return surface.to_rows(map); }
};

// Errors.

/// Above this number of vertices, exact polyhedral distances take minutes and gigabytes.
constexpr std::size_t exact_up_to = 12000;

/// Exact distances from each source; empty where they are unknown.
using Exact = std::vector<std::vector<double>>;

std::vector<Index> sources_of(const Shape& shape) {
  const auto n = static_cast<Index>(shape.quads.points.size());
  return {n / 7, n / 2};
}

Exact exact_distances(const Shape& shape) {
  Exact exact;
  for (Index source : sources_of(shape)) {
    const Vec3& p = shape.quads.points[source];
    std::vector<double> distance;
    if (shape.name == "sphere")
      for (const Vec3& q : shape.quads.points) distance.push_back(test::sphere_distance(p, q));
#ifdef AHM_METHODS_CGAL
    else if (shape.quads.points.size() <= exact_up_to)
      distance = methods::exact_distance(shape.quads.points, shape.triangles)->solve(source).distance;
#endif
    exact.push_back(std::move(distance));
  }
  return exact;
}

struct Accuracy {
  double mean = NAN, median = NAN, most = NAN, largest = NAN;  ///< relative errors of distance, over all vertices
  double vector = NAN;  ///< rms of the vector error within 0.9 of the largest distance, over that distance
};

/// The sphere's log map of q from p, with the u axis of the sources.
Vec2 sphere_log(const Vec3& p, const Vec3& q) {
  const Vec3 x = unit(test::tangential(u_direction, p));
  return test::sphere_log(p, x, test::cross(p, x), q);
}

Accuracy accuracy(const Shape& shape, const Exact& exact, const std::vector<PointLogs>& maps) {
  std::vector<double> relative;
  double sum = 0, squares = 0, count = 0;
  const std::vector<Index> sources = sources_of(shape);
  const std::vector<Vec3>& points = shape.quads.points;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const auto source = static_cast<std::size_t>(sources[s]);
    const double farthest = exact[s].empty() ? 0 : std::ranges::max(exact[s]);
    for (std::size_t i = 0; i < exact[s].size(); ++i) {
      if (i == source) continue;
      const double u = maps[s].u[i], v = maps[s].v[i];
      relative.push_back(std::abs(std::hypot(u, v) / exact[s][i] - 1));
      sum += relative.back();
      if (shape.name != "sphere" || exact[s][i] > 0.9 * farthest) continue;
      const auto known = sphere_log(points[source], points[i]);
      squares += std::pow(std::hypot(u - known[0], v - known[1]) / farthest, 2);
      ++count;
    }
  }
  if (relative.empty()) return {};
  return {sum / static_cast<double>(relative.size()), quantile(relative, 0.5), quantile(relative, 0.95),
          std::ranges::max(relative), std::sqrt(squares / count)};
}

// Costs.

const std::vector<std::string> columns{"part",       "shape",        "as",          "vertices",         "choice",
                                       "mean error", "median error", "95% error",   "largest error",    "vector error",
                                       "build s",    "factor s",     "first map s", "additional map s", "batch s each",
                                       "factors MB", "peak MB"};

/// Adds one row: one shape, one backend and one setup.
template <class Backend>
void measure(const char* part, const Shape& shape, const Exact& exact, const Setup& setup, Table& table) {
  const MapOptions options{.threads = setup.threads};
  const double peak = added_megabytes([&] {
    const Backend backend(shape, setup);
    setup.solver(backend.surface.graph()).solve(backend.source(0), options);
  });
  std::optional<Backend> backend;
  std::optional<LogMapSolver> solver;
  const double build = min_seconds([&] { backend.emplace(shape, setup); });
  const double factor = min_seconds([&] { solver.emplace(setup.solver(backend->surface.graph())); });
  std::vector<Source> sources;
  std::vector<PointLogs> logs;
  for (Index point : sources_of(shape)) {
    sources.push_back(backend->source(point));
    const auto map = backend->on_points(solver->solve(sources.back(), options));
    logs.push_back({map.u, map.v});
  }
  const double additional = min_seconds([&] { solver->solve(sources[0], options); });
  const bool global = setup.strategy == Strategy::global;  // the march has no factors, and a batch saves nothing
  while (sources.size() < 32) sources.push_back(sources[sources.size() - 2]);
  const Cell batch = global ? Cell(min_seconds([&] { solver->solve(sources, options); }) / 32) : Cell();
  const Accuracy error = accuracy(shape, exact, logs);
  table.add({part, shape.name, Backend::name, static_cast<Index>(shape.quads.points.size()), setup.name,
             known(error.mean), known(error.median), known(error.most), known(error.largest), known(error.vector),
             build, factor, factor + additional, additional, batch,
             global ? Cell(1e-6 * static_cast<double>(solver->operators().statistics().bytes)) : Cell(), known(peak)});
}

void compare_setups(Index n, Table& table, unsigned threads) {
  const Shape shape = make_shape("torus", n);
  const Exact unknown(sources_of(shape).size());
  auto both = [&](const char* part, const Setup& setup) {
    measure<Triangles>(part, shape, unknown, setup, table);
    measure<Points>(part, shape, unknown, setup, table);
  };
  both("ordering", {"amd", threads, Ordering::amd});
  both("ordering", {"nested dissection", threads, Ordering::nested_dissection});
  both("threads", {"1", 1});
  both("threads", {"2", 2});
  both("strategy", {"global", threads, Ordering::amd, Strategy::global});
  both("strategy", {"march", threads, Ordering::amd, Strategy::march});
  std::vector<std::pair<const char*, pointcloud::NeighborSearchFactory>> searches{
      {"nanoflann", pointcloud::nanoflann_search}, {"FLANN", pointcloud::flann_search}};
#ifdef AHM_WITH_PCL
  searches.emplace_back("PCL", pcl_bridge::kdtree_search);
#endif
  for (const auto& [name, search] : searches) try {
      measure<Points>("search", shape, unknown, {name, threads, Ordering::amd, Strategy::global, search}, table);
    } catch (const InvalidArgument&) {  // this build does not contain the search
    }
}

}  // namespace

Table backends(const Settings& settings) {
  Table table(columns);
  const std::vector<Index> sizes =
      settings.toy ? std::vector<Index>{400, 1300} : std::vector<Index>{2400, 10000, 40000};
  std::string largest;  // number of points of the largest sphere
  for (const char* name : {"torus", "bumpy sphere", "sphere"})
    for (Index n : sizes) {
      const Shape shape = make_shape(name, n);
      const Exact exact = exact_distances(shape);
      const Setup setup{"", settings.threads};
      measure<Triangles>("backend", shape, exact, setup, table);
      measure<Quadrilaterals>("backend", shape, exact, setup, table);
      measure<Points>("backend", shape, exact, setup, table);
      largest = std::to_string(shape.quads.points.size());
    }
  compare_setups(settings.toy ? 1300 : 160000, table, settings.threads);
  for (const char* as : {"triangles", "quads", "points"}) {
    const Table rows = table.where("shape", "sphere").where("vertices", largest).where("as", as);
    table.seen +=
        fmt::format("{}{}: median error of distance {:.2g}, first map after {:.2g} s, each additional one {:.2g} s",
                    table.seen.empty() ? "Sphere, " + largest + " vertices: " : "; ", as, rows.mean("median error"),
                    rows.mean("build s") + rows.mean("first map s"), rows.mean("additional map s"));
  }
  table.seen += fmt::format(". Registers: {}.", register_set());
  return table;
}

}  // namespace ahm::bench
