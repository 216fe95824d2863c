#include "ahm/trimesh/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/detail/gluing.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "triangle_mesh_surface.hpp"

namespace ahm::trimesh {

using detail::HalfEdges;

namespace {

/// Edges in space up to this many times the rounding of a coordinate are contracted. At longer edges, the angles around a flat
/// vertex sum to 2 pi to 1e-8 in any plane, because this error is the square of the angle by which rounding rotates an edge.
constexpr double min_edge_in_space = 8192;
/// Edges of a mesh of edge lengths are contracted up to this fraction of the longest edge of their component.
constexpr double min_edge_by_length = 1e-15;

void check_lengths(std::span<const Triangle> faces, std::span<const std::array<double, 3>> lengths) {
  if (lengths.size() != faces.size())
    throw InvalidGeometry("'lengths' has " + detail::counted(lengths.size(), "entry") + " for " +
                          detail::counted(faces.size(), "face"));
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

std::span<const Index> corners_of(std::span<const Triangle> faces) {
  return {faces.empty() ? nullptr : faces.front().data(), 3 * faces.size()};
}

detail::GluedMesh glued(Index vertices, std::span<const Triangle> faces, NonManifold non_manifold,
                        std::span<const std::uint8_t> counts_as_reversed) {
  std::vector<Offset> begin(faces.size() + 1);
  for (std::size_t f = 0; f < begin.size(); ++f) begin[f] = static_cast<Offset>(3 * f);
  return detail::GluedMesh(vertices, {begin, corners_of(faces)}, non_manifold, counts_as_reversed);
}

}  // namespace

TriangleMesh::TriangleMesh(Index vertices, std::span<const Triangle> faces, NonManifold non_manifold,
                           std::span<const std::uint8_t> counts_as_reversed)
    : topology_(glued(vertices, faces, non_manifold, counts_as_reversed)) {}

TriangleMesh TriangleMesh::from_positions(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                          NonManifold non_manifold, std::span<const std::uint8_t> counts_as_reversed) {
  detail::check_positions(positions, corners_of(faces));
  TriangleMesh mesh(static_cast<Index>(positions.size()), faces, non_manifold, counts_as_reversed);
  mesh.input_.assign(positions.begin(), positions.end());
  std::vector<Vec3> points;
  for (Index v : mesh.input_of_vertex()) points.push_back(positions[v]);
  auto normalized = detail::normalize_positions(std::move(points), mesh.topology_.parts());
  mesh.position_ = std::move(normalized.points);
  mesh.rounding_ = std::move(normalized.rounding);
  mesh.length_unit_ = normalized.unit;
  const HalfEdges edges = mesh.topology_.half_edges();
  std::vector<std::uint8_t> contracted(edges.tail.size());
  for (Half h = 0; h < edges.size(); ++h) {
    const double length = norm(mesh.position_[edges.head(h)] - mesh.position_[edges.tail[h]]);
    contracted[h] = length <= min_edge_in_space * mesh.rounding_[edges.tail[h]];
  }
  mesh.contract(std::move(contracted));
  return mesh;
}

/// Contracts edges, and keeps positions of the remaining vertices.
/// @param contracted  per half-edge, 1 for both halves of an edge to contract
void TriangleMesh::contract(std::vector<std::uint8_t> contracted) {
  if (std::find(contracted.begin(), contracted.end(), 1) == contracted.end()) return;
  const std::vector<Index> tails_before(tails().begin(), tails().end()),
      input_before(input_of_vertex().begin(), input_of_vertex().end());
  topology_.contract(std::move(contracted));
  if (position_.empty()) return;
  // Copies of a split vertex have their own positions, each relative to the center of its component.
  std::vector<Index> before(input_of_vertex().size(), -1);
  for (std::size_t h = 0; h < tails().size(); ++h) {
    if (is_dropped(static_cast<Index>(h / 3))) continue;
    const Index vertex = tails()[h];
    if (before[vertex] < 0 || input_before[tails_before[h]] == input_of_vertex()[vertex])
      before[vertex] = tails_before[h];
  }
  std::vector<Vec3> positions;
  std::vector<double> rounding;
  for (const Index vertex : before) {
    positions.push_back(position_[vertex]);
    rounding.push_back(rounding_[vertex]);
  }
  position_ = std::move(positions);
  rounding_ = std::move(rounding);
}

Half TriangleMesh::kept_corner(Index face, int corner) const {
  const int stored = stored_corner(face, corner);
  if (!is_dropped(face)) return 3 * face + stored;
  const Half kept = topology_.stand_in(face)[stored];
  if (kept < 0) throw InvalidArgument("face " + std::to_string(face) + " has no area, and no face next to it has one");
  return kept;
}

TriangleMesh TriangleMesh::from_edge_lengths(Index vertices, std::span<const Triangle> faces,
                                             std::span<const std::array<double, 3>> lengths, NonManifold non_manifold) {
  check_lengths(faces, lengths);
  TriangleMesh mesh(vertices, faces, non_manifold);
  double longest = 0;
  for (const auto& l : lengths) longest = std::max({longest, l[0], l[1], l[2]});
  const int exponent = longest > 0 ? std::ilogb(longest) : 0;
  mesh.length_unit_ = std::scalbn(1.0, exponent);
  mesh.length_.resize(mesh.tails().size());
  for (std::size_t f = 0; f < lengths.size(); ++f)
    for (int s = 0; s < 3; ++s)
      mesh.length_[3 * f + (mesh.reversed()[f] ? 2 - s : s)] = std::scalbn(lengths[f][s], -exponent);
  for (std::size_t h = 0; h < mesh.length_.size(); ++h) {
    const Half t = mesh.twins()[h];
    if (t < static_cast<Half>(h)) continue;
    const double a = mesh.length_[h], b = mesh.length_[t];
    if (std::abs(a - b) > 1e-9 * std::max(a, b))
      throw InvalidGeometry("faces " + std::to_string(h / 3) + " and " + std::to_string(t / 3) + " have lengths " +
                            detail::number(std::scalbn(a, exponent)) + " and " +
                            detail::number(std::scalbn(b, exponent)) + " for their common edge; they must be equal");
    mesh.length_[t] = a;
  }
  const std::span<const Index> part = mesh.topology_.parts();
  std::vector<double> longest_of_part(part.size(), 0.0);
  for (std::size_t h = 0; h < mesh.length_.size(); ++h) {
    double& longest_here = longest_of_part[part[mesh.tails()[h]]];
    longest_here = std::max(longest_here, mesh.length_[h]);
  }
  std::vector<std::uint8_t> contracted(mesh.length_.size());
  for (std::size_t h = 0; h < contracted.size(); ++h)
    contracted[h] = mesh.length_[h] <= min_edge_by_length * longest_of_part[part[mesh.tails()[h]]];
  mesh.contract(std::move(contracted));
  for (std::size_t h = 0; h < mesh.length_.size(); ++h)
    if (const Half t = mesh.twins()[h]; t > static_cast<Half>(h)) mesh.length_[t] = mesh.length_[h];
  return mesh;
}

std::array<Vec2, 3> TriangleMesh::layout(Index face) const {
  const auto h = 3 * static_cast<std::size_t>(face);
  return has_positions()
             ? layout_of_positions(position_[tails()[h]], position_[tails()[h + 1]], position_[tails()[h + 2]])
             : layout_of_lengths(length_[h], length_[h + 1], length_[h + 2]);
}

}  // namespace ahm::trimesh
