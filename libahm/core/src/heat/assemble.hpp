/// \file
/// The matrices c (M + tau L) and c (M + tau L^nabla) of a graph.
#pragma once

#include <span>

#include "ahm/graph/tangent_graph.hpp"
#include "heat/cholesky.hpp"

namespace ahm {

struct AssembledOperators {
  SparseUpper A;  ///< c (M + tau L), n x n real
  SparseUpper B;  ///< c (M + tau L^nabla): n x n complex Hermitian (rotation2) or nd x nd real (block)
};

/// Assembles both operators in one pass over the graph's stars; parallel edges are summed. Time and memory O(nnz).
/// @param tau  of each vertex, the same at both ends of an edge
AssembledOperators assemble(const TangentGraph& graph, std::span<const double> tau, double scaling);

}  // namespace ahm
