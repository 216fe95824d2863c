// CGAL's exact geodesics on a triangle mesh. This part of CGAL is GPL.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <string>

#include "ahm/error.hpp"
#include "methods/heat_fields.hpp"
#include "methods/method.hpp"

namespace ahm::methods {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Geodesics = CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Surface>>;

Surface::Vertex_index cgal_vertex(Index vertex) { return Surface::Vertex_index(static_cast<unsigned>(vertex)); }

Surface cgal_surface(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  Surface surface;
  for (const Vec3& p : positions) surface.add_vertex({p[0], p[1], p[2]});
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (Index i : faces[f]) {
      if (i < 0 || i >= static_cast<Index>(positions.size()))
        throw InvalidGeometry("face " + std::to_string(f) + ": vertex " + std::to_string(i) + " must be in [0, " +
                              std::to_string(positions.size()) + ")");
    }
    const auto& [a, b, c] = faces[f];
    if (surface.add_face(cgal_vertex(a), cgal_vertex(b), cgal_vertex(c)) == Surface::null_face())
      throw InvalidGeometry("face " + std::to_string(f) +
                            " does not fit an oriented manifold with the faces before it; orient and clean the mesh");
  }
  return surface;
}

class ExactDistance final : public Baseline {
 public:
  ExactDistance(std::span<const Vec3> positions, std::span<const Triangle> faces)
      : surface_(cgal_surface(positions, faces)) {}

  std::string_view name() const noexcept override { return "exact polyhedral"; }

  Result solve(Index source) const override {
    check_source(source, static_cast<Index>(surface_.number_of_vertices()));
    if (surface_.is_isolated(cgal_vertex(source)))
      throw InvalidArgument("'source' " + std::to_string(source) + " is used by no face");
    Geodesics geodesics(surface_);
    geodesics.add_source_point(cgal_vertex(source));
    Result result;
    for (const auto vertex : surface_.vertices()) {
      // negative: there is no path
      const double distance =
          surface_.is_isolated(vertex) ? -1.0 : geodesics.shortest_distance_to_source_points(vertex).first;
      result.distance.push_back(distance >= 0 ? distance : nan);
    }
    return result;
  }

 private:
  Surface surface_;
};

}  // namespace

Method exact_distance(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  return std::make_unique<ExactDistance>(positions, faces);
}

}  // namespace ahm::methods
