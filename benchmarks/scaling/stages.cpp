// The stages of a log map from file to file: processor time of each, and a lower bound of the time on this machine.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "ahm/io/read.hpp"
#include "ahm/io/temporary_folder.hpp"
#include "ahm/io/write.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "heat/heat_system.hpp"
#include "scaling/sizes.hpp"
#include "shapes.hpp"
#include "speed.hpp"

namespace ahm::bench {
namespace {

// The lower bound counts bytes that are read and written once, at the speed of a copy, and the operations of the
// factorizations at the speed of arithmetic in registers. All else is free.
constexpr std::array stages{"read",
                            "graph",
                            "assemble",
                            "order and analyze",
                            "factor A",
                            "factor B",
                            "first map",
                            "additional adaptive",
                            "additional localized",
                            "write"};

/// Processor time of a stage, and the lower bound from its bytes or operations.
struct Cost {
  double seconds, least;
};

/// Median of five runs, or of three if a run takes longer than 1 s; a single run if it takes longer than 10 s.
template <class Work>
double median_seconds(const Work& work) {
  std::vector<double> times{cpu_seconds_of(work)};
  const std::size_t runs = times[0] < 1 ? 5 : times[0] < 10 ? 3 : 1;
  while (times.size() < runs) times.push_back(cpu_seconds_of(work));
  std::ranges::sort(times);
  return times[times.size() / 2];
}

template <class T>
double bytes(const std::vector<T>& values) {
  return static_cast<double>(sizeof(T) * values.size());
}

double bytes(const SparseUpper& K) { return bytes(K.column_begin) + bytes(K.rows) + bytes(K.values); }

double bytes(const CsrGraphData& g) {
  return bytes(g.row_begin) + bytes(g.neighbors) + bytes(g.weights) + bytes(g.logs) + bytes(g.transports) +
         bytes(g.masses) + bytes(g.frames);
}

/// The input of a surface, as arrays.
struct MeshInput {
  std::vector<Vec3> points;
  std::vector<Triangle> faces;

  explicit MeshInput(Index n) {
    Mesh mesh = split_icosphere(n);
    points = std::move(mesh.positions);
    faces = std::move(mesh.faces);
  }
  auto surface() const { return trimesh::TriangleMeshSurface::build(points, faces, {.threads = 1}); }
  double bytes() const { return bench::bytes(points) + bench::bytes(faces); }
};

struct CloudInput {
  std::vector<Vec3> points;
  std::vector<Triangle> faces;  ///< none

