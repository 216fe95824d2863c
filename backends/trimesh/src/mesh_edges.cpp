#include "mesh_edges.hpp"

#include <algorithm>
#include <cmath>

#include "ahm/util/component_lengths.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/unset_vector.hpp"

namespace ahm::trimesh {
namespace {

/// Weights up to this are rounding (diagonals of cocircular quadrilaterals) and make no edge.
constexpr double least_weight = 1e-13;

/// Larger weights make the heat at both ends equal to 1e-4 anyway, and cost the solver the digits that the sum of a row
/// needs.
constexpr double largest_weight = 1e4;

/// Of a sliver on the boundary, so that vertices in nothing else stay joined.
constexpr double least_conductance = 1e-3;

class Rows {
 public:
  Rows(const IntrinsicTriangulation& triangulation, const VertexFrames& frames, bool clamp, unsigned threads)
      : triangulation_(triangulation),
        edges_(triangulation.half_edges()),
        frames_(frames),
        clamp_(clamp),
        half_cotangents_(static_cast<std::size_t>(edges_.size())),
        units_(frames.angle.size()) {
    detail::for_each_index(half_cotangents_.size(), threads, [&](std::size_t h) {
      half_cotangents_[h] = 0.5 * triangulation_.cotangent(static_cast<Half>(h));
    });
    detail::for_each_index(units_.size(), threads, [&](std::size_t e) { units_[e] = unit(frames_.angle[e]); });
    if (clamp) find_slivers();
  }

  /// (cot alpha + cot beta) / 2, one of them on the boundary.
  double cotangents(Half side) const {
    const Half t = edges_.twin[side];
    return t >= 0 ? half_cotangents_[side] + half_cotangents_[t] : half_cotangents_[side];
  }

  /// What a face gives to the weight of its side: half the cotangent of the angle across, but in a sliver.
  double from_face(Half side) const {
    const Half base = base_.empty() ? -1 : base_[static_cast<std::size_t>(side / 3)];
    if (base < 0) return half_cotangents_[side];
    if (side == base) return 0;
    const Half third = detail::next(side) == base ? detail::previous(side) : detail::next(side);
    return std::max(0.25 / half_cotangents_[third], least_conductance);
  }

  /// w_ij; no less than what counts, so that squares and rectangles have no diagonal in the operators.
  double weight(Half side) const {
    const Half t = edges_.twin[side];
    double w = from_face(side) + (t >= 0 ? from_face(t) : 0);
    if (clamp_) w = std::clamp(w, 0.0, largest_weight);
    return std::abs(w) > least_weight ? w : 0;
  }

  /// An edge from a vertex to itself is left out. On a flat surface it contributes nothing: its two logarithms are
  /// opposite, and its holonomy is the identity. Elsewhere its sole effect would be a damping of vectors at a vertex
  /// too coarse to resolve them.
  bool is_edge(Half side) const { return edges_.tail[side] != edges_.head(side); }

  /// Calls visit(side, from_tail, forward) for every edge of the graph that leaves the vertex, counter-clockwise.
  template <class Visit>
  void for_each(std::size_t vertex, const Visit& visit) const {
    const Corner start = frames_.start[vertex];
    for (Corner c = start;;) {
      if (is_edge(edges_.right(c))) visit(edges_.right(c), c.forward, c.forward);
      const Corner left = edges_.turn_left(c);
      if (left.half < 0 && is_edge(edges_.left(c))) visit(edges_.left(c), !c.forward, c.forward);
      if (left.half < 0 || left == start) return;
      c = left;
    }
  }

  void fill(std::size_t i, CsrGraphData& g) const {
    auto at = static_cast<std::size_t>(g.row_begin[i]);
    for_each(i, [&](Half side, bool from_tail, bool forward) {
      g.neighbors[at] = from_tail ? edges_.head(side) : edges_.tail[side];
      g.weights[at] = weight(side);
      const Vec2 u_ij = units_[edges_.directed(side, from_tail)], u_ji = units_[edges_.directed(side, !from_tail)];
      const double length = triangulation_.length(side);
      g.logs[2 * at] = length * u_ij[0];
      g.logs[2 * at + 1] = length * u_ij[1];
      // The direction of the edge goes to itself: u_ji -> -u_ij, turning the same way or, between frames of opposite
      // orientation, the other way.
      const bool reflects = forward != frames_.forward(edges_, side, !from_tail);
      const Vec2 R = reflects ? -product(u_ij, u_ji) : -product(u_ij, conj(u_ji));
      if (g.kind == TransportKind::rotation2) {
        g.transports[2 * at] = R[0];
        g.transports[2 * at + 1] = R[1];
      } else {
        const double block[] = {R[0], reflects ? R[1] : -R[1], R[1], reflects ? -R[0] : R[0]};
        std::copy_n(block, 4, g.transports.begin() + static_cast<std::ptrdiff_t>(4 * at));
      }
      ++at;
    });
  }

