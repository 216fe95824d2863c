#include "flat_faces.hpp"

#include <Eigen/Geometry>

#include "polygon.hpp"
#include "polygon_frames.hpp"

namespace ahm::polymesh {

std::vector<Vec2> flat_faces(const PolygonMesh& mesh) {
  std::vector<Vec2> places;
  places.reserve(mesh.corners().size());
  Polygon polygon;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    polygon.read_corners(mesh, f);
    const Eigen::Vector3d area = polygon.vector_area(), first = polygon.corner(0), side = polygon.corner(1) - first;
    const Eigen::Vector3d normal = area.norm() > 0 ? Eigen::Vector3d(area.normalized()) : side.unitOrthogonal();
    const Axes plane = axes_along(normal, side);
    for (std::size_t c = 0; c < polygon.size(); ++c) {
      const std::complex<double> place = plane.components(polygon.corner(c) - first);
      places.push_back({place.real(), place.imag()});
    }
  }
  return places;
}

}  // namespace ahm::polymesh
