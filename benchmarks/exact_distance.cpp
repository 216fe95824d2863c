// Distances of the log map against CGAL's exact polyhedral geodesics: bench_exact_distance MESH ...
//
// Relative errors of |phi| over the vertices within a quarter, a half and the whole of the largest distance, from three
// vertices spread over the mesh. The rows are Markdown.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "ahm/io/read.hpp"
#include "ahm/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_graph.hpp"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Geodesics = CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Surface>>;

std::vector<double> exact_distances(const Surface& surface, ahm::Index source) {
  Geodesics geodesics(surface);
  geodesics.add_source_point(Surface::Vertex_index(static_cast<unsigned>(source)));
  std::vector<double> distances;
  for (const auto vertex : surface.vertices())
    distances.push_back(geodesics.shortest_distance_to_source_points(vertex).first);
  return distances;
}

struct Relative {
  double mean = 0, median = 0, largest = 0;
};

Relative relative_error(const std::vector<double>& exact, const std::vector<double>& distance, double within) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < exact.size(); ++i)
    if (exact[i] > 0 && exact[i] <= within && std::isfinite(distance[i]))
      errors.push_back(std::abs(distance[i] / exact[i] - 1));
  if (errors.empty()) return {};
  Relative result;
  for (double e : errors) result.mean += e / static_cast<double>(errors.size());
  std::sort(errors.begin(), errors.end());
  result.median = errors[errors.size() / 2];
  result.largest = errors.back();
  return result;
}

void run(const char* path) {
  const ahm::io::Geometry input = ahm::io::read(path);
  std::vector<ahm::trimesh::Triangle> faces;
  for (std::size_t f = 0; f < input.face_count(); ++f)
    faces.push_back({input.face(f)[0], input.face(f)[1], input.face(f)[2]});
  Surface surface;
  for (const auto& p : input.points) surface.add_vertex({p[0], p[1], p[2]});
  for (const auto& f : faces)
    surface.add_face(Surface::Vertex_index(static_cast<unsigned>(f[0])),
                     Surface::Vertex_index(static_cast<unsigned>(f[1])),
                     Surface::Vertex_index(static_cast<unsigned>(f[2])));
  const auto graph = ahm::trimesh::TriangleMeshGraph::build(input.points, faces);
  const ahm::LogMapSolver solver(graph.graph());
  const auto n = static_cast<ahm::Index>(input.points.size());
  for (ahm::Variant variant : {ahm::Variant::adaptive, ahm::Variant::localized}) {
    Relative sums[3];
    for (ahm::Index source : {n / 7, n / 2, 5 * n / 6}) {
      const std::vector<double> exact = exact_distances(surface, source);
      const auto map = graph.on_vertices(solver.solve(graph.source_at_vertex(source), {.variant = variant}));
      double farthest = 0;
      for (double d : exact)
        if (std::isfinite(d)) farthest = std::max(farthest, d);
      const double shares[] = {0.25, 0.5, 1.0};
      for (int s = 0; s < 3; ++s) {
        const Relative r = relative_error(exact, map.distance, shares[s] * farthest);
        sums[s].mean += r.mean / 3, sums[s].median += r.median / 3,
            sums[s].largest = std::max(sums[s].largest, r.largest);
      }
    }
    std::printf("| %s | %d | %s |", std::filesystem::path(path).filename().c_str(), n,
                std::string(ahm::to_string(variant)).c_str());
    for (const Relative& r : sums) std::printf(" %.4f / %.4f / %.3f |", r.mean, r.median, r.largest);
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::printf(
      "| mesh | vertices | variant | to 1/4: mean / median / max | to 1/2 | all |\n|---|---|---|---|---|---|\n");
  for (int a = 1; a < argc; ++a) try {
      run(argv[a]);
    } catch (const std::exception& e) {
      std::printf("| %s | %s |\n", argv[a], e.what());
    }
}
