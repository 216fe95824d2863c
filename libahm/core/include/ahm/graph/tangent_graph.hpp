/// \file
/// The interface between geometry and the solver: a graph whose vertices have tangent spaces R^d.
///
/// \code
/// void print(const ahm::TangentGraph& graph, ahm::Index i) {
///   ahm::Star star = graph.star(i);
///   for (std::size_t e = 0; e < star.neighbors.size(); ++e)
///     std::cout << star.neighbors[e] << " lies at " << star.log(e)[0] << ", " << star.log(e)[1] << '\n';
/// }
/// \endcode
#pragma once

#include <optional>
#include <span>

#include "ahm/graph/transport.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// The out-edges of one vertex i. A neighbor may appear more than once (parallel edges).
struct Star {
  int dimension;                     ///< d
  std::span<const Index> neighbors;  ///< j, one per edge
  std::span<const double> weights;   ///< w_ij = w_ji
  std::span<const double> logs;      ///< e_ij, position of j in frame i; degree x d
  /// R_ji: components in frame j -> components in frame i; degree x 2 or degree x d*d
  std::span<const double> transports;

  std::size_t degree() const { return neighbors.size(); }
  /// Edge logarithm e_ij of edge number `edge`, d numbers.
  std::span<const double> log(std::size_t edge) const { return logs.subspan(edge * dimension, dimension); }
  /// Transport R_ji of edge number `edge`. Its storage follows from the width of `transports`, since d x d is never 2.
  Transport transport(std::size_t edge) const {
    const bool is_complex = transports.size() == 2 * degree();
    const TransportLayout layout{is_complex ? TransportKind::rotation2 : TransportKind::block, dimension};
    return {layout, transports.data() + edge * layout.width()};
  }
  /// A star with only this edge.
  Star only(std::size_t edge) const {
    const std::size_t width = transports.size() / degree();
    return {dimension, neighbors.subspan(edge, 1), weights.subspan(edge, 1), log(edge),
            transports.subspan(edge * width, width)};
  }
};

/// Tangent axes at a vertex in ambient 3-space, for input and display. The solver does not use them.
struct Frame {
  Vec3 origin;  ///< position of the vertex
  Vec3 x;       ///< first tangent axis, unit length
  Vec3 y;       ///< second tangent axis, unit length
  Vec3 normal;  ///< x cross y
};

class GraphCache;

/// An immutable graph on n vertices whose tangent spaces are R^d (docs/concepts/graph_contract.md).
///
/// Lengths (edge logs, square root of masses in d = 2, mean edge length) are in units of `length_unit()`.
/// `validate` lists and checks the requirements.
class TangentGraph {
 public:
  virtual ~TangentGraph() = default;

  /// Number of vertices n.
  virtual Index size() const noexcept = 0;
  /// Dimension d >= 1 of the tangent spaces.
  virtual int dimension() const noexcept = 0;
  virtual TransportKind transport_kind() const noexcept = 0;
  TransportLayout transport_layout() const noexcept { return {transport_kind(), dimension()}; }
  /// Mean edge length h > 0; the diffusion time is tau = t_coef h^2.
  virtual double mean_edge_length() const noexcept = 0;
  /// Mean edge length of the connected component of a vertex, which determines the component's diffusion time. 0 if the backend has
  /// not measured it; then the solver scales `mean_edge_length` in the ratio of the components' mean |e_ij|.
  virtual double component_edge_length(Index) const { return 0; }
  /// Lumped mass (dual area or volume) m_i > 0.
  virtual double mass(Index vertex) const = 0;
  /// The out-edges of `vertex`. A star is valid until the next call on the same thread. If you need two stars at a time, copy one.
  virtual Star star(Index vertex) const = 0;
  /// Number of directed edges, to size arrays.
  virtual Offset edge_count() const noexcept = 0;

  /// World length of one graph unit, a power of two. Backends divide the geometry by it, so that models of any scale from 1e-300 to
  /// 1e300 are solved alike. Results are multiplied by it.
  virtual double length_unit() const noexcept { return 1.0; }
  /// Whether d = 2 and the edges are all the edges of an intrinsic Delaunay triangulation. If so, distances can be unfolded across its
  /// triangles (`Wavefront`).
  virtual bool is_delaunay() const noexcept { return false; }
  /// Where solvers keep data that they compute from this graph, such as `Wavefront::one_rings`; null: nowhere. Graphs whose data never
  /// changes may return one.
  virtual const GraphCache* cache() const noexcept { return nullptr; }
  /// Tangent axes in ambient space, world units; nullopt if the backend has none.
  virtual std::optional<Frame> frame(Index) const { return std::nullopt; }
};

/// Converts a mass of the graph, or a sum of masses, to world units to the power d. NaN if the result overflows or is subnormal. For
/// areas this happens at lengths above about 1e154 and below about 1e-154.
double world_mass(const TangentGraph& graph, double mass);

}  // namespace ahm
