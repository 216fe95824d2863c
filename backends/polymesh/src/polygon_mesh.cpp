#include "ahm/polymesh/polygon_mesh.hpp"

#include <algorithm>
#include <string>

#include "ahm/util/disjoint_sets.hpp"
#include "ahm/error.hpp"
#include "ahm/surface/gluing.hpp"
#include "polygon.hpp"

namespace ahm::polymesh {

using detail::DisjointSets;
using detail::Half;

/// The oriented faces' sides, numbered like the corners they leave from.
struct PolygonMesh::Sides {
  const std::vector<Offset>& face_begin;
  const std::vector<Index>& face_of;
  std::vector<Index> tail;  ///< input vertices
  std::vector<Half> twin;   ///< -1: boundary

  Half size() const { return static_cast<Half>(tail.size()); }
  Half next(Half h) const {
    return h + 1 == face_begin[face_of[h] + 1] ? static_cast<Half>(face_begin[face_of[h]]) : h + 1;
  }
  Half previous(Half h) const {
    return static_cast<Half>(h == face_begin[face_of[h]] ? face_begin[face_of[h] + 1] - 1 : h - 1);
  }
  /// Whether the two faces at a side are oppositely oriented.
  bool is_mirrored(Half h) const { return tail[h] == tail[twin[h]]; }
  /// The corner beyond side h about the vertex h leaves from, and about the vertex it leads to.
  Half across_tail(Half h) const { return is_mirrored(h) ? twin[h] : next(twin[h]); }
  Half across_head(Half h) const { return is_mirrored(h) ? next(twin[h]) : twin[h]; }
};

PolygonMesh PolygonMesh::from_faces(std::span<const Vec3> positions, std::span<const Offset> face_begin,
                                    std::span<const Index> face_vertices, NonManifold non_manifold) {
  detail::check_positions(positions);
  const FaceList faces{face_begin, face_vertices};
  PolygonMesh mesh;
  mesh.report_.vertices = static_cast<Index>(positions.size());
  detail::Gluing gluing = detail::glue(mesh.report_.vertices, faces, non_manifold);
  mesh.report_.faces = static_cast<Index>(faces.size());
  mesh.report_.reoriented = gluing.reoriented;
  mesh.report_.orientable = gluing.orientable;
  mesh.report_.non_manifold_edges = gluing.non_manifold_edges;
  mesh.face_begin_.assign(face_begin.begin(), face_begin.end());
  mesh.reversed_ = std::move(gluing.reversed);

  // A reversed face keeps its first corner: its side s becomes side m - 1 - s.
  mesh.face_of_.resize(face_vertices.size());
  Sides sides{mesh.face_begin_, mesh.face_of_, {}, {}};
  sides.tail.resize(face_vertices.size());
  sides.twin.resize(face_vertices.size());
  for (Index f = 0; f < static_cast<Index>(faces.size()); ++f)
    std::fill(mesh.face_of_.begin() + face_begin[f], mesh.face_of_.begin() + face_begin[f + 1], f);
  auto stored = [&](Half h) {
    const Index f = mesh.face_of_[h];
    return mesh.reversed_[f] ? static_cast<Half>(face_begin[f] + face_begin[f + 1] - 1 - h) : h;
  };
  for (Half h = 0; h < sides.size(); ++h) {
    const Index f = mesh.face_of_[h];
    const bool turned = mesh.reversed_[f] && h != face_begin[f];
    sides.tail[turned ? face_begin[f] + face_begin[f + 1] - h : h] = face_vertices[h];
    sides.twin[stored(h)] = gluing.partner[h] >= 0 ? stored(gluing.partner[h]) : -1;
  }
  mesh.number_vertices(sides, non_manifold);
  mesh.collect_corners();
  if (!mesh.report_.orientable) mesh.orient_vertices(sides);
  mesh.count_parts(sides);

  mesh.input_.assign(positions.begin(), positions.end());
  for (Index v : mesh.input_of_vertex_) mesh.position_.push_back(positions[v]);
  mesh.length_unit_ = detail::normalize_positions(mesh.position_);
  return mesh;
}

/// Makes every fan of faces about an input vertex a vertex: first fans are numbered in the order of the input, then the
/// others.
void PolygonMesh::number_vertices(const Sides& sides, NonManifold non_manifold) {
  DisjointSets fans(sides.tail.size());  // of corners
  for (Half h = 0; h < sides.size(); ++h) {
    if (sides.twin[h] < 0) continue;
    fans.join(h, sides.across_tail(h));
    fans.join(sides.next(h), sides.across_head(h));
  }
  vertex_of_input_.assign(static_cast<std::size_t>(report_.vertices), -1);
  std::vector<Half> later;
  detail::ItemList pinched;
  for (Half h = 0; h < sides.size(); ++h) {
    if (fans.root(h) != h) continue;
    Index& first = vertex_of_input_[sides.tail[h]];
    if (first >= 0) {
      later.push_back(h);
      pinched.add(std::to_string(sides.tail[h]));
    } else {
      first = h;
    }
  }
  report_.non_manifold_vertices = static_cast<Index>(later.size());
  if (pinched.count() > 0 && non_manifold == NonManifold::error)
    throw InvalidGeometry(
        "non_manifold_vertices",
        std::to_string(pinched.count()) + " vertices join several fans of faces (bow ties): " + pinched.text(),
        "repair them, or split them with NonManifold::split");
  corner_.assign(sides.tail.size(), -1);
  for (Index v = 0; v < report_.vertices; ++v) {
    if (Index& first = vertex_of_input_[v]; first >= 0) {
      corner_[first] = vertex_count();
      first = vertex_count();
      input_of_vertex_.push_back(v);
    } else {
      ++report_.unreferenced;
    }
  }
  for (Half h : later) {
    corner_[h] = vertex_count();
    input_of_vertex_.push_back(sides.tail[h]);
  }
  for (Half h = 0; h < sides.size(); ++h) corner_[h] = corner_[fans.root(h)];
}

void PolygonMesh::collect_corners() {
  at_begin_.assign(input_of_vertex_.size() + 1, 0);
  for (Index v : corner_) ++at_begin_[v + 1];
  for (std::size_t v = 1; v < at_begin_.size(); ++v) at_begin_[v] += at_begin_[v - 1];
  std::vector<Offset> fill(at_begin_.begin(), at_begin_.end() - 1);
  at_.resize(corner_.size());
  for (std::size_t h = 0; h < corner_.size(); ++h) at_[fill[corner_[h]]++] = static_cast<Offset>(h);
}

/// Where the mesh has no orientation, each vertex takes that of its first face and compares the others with it.
void PolygonMesh::orient_vertices(const Sides& sides) {
  mirrored_.assign(corner_.size(), 2);
  std::vector<Half> fan;
  for (Index v = 0; v < vertex_count(); ++v) {
    const auto start = static_cast<Half>(corners_at(v).front());
    mirrored_[start] = 0;
    fan.assign(1, start);
    for (std::size_t at = 0; at < fan.size(); ++at) {
      const Half h = fan[at], before = sides.previous(h);
      auto visit = [&](Half side, Half corner) {
        if (mirrored_[corner] != 2) return;
        mirrored_[corner] = mirrored_[h] ^ static_cast<std::uint8_t>(sides.is_mirrored(side));
        fan.push_back(corner);
      };
      if (sides.twin[h] >= 0) visit(h, sides.across_tail(h));
      if (sides.twin[before] >= 0) visit(before, sides.across_head(before));
    }
  }
}

void PolygonMesh::count_parts(const Sides& sides) {
  DisjointSets parts(input_of_vertex_.size()), loops(input_of_vertex_.size());
  std::vector<std::uint8_t> on_boundary(input_of_vertex_.size(), 0);
  for (Half h = 0; h < sides.size(); ++h) {
    const Index a = corner_[h], b = corner_[sides.next(h)];
    parts.join(a, b);
    if (sides.twin[h] >= 0) continue;
    ++report_.boundary_edges;
    on_boundary[a] = on_boundary[b] = 1;
    loops.join(a, b);
  }
  for (Index v = 0; v < vertex_count(); ++v) {
    report_.components += parts.root(v) == v;
    report_.boundary_loops += on_boundary[v] && loops.root(v) == v;
  }
}

Refinement PolygonMesh::refined() const {
  Refinement result;
  for (Index v : input_of_vertex_) result.positions.push_back(input_[v]);
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
      const bool folds = polygon.folds();
      if (folds && polygon.cut_ears(ears)) {
        for (const auto& [a, b, c] : ears) result.triangles.push_back({corners[a], corners[b], corners[c]});
      } else {
        if (folds) result.folded.push_back(f);
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
