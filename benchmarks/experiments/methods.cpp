// All methods on the same graphs of the unit sphere, compared with the closed form.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "experiments/comparison.hpp"
#include "methods/signed_heat.hpp"
#include "timing.hpp"

namespace ahm::bench {
namespace {

/// Sums of squared errors over the vertices within 0.9 pi of the sources.
struct SquareErrors {
  double distance = 0, angle = 0, map = 0;
  int count = 0;
  bool has_map = false;

  void add(const TangentGraph& graph, Index source, const methods::Result& result) {
    const Frame frame = *graph.frame(source);
    has_map = !result.coordinates.empty();
    for (Index i = 0; i < graph.size(); ++i) {
      const Vec2 exact = test::sphere_log(frame.origin, frame.x, frame.y, graph.frame(i)->origin);
      const double r = std::hypot(exact[0], exact[1]);
      if (i == source || r > 0.9 * std::numbers::pi) continue;
      ++count;
      distance += std::pow(result.distance[i] - r, 2);
      if (!has_map) continue;
      const double u = result.coordinates[2 * i], v = result.coordinates[2 * i + 1];
      map += std::pow(u - exact[0], 2) + std::pow(v - exact[1], 2);
      angle += std::pow(std::atan2(v * exact[0] - u * exact[1], u * exact[0] + v * exact[1]), 2);
    }
  }

  Cell rms(double sum) const { return Cell(std::sqrt(sum / count)); }
};

template <class Make>
void measure(std::string_view shape, const char* name, const TangentGraph& graph, Table& table, const Make& make) {
  methods::Method method;
  const double made = seconds([&] { method = make(); });
  SquareErrors errors;
  double additional = 0;
  const Index n = graph.size(), sources[] = {n / 7, n / 3, n / 2 + 7};
  for (Index source : sources) {
    methods::Result result;
    additional += seconds([&] { result = method->solve(source); }) / 3;
    errors.add(graph, source, result);
  }
  table.add({shape, n, name, errors.rms(errors.distance), errors.has_map ? errors.rms(errors.angle) : Cell(),
             errors.has_map ? errors.rms(errors.map) : Cell(), made, additional});
}

void measure_all(std::string_view shape, const TangentGraph& graph, Table& table) {
  using namespace ahm::methods;
  auto add = [&](const char* name, const auto& make) { measure(shape, name, graph, table, make); };
  add("AHM_a", [&] { return affine_heat(graph, Variant::adaptive); });
  add("AHM_l", [&] { return affine_heat(graph, Variant::localized); });
  add("VHM_log", [&] { return vector_heat_log(graph); });
  add("VHM_log, radial at the source", [&] { return vector_heat_log(graph, {.radial_at_source = true}); });
  add("SEM", [&] { return smoothed_exponential(graph); });
  add("SEM, t_coef 1", [&] { return smoothed_exponential(graph, 1.0); });
  add("DEM", [&] { return discrete_exponential(graph); });
  add("DEM, turned in space", [&] { return discrete_exponential(graph, {.turn = FrameTurn::in_space}); });
  add("HM (graph)", [&] { return heat_distance(graph); });
  add("SHM", [&]() -> methods::Method { return std::make_unique<SignedHeat>(graph); });
}

}  // namespace

Table methods_compared(const Settings& settings) {
  Table table({"shape", "vertices", "method", "distance", "angle", "map", "made s", "per source s"});
  for (Index n : settings.toy ? std::vector<Index>{642} : std::vector<Index>{10242, 40962}) {
    const Mesh mesh = split_icosphere(n);
    const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
    measure_all("icosphere", surface.graph(), table);
    measure("icosphere", "HM (faces)", surface.graph(), table, [&] { return methods::heat_distance(surface.mesh()); });
  }
  const auto cloud = pointcloud::PointCloudSurface::build(test::random_sphere(settings.toy ? 1000 : 10000).points);
  measure_all("random cloud", cloud.graph(), table);
  const Table clouds = table.where("shape", "random cloud");
  auto map = [&](const char* method) { return clouds.where("method", method).mean("map"); };
  table.seen = fmt::format(
      "Root mean square errors of the map of a random cloud: AHM_a {:.2g}, AHM_l {:.2g}, VHM_log {:.2g}, SEM {:.2g}.",
      map("AHM_a"), map("AHM_l"), map("VHM_log"), map("SEM"));
  return table;
}

}  // namespace ahm::bench
