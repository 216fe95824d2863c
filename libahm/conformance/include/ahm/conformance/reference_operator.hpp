/// \file
/// The paper's (d + 1) n x (d + 1) n affine connection Laplacian, assembled and solved as written (Alg. 1, Alg. 2). The
/// library itself never assembles it; this is what its elimination is checked against.
#pragma once

#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"

namespace ahm::test {

/// phi, n x d, for a vertex source whose axes are those of its frame.
std::vector<double> reference_log_map(const TangentGraph& graph, Index source, Variant variant, double t_coef = 1.0);

}  // namespace ahm::test
