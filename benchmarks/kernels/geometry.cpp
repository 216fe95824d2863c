// From geometry to graph, step by step: intrinsic flips, logarithms and transports, the local triangulations of clouds.
#include <benchmark/benchmark.h>

#include <memory>
#include <numeric>

#include "backends/pointcloud/src/clean_points.hpp"
#include "backends/pointcloud/src/local_delaunay.hpp"
#include "backends/pointcloud/src/tangent_edges.hpp"
#include "backends/pointcloud/src/tangent_planes.hpp"
#include "backends/pointcloud/src/tufted_cover.hpp"
#include "backends/polymesh/src/polygon.hpp"
#include "backends/trimesh/src/intrinsic_triangulation.hpp"
#include "backends/trimesh/src/vertex_frames.hpp"
#include "graphs.hpp"
#include "machine.hpp"
#include "quads.hpp"

namespace {

using ahm::Index, ahm::bench::Mesh, ahm::bench::report_bandwidth, ahm::bench::run;

void report_points(benchmark::State& state, double points) {
  state.counters["points/s"] = benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate);
}

/// Bytes of the edges and masses of a graph.
double bytes(const ahm::CsrGraphData& g) {
  return 8.0 * static_cast<double>(g.row_begin.size() + g.weights.size() + g.logs.size() + g.transports.size() +
                                   g.masses.size()) +
         4.0 * static_cast<double>(g.neighbors.size());
}

// Triangle meshes.

ahm::trimesh::TriangleMesh checked(const Mesh& mesh) {
  return ahm::trimesh::TriangleMesh::from_positions(mesh.positions, mesh.faces);
}

void mesh_flips(benchmark::State& state) {
  const auto mesh = checked(ahm::bench::torus_mesh(static_cast<Index>(state.range(0))));
  std::size_t flips = 0;
  for (auto _ : state) {
    state.PauseTiming();
    auto triangulation = std::make_unique<ahm::trimesh::IntrinsicTriangulation>(mesh, false, 1);
    state.ResumeTiming();
    triangulation->flip_to_delaunay(1, {});
    state.PauseTiming();
    flips = triangulation->history().size();
    triangulation.reset();
    state.ResumeTiming();
  }
  state.counters["flips/s"] =
      benchmark::Counter(static_cast<double>(flips), benchmark::Counter::kIsIterationInvariantRate);
  report_points(state, mesh.vertex_count());
}

void mesh_frames(benchmark::State& state) {
  const auto mesh = checked(ahm::bench::torus_mesh(static_cast<Index>(state.range(0))));
  ahm::trimesh::IntrinsicTriangulation triangulation(mesh, false, 1);
  triangulation.flip_to_delaunay(1, {});
  for (auto _ : state) benchmark::DoNotOptimize(ahm::trimesh::find_frames(mesh, triangulation, 1));
  report_points(state, mesh.vertex_count());
}

/// Bytes of traffic: the result, and the layouts and angles that are read.
void mesh_logs_transports(benchmark::State& state) {
  const auto mesh = checked(ahm::bench::torus_mesh(static_cast<Index>(state.range(0))));
  ahm::trimesh::IntrinsicTriangulation triangulation(mesh, false, 1);
  triangulation.flip_to_delaunay(1, {});
  const ahm::trimesh::VertexFrames frames = ahm::trimesh::find_frames(mesh, triangulation, 1);
  ahm::trimesh::MeshDetails report;
  auto work = [&] { return ahm::trimesh::mesh_edges(mesh, triangulation, frames, true, 1, report); };
  const double seconds = run(state, [&] { benchmark::DoNotOptimize(work()); });
  const ahm::CsrGraphData g = work();
  report_points(state, mesh.vertex_count());
  report_bandwidth(state, bytes(g) + 32.0 * static_cast<double>(g.neighbors.size()), seconds);
}

// Polygon meshes: the quads of the torus.

void polygon_logs_transports(benchmark::State& state) {
  const auto quads = ahm::bench::quads_of(ahm::bench::torus_mesh(static_cast<Index>(state.range(0))));
  const auto mesh = ahm::polymesh::PolygonMesh::from_faces(quads.points, quads.begin, quads.corners);
  const ahm::polymesh::Frames frames = ahm::polymesh::find_frames(mesh, 1);
  ahm::polymesh::PolygonDetails report;
  auto work = [&] { return ahm::polymesh::polygon_edges(mesh, frames, {.threads = 1}, report); };
  const double seconds = run(state, [&] { benchmark::DoNotOptimize(work()); });
  report_points(state, mesh.vertex_count());
  report_bandwidth(state, bytes(work()) + 100.0 * static_cast<double>(quads.corners.size()), seconds);
}

