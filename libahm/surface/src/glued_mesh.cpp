#include "ahm/surface/glued_mesh.hpp"

#include <algorithm>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/gluing.hpp"
#include "ahm/util/disjoint_sets.hpp"

namespace ahm::detail {
namespace {

/// Fans of faces about the input vertices.
struct Fans {
  std::vector<Index> of_half;  ///< per half-edge, about its start
  std::vector<Half> corner;    ///< per fan: its lowest half-edge
  std::vector<Index> first;    ///< per input vertex: its first fan, -1: none
  std::vector<Index> later;    ///< the others
  ItemList pinched;            ///< vertices that have others, each once
};

Fans find_fans(const HalfEdges& edges, Index vertices, std::span<const std::uint8_t> dropped) {
  Fans fans;
  fans.of_half.assign(edges.tail.size(), -1);
  fans.first.assign(vertices, -1);
  std::vector<bool> listed(vertices);
  for (Half h = 0; h < edges.size(); ++h) {
    if (fans.of_half[h] >= 0 || (!dropped.empty() && dropped[h / 3])) continue;
    const auto number = static_cast<Index>(fans.corner.size());
    fans.corner.push_back(h);
    if (Index& first = fans.first[edges.tail[h]]; first < 0) {
      first = number;
    } else {
      if (!listed[edges.tail[h]]) fans.pinched.add(std::to_string(edges.tail[h]));
      listed[edges.tail[h]] = true;
      fans.later.push_back(number);
    }
    for (Corner c = edges.rightmost({h, true}); c.half >= 0 && fans.of_half[c.half] < 0; c = edges.turn_left(c))
      fans.of_half[c.half] = number;
  }
  return fans;
}

bool are_triangles(const FaceList& faces) {
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f].size() != 3) return false;
  return true;
}

}  // namespace

GluedMesh::GluedMesh(Index vertices, const FaceList& faces, NonManifold non_manifold,
                     std::span<const std::uint8_t> turned) {
  report_.vertices = vertices;
  report_.faces = static_cast<Index>(faces.size());
  build_half_edges(faces, non_manifold, turned);
  number_vertices(non_manifold);
  find_parts();
}

/// Half-edges of the oriented faces, tails still input vertices. Turning a face of m corners over, its first corner staying
/// first, takes side s to side m - 1 - s.
void GluedMesh::build_half_edges(const FaceList& faces, NonManifold non_manifold,
                                 std::span<const std::uint8_t> turned) {
  Gluing gluing = glue(report_.vertices, faces, non_manifold, turned);
  report_.non_manifold_edges = gluing.non_manifold_edges;
  report_.reoriented = gluing.reoriented;
  report_.orientable = gluing.orientable;
  reversed_ = std::move(gluing.reversed);
  face_begin_.assign(faces.begin.begin(), faces.begin.end());
  if (!are_triangles(faces)) {
    face_of_.resize(faces.vertices.size());
    for (Index f = 0; f < face_count(); ++f)
      std::fill(face_of_.begin() + face_begin_[f], face_of_.begin() + face_begin_[f + 1], f);
  }
  auto stored = [&](Half h) {
    const Index f = face_of(h);
    return reversed_[f] ? static_cast<Half>(face_begin_[f] + face_begin_[f + 1] - 1 - h) : h;
  };
  const auto halves = static_cast<Half>(faces.vertices.size());
  tail_.resize(faces.vertices.size());
  twin_.resize(faces.vertices.size());
  for (Half h = 0; h < halves; ++h) {
    const Index f = face_of(h);
    const auto first = static_cast<Index>(face_begin_[f]);
    tail_[first + stored_corner(f, h - first)] = faces.vertices[h];
    const Half t = gluing.partner[h];
    twin_[stored(h)] = t >= 0 ? stored(t) : -1 - report_.boundary_edges++;
  }
  if (report_.orientable) return;
  mirrored_.resize(faces.vertices.size());
  for (Half h = 0; h < halves; ++h) mirrored_[h] = twin_[h] >= 0 && tail_[h] == tail_[twin_[h]];
}

/// Makes every fan of faces about an input vertex a vertex: first fans are numbered in the order of the input, then the
/// others.
void GluedMesh::number_vertices(NonManifold non_manifold) {
  Fans fans = find_fans(half_edges(), report_.vertices, dropped_);
  report_.non_manifold_vertices = static_cast<Index>(fans.pinched.count());
  report_.added_vertices = static_cast<Index>(fans.later.size());
  if (fans.pinched.count() > 0 && non_manifold == NonManifold::error)
    throw InvalidGeometry("non_manifold_vertices",
                          std::to_string(fans.pinched.count()) +
                              " vertices join several fans of faces (bow ties): " + fans.pinched.text(),
                          "repair them, or split them with NonManifold::split");
  std::vector<Index> vertex_of_fan(fans.corner.size(), -1);
  auto number = [&](Index fan, Index input) {
    vertex_of_fan[fan] = vertex_count();
    input_of_vertex_.push_back(input);
    corner_.push_back(fans.corner[fan]);
  };
  vertex_of_input_ = std::move(fans.first);
  for (Index v = 0; v < report_.vertices; ++v) {
    if (Index& first = vertex_of_input_[v]; first >= 0) {
      number(first, v);
      first = vertex_count() - 1;
    } else {
      ++report_.unreferenced;
    }
  }
  for (Index fan : fans.later) number(fan, tail_[fans.corner[fan]]);
  for (std::size_t h = 0; h < tail_.size(); ++h)
    if (fans.of_half[h] >= 0) tail_[h] = vertex_of_fan[fans.of_half[h]];
}

void GluedMesh::find_parts() {
  const HalfEdges edges = half_edges();
  DisjointSets parts(input_of_vertex_.size()), loops(input_of_vertex_.size());
  std::vector<std::uint8_t> on_boundary(input_of_vertex_.size(), 0);
  Index faces = 0;
  Offset sides = 0;
  for (Index f = 0; f < face_count(); ++f)
    if (!is_dropped(f)) ++faces, sides += face_begin_[f + 1] - face_begin_[f];
  for (Half h = 0; h < edges.size(); ++h) {
    if (is_dropped(face_of(h))) continue;
    const Index a = tail_[h], b = edges.head(h);
    parts.join(a, b);
    if (twin_[h] >= 0) continue;
    on_boundary[a] = on_boundary[b] = 1;
    loops.join(a, b);
  }
  part_.resize(input_of_vertex_.size());
  for (Index v = 0; v < vertex_count(); ++v) {
    part_[v] = parts.root(v);
    report_.components += part_[v] == v;
    report_.boundary_loops += on_boundary[v] && loops.root(v) == v;
  }
  report_.edges = (sides + report_.boundary_edges) / 2;
  report_.euler_characteristic = vertex_count() - report_.edges + faces;
}

std::vector<Index> GluedMesh::given_corners() const {
  if (!given_corners_.empty()) return given_corners_;
  std::vector<Index> result(tail_.size());
  for (Index f = 0; f < face_count(); ++f)
    for (Offset begin = face_begin_[f], c = 0; begin + c < face_begin_[f + 1]; ++c)
      result[begin + c] = input_of_vertex_[tail_[begin + stored_corner(f, static_cast<Index>(c))]];
  return result;
}

}  // namespace ahm::detail