  explicit CloudInput(Index n) : points(test::random_sphere(n).points) {}
  auto surface() const { return pointcloud::PointCloudSurface::build(points, {}, {.threads = 1}); }
  double bytes() const { return bench::bytes(points); }
};

double file_bytes(const std::filesystem::path& path) { return static_cast<double>(std::filesystem::file_size(path)); }

/// Speeds of one thread: bytes of a copy and operations per second.
struct Speeds {
  double copy, arithmetic;
};

/// Measured in a process of its own, so that its arrays do not add to the memory of the stages.
Speeds measured_speeds() {
  const auto all = in_own_process(2, [] { return std::vector{copy_bandwidth(), arithmetic_speed()}; });
  return {all[0], all[1]};
}

/// Peak memory from points and faces to the first map, MB.
template <class Input>
double peak_to_first_map(Index n) {
  const Input input(n);
  const auto surface = input.surface();
  LogMapSolver(surface.graph(), {.strategy = Strategy::global, .threads = 1})
      .solve(surface.source(Row(0)).source, {.threads = 1});
  return peak_megabytes();
}

/// n, then processor time and lower bound of each stage, seconds.
template <class Input>
std::vector<double> measure(Index n, const Speeds& speeds) {
  const auto [copy, arithmetic] = speeds;
  const Input input(n);
  const io::TemporaryFolder folder("ahm_bench_");
  const std::filesystem::path file = folder.directory() / "input.ply";
  const auto rows = static_cast<Index>(input.points.size());
  std::vector<Offset> begin;
  std::vector<Index> corners;
  for (const Triangle& face : input.faces) {
    begin.push_back(static_cast<Offset>(corners.size()));
    corners.insert(corners.end(), face.begin(), face.end());
  }
  if (!input.faces.empty()) begin.push_back(static_cast<Offset>(corners.size()));
  io::Table table;
  table.add({"x", "y", "z"}, input.points);
  table.faces = {begin, corners};
  io::write(file, table);
  std::vector<double> numbers{static_cast<double>(rows)};
  const auto add = [&](double seconds, double least) { numbers.insert(numbers.end(), {seconds, least}); };

  add(median_seconds([&] { io::read(file); }), (file_bytes(file) + input.bytes()) / copy);

  const auto surface = input.surface();
  const CsrGraph& graph = surface.graph();
  add(median_seconds([&] { input.surface(); }), (input.bytes() + bytes(graph.data())) / copy);

  double factor_bytes = 0;
  {
    const double h = graph.mean_edge_length();
    const std::vector<double> tau(static_cast<std::size_t>(rows), h * h);
    const auto operators = [&] { return assemble(graph, tau, 1.0 / (h * h)); };
    AssembledOperators matrices = operators();
    const double both = bytes(matrices.A) + bytes(matrices.B);
    add(median_seconds(operators), (both + 28.0 * static_cast<double>(graph.edge_count()) + 16.0 * rows) / copy);
    const auto analyzed = [&] { return SymbolicCholesky(matrices.A); };
    add(median_seconds(analyzed), (bytes(matrices.A.column_begin) + bytes(matrices.A.rows)) / copy);
    const SymbolicCholesky symbolic = analyzed();
    const double flops = symbolic.operations();
    for (const bool scalar : {true, false}) {
      const auto factored = [&] { return CholeskyFactor(scalar ? matrices.A : matrices.B, symbolic, "benchmark"); };
      add(median_seconds(factored), (scalar ? 1 : 4) * flops / arithmetic);
      factor_bytes += static_cast<double>(factored().bytes());
    }
  }

  // Each map reads both factors at least once forwards and once backwards.
  const double solves = 2 * factor_bytes / copy;
  const LogMapSolver solver(graph, {.strategy = Strategy::global, .threads = 1});
  const Source source = surface.source(Row(0)).source;
  std::optional<LogMap> map;
  add(cpu_seconds_of([&] { map.emplace(solver.solve(source, {.threads = 1})); }), solves);
  for (const Variant variant : {Variant::adaptive, Variant::localized})
    add(median_seconds([&] { solver.solve(source, {.variant = variant, .threads = 1}); }), solves);

  table.add("distance", map->distances());
  table.add("status", map->status());
  const double columns = input.bytes() + 9.0 * rows;
  const double writing = median_seconds([&] { io::write(file, table); });
  add(writing, (columns + file_bytes(file)) / copy);
  return numbers;
}

template <class Input>
void add_rows(const char* shape, Index n, Table& table) {
  const Speeds speeds = measured_speeds();
  const std::vector<double> numbers = in_own_process(1 + 2 * stages.size(), [&] { return measure<Input>(n, speeds); });
  const double peak = in_own_process(1, [&] { return std::vector{peak_to_first_map<Input>(n)}; }).front();
  for (std::size_t s = 0; s < stages.size(); ++s) {
    const double time = numbers[1 + 2 * s], least = numbers[2 + 2 * s];
    table.add({shape, static_cast<Index>(numbers[0]), stages[s], time, least, time / least, peak, 1e-9 * speeds.copy,
               1e-9 * speeds.arithmetic});
  }
}

}  // namespace

Table stages_of_a_map(const Settings& settings) {
  Table table({"shape", "vertices", "stage", "cpu s", "least s", "times the least", "peak MB to the first map",
               "copy GB/s", "arithmetic GFlop/s"});
  for (const Index n : sizes(settings, 600, {10000, 40000, 160000, 640000})) {
    add_rows<MeshInput>("mesh", n, table);
    add_rows<CloudInput>("cloud", n, table);
  }
  const auto slowest = [&](const char* stage) { return table.where("stage", stage).largest("cpu s"); };
  table.seen = fmt::format(
      "{:.0f} vertices take {:.2g} s for the graph, {:.2g} s for both factors and {:.2g} s for each additional map, on "
      "one thread.",
      table.largest("vertices"), slowest("graph"), slowest("factor A") + slowest("factor B"),
      slowest("additional adaptive"));
  return table;
}

}  // namespace ahm::bench
