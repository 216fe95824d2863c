/// \file
/// The paper's (d + 1) n x (d + 1) n affine connection Laplacian, assembled and solved as in Alg. 1 and Alg. 2. Tests
/// compare the library, which eliminates the homogeneous coordinate, with it.
#pragma once

#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"

namespace ahm::test {

/// The log map phi, n x d, from a vertex in the axes of its frame.
std::vector<double> reference_log_map(const TangentGraph& graph, Index source, Variant variant, double t_coef = 1.0);

}  // namespace ahm::test