// Clouds.

/// All steps from points to edges.
struct CloudSteps {
  ahm::pointcloud::CloudOptions options{.threads = 1};
  ahm::pointcloud::CloudDetails report;
  ahm::pointcloud::CleanPoints cloud;
  std::unique_ptr<ahm::pointcloud::NeighborSearch> search;
  ahm::pointcloud::Neighborhoods neighborhoods;
  ahm::pointcloud::TangentPlanes planes;
  std::unique_ptr<const ahm::pointcloud::CloudParts> parts;
  double noise = 0;
  std::vector<ahm::Triangle> triangles;
  ahm::pointcloud::WeightedEdges edges;
  std::vector<Index> vertices;

  explicit CloudSteps(const std::vector<ahm::Vec3>& points)
      : cloud(clean_points(
            points, [](std::size_t i) { return static_cast<Index>(i); }, options, report)) {
    search = options.search(cloud.points);
    find_neighbors();
    parts = std::make_unique<const ahm::pointcloud::CloudParts>(neighborhoods);
    find_planes();
    triangulate();
    weigh();
    vertices.resize(cloud.points.size());
    std::iota(vertices.begin(), vertices.end(), 0);
  }
  void find_neighbors() { neighborhoods = find_neighborhoods(cloud, *search, 30, options); }
  void find_planes() { planes = find_tangent_planes(cloud, {}, *search, neighborhoods, options); }
  void triangulate() { triangles = local_delaunay(cloud, neighborhoods, planes, false, noise, options, report); }
  void weigh() { edges = tufted_laplacian(cloud, planes, triangles, *parts, 1, report); }
  ahm::CsrGraphData join() { return tangent_edges(cloud, planes, edges, vertices, size(), true, noise, 1, report); }
  Index size() const { return static_cast<Index>(cloud.points.size()); }
};

CloudSteps& steps(Index n) {
  static std::unique_ptr<CloudSteps> kept;
  if (!kept || kept->size() != n) kept = std::make_unique<CloudSteps>(ahm::bench::sphere_points(n));
  return *kept;
}

void cloud_step(benchmark::State& state, void (CloudSteps::*step)()) {
  CloudSteps& cloud = steps(static_cast<Index>(state.range(0)));
  for (auto _ : state) (cloud.*step)();
  report_points(state, cloud.size());
}

/// Bytes of traffic: the result, the edges, and a point and a normal at both ends of each edge.
void cloud_logs_transports(benchmark::State& state) {
  CloudSteps& cloud = steps(static_cast<Index>(state.range(0)));
  const double seconds = run(state, [&] { benchmark::DoNotOptimize(cloud.join()); });
  report_points(state, cloud.size());
  report_bandwidth(state, bytes(cloud.join()) + (16.0 + 2 * 48.0) * static_cast<double>(cloud.edges.tails.size()),
                   seconds);
}

void add_sizes(benchmark::internal::Benchmark* kernel) {
  kernel->ArgName("n")->Arg(2500)->Arg(40000)->Arg(160000)->Unit(benchmark::kMillisecond);
}

BENCHMARK(mesh_flips)->Apply(add_sizes);
BENCHMARK(mesh_frames)->Apply(add_sizes);
BENCHMARK(mesh_logs_transports)->Apply(add_sizes);
BENCHMARK(polygon_logs_transports)->Apply(add_sizes);
BENCHMARK_CAPTURE(cloud_step, neighbors, &CloudSteps::find_neighbors)->Apply(add_sizes);
BENCHMARK_CAPTURE(cloud_step, tangent_planes, &CloudSteps::find_planes)->Apply(add_sizes);
BENCHMARK_CAPTURE(cloud_step, local_delaunay, &CloudSteps::triangulate)->Apply(add_sizes);
BENCHMARK_CAPTURE(cloud_step, tufted_laplacian, &CloudSteps::weigh)->Apply(add_sizes);
BENCHMARK(cloud_logs_transports)->Apply(add_sizes);

}  // namespace