  /// Edges of the triangulation: mean length, and what was left out.
  void summarize(CsrGraphData& g, MeshDetails& report) const {
    double sum = 0;
    detail::ComponentLengths lengths(g.masses.size());
    for (Half h = 0; h < edges_.size(); ++h) {
      const Half t = edges_.twin[h];
      if (triangulation_.is_dropped(h / 3) || (t >= 0 && t < h)) continue;
      ++report.edges;
      sum += triangulation_.length(h);
      lengths.add(edges_.tail[h], edges_.head(h), triangulation_.length(h));
      report.closed_edges += edges_.tail[h] == edges_.head(h);
      report.clamped_weights += clamp_ && cotangents(h) < -least_weight;
      report.capped_weights += clamp_ && weight(h) >= largest_weight;
    }
    g.mean_edge_length = sum / static_cast<double>(report.edges);
    g.component_edge_lengths = lengths.means();
  }

 private:
  /// Finds the slivers on the boundary that no flip removes: the weight of their outer side is negative. Setting it to zero alone
  /// would leave the weights of the other two sides, which it balances: heat would run along the boundary as if it had no
  /// length. A sliver conducts along its outer side only: of a strip of that length, the height of the sliver over either part.
  /// What it no longer gives to its other sides may show the next one.
  void find_slivers() {
    base_.assign(static_cast<std::size_t>(edges_.size() / 3), -1);
    std::vector<Half> outer;
    for (Half h = 0; h < edges_.size(); ++h)
      if (edges_.twin[h] < 0 && !triangulation_.is_dropped(h / 3)) outer.push_back(h);
    while (!outer.empty()) {
      const Half h = outer.back(), beyond = edges_.twin[h];
      outer.pop_back();
      if (base_[h / 3] >= 0 || !((beyond >= 0 ? from_face(beyond) : 0) + half_cotangents_[h] < 0)) continue;
      base_[h / 3] = h;
      for (const Half side : {detail::next(h), detail::previous(h)})
        if (edges_.twin[side] >= 0) outer.push_back(edges_.twin[side]);
    }
  }

  const IntrinsicTriangulation& triangulation_;
  HalfEdges edges_;
  const VertexFrames& frames_;
  bool clamp_;
  detail::UnsetVector<double> half_cotangents_;  ///< of the angles across the sides
  detail::UnsetVector<Vec2> units_;              ///< directions of directed edges
  std::vector<Half> base_;                       ///< of the faces that are slivers: the outer side; -1: of the others
};

/// Vertices whose faces have no area still need a mass: where it is below 1e-14 of the square of their longest edge, it
/// becomes a hundredth of that.
void mend_masses(const IntrinsicTriangulation& triangulation, std::vector<double>& masses) {
  const HalfEdges edges = triangulation.half_edges();
  std::vector<double> longest(masses.size(), 0.0);
  for (Half h = 0; h < edges.size(); ++h) {
    if (triangulation.is_dropped(h / 3)) continue;
    const double length = triangulation.length(h);
    for (Index v : {edges.tail[h], edges.head(h)}) longest[v] = std::max(longest[v], length * length);
  }
  const double of_all = std::ranges::max(longest);
  for (std::size_t v = 0; v < masses.size(); ++v)
    if (const double square = longest[v] > 0 ? longest[v] : of_all; !(masses[v] > 1e-14 * square))
      masses[v] = 0.01 * square;
}

}  // namespace

CsrGraphData mesh_edges(const TriangleMesh& mesh, const IntrinsicTriangulation& triangulation,
                        const VertexFrames& frames, bool clamp, unsigned threads, MeshDetails& report) {
  const auto n = static_cast<std::size_t>(mesh.vertex_count());
  const HalfEdges edges = triangulation.half_edges();
  const Rows rows(triangulation, frames, clamp, threads);
  CsrGraphData g;
  g.kind = mesh.report().orientable ? TransportKind::rotation2 : TransportKind::block;
  g.length_unit = mesh.length_unit();
  g.masses.assign(n, 0.0);
  for (Half h = 0; h < edges.size(); h += 3) {
    const double third = std::max(0.0, triangulation.area(h / 3)) / 3.0;
    for (Half s = h; s < h + 3; ++s) g.masses[edges.tail[s]] += third;
  }
  mend_masses(triangulation, g.masses);
  g.row_begin.assign(n + 1, 0);
  detail::for_each_index(n, threads, [&](std::size_t i) {
    Offset degree = 0;
    rows.for_each(i, [&](Half, bool, bool) { ++degree; });
    g.row_begin[i + 1] = degree;
  });
  for (std::size_t i = 0; i < n; ++i) g.row_begin[i + 1] += g.row_begin[i];
  const auto count = static_cast<std::size_t>(g.row_begin[n]);
  g.neighbors.resize(count);
  g.weights.resize(count);
  g.logs.resize(2 * count);
  g.transports.resize((g.kind == TransportKind::block ? 4 : 2) * count);
  detail::for_each_index(n, threads, [&](std::size_t i) { rows.fill(i, g); });
  rows.summarize(g, report);
  return g;
}

}  // namespace ahm::trimesh
