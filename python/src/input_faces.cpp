#include "input_faces.hpp"

#include <algorithm>

namespace ahm::python {

InputFaces::InputFaces(const ExactGeodesics& geodesics) : geodesics_(geodesics) {
  const Surface& surface = geodesics.surface();
  const exact::PolyhedralSurface& flat = geodesics.triangles().surface;
  const FaceList given = surface.faces();
  const std::span<const Index> turned = surface.corner_vertices();
  if (turned.size() != 3 * given.size()) return;
  // The flat triangles are in the order of the faces. Faces without area have none.
  std::size_t face = 0;
  for (Index t = 0; t < flat.face_count(); ++t) {
    std::array<Index, 3> corner{};
    for (int s = 0; s < 3; ++s) corner[s] = flat.record(3 * t + s).tail;
    while (face < given.size() &&
           !std::is_permutation(corner.begin(), corner.end(), turned.begin() + static_cast<std::ptrdiff_t>(3 * face)))
      ++face;
    if (face == given.size()) {
      corners_.clear();
      return;
    }
    // A reversed face keeps its first corner; the other two are exchanged.
    const auto vertex_at = [&](int place) {
      return surface.rows().vertices(Row(given[face][static_cast<std::size_t>(place)]));
    };
    Corners& found = corners_.emplace_back(Corners{static_cast<Index>(face), {}});
    for (int s = 0; s < 3; ++s)
      for (int place = 0; place < 3; ++place)
        if (std::ranges::find(vertex_at(place), Vertex(corner[s])) != vertex_at(place).end()) found.place[s] = place;
    ++face;
  }
}

FacePoint InputFaces::point(const exact::MeshPoint& on) const {
  if (corners_.empty()) {
    const SurfacePoint nearest = geodesics_.surface().closest_point(geodesics_.position(on)).point;
    return std::get<FacePoint>(nearest);
  }
  const Corners& corners = corners_[static_cast<std::size_t>(on.face)];
  FacePoint result{corners.face, {0, 0, 0}};
  for (int s = 0; s < 3; ++s) result.barycentric[static_cast<std::size_t>(corners.place[s])] = on.barycentric[s];
  return result;
}

}  // namespace ahm::python
