#include "ahm/polymesh/polygon_mesh.hpp"

#include <algorithm>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/detail/gluing.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "polygon.hpp"

namespace ahm::polymesh {

PolygonMesh PolygonMesh::from_faces(std::span<const Vec3> positions, std::span<const Offset> face_begin,
                                    std::span<const Index> face_vertices, NonManifold non_manifold,
                                    std::span<const std::uint8_t> counts_as_reversed) {
  detail::check_positions(positions, face_vertices);
  PolygonMesh mesh(detail::GluedMesh(static_cast<Index>(positions.size()), {face_begin, face_vertices}, non_manifold,
                                     counts_as_reversed));
  mesh.collect_corners();
  if (!mesh.report().orientable) mesh.orient_vertices();
  mesh.input_.assign(positions.begin(), positions.end());
  std::vector<Vec3> points;
  for (Index v : mesh.input_of_vertex()) points.push_back(positions[v]);
  auto normalized = detail::normalize_positions(std::move(points), mesh.topology_.parts());
  mesh.position_ = std::move(normalized.points);
  mesh.length_unit_ = normalized.unit;
  return mesh;
}

void PolygonMesh::collect_corners() {
  at_begin_.assign(input_of_vertex().size() + 1, 0);
  for (Index v : corners()) ++at_begin_[v + 1];
  for (std::size_t v = 1; v < at_begin_.size(); ++v) at_begin_[v] += at_begin_[v - 1];
  std::vector<Offset> fill(at_begin_.begin(), at_begin_.end() - 1);
  at_.resize(corners().size());
  for (std::size_t h = 0; h < corners().size(); ++h) at_[fill[corners()[h]]++] = static_cast<Offset>(h);
}

/// Orients each vertex of a non-orientable mesh like its first face, and compares the other faces with it.
void PolygonMesh::orient_vertices() {
  const detail::HalfEdges edges = topology_.half_edges();
  mirrored_.assign(corners().size(), 0);
  for (detail::Half first : topology_.corners()) {
    const detail::Corner start = edges.rightmost({first, true});
    for (detail::Corner c = start; c.half >= 0;) {
      mirrored_[c.half] = !c.forward;
      c = edges.turn_left(c);
      if (c == start) break;
    }
  }
}

std::vector<Index> PolygonMesh::collinear_faces() const {
  std::vector<Index> result;
  Polygon polygon;
  for (Index f = 0; f < face_count(); ++f) {
    polygon.read_corners(*this, f);
    if (polygon.is_collinear()) result.push_back(f);
  }
  return result;
}

Refinement PolygonMesh::refined() const {
  Refinement result;
  for (Index v : input_of_vertex()) result.positions.push_back(input_[v]);
  result.face_begin.push_back(0);
  Polygon polygon;
  std::vector<std::array<std::size_t, 3>> ears;
  for (Index f = 0; f < face_count(); ++f) {
    const auto corners = face(f);
    if (corners.size() == 3) {
      result.triangles.push_back({corners[0], corners[1], corners[2]});
    } else {
      polygon.read(*this, f);
      ears.clear();
      const bool is_folded = !polygon.is_collinear() && polygon.is_folded();
      if (is_folded && polygon.cut_ears(ears)) {
        for (const auto& [a, b, c] : ears) result.triangles.push_back({corners[a], corners[b], corners[c]});
      } else {
        if (is_folded) result.folded.push_back(f);
        const auto middle = static_cast<Index>(result.positions.size());
        result.positions.push_back(polygon.blend(result.positions, corners));
        for (std::size_t s = 0; s < corners.size(); ++s)
          result.triangles.push_back({corners[s], corners[(s + 1) % corners.size()], middle});
      }
    }
    result.face_begin.push_back(static_cast<Offset>(result.triangles.size()));
  }
  return result;
}

}  // namespace ahm::polymesh
