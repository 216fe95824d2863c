#include "ahm/trimesh/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/util/disjoint_sets.hpp"
#include "ahm/error.hpp"
#include "ahm/surface/gluing.hpp"
#include "ahm/util/text.hpp"
#include "face_layout.hpp"
#include "half_edges.hpp"
#include "vec.hpp"

namespace ahm::trimesh {
namespace {

using detail::DisjointSets;
using detail::ItemList;

void check_lengths(std::span<const Triangle> faces, std::span<const std::array<double, 3>> lengths) {
  if (lengths.size() != faces.size())
    throw InvalidGeometry("'lengths' has " + std::to_string(lengths.size()) + " entries for " +
                          std::to_string(faces.size()) + " faces");
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (int s = 0; s < 3; ++s) {
      const double l = lengths[f][s], rest = lengths[f][(s + 1) % 3] + lengths[f][(s + 2) % 3];
      if (!(l >= 0) || !std::isfinite(l))
        throw InvalidGeometry("length " + std::to_string(s) + " of face " + std::to_string(f) + " is " +
                              detail::number(l) + "; it must be finite and >= 0");
      if (l > rest * (1 + 1e-9))
        throw InvalidGeometry("face " + std::to_string(f) + " breaks the triangle inequality: " + detail::number(l) +
                              " > " + detail::number(rest));
    }
}

/// Fans of faces about the input vertices.
struct Fans {
  std::vector<Index> of_half;  ///< per half-edge, about its start
  std::vector<Half> corner;    ///< per fan: its lowest half-edge
  std::vector<Index> first;    ///< per input vertex: its first fan, -1: none
  std::vector<Index> later;    ///< the others
  ItemList pinched;            ///< vertices of the others
};

Fans find_fans(const HalfEdges& edges, Index vertices) {
  Fans fans;
  fans.of_half.assign(edges.tail.size(), -1);
  fans.first.assign(static_cast<std::size_t>(vertices), -1);
  for (Half h = 0; h < edges.size(); ++h) {
    if (fans.of_half[h] >= 0) continue;
    const auto number = static_cast<Index>(fans.corner.size());
    fans.corner.push_back(h);
    if (Index& first = fans.first[edges.tail[h]]; first < 0) {
      first = number;
    } else {
      fans.pinched.add(std::to_string(edges.tail[h]));
      fans.later.push_back(number);
    }
    for (Corner c = edges.rightmost({h, true}); c.half >= 0 && fans.of_half[c.half] < 0; c = edges.turn_left(c))
      fans.of_half[c.half] = number;
  }
  return fans;
}

}  // namespace

TriangleMesh::TriangleMesh(Index vertices, std::span<const Triangle> faces, NonManifold non_manifold) {
  report_.vertices = vertices;
  report_.faces = static_cast<Index>(faces.size());
  build_half_edges(vertices, faces, non_manifold);
  number_vertices(non_manifold);
  count_parts();
}

/// Half-edges of the oriented faces, tails still input vertices. Turning (a, b, c) over to (a, c, b) takes side s to
/// side 2 - s.
void TriangleMesh::build_half_edges(Index vertices, std::span<const Triangle> faces, NonManifold non_manifold) {
  std::vector<Offset> begin(faces.size() + 1);
  for (std::size_t f = 0; f < begin.size(); ++f) begin[f] = static_cast<Offset>(3 * f);
  const std::span corners(faces.empty() ? nullptr : faces.front().data(), 3 * faces.size());
  detail::Gluing gluing = detail::glue(vertices, {begin, corners}, non_manifold);
  report_.non_manifold_edges = gluing.non_manifold_edges;
  report_.reoriented = gluing.reoriented;
  report_.orientable = gluing.orientable;
  reversed_ = std::move(gluing.reversed);
  auto stored = [&](Half h) { return reversed_[h / 3] ? 3 * (h / 3) + 2 - h % 3 : h; };
  const auto halves = static_cast<Half>(faces.size() * 3);
  tail_.resize(faces.size() * 3);
  twin_.resize(faces.size() * 3);
  for (Half h = 0; h < halves; ++h) {
    tail_[3 * (h / 3) + stored_corner(h / 3, h % 3)] = faces[h / 3][h % 3];
    const Half t = gluing.partner[h];
    twin_[stored(h)] = t >= 0 ? stored(t) : -1 - report_.boundary_edges++;
  }
  if (report_.orientable) return;
  mirrored_.resize(faces.size() * 3);
  for (Half h = 0; h < halves; ++h) mirrored_[h] = twin_[h] >= 0 && tail_[h] == tail_[twin_[h]];
}

/// Makes every fan of faces about an input vertex a vertex: first fans are numbered in the order of the input, then the
/// others.
void TriangleMesh::number_vertices(NonManifold non_manifold) {
  Fans fans = find_fans(HalfEdges(*this), report_.vertices);
  report_.non_manifold_vertices = static_cast<Index>(fans.pinched.count());
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
  for (std::size_t h = 0; h < tail_.size(); ++h) tail_[h] = vertex_of_fan[fans.of_half[h]];
}

void TriangleMesh::count_parts() {
  DisjointSets parts(input_of_vertex_.size()), loops(input_of_vertex_.size());
  std::vector<std::uint8_t> on_boundary(input_of_vertex_.size(), 0);
  for (Half h = 0; h < static_cast<Half>(tail_.size()); ++h) {
    const Index a = tail_[h], b = tail_[next(h)];
    parts.join(a, b);
    if (twin_[h] >= 0) continue;
    on_boundary[a] = on_boundary[b] = 1;
    loops.join(a, b);
  }
  for (Index v = 0; v < vertex_count(); ++v) {
    report_.components += parts.root(v) == v;
    report_.boundary_loops += on_boundary[v] && loops.root(v) == v;
  }
}

TriangleMesh TriangleMesh::from_positions(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                          NonManifold non_manifold) {
  detail::check_positions(positions);
  TriangleMesh mesh(static_cast<Index>(positions.size()), faces, non_manifold);
  mesh.input_.assign(positions.begin(), positions.end());
  for (Index v : mesh.input_of_vertex_) mesh.position_.push_back(positions[v]);
  mesh.length_unit_ = detail::normalize_positions(mesh.position_);
  return mesh;
}

TriangleMesh TriangleMesh::from_edge_lengths(Index vertices, std::span<const Triangle> faces,
                                             std::span<const std::array<double, 3>> lengths, NonManifold non_manifold) {
  check_lengths(faces, lengths);
  TriangleMesh mesh(vertices, faces, non_manifold);
  double longest = 0;
  for (const auto& l : lengths) longest = std::max({longest, l[0], l[1], l[2]});
  const int exponent = longest > 0 ? std::ilogb(longest) : 0;
  mesh.length_unit_ = std::scalbn(1.0, exponent);
  mesh.length_.resize(mesh.tail_.size());
  for (std::size_t f = 0; f < lengths.size(); ++f)
    for (int s = 0; s < 3; ++s)
      mesh.length_[3 * f + (mesh.reversed_[f] ? 2 - s : s)] = std::scalbn(lengths[f][s], -exponent);
  for (std::size_t h = 0; h < mesh.length_.size(); ++h) {
    const Half t = mesh.twin_[h];
    if (t < static_cast<Half>(h)) continue;
    const double a = mesh.length_[h], b = mesh.length_[t];
    if (std::abs(a - b) > 1e-9 * std::max(a, b))
      throw InvalidGeometry("faces " + std::to_string(h / 3) + " and " + std::to_string(t / 3) +
                            " give their common edge lengths " + detail::number(std::scalbn(a, exponent)) + " and " +
                            detail::number(std::scalbn(b, exponent)) + "; they must be equal");
    mesh.length_[t] = a;
  }
  return mesh;
}

std::array<std::array<double, 2>, 3> TriangleMesh::layout(Index face) const {
  const auto h = 3 * static_cast<std::size_t>(face);
  const FaceLayout sides =
      has_positions() ? layout_of_positions(position_[tail_[h]], position_[tail_[h + 1]], position_[tail_[h + 2]])
                      : layout_of_lengths(length_[h], length_[h + 1], length_[h + 2]);
  return {{{sides[0].x, sides[0].y}, {sides[1].x, sides[1].y}, {sides[2].x, sides[2].y}}};
}

}  // namespace ahm::trimesh
