/// \file
/// Flat graphs with random weights, masses and frames, for which the log map has a closed form.
#pragma once

#include <vector>

#include "ahm/graph/csr_graph.hpp"

namespace ahm::test {

/// A flat graph: positions in R^d, and for each vertex an orthogonal matrix from positions to components in its frame.
struct FlatGraph {
  int dimension = 2;
  std::vector<double> positions;  ///< n x d
  std::vector<double> frames;     ///< n x d x d, row major
  CsrGraphData data;
  double diagonal = 0;

  Index size() const { return static_cast<Index>(data.masses.size()); }
  /// Position of vertex i relative to vertex p, in the frame of p.
  std::vector<double> exact(Index p, Index i) const;
  /// Parallel transport: a vector in the frame of vertex p, expressed in the frame of vertex i.
  std::vector<double> carried(Index p, Index i, const std::vector<double>& vector) const;
  /// Diagonal of the bounding box of the positions.
  double diameter() const { return diagonal; }
};

/// An undirected edge.
struct Pair {
  Index a, b;
};

/// A flat graph with random weights in [0.1, 10], random masses in [0.1, 2] times the mean edge length to the power d, and
/// frames rotated at random. `reflections` mirrors every other frame, which requires the `kind` block.
FlatGraph flat_graph(int dimension, std::vector<double> positions, const std::vector<Pair>& edges, TransportKind kind,
                     bool reflections, unsigned seed);

/// A jittered grid of `side` x `side` points in the unit square, triangulated with random diagonals.
FlatGraph planar_triangulation(Index side, TransportKind kind = TransportKind::rotation2, bool reflections = false,
                               unsigned seed = 1);

/// Points on a line at distance 1, d = 1.
FlatGraph line_graph(Index n);

/// A jittered lattice of `side`^3 points in the unit cube, d = 3.
FlatGraph lattice3(Index side);

/// A straight strip of `length` x 3 points at distance 1. Paths from end to end have many edges.
FlatGraph strip(Index length);

/// A tube of `rings` rings of `around` vertices, at distance 1 along and around it. The x axes of the frames run along it.
CsrGraphData tube(Index rings, Index around);

}  // namespace ahm::test
