/// \file
/// Flat graphs with random weights, masses and frames, on which the log map is known exactly.
#pragma once

#include <vector>

#include "ahm/graph/csr_graph.hpp"

namespace ahm::test {

/// A flat graph: positions in R^d, and per vertex an orthogonal matrix that takes positions to components in its frame.
struct FlatGraph {
  int dimension = 2;
  std::vector<double> positions;  ///< n x d
  std::vector<double> frames;     ///< n x d x d, row major
  CsrGraphData data;
  double diagonal = 0;

  Index size() const { return static_cast<Index>(data.masses.size()); }
  /// Position of vertex i relative to vertex p, in the frame of p.
  std::vector<double> exact(Index p, Index i) const;
  /// Components in the frame of vertex i of a vector given in the frame of vertex p.
  std::vector<double> carried(Index p, Index i, const std::vector<double>& vector) const;
  /// Diagonal of the least box around the positions.
  double diameter() const { return diagonal; }
};

/// An undirected edge.
struct Pair {
  Index a, b;
};

/// Random weights in [0.1, 10], masses in [0.1, 2] x cell, frames rotated at random; `reflections` mirrors half of
/// them, which needs `kind` block.
FlatGraph flat_graph(int dimension, std::vector<double> positions, const std::vector<Pair>& edges, TransportKind kind,
                     bool reflections, unsigned seed);

/// Jittered grid of `side` x `side` points in the unit square, triangulated with random diagonals.
FlatGraph planar_triangulation(Index side, TransportKind kind = TransportKind::rotation2, bool reflections = false,
                               unsigned seed = 1);

/// Points on a line, one apart, d = 1.
FlatGraph line_graph(Index n);

/// Jittered lattice of `side`^3 points in the unit cube, d = 3.
FlatGraph lattice3(Index side);

/// A straight strip of `length` x 3 points, one apart: many edges from end to end.
FlatGraph strip(Index length);

/// A tube of `rings` rings of `around` vertices, one apart along and around it; the frames' x axes run along it.
CsrGraphData tube(Index rings, Index around);

}  // namespace ahm::test
