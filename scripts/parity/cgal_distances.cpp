// Distances on a triangle mesh by CGAL: `cgal_distances MESH.off ROW` prints one line per vertex with the exact distance from ROW, the
// distance by the heat method, and the number of points of the exact shortest path. These parts of CGAL are GPL.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Geodesics = CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Mesh>>;

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  Mesh mesh;
  std::ifstream file(argv[1]);
  if (!(file >> mesh)) return 1;
  const Mesh::Vertex_index source(static_cast<unsigned>(std::stoul(argv[2])));
  Geodesics geodesics(mesh);
  geodesics.add_source_point(source);
  auto heat = mesh.add_property_map<Mesh::Vertex_index, double>("heat", 0.0).first;
  CGAL::Heat_method_3::estimate_geodesic_distances(mesh, heat, source, CGAL::Heat_method_3::Intrinsic_Delaunay());
  for (const auto vertex : mesh.vertices()) {
    std::vector<Kernel::Point_3> path;
    geodesics.shortest_path_points_to_source_points(vertex, std::back_inserter(path));
    std::printf("%.17g %.17g %zu\n", geodesics.shortest_distance_to_source_points(vertex).first, heat[vertex],
                path.size());
  }
}
