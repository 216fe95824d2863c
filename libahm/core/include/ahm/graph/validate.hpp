/// \file
/// Checks the contract of a tangent graph.
#pragma once

#include "ahm/graph/tangent_graph.hpp"

namespace ahm {

/// Checks all requirements of a `TangentGraph`. The message names the first violation and its vertex or edge:
///  - n >= 1, d >= 1; `rotation2` only for d = 2; mean edge length and unit of length finite and > 0;
///  - masses finite and > 0;
///  - neighbors in range, no self loops; weights, logs and transports finite;
///  - transports orthogonal: R R^T = id to 1e-8;
///  - each edge has a reverse edge with the same weight, and R_ij R_ji = id to 1e-8. Parallel edges are matched one to one.
///
/// Time is linear in the number of edges times the largest degree.
///
/// \code
/// ahm::validate(graph);  // throws InvalidGraph "edge 3 -> 17: the transport is not orthogonal"
/// \endcode
/// @param threads  0: one per core. The exception does not depend on it
/// @throws InvalidGraph
void validate(const TangentGraph& graph, unsigned threads = 1);

}  // namespace ahm
