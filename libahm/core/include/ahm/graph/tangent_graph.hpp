/// \file
/// The one interface between geometry and the solver: a graph whose vertices carry tangent spaces R^d.
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

/// The out-edges of one vertex i. A neighbour may appear more than once (parallel edges).
struct Star {
  int dimension;                     ///< d
  std::span<const Index> neighbors;  ///< j, one per edge
  std::span<const double> weights;   ///< w_ij = w_ji
  std::span<const double> logs;      ///< e_ij in frame i, degree x d: where j lies, seen from i
  std::span<const double>
      transports;  ///< R_ji: components in frame j -> components in frame i; degree x 2 or degree x d*d

  std::size_t degree() const { return neighbors.size(); }
  /// e_ij of edge number `edge`, d numbers.
  std::span<const double> log(std::size_t edge) const { return logs.subspan(edge * dimension, dimension); }
  /// R_ji of edge number `edge`. No square is 2, so that the number of numbers tells how they are stored.
  Transport transport(std::size_t edge) const {
    const bool is_complex = transports.size() == 2 * degree();
    const TransportLayout layout{is_complex ? TransportKind::rotation2 : TransportKind::block, dimension};
    return {layout, transports.data() + edge * layout.width()};
  }
  /// The star with that edge alone.
  Star only(std::size_t edge) const {
    const std::size_t width = transports.size() / degree();
    return {dimension, neighbors.subspan(edge, 1), weights.subspan(edge, 1), log(edge),
            transports.subspan(edge * width, width)};
  }
};

/// Tangent axes at a vertex in ambient 3-space, for input and display. The solver never asks for them.
struct Frame {
  Vec3 origin;  ///< the vertex
  Vec3 x;       ///< first tangent axis, unit length
  Vec3 y;       ///< second tangent axis, unit length
  Vec3 normal;  ///< x cross y
};

/// An immutable graph on n vertices whose tangent spaces are R^d (docs/concepts/graph_contract.md).
///
/// Lengths (edge logs, square root of masses in d = 2, mean edge length) are in units of `length_unit()`.
/// `validate` lists the laws and checks them.
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
  /// The same of the connected component of a vertex alone, whose diffusion time it sets, where the backend has measured it;
  /// 0: not, and `mean_edge_length` is shared out in the ratio of the components' mean |e_ij|.
  virtual double component_edge_length(Index) const { return 0; }
  /// Lumped mass (dual area or volume) m_i > 0.
  virtual double mass(Index vertex) const = 0;
  /// The out-edges of `vertex`. A star lives until the next call on the same thread, no longer: whoever needs two at a
  /// time copies one.
  virtual Star star(Index vertex) const = 0;
  /// Number of directed edges, to size arrays.
  virtual Offset edge_count() const noexcept = 0;

  /// What a length of 1 in this graph means outside. Backends store geometry divided by a power of two, so that models
  /// at any scale from 1e-300 to 1e300 are solved alike; results are multiplied by it again.
  virtual double length_unit() const noexcept { return 1.0; }
  /// Whether d = 2 and the edges are the sides of an intrinsic Delaunay triangulation, all of them, so that distances can be
  /// unfolded across its triangles (`Wavefront`).
  virtual bool is_delaunay() const noexcept { return false; }
  /// Tangent axes in ambient space, in world units, where the backend knows them.
  virtual std::optional<Frame> frame(Index) const { return std::nullopt; }
};

/// A mass of the graph, or a sum of them, in world units to the power d. NaN where that is beyond a double or has lost
/// digits at its lower end, as areas have from lengths of about 1e154 up and 1e-154 down.
double world_mass(const TangentGraph& graph, double mass);

}  // namespace ahm
